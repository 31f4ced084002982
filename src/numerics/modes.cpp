#include "numerics/modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace calot {

std::optional<Modes> modes(const Eigen::MatrixXd& k) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Modes{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Modes> modes(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m) {
  // In the measure of M: with M = L L', the ordinary problem of L^-1 K L^-T.
  const Eigen::LLT<Eigen::MatrixXd> measure(m);
  if (measure.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd reduced = k;
  measure.matrixL().solveInPlace(reduced);
  reduced.transposeInPlace();
  measure.matrixL().solveInPlace(reduced);
  std::optional<Modes> out = modes(reduced);
  if (out) measure.matrixU().solveInPlace(out->vectors);
  return out;
}

}  // namespace calot
