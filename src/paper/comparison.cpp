#include "paper/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paper/comparison_run.h"
#include "paper/displacement_errors.h"

namespace calot {
namespace {

/// How to make one body, and what its rows have in common.
struct Candidate {
  ComparisonRow row;
  std::function<Result<std::unique_ptr<ComparedBody>>()> make;
};

void add_costs(const ComparedBody& body, ComparisonRow& row) {
  for (const NewtonWorkspace* system : body.systems()) {
    const double entries = static_cast<double>(system->factor.factor_nonzeros());
    row.flops += system->factor.factor_flops() + 4 * entries;
    row.memory_bytes += sizeof(double) * (entries + static_cast<double>(system->matrix.entries().size()));
    row.condition_estimate = std::max(row.condition_estimate, 1 / system->factor.reciprocal_condition());
  }
}

class Comparing {
 public:
  Comparing(const ComparisonCase& given, const ComparedSurface& surface,
            const std::function<void(const std::string&)>& progress)
      : given_(given), surface_(surface), progress_(progress) {}

  Comparison run_all() {
    compare_formulation("shell", shells());
    if (given_.paper) compare_formulation("1997", triangles());
    add_speedups();
    out_.interrupted = given_.stopped();
    return std::move(out_);
  }

 private:
  std::vector<Vec3> places() const {
    std::vector<Vec3> out;
    for (const LoadedPlace& place : given_.loads.front().places) out.push_back(place.direction);
    return out;
  }
  int extensions() const { return static_cast<int>(given_.loads.front().places.size()); }

  std::vector<Candidate> shells() const {
    std::vector<Candidate> out;
    // The finest first: the others are measured against it.
    for (int level = given_.uniform_levels; level >= 0; --level)
      out.push_back({row_of("shell", 0, level, surface_.levels.nodes(level)),
                     [this, level] { return uniform_shell(surface_, level); }});
    for (int levels = 1; levels <= given_.extension_levels; ++levels)
      out.push_back({row_of("shell", extensions(), levels, surface_.levels.nodes(levels)),
                     [this, levels] { return extended_shell(surface_, places(), levels); }});
    return out;
  }

  std::vector<Candidate> triangles() const {
    std::vector<Candidate> out;
    for (int level = given_.uniform_levels; level >= 0; --level)
      out.push_back({row_of("1997", 0, level, surface_.levels.nodes(level)),
                     [this, level] { return uniform_triangles(surface_, level); }});
    // A star's inner edges are half of its triangle's.
    for (bool two_stages : {false, true})
      for (int levels = 0; levels <= given_.extension_levels; ++levels)
        out.push_back({row_of(two_stages ? "1997 two stages" : "1997", extensions(), levels,
                              surface_.levels.nodes(levels + 1)),
                       [this, levels, two_stages] {
                         return extended_triangles(surface_, places(), levels, two_stages);
                       }});
    return out;
  }

  static ComparisonRow row_of(const std::string& formulation, int extensions, int levels, int uniform_nodes) {
    ComparisonRow row;
    row.formulation = formulation;
    row.extensions = extensions;
    row.levels = extensions > 0 ? levels : 0;
    row.uniform_nodes = uniform_nodes;
    return row;
  }

  void compare_formulation(const std::string& family, const std::vector<Candidate>& candidates) {
    references_.clear();
    for (const Candidate& candidate : candidates) {
      if (given_.stopped()) return;
      progress_(fmt::format("{}, {} extensions, level {}, as fine as {} nodes", candidate.row.formulation,
                            candidate.row.extensions, candidate.row.levels, candidate.row.uniform_nodes));
      Result<std::unique_ptr<ComparedBody>> body = candidate.make();
      if (body)
        compare_body(*body.value(), candidate.row);
      else
        add_failed(candidate.row, to_text(body.failure()));
    }
    remember_reference(family);
  }

  void add_failed(ComparisonRow row, const std::string& status) {
    for (const ComparedLoad& load : given_.loads) {
      row.load = load.name;
      row.status = status;
      out_.rows.push_back(row);
    }
  }

  void compare_body(ComparedBody& body, ComparisonRow row) {
    row.nodes = body.nodes();
    row.insertion_ms = 1e3 * body.insertion_s();
    const bool extended = row.extensions > 0;
    double factorise_solve_s = 0;
    for (std::size_t l = 0; l < loads_for(row); ++l) {
      const ComparedLoad& load = given_.loads[l];
      row.load = load.name;
      std::vector<Vec3> displacements;
      for (double rate : given_.rates) {
        row.rate_hz = rate;
        for (FactorKind solver : solvers_of(body, extended)) {
          const ComparedRun made =
              run_out_and_back(body, load, solver, steps_out(load, rate), given_, displacements.empty());
          if (given_.stopped()) return;
          if (displacements.empty()) displacements = made.displacements;
          if (factorise_solve_s == 0) factorise_solve_s = fastest_factor_and_solve(body, extended);
          row.solver = name_of(solver);
          add_row(body, row, made, displacements, factorise_solve_s, l);
        }
        if (extended && !displacements.empty()) compare_stages(body, load, displacements);
      }
    }
  }

  /// After the row of the condensed solver, which comes last (solvers_of).
  void compare_stages(ComparedBody& body, const ComparedLoad& load, const std::vector<Vec3>& displacements) {
    if (!body.use_stages(true)) return;
    const ComparisonRow& condensed = out_.rows.back();
    const ComparedRun made =
        run_out_and_back(body, load, FactorKind::condensed, steps_out(load, condensed.rate_hz), given_, true);
    body.use_stages(false);
    if (given_.stopped()) return;
    StagedRow row{condensed.levels, load.name, condensed.rate_hz, made.status};
    row.condensed_step_ms_median = condensed.step_ms_median;
    if (made.status == "converged") {
      row.step_ms_median = 1e3 * median(made.times_s);
      const DisplacementErrors apart =
          displacement_errors(made.displacements, displacements, std::vector<bool>(displacements.size()));
      row.mean_apart_pct = apart.mean_pct;
      row.largest_apart_pct = apart.max_pct;
    }
    out_.staged.push_back(row);
  }

