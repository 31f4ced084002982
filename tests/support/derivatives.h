#pragma once
// Central differences, to hold gradients and Hessians against.

#include <algorithm>
#include <functional>

#include "base/rng.h"
#include "numerics/block_matrix.h"

namespace calot::test {

inline VecX random_coordinates(Rng& rng, int size, double reach) {
  VecX x(size);
  for (int i = 0; i < size; ++i) x[i] = rng.uniform(-reach, reach);
  return x;
}

/// Gradient of `value` at x by central differences with step h: error h^2 times third derivatives.
inline VecX difference_gradient(const std::function<double(const VecX&)>& value, VecX x, double h) {
  VecX gradient(x.size());
  for (int i = 0; i < x.size(); ++i) {
    const double at = x[i];
    x[i] = at + h;
    const double after = value(x);
    x[i] = at - h;
    const double before = value(x);
    x[i] = at;
    gradient[i] = (after - before) / (2 * h);
  }
  return gradient;
}

/// Jacobian of `gradient` at x by central differences.
inline Eigen::MatrixXd difference_hessian(const std::function<VecX(const VecX&)>& gradient, VecX x,
                                          double h) {
  Eigen::MatrixXd hessian(x.size(), x.size());
  for (int i = 0; i < x.size(); ++i) {
    const double at = x[i];
    x[i] = at + h;
    const VecX after = gradient(x);
    x[i] = at - h;
    hessian.col(i) = (after - gradient(x)) / (2 * h);
    x[i] = at;
  }
  return hessian;
}

/// The stored entries as they are: diagonal blocks whole, blocks above the diagonal zero.
inline Eigen::MatrixXd stored(const BlockMatrix& matrix) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (int c = 0; c < matrix.size(); ++c)
    for (int e = matrix.column_starts()[c]; e < matrix.column_starts()[c + 1]; ++e)
      dense(matrix.rows()[e], c) = matrix.entries()[e];
  return dense;
}

/// The symmetric matrix that its lower triangle stands for.
inline Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const Eigen::MatrixXd lower = stored(matrix).triangularView<Eigen::Lower>();
  const Eigen::MatrixXd strict = lower.triangularView<Eigen::StrictlyLower>();
  return lower + strict.transpose();
}

/// Largest difference relative to the largest entry of `expected`.
inline double relative_error(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected) {
  return (actual - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace calot::test
