#include <algorithm>
#include <cmath>
#include <memory>

#include "base/timed.h"
#include "group/staged.h"
#include "motion/structural_extension.h"
#include "numerics/response.h"
#include "paper/comparison_run.h"

namespace calot {
namespace {

/// Springs on surface points, and where their ends are at `share` of their travels.
struct Springs {
  Links links;
  std::vector<Vec3> from, travel;
  std::vector<double> hessian;  ///< entries in the body's pattern: linear springs have one for good

  void move_to(double share) {
    for (std::size_t i = 0; i < from.size(); ++i) links.target[i] = from[i] + share * travel[i];
  }
};

/// What the springs add to a body's energy.
class SpringJoin : public Join {
 public:
  SpringJoin(const StencilTable& points, const Springs& springs) : points_(points), springs_(springs) {}

  double value(const VecX& x) const override { return springs_.links.value(points_, x); }
  void add_gradient(const VecX& x, VecX& gradient) const override {
    springs_.links.add_gradient(points_, x, gradient);
  }
  void add_hessian(const VecX& /*x*/, BlockMatrix& matrix) const override { matrix.add(springs_.hessian); }
  void add_cliques(const VecX& /*x*/, bool /*close*/,
                   std::vector<std::vector<int>>& /*cliques*/) const override {}

 private:
  const StencilTable& points_;
  const Springs& springs_;
};

/// A body that is filled and at rest.
struct Rested {
  ShellBody body;
  BodyState state;
};

class ComparedShell : public ComparedBody {
 public:
  ComparedShell(const ComparedSurface& surface, Rested rested, StencilTable points, double insertion_s)
      : surface_(surface),
        body_(std::move(rested.body)),
        points_(std::move(points)),
        work_(body_.pattern(), body_.coarse_nodes()),
        filled_(std::move(rested.state)),
        state_(filled_),
        insertion_s_(insertion_s) {
    search_.own.active = false;  // these bodies are never folded
    joins_.push_back(std::make_shared<SpringJoin>(points_, springs_));
  }

  NewtonResult begin(const ComparedLoad& load, FactorKind solver) override {
    state_ = filled_;
    work_ = NewtonWorkspace(body_.pattern(), body_.coarse_nodes());
    work_.factor = Cholesky(work_.matrix, body_.coarse_nodes(), solver);
    springs_ = {};
    share_ = 0;
    for (const LoadedPlace& place : load.places) {
      const std::vector<double> stiffness = surface_.springs(place.direction);
      for (int row = 0; row < points_.rows(); ++row) {
        if (stiffness[row] <= 0) continue;
        springs_.links.row.push_back(row);
        springs_.links.stiffness.push_back(stiffness[row]);
        springs_.from.push_back(blend(points_, points_.value, row, state_.x));
        springs_.travel.push_back(place.travel * place.direction);
      }
    }
    springs_.links.target = springs_.from;
    BlockMatrix stiffness = body_.pattern();
    stiffness.set_zero();
    springs_.links.add_hessian(points_, stiffness);
    springs_.hessian = stiffness.entries();
    return {};
  }

  /// As the simulator's motion (acts/advance.cpp): in parts that a first-order answer begins.
  NewtonResult step(double share) override {
    constexpr int most_parts = 100;
    NewtonResult total;
    bool fresh = false;
    double most = 1;  // of what is left
    for (int part = 0; part < most_parts && share_ != share; ++part) {
      const BodyState before = state_;
      const double from = share_;
      total.add(predict(share, most, fresh));
      if (total.converged()) total.add(settle());
      if (total.converged()) {
        fresh = false, most = 1;
        continue;
      }
      if (fresh) most *= 0.5;
      fresh = true;
      state_ = before;
      share_ = from;
      if (part + 1 < most_parts) total.status = NewtonStatus::converged;
    }
    return total;
  }

  std::vector<Vec3> surface() const override { return blend_all(points_, points_.value, state_.x); }
  int nodes() const override { return body_.nodes(); }
  int coarse_nodes() const override { return body_.coarse_nodes(); }
  std::vector<const NewtonWorkspace*> systems() const override { return {&work_}; }
  double insertion_s() const override { return insertion_s_; }
  bool use_stages(bool staged) override {
    staged_ = staged;
    return true;
  }

 private:
  GroupProblem problem() { return {{&member_, 1}, joins_, patterns_}; }

  NewtonResult settle() {
    if (staged_) return solve_in_stages({&member_, 1}, joins_, patterns_, NewtonSettings{}, work_);
    return solve(problem(), NewtonSettings{}, work_);
  }