  /// Thousands of nodes in three triangles take a minute a load.
  std::size_t loads_for(const ComparisonRow& row) const {
    constexpr int many_nodes = 2000;
    return row.extensions > 0 && row.nodes > many_nodes ? 1 : given_.loads.size();
  }

  int steps_out(const ComparedLoad& load, double rate) const {
    double travel = 0;
    for (const LoadedPlace& place : load.places) travel = std::max(travel, std::abs(place.travel));
    return std::max(1, static_cast<int>(std::lround(travel / given_.speed * rate)));
  }

  void add_row(const ComparedBody& body, ComparisonRow row, const ComparedRun& made,
               const std::vector<Vec3>& displacements, double factorise_solve_s, std::size_t load) {
    add_costs(body, row);
    row.status = made.status;
    row.factorise_solve_ms = 1e3 * factorise_solve_s;
    row.steps = static_cast<int>(made.times_s.size());
    if (made.status == "converged") {
      row.step_ms_median = 1e3 * median(made.times_s);
      row.newton_iterations = static_cast<double>(made.iterations) / row.steps;
      row.factor_solve_ratio = 1e-3 * row.step_ms_median / factorise_solve_s;
      if (references_.size() == load) references_.push_back(displacements);
      if (!displacements.empty()) measure(displacements, load, row);
    }
    out_.rows.push_back(row);
  }

  void measure(const std::vector<Vec3>& displacements, std::size_t load, ComparisonRow& row) const {
    std::vector<bool> near;
    for (const Vec3& point : surface_.rest) near.push_back(near_a_place(point));
    const DisplacementErrors errors = displacement_errors(displacements, references_[load], near);
    row.mean_error_pct = errors.mean_pct;
    row.contact_error_pct = errors.contact_pct;
    row.max_error_pct = errors.max_pct;
  }

  bool near_a_place(const Vec3& point) const {
    const std::vector<LoadedPlace>& all = given_.loads.front().places;
    return std::any_of(all.begin(), all.end(), [&](const LoadedPlace& place) {
      return (point - surface_.radius * place.direction).norm() < near_contact;
    });
  }

  void remember_reference(const std::string& family) {
    if (family == "shell") {
      shell_references_ = references_;
      for (const std::vector<Vec3>& reference : references_)
        out_.largest_mm.push_back(1e3 * largest_of(reference));
      return;
    }
    for (std::size_t l = 0; l < std::min(references_.size(), shell_references_.size()); ++l) {
      double sum = 0;
      for (std::size_t i = 0; i < references_[l].size(); ++i)
        sum += (references_[l][i] - shell_references_[l][i]).norm();
      out_.formulations_apart_pct.push_back(100 * sum / static_cast<double>(references_[l].size()) /
                                            largest_of(shell_references_[l]));
    }
  }

  void add_speedups() {
    for (ComparisonRow& row : out_.rows) {
      double fastest = 0;
      for (const ComparisonRow& other : out_.rows) {
        const bool same = other.formulation == row.formulation.substr(0, other.formulation.size()) &&
                          other.load == row.load && other.rate_hz == row.rate_hz;
        if (!same || other.extensions > 0 || other.nodes != row.uniform_nodes || other.step_ms_median == 0)
          continue;
        if (fastest == 0 || other.step_ms_median < fastest) fastest = other.step_ms_median;
      }
      if (row.step_ms_median > 0) row.speedup = fastest / row.step_ms_median;
    }
  }

  const ComparisonCase& given_;
  const ComparedSurface& surface_;
  const std::function<void(const std::string&)>& progress_;
  std::vector<std::vector<Vec3>> references_, shell_references_;  ///< of each load
  Comparison out_;
};

}  // namespace

std::vector<ComparedLoad> standard_loads(double travel) {
  const std::vector<Vec3> places = {Vec3(0.45, 0.25, 0.86).normalized(), Vec3(-0.75, 0.2, 0.63).normalized(),
                                    Vec3(0.1, -0.85, 0.5).normalized()};
  const auto load = [&](const std::string& name, double a, double b, double c) {
    return ComparedLoad{name, {{places[0], a * travel}, {places[1], b * travel}, {places[2], c * travel}}};
  };
  return {load("pull", 1, 1, 1), load("push", -1, -1, -1), load("two instruments", 1, -1, 0)};
}

Result<Comparison> compare(const ComparisonCase& given,
                           const std::function<void(const std::string&)>& progress) {
  const bool rates = std::all_of(given.rates.begin(), given.rates.end(), [](double r) { return r > 0; });
  const bool loads = std::all_of(given.loads.begin(), given.loads.end(), [&](const ComparedLoad& load) {
    return !load.places.empty() && load.places.size() == given.loads.front().places.size();
  });
  if (!rates || !loads || given.rates.empty() || given.loads.empty() || !(given.radius > 0) ||
      !(given.speed > 0) || given.uniform_levels < 0 || given.extension_levels < 0 || given.cycles < 1)
    return fail(FailureKind::usage, "a comparison that makes no sense",
                "lengths, rates and speed above 0, at least one load, as many places in each");
  constexpr int points_level = 2;
  const int finest = std::max({given.uniform_levels, given.extension_levels, points_level});
  const Result<ComparedSurface> surface = ComparedSurface::create(given.radius, given.nodes, finest);
  if (!surface) return surface.failure();
  return Comparing(given, surface.value(), progress).run_all();
}

}  // namespace calot
