#pragma once
// A quadratic tetrahedron of a linear elastic solid. Ten nodes bend and, up to a Poisson's ratio of 0.45, do not lock:
// four would.

#include <optional>

#include "geometry/tet_mesh.h"

namespace calot {

struct ElasticSolid {
  double young = 0, poisson = 0;  ///< Pa; below 0.5

  double shear() const { return 0.5 * young / (1 + poisson); }
  double first_lame() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
};

struct TetMatrices {
  Eigen::Matrix<double, 30, 30> stiffness;  ///< N/m, x, y, z of node 0, then of node 1, ...
  Eigen::Matrix<double, 3, 10> slopes;      ///< m^2: integrals of the gradients of the nodes' functions
  std::array<double, 10> shares{};          ///< m^3: integrals of these functions
  double volume = 0;                        ///< m^3
};
/// At rest at `points`, m; none where it is inside out somewhere.
std::optional<TetMatrices> tet_matrices(const std::array<Vec3, 10>& points, const ElasticSolid& solid);

/// m^3: integrals of the products of two nodes' functions.
Eigen::Matrix<double, 10, 10> tet_products(const std::array<Vec3, 10>& points);

}  // namespace calot
