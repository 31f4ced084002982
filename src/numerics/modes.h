#pragma once
// Eigenvalues of small symmetric matrices. Here and nowhere else, as Eigen's templates for them take ten seconds of a
// compiler's time in each file.

#include <optional>

#include "geometry/types.h"

namespace calot {

struct Modes {
  VecX values;              ///< increasing
  Eigen::MatrixXd vectors;  ///< columns
};

/// K v = value v with |v| = 1; the lower triangle of `k` is read. None where the iteration does not converge.
std::optional<Modes> modes(const Eigen::MatrixXd& k);

/// K v = value M v with v' M v = 1; both symmetric. None where M is not positive definite, or as above.
std::optional<Modes> modes(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m);

}  // namespace calot
