#include "numerics/body_energy.h"

#include <cmath>

namespace calot {

std::vector<Part> LoneBody::parts() const {
  const int places = std::min(body_.places(), nodes_);
  return {{{0, places}, {places, nodes_}, body_.length_scale()}};
}

double LoneBody::cancelling() const {
  return body_.constrained() ? 0.0 : std::abs(multiplier_) * body_.constraint_scale();
}

void LoneBody::gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const {
  largest_internal.resize(1);
  body_.gradient(x, gradient, largest_internal[0]);
}

void LoneBody::hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const {
  body_.hessian(x, multipliers.size() > 0 ? multipliers[0] : multiplier_, matrix);
}

void LoneBody::constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const {
  VecX gradient;
  values = VecX::Constant(1, body_.constraint(x, gradient));
  gradients = gradient;
}

VecX LoneBody::constraint_values(const VecX& x) const { return VecX::Constant(1, body_.constraint_value(x)); }

void LoneBody::gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                                       Eigen::MatrixXd& of_constraints) const {
  VecX of_constraint;
  largest_internal.resize(1);
  values = VecX::Constant(1, body_.gradient_and_constraint(x, of_energy, largest_internal[0], of_constraint));
  of_constraints = of_constraint;
}

}  // namespace calot
