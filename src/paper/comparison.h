#pragma once
// Structural extensions against uniform meshes, error and cost, in both formulations: the paper's section 6 with
// the surface, the springs, their motion and the tolerance the same for all.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "base/status.h"
#include "paper/compared_body.h"

namespace calot {

struct ComparisonCase {
  double radius = 20e-3;   ///< m
  int nodes = 61;          ///< of the coarse mesh
  int uniform_levels = 3;  ///< 61, 238, 946 and 3778 nodes
  int extension_levels =
      4;                  ///< 1 to this; the paper's stars from 0 on, the largest under the first load only
  double speed = 100e-3;  ///< m/s, of the springs' ends
  std::vector<double> rates = {50, 1000};  ///< steps a second
  std::vector<ComparedLoad> loads;         ///< all with the same places, where the extensions are
  int cycles = 2;                          ///< out and back
  /// A run that takes longer, s, is cut short after five steps or the way out; not the first of each body and load,
  /// which goes out once at least.
  double patience = 1.5;
  bool paper = true;                        ///< the 1997 formulation too
  const std::atomic<bool>* stop = nullptr;  ///< set: it ends with the rows that it has
  bool stopped() const { return stop != nullptr && *stop; }
};

/// A pull and a push at all three places, and two instruments: a pull, a push, and a place that is held.
std::vector<ComparedLoad> standard_loads(double travel);

/// One body under one load, stepped by one solver. "shell": this project's; "1997" and "1997 two stages": the
/// paper's triangles as one system and in its two stages.
struct ComparisonRow {
  std::string formulation;
  int nodes = 0;  ///< of all systems
  int extensions = 0, levels = 0;
  std::string solver;  ///< "dense", "sparse", "condensed" (shell's extensions only)
  std::string load;
  double rate_hz = 0;
  std::string status = "converged";  ///< else what failed; times and errors are then 0
  int steps = 0;                     ///< that were timed
  double step_ms_median = 0;
  double newton_iterations = 0;   ///< of a step, in the mean
  double factorise_solve_ms = 0;  ///< once, of the same matrices, by the fastest of the solvers
  double factor_solve_ratio = 0;  ///< step over that
  double flops = 0;               ///< of one factorisation and solve by this solver
  double memory_bytes = 0;        ///< matrices and factors
  /// Distance of surface points from where the formulation's finest uniform mesh has them, over its largest
  /// displacement, at the end of the way out, %: in the mean, in the mean within 10 mm of a place, at most.
  double mean_error_pct = 0, contact_error_pct = 0, max_error_pct = 0;
  double condition_estimate = 0;
  int uniform_nodes = 0;    ///< of the uniform mesh whose edges are as short as this one's shortest
  double speedup = 0;       ///< over its fastest solver, same load and rate; 0: it was not run
  double insertion_ms = 0;  ///< to lay the last extension and be at rest again
};

/// The shell's extensions solved in the paper's two stages against the same ones condensed (the simulator's setting
/// extensions.scheme), both by the condensed solver. As there, a step of either begins with a first-order answer of the
/// whole body; stages factorise anew each time.
struct StagedRow {
  int levels = 0;
  std::string load;
  double rate_hz = 0;
  std::string status = "converged";
  /// Distance of surface points from where the condensed ones have them, over their largest displacement, at the end
  /// of the way out, %.
  double mean_apart_pct = 0, largest_apart_pct = 0;
  double step_ms_median = 0, condensed_step_ms_median = 0;
};

struct Comparison {
  bool interrupted = false;
  std::vector<ComparisonRow> rows;
  std::vector<StagedRow> staged;
  /// For each load: how far the finest mesh of the 1997 formulation is from the shell's, in the mean, % of the
  /// largest displacement; empty without it.
  std::vector<double> formulations_apart_pct;
  std::vector<double> largest_mm;  ///< for each load, the finest shell's largest displacement
};

/// `progress` is told what comes next. Fails (usage) for a case without sense. A body that cannot be built or
/// followed is a row that says so.
Result<Comparison> compare(const ComparisonCase& given,
                           const std::function<void(const std::string&)>& progress);

}  // namespace calot
