#include "paper/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <thread>

#include "process/terminal.h"
#include "session/build_info.h"
#include "session/json.h"

namespace calot {
namespace {

using Figure = std::function<double(const ComparisonRow&)>;

bool of_extensions(const ComparisonRow& row, int levels, double rate) {
  return row.formulation == "shell" && row.extensions > 0 && row.levels == levels && row.rate_hz == rate;
}

/// Of the shell's extensions: the best of each load's solvers, the worst of the loads. A row that failed is no
/// figure, and then there is none.
std::optional<double> worst_load(const std::vector<ComparisonRow>& rows, int levels, double rate,
                                 bool larger_is_better, const Figure& figure) {
  const auto better = [&](double a, double b) { return larger_is_better ? a > b : a < b; };
  std::vector<std::string> loads;
  std::optional<double> worst;
  for (const ComparisonRow& row : rows) {
    if (!of_extensions(row, levels, rate)) continue;
    if (std::find(loads.begin(), loads.end(), row.load) != loads.end()) continue;
    loads.push_back(row.load);
    std::optional<double> best;
    for (const ComparisonRow& other : rows) {
      if (!of_extensions(other, levels, rate) || other.load != row.load) continue;
      if (other.status != "converged" || figure(other) <= 0) continue;
      if (!best || better(figure(other), *best)) best = figure(other);
    }
    if (!best) return std::nullopt;
    if (!worst || better(*worst, *best)) worst = best;
  }
  return worst;
}

/// None as null: what was not run has no figure.
OrderedJson figure_or_null(double value) { return value > 0 ? OrderedJson(value) : OrderedJson(); }

OrderedJson row_json(const ComparisonRow& row) {
  return {{"formulation", row.formulation},
          {"nodes", row.nodes},
          {"extensions", row.extensions},
          {"levels", row.levels},
          {"solver", row.solver},
          {"load", row.load},
          {"rate_hz", row.rate_hz},
          {"status", row.status},
          {"steps", row.steps},
          {"step_ms_median", figure_or_null(row.step_ms_median)},
          {"newton_iterations", row.newton_iterations},
          {"factorise_solve_ms", figure_or_null(row.factorise_solve_ms)},
          {"factor_solve_ratio", figure_or_null(row.factor_solve_ratio)},
          {"flops", row.flops},
          {"memory_bytes", row.memory_bytes},
          {"mean_error_pct", row.mean_error_pct},
          {"contact_error_pct", row.contact_error_pct},
          {"max_error_pct", row.max_error_pct},
          {"condition_estimate", row.condition_estimate},
          {"uniform_nodes", row.uniform_nodes},
          {"speedup", figure_or_null(row.speedup)},
          {"insertion_ms", figure_or_null(row.insertion_ms)}};
}

OrderedJson staged_json(const StagedRow& row) {
  return {{"levels", row.levels},
          {"load", row.load},
          {"rate_hz", row.rate_hz},
          {"status", row.status},
          {"mean_apart_pct", row.mean_apart_pct},
          {"largest_apart_pct", row.largest_apart_pct},
          {"step_ms_median", figure_or_null(row.step_ms_median)},
          {"condensed_step_ms_median", figure_or_null(row.condensed_step_ms_median)}};
}

std::string staged_text(const std::vector<StagedRow>& rows) {
  std::vector<std::vector<std::string>> lines = {
      {"load", "Hz", "levels", "apart: mean %", "most %", "step ms", "condensed ms"}};
  for (const StagedRow& row : rows) {
    lines.push_back({row.load, fmt::format("{:g}", row.rate_hz), std::to_string(row.levels)});
    if (row.status != "converged") {
      lines.back().resize(6);
      lines.back().push_back(row.status);
      continue;
    }
    for (double figure : {row.mean_apart_pct, row.largest_apart_pct})
      lines.back().push_back(fmt::format("{:.3f}", figure));
    for (double figure : {row.step_ms_median, row.condensed_step_ms_median})
      lines.back().push_back(fmt::format("{:.3f}", figure));
  }
  return bold("The shell's extensions in two stages against condensed ones, % of the largest displacement") +
         "\n" + table(lines, "lrrrrrr") + "\n";
}

std::vector<std::string> cells(const ComparisonRow& row) {
  std::vector<std::string> out = {row.formulation, std::to_string(row.nodes), std::to_string(row.extensions),
                                  std::to_string(row.levels), row.solver};
  if (row.status != "converged") {
    out.resize(15);
    out.push_back(row.status);
    return out;
  }
  const std::vector<std::string> figures = {std::to_string(row.steps),
                                            fmt::format("{:.3f}", row.step_ms_median),
                                            fmt::format("{:.1f}", row.newton_iterations),
                                            fmt::format("{:.1f}", row.factor_solve_ratio),
                                            fmt::format("{:.2f}", 1e-6 * row.flops),
                                            fmt::format("{:.2f}", 1e-6 * row.memory_bytes),
                                            fmt::format("{:.2f}", row.mean_error_pct),
                                            fmt::format("{:.2f}", row.contact_error_pct),
                                            fmt::format("{:.2f}", row.max_error_pct),
                                            fmt::format("{:.2g}", row.condition_estimate),
                                            row.speedup > 0 ? fmt::format("{:.1f}", row.speedup) : "-"};
  out.insert(out.end(), figures.begin(), figures.end());
  return out;
}

const std::vector<std::string> heads = {"formulation", "nodes",  "ext.",  "levels", "solver", "steps",
                                        "step ms",     "its",    "ratio", "Mflop",  "MB",     "mean %",
                                        "near %",      "most %", "cond.", "speedup"};

}  // namespace

std::vector<BenchTarget> bench_targets(const std::vector<ComparisonRow>& rows) {
  const auto at_most = [&](const char* name, const char* unit, double limit, double rate, const Figure& f) {
    return BenchTarget{name, unit, worst_load(rows, 1, rate, false, f), limit, false};
  };
  const Figure step = [](const ComparisonRow& r) { return r.step_ms_median; };
  std::vector<BenchTarget> out = {
      at_most("step at 1 kHz", "ms", 1, 1000, step),
      at_most("the same over one factorisation and solve", "times", 5, 1000,
              [](const ComparisonRow& r) { return r.factor_solve_ratio; }),
      at_most("step at 50 Hz", "ms", 5, 50, step),
      at_most("insertion of an extension", "ms", 2, 1000,
              [](const ComparisonRow& r) { return r.insertion_ms; }),
      at_most("mean error", "%", 2, 1000, [](const ComparisonRow& r) { return r.mean_error_pct; }),
      at_most("error near a contact", "%", 3, 1000,
              [](const ComparisonRow& r) { return r.contact_error_pct; }),
      at_most("largest error", "%", 5, 1000, [](const ComparisonRow& r) { return r.max_error_pct; })};
  constexpr double speedups[] = {5, 40, 200};
  for (double rate : {50.0, 1000.0})
    for (int levels = 1; levels <= 3; ++levels)
      out.push_back({fmt::format("speedup with levels to {} at {:g} Hz", levels, rate), "times",
                     worst_load(rows, levels, rate, true, [](const ComparisonRow& r) { return r.speedup; }),
                     speedups[levels - 1], true});
  return out;
}

BenchMachine this_machine() {
  BenchMachine out{"unknown", std::thread::hardware_concurrency(), "unknown"};
  std::ifstream processors("/proc/cpuinfo"), load("/proc/loadavg");
  const std::string key = "model name";
  for (std::string line; std::getline(processors, line);) {
    const std::size_t colon = line.find(": ");
    if (line.compare(0, key.size(), key) != 0 || colon == std::string::npos) continue;
    out.processor = line.substr(colon + 2);
    break;
  }
  std::string one, five, fifteen;
  if (load >> one >> five >> fifteen) out.load_average = one + " " + five + " " + fifteen;
  return out;
}

std::string bench_json(const Comparison& comparison, const BenchMachine& machine, bool quick) {
  OrderedJson json = {
      {"schema", "calot.bench/1"},
      {"quick", quick},
      {"interrupted", comparison.interrupted},
      {"version", version()},
      {"toolchain", this_make().toolchain},
      {"instruction_set", this_make().instruction_set},
      {"machine",
       {{"processor", machine.processor}, {"cores", machine.cores}, {"load_average", machine.load_average}}},
      {"largest_displacement_mm", comparison.largest_mm},
      {"formulations_apart_pct", comparison.formulations_apart_pct},
      {"targets", OrderedJson::array()},
      {"rows", OrderedJson::array()}};
  for (const BenchTarget& target : bench_targets(comparison.rows))
    json["targets"].push_back({{"name", target.name},
                               {"unit", target.unit},
                               {"value", target.value ? OrderedJson(*target.value) : OrderedJson()},
                               {target.at_least ? "at_least" : "at_most", target.limit},
                               {"met", target.met()}});
  for (const ComparisonRow& row : comparison.rows) json["rows"].push_back(row_json(row));
  json["staged"] = OrderedJson::array();
  for (const StagedRow& row : comparison.staged) json["staged"].push_back(staged_json(row));
  return json_text(json);
}

std::string bench_text(const Comparison& comparison, const BenchMachine& machine) {
  std::string out;
  std::vector<std::pair<std::string, double>> done;
  for (const ComparisonRow& first : comparison.rows) {
    const std::pair<std::string, double> group(first.load, first.rate_hz);
    if (std::find(done.begin(), done.end(), group) != done.end()) continue;
    done.push_back(group);
    std::vector<std::vector<std::string>> lines = {heads};
    for (const ComparisonRow& row : comparison.rows)
      if (row.load == group.first && row.rate_hz == group.second) lines.push_back(cells(row));
    out += bold(fmt::format("{}, {:g} Hz", group.first, group.second)) + "\n";
    out += table(lines, "lrrrlrrrrrrrrrrr") + "\n";
  }
  if (!comparison.staged.empty()) out += staged_text(comparison.staged);
  out += bold("Wanted of the shell with extensions, the worst of the loads") + "\n";
  std::vector<std::vector<std::string>> lines;
  for (const BenchTarget& target : bench_targets(comparison.rows))
    lines.push_back({target.value ? (target.met() ? green("ok    ") : red("MISSED")) : "not run", target.name,
                     target.value ? fmt::format("{:.2f}", *target.value) : "-",
                     fmt::format("{} {:g}", target.at_least ? "at least" : "at most", target.limit),
                     target.unit});
  out += table(lines, "llrll");
  out += fmt::format("\n{}, {} cores, load {}; {}, {}", machine.processor, machine.cores,
                     machine.load_average, this_make().toolchain, this_make().instruction_set);
  return out;
}

}  // namespace calot