  /// Moves springs and body on towards `share` to first order, as far as no node goes beyond half an edge.
  NewtonResult predict(double share, double most, bool fresh) {
    VecX load = VecX::Zero(state_.x.size());
    for (std::size_t i = 0; i < springs_.from.size(); ++i)
      spread(points_, springs_.links.row[i],
             springs_.links.stiffness[i] * (share - share_) * springs_.travel[i], load);
    const GroupProblem whole = problem();
    const FirstOrderAnswer answer = first_order_answer(whole, work_, whole.coordinates(), whole.multipliers(),
                                                       load, body_.edge_lengths(), fresh);
    if (!answer.result.converged()) return answer.result;
    const double part = std::min(most, answer.share);
    state_.x += part * answer.dx;
    state_.datum_pressure += part * answer.dmultiplier();
    share_ = part >= 1 ? share : share_ + part * (share - share_);
    springs_.move_to(share_);
    return answer.result;
  }

  const ComparedSurface& surface_;
  ShellBody body_;
  StencilTable points_;
  NewtonWorkspace work_;
  ContactLoads nothing_;
  ContactSearch search_;
  BodyState filled_, state_;
  Springs springs_;
  Member member_{body_, nothing_, search_, state_};
  std::vector<JoinPointer> joins_;
  GroupPatterns patterns_;
  double share_ = 0, insertion_s_ = 0;
  bool staged_ = false;
};

ShellBody::Setup setup_of(const TriMesh& control, double radius, int levels) {
  ShellBody::Setup setup;
  setup.name = "sphere";
  setup.control = control;
  setup.bile = BileDefinition{};
  setup.levels = levels;
  setup.foundation = [radius](const Vec3& x) {
    constexpr double reach = 3;
    const double far = (x + radius * Vec3::UnitZ()).norm() / bed_spread;
    return far < reach ? bed_stiffness * std::exp(-0.5 * far * far) : 0.0;
  };
  return setup;
}

Result<Rested> brought_to_rest(ShellBody body, BodyState state) {
  NewtonWorkspace work(body.pattern(), body.coarse_nodes());
  const ContactLoads nothing;
  ContactSearch search;
  search.own.active = false;
  const Member member{body, nothing, search, state};
  GroupPatterns patterns;
  const NewtonResult result = solve(GroupProblem({&member, 1}, {}, patterns), NewtonSettings{}, work);
  if (!result.converged())
    return fail(FailureKind::simulation, "a filled sphere found no rest: " + to_text(result.status));
  return Rested{std::move(body), std::move(state)};
}

Result<Rested> filled(const TriMesh& control, double radius, int levels) {
  Result<ShellBody> body = ShellBody::create(setup_of(control, radius, levels));
  if (!body) return body.failure();
  const BodyState state{body->rest(), 0, compared_fill * body->bile()->volume(body->rest())};
  return brought_to_rest(std::move(body).value(), state);
}

Result<Rested> extended(const Rested& before, std::span<const Extension> extensions) {
  std::vector<Extension> all(extensions.begin(), extensions.end());
  Result<ShellBody> body = before.body.with_details(details_around(before.body, all));
  if (!body) return body.failure();
  const BodyState state{before.body.coordinates_in(body.value(), before.state.x), before.state.datum_pressure,
                        before.state.volume};
  return brought_to_rest(std::move(body).value(), state);
}

}  // namespace

Result<std::unique_ptr<ComparedBody>> uniform_shell(const ComparedSurface& surface, int uniform) {
  const Result<TriMesh> control = surface.level_control(uniform);
  if (!control) return control.failure();
  Result<Rested> rested = filled(control.value(), surface.radius, 0);
  if (!rested) return rested.failure();
  return std::unique_ptr<ComparedBody>(std::make_unique<ComparedShell>(
      surface, std::move(rested).value(), surface.levels.evaluate(uniform, surface.points, 0), 0));
}

Result<std::unique_ptr<ComparedBody>> extended_shell(const ComparedSurface& surface,
                                                     const std::vector<Vec3>& places, int levels) {
  Result<Rested> coarse = filled(surface.control, surface.radius, levels);
  if (!coarse) return coarse.failure();
  coarse->body.keep_in_equilibrium(coarse->state);  // as the simulator's organs
  std::vector<Extension> extensions;
  for (const Vec3& place : places)
    extensions.push_back(
        {static_cast<int>(extensions.size()), nearest_of(coarse->body.skin_rest(), surface.radius * place)});
  const Result<Rested> before = extended(coarse.value(), std::span(extensions).first(places.size() - 1));
  if (!before) return before.failure();
  constexpr int repeats = 5;
  std::vector<double> seconds(repeats, 0.0);
  for (int k = 0;; ++k) {
    Result<Rested> rested = [&] {
      const Timed timed(seconds[k]);
      return extended(before.value(), extensions);
    }();
    if (!rested) return rested.failure();
    if (k + 1 < repeats) continue;
    StencilTable points = rested->body.basis().evaluate(surface.points, 0);
    return std::unique_ptr<ComparedBody>(std::make_unique<ComparedShell>(surface, std::move(rested).value(),
                                                                         std::move(points), median(seconds)));
  }
}

}  // namespace calot
