#pragma once
// The capsule of a solid organ, such as Glisson's of the liver: a net of cords along the edges of a surface's triangles.
// Its collagen is wavy, so a cord is slack up to a stretch, draws straight over a further one, and is stiff beyond: the
// J-shaped curve of tensile tests (Brunon and others 2010, doi 10.1016/j.jbiomech.2010.03.038).

#include <array>

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

struct CapsuleMaterial {
  double stiffness = 0;   ///< N/m, tension a width by stretch once straight; 0: there is no capsule
  double slack = 1.25;    ///< stretch up to which it is slack
  double straight = 0.1;  ///< the further stretch over which it draws straight, above 0

  /// Tension a width, N/m, at a stretch: stiffness y^2 / (2 straight) for y = stretch - slack up to straight, and
  /// stiffness (y - straight / 2) beyond.
  double tension(double stretch) const;
  /// Its derivative, N/m.
  double tangent(double stretch) const;
  /// Its integral, N/m.
  double energy(double stretch) const;
};

/// A cord of rest length l0 carries the tension of a strip as wide as its triangles' areas over l0: with all triangles
/// equilateral that is an isotropic membrane of modulus `stiffness` and Poisson's ratio 1/3.
struct CapsuleNet {
  CapsuleNet() = default;
  /// Along the edges of the surface's triangles, at rest at `x`.
  CapsuleNet(const Tessellation& surface, const VecX& x, const CapsuleMaterial& capsule);

  double value(const VecX& x) const;  ///< J
  void add_gradient(const VecX& x, VecX& gradient) const;
  /// The pattern has to hold the pairs of both ends' nodes.
  void add_hessian(const VecX& x, BlockMatrix& matrix) const;

  CapsuleMaterial material;
  StencilTable table;                    ///< a row each end
  std::vector<std::array<int, 2>> ends;  ///< of each cord, rows of the table
  std::vector<double> rest, width;       ///< of each, m
};

}  // namespace calot
