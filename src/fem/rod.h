#pragma once
// A thin tube or a solid thread on a centreline, by its control nodes alone: an extensible rod after Kirchhoff that
// does not shear and twists freely (Antman, Nonlinear Problems of Elasticity, 2nd ed., ch. IV and VIII; Audoly and
// Pomeau, Elasticity and Geometry, ch. 3), with a liquid's pressure inside.
//
// Energy a unit of rest length, L = |r'| / |r0'| being the stretch, r' and r'' derivatives of the line, r0 at rest:
//
//   EA / 2 (L - 1)^2  +  EI / 2 K^2  -  p pi r^2 L / (1 - p r L / Et)
//
// - Stretch: the force of the wall is EA times the engineering strain L - 1, at any strain.
// - Bending: K = |r' x r''| / (|r'|^2 |r0'|) is the turning of the tangent a unit of rest length (the stretch times the
//   line's curvature), the size of the curvature vector: the same however the rod is moved, and EI K the moment.
//   The rod is straight when nothing bends it, whatever its rest line. Without twist nothing tells in which direction a
//   bend at rest would point: held to its size alone, (K - K0)^2, a rod would turn its bends to any side at no cost
//   (an arc becomes a helix freely: a mechanism), and its straight state would be a peak of energy. So a curved rest
//   line is under the moments EI K0: some 1e-4 N m for a duct of 3 mm bent over 20 mm, a few times what its weight and
//   its bile's do.
// - Pressure p: minus its work on the lumen, pi R^2 L, and the energy of the wall round it, pi Et (R - r)^2 / r, least
//   at the radius R = r / (1 - p r L / Et), a hoop strain of p r / (E t) where that is small. It pushes on the rod's
//   ends, which count as closed, by p pi R^2, and makes a held rod buckle as a thrust of that size would (Sparks 1984,
//   "The influence of tension, pressure and weight on pipe and riser deformations and stresses", J. Energy Resour.
//   Technol. 106(1):46-54). What the wall's hoop and axial strains do to each other is left out, as is the liquid's
//   weight.

#include "fem/centreline.h"
#include "numerics/block_matrix.h"

namespace calot {

/// A section's stiffness at rest.
struct RodSection {
  double axial = 0;    ///< EA, N
  double bending = 0;  ///< EI, N m^2
  double radius = 0;   ///< r, of the wall's middle, m
  double hoop = 0;     ///< Et, N/m; 0: no lumen, pressure does nothing
};

/// A thin wall: A = 2 pi r t, I = pi r^3 t; short of the thick one's I by the share (t / r)^2 / 4. Young's modulus in
/// Pa.
RodSection tube_section(double young, double radius, double wall);
RodSection solid_section(double young, double radius);

/// What a section answers to its stretch: all that is not bending. A section that gives way in other ways, as by
/// flattening, is brought to its least energy here, as its radius is.
struct SectionAnswer {
  double energy = 0;     ///< J/m of rest length; infinite where no radius holds the pressure
  double force = 0;      ///< its derivative by the stretch, N: the wall's pull less the push of the pressure
  double stiffness = 0;  ///< the second derivative, N
  double radius = 0;     ///< m
};
SectionAnswer answer(const RodSection& section, double stretch, double pressure);

class Rod {
 public:
  /// `rest`: 3 * nodes coordinates, m; `sections`: one a row of the quadrature. Fails (scenario) where the rest line has
  /// no direction and where a section has no stiffness.
  static Result<Rod> create(RodQuadrature quadrature, const VecX& rest, std::vector<RodSection> sections);

  /// Energy, J, at a gauge pressure in Pa; infinite where the line has no direction or the pressure bursts it.
  double value(const VecX& x, double pressure) const;
  /// Adds the gradient, N; not finite where the energy is infinite.
  void add_gradient(const VecX& x, double pressure, VecX& gradient) const;
  /// Adds the exact Hessian, N/m.
  void add_hessian(const VecX& x, double pressure, BlockMatrix& matrix) const;

  struct Sample {
    double stretch = 0;  ///< L
    double bending = 0;  ///< K, 1/m of rest length
    SectionAnswer answer;
  };
  /// The rod at each row of the quadrature.
  std::vector<Sample> samples(const VecX& x, double pressure) const;
  /// Of the lumen, m^3.
  double volume(const VecX& x, double pressure) const;

  const StencilTable& stencils() const { return stencils_; }
  const std::vector<double>& point_lengths() const { return lengths_; }  ///< rest length of each row, m
  std::vector<std::vector<int>> cliques() const;                         ///< four nodes a row

 private:
  StencilTable stencils_;
  std::vector<double> lengths_, speeds_;  ///< of each row: rest length, |r0'|
  std::vector<RodSection> sections_;
};

}  // namespace calot
