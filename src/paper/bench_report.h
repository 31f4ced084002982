#pragma once
// The comparison's rows as text and as JSON, and the figures that the project wants to reach beside those it does.

#include <optional>
#include <string>
#include <vector>

#include "paper/comparison.h"

namespace calot {

struct BenchTarget {
  std::string name, unit;
  std::optional<double> value;  ///< of the worst load, by the best solver; none: it was not run
  double limit = 0;
  bool at_least = false;  ///< else at most
  bool met() const { return value && (at_least ? *value >= limit : *value <= limit); }
};
std::vector<BenchTarget> bench_targets(const std::vector<ComparisonRow>& rows);

/// What the figures were taken on.
struct BenchMachine {
  std::string processor;
  unsigned cores = 0;
  std::string load_average;  ///< of the last 1, 5 and 15 minutes when the comparison began
};
BenchMachine this_machine();

std::string bench_json(const Comparison& comparison, const BenchMachine& machine, bool quick);
/// A table for each load and rate, one for the two stages, the targets, the machine.
std::string bench_text(const Comparison& comparison, const BenchMachine& machine);
/// For a README: one load, each mesh by its fastest solver.
std::string bench_markdown(const std::vector<ComparisonRow>& rows, const std::string& load);
/// Error near the contacts against the time of a step, for one load, a panel for each rate.
std::string bench_plot(const std::vector<ComparisonRow>& rows, const std::string& load);

}  // namespace calot
