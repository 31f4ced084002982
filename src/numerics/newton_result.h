#pragma once
// How a solve ended.

#include <string>
#include <vector>

namespace calot {

enum class NewtonStatus {
  converged,
  not_finite,
  mechanism,
  dependent_constraints,
  stalled,
  iteration_limit,
  out_of_memory,
  stopped
};

struct NewtonResult {
  NewtonStatus status = NewtonStatus::converged;
  int part = 0;  ///< that the status is of: the one furthest from converged, or that nothing holds
  int iterations = 0;
  int chords = 0;          ///< of the iterations, those that reused a factor
  int by_last_factor = 0;  ///< of the iterations, those since the last factorisation
  int factorisations = 0;  ///< of a matrix, with or without a shift
  int shifts = 0;          ///< of these, of a matrix that was shifted
  /// By part: iterations that began with its forces further from balance than any other's. Empty: there was none.
  std::vector<int> furthest;
  double residual = 0;          ///< largest nodal residual / largest internal nodal force, of the worst part
  double increment = 0;         ///< largest coordinate of the last increment / length, of the worst part
  double constraint_error = 0;  ///< relative, of the worst constraint
  /// Wall time, for benchmarks only: energies and their derivatives, factors, solves with them,
  /// safe_share, and what corrects steps (sharp_step.h).
  double assembly_s = 0, factorisation_s = 0, solve_s = 0, safety_s = 0, sharp_s = 0;
  bool converged() const { return status == NewtonStatus::converged; }
  /// Takes over the outcome of a further solve and adds its counts and times.
  void add(const NewtonResult& next);
};

/// In words, for an error message.
std::string to_text(NewtonStatus status);

}  // namespace calot
