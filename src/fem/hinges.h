#pragma once
// Bending of flat triangles about their edges (Grinspun, Hirani, Desbrun and Schroeder 2003, "Discrete
// shells", doi 10.2312/SCA03/062-068), the companion of a constant-strain membrane.

#include <array>
#include <vector>

#include "base/status.h"
#include "numerics/block_matrix.h"

namespace calot {

/// Energy 1/2 stiffness (angle - rest angle)^2 a hinge, the angle being the one between the two triangles'
/// normals, in (-pi, pi], positive where the surface is convex: a fold through pi makes it jump.
///
/// The stiffness is D / 3 times Grinspun's 3 |e|^2 / A (edge length; area of both triangles; at rest), D the
/// plate's rigidity. The third makes a sheet of equilateral triangles, rolled up about one of its edges'
/// directions, store the plate's D / 2 k^2: only every third edge then bends (Seung and Nelson 1988, doi
/// 10.1103/PhysRevA.38.1005). Their Poisson's ratio for bending is -1/3, so a dome is stiffer in the plate.
class Hinges {
 public:
  /// One hinge an edge that two triangles share. `rest`: 3 * nodes coordinates, m; `rigidity`: D, N m. Fails
  /// (scenario) at an edge of more than two triangles, or of triangles that are oriented differently, and at
  /// a triangle without area.
  static Result<Hinges> create(const std::vector<Triangle>& triangles, const VecX& rest, double rigidity);

  double value(const VecX& x) const;                           ///< J
  void add_gradient(const VecX& x, VecX& gradient) const;      ///< N
  void add_hessian(const VecX& x, BlockMatrix& matrix) const;  ///< N/m, exact
  std::vector<std::vector<int>> cliques() const;               ///< four nodes a hinge
  int count() const { return static_cast<int>(hinges_.size()); }

 private:
  struct Hinge {
    std::array<int, 4> nodes;  ///< edge 0-1, its triangles (0, 1, 2) and (1, 0, 3)
    double stiffness = 0;      ///< N m
    double rest_angle = 0;     ///< rad
  };
  std::vector<Hinge> hinges_;
};

}  // namespace calot
