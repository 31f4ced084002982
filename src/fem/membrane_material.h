#pragma once
// Plane-stress membrane laws: energy a unit rest area as a function of the deformed first fundamental form.

#include "geometry/types.h"

namespace calot {

/// Components (11, 12, 22) of a symmetric surface tensor in a face's parameters.
using SurfaceTensor = Vec3;

struct MembraneSample {
  double energy = 0;             ///< J/m^2 of rest area
  Vec3 gradient = Vec3::Zero();  ///< by (a11, a12, a22), a12 standing for both off-diagonal entries
  Mat3 hessian = Mat3::Zero();
};

/// Incompressible neo-Hookean wall in plane stress: thickness * mu / 2 (tr C + 1 / det C - 3), C = A^-1 a.
struct NeoHookean {
  double shear_modulus = 100e3;  ///< mu, Pa
  double thickness = 2e-3;       ///< m

  /// `rest_inverse` is A^-1, `rest_determinant` det A, `metric` a. Infinite when a is not positive definite.
  MembraneSample sample(const SurfaceTensor& rest_inverse, double rest_determinant,
                        const SurfaceTensor& metric) const;
  double energy(const SurfaceTensor& rest_inverse, double rest_determinant,
                const SurfaceTensor& metric) const;
};

/// Koiter bending of an incompressible wall, quadratic in the change of curvature k = b - B (Koiter 1966;
/// with nu = 1/2 the flexural rigidity is mu t^3 / 3): D / 4 (k:k + (tr k)^2), contracted with A^-1.
struct KoiterBending {
  double shear_modulus = 100e3;                                                                ///< Pa
  double thickness = 2e-3;                                                                     ///< m
  double rigidity() const { return shear_modulus * thickness * thickness * thickness / 3.0; }  ///< D, N m
  /// Constant Hessian by (k11, k12, k22); energy = 1/2 k' H k, J/m^2.
  Mat3 hessian(const SurfaceTensor& rest_inverse) const;
};

/// Principal stretches squared are the eigenvalues of A^-1 a; the larger one's root.
double largest_stretch(const SurfaceTensor& rest_inverse, const SurfaceTensor& metric);

}  // namespace calot
