#include "numerics/modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace calot {

std::optional<Modes6> modes(const Mat6& k) {
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(k);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Modes6{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Modes> modes(const Eigen::MatrixXd& k) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Modes{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Modes6> modes(const Mat6& k, const Mat6& m) {
  // In the measure of M: with M = L L', the ordinary problem of L^-1 K L^-T.
  const Eigen::LLT<Mat6> measure(m);
  if (measure.info() != Eigen::Success) return std::nullopt;
  const Mat6 half = measure.matrixL().solve(k);
  std::optional<Modes6> out = modes(Mat6(measure.matrixL().solve(Mat6(half.transpose()))));
  if (out) out->vectors = measure.matrixU().solve(out->vectors).eval();
  return out;
}

}  // namespace calot
