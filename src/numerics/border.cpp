#include "numerics/border.h"

#include <Eigen/Cholesky>

namespace calot {

void Border::solve_with(const Cholesky& factor) {
  answers.resize(gradients.rows(), gradients.cols());
  complement.resize(constraints(), constraints());
  for (int k = 0; k < constraints(); ++k) answers.col(k) = factor.solve(gradients.col(k));
  for (int k = 0; k < constraints(); ++k)
    for (int i = 0; i < constraints(); ++i) complement(i, k) = gradients.col(i).dot(answers.col(k));
}

std::optional<int> Border::dependent() const {
  // What is left of each once those before it are taken off, beside itself. Rounding leaves 1e-16 times K's condition,
  // which factors are trusted up to 1e12 with.
  constexpr double least = 1e-12;
  if (constraints() == 0) return std::nullopt;
  const Eigen::LDLT<Eigen::MatrixXd> factor(complement);
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(constraints(), 0, constraints() - 1);
  order = factor.transpositionsP() * order;
  for (int i = 0; i < constraints(); ++i)
    if (!(factor.vectorD()[i] > least * complement(order[i], order[i]))) return order[i];
  return std::nullopt;
}

VecX Border::keep(const VecX& values, VecX& step) const {
  if (constraints() == 0) return VecX();
  VecX left(constraints());
  for (int k = 0; k < constraints(); ++k) left[k] = -(values[k] + gradients.col(k).dot(step));
  const VecX multipliers = Eigen::LDLT<Eigen::MatrixXd>(complement).solve(left);
  for (int k = 0; k < constraints(); ++k) step += multipliers[k] * answers.col(k);
  return multipliers;
}

}  // namespace calot
