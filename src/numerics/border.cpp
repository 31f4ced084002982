#include "numerics/border.h"

#include <Eigen/Cholesky>

namespace calot {

void Border::solve_with(const Cholesky& factor, Workers* workers) {
  if (constraints() == 0) {
    answers.resize(gradients.rows(), 0);
    complement.resize(0, 0);
    return;
  }
  answers = factor.solve(gradients, workers);
  complement.noalias() = gradients.transpose() * answers;
  if (compliances.size() > 0) complement.diagonal() += compliances;
}

std::vector<int> Border::kept() const {
  std::vector<int> out;
  for (int k = 0; k < constraints(); ++k)
    if (compliances.size() == 0 || compliances[k] == 0) out.push_back(k);
  return out;
}

std::optional<int> Border::dependent() const {
  // What is left of each once those before it are taken off, beside itself. Rounding leaves 1e-16 times K's condition,
  // which factors are trusted up to 1e12 with.
  constexpr double least = 1e-12;
  const std::vector<int> hard = kept();
  if (hard.empty()) return std::nullopt;
  const Eigen::MatrixXd among = complement(hard, hard);
  const Eigen::LDLT<Eigen::MatrixXd> factor(among);
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(among.cols(), 0, static_cast<int>(among.cols()) - 1);
  order = factor.transpositionsP() * order;
  for (int i = 0; i < among.cols(); ++i)
    if (!(factor.vectorD()[i] > least * among(order[i], order[i]))) return hard[order[i]];
  return std::nullopt;
}

VecX Border::keep(const VecX& values, VecX& step) const {
  if (constraints() == 0) return VecX();
  VecX left(constraints());
  for (int k = 0; k < constraints(); ++k) left[k] = values[k] + gradients.col(k).dot(step);
  return restore(left, step);
}

VecX Border::restore(const VecX& values, VecX& step) const {
  if (constraints() == 0) return VecX();
  const VecX multipliers = Eigen::LDLT<Eigen::MatrixXd>(complement).solve(-values);
  for (int k = 0; k < constraints(); ++k) step += multipliers[k] * answers.col(k);
  return multipliers;
}

}  // namespace calot
