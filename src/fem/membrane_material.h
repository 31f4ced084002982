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

  /// `rest_inverse` is A^-1, `rest_determinant` det A, `metric` a. Infinite, with gradient and Hessian left
  /// zero, when a is not positive definite.
  MembraneSample sample(const SurfaceTensor& rest_inverse, double rest_determinant,
                        const SurfaceTensor& metric) const;
  double energy(const SurfaceTensor& rest_inverse, double rest_determinant,
                const SurfaceTensor& metric) const;
};

/// Stiffening incompressible wall in plane stress: thickness * mu / (2 b) (exp(b (I1 - 3)) - 1) with
/// I1 = tr C + 1 / det C. The isotropic Fung-type law of Demiray 1972 (J. Biomechanics 5, 309); at
/// small strain the neo-Hookean wall of the same mu, and that wall itself for b = 0.
struct Demiray {
  double shear_modulus = 100e3;  ///< mu at rest, Pa
  double thickness = 2e-3;       ///< m
  double stiffening = 0;         ///< b, dimensionless, not negative

  /// As NeoHookean's. Infinite, with gradient and Hessian left zero, where `metric` is not positive definite
  /// or the exponent exceeds `largest_exponent`.
  MembraneSample sample(const SurfaceTensor& rest_inverse, double rest_determinant,
                        const SurfaceTensor& metric) const;
  double energy(const SurfaceTensor& rest_inverse, double rest_determinant,
                const SurfaceTensor& metric) const;
};

/// Exponential laws end here, at 1e130 times their energy: beyond, products of derivatives would overflow.
inline constexpr double largest_exponent = 300;

/// Along a fibre of contravariant components m1, m2 (its rest length is 1 where m' A m = 1): what I4 = m' a m
/// is of (a11, a12, a22).
inline SurfaceTensor fibre_direction(double m1, double m2) { return {m1 * m1, 2 * m1 * m2, m2 * m2}; }

/// A family of fibres that bear tension only (Holzapfel, Gasser and Ogden 2000,
/// doi 10.1023/A:1010835316564): thickness * k1 / (2 k2) (exp(k2 <I4 - 1>^2) - 1), I4 the square of the
/// fibres' stretch, <y> = max(y, 0). At small strain it adds 4 k1 to Young's modulus along the fibres. The
/// gradient is continuous; the Hessian jumps by 4 k1 where the fibres tighten.
struct FibreFamily {
  double stiffness = 0;     ///< k1, Pa, not negative
  double stiffening = 0;    ///< k2, dimensionless, not negative; 0: quadratic in I4 - 1
  double thickness = 2e-3;  ///< of the wall they are spread over, m

  /// `direction` of a unit rest tangent, see fibre_direction(). Infinite, with gradient and Hessian left
  /// zero, where the exponent exceeds `largest_exponent`.
  MembraneSample sample(const SurfaceTensor& direction, const SurfaceTensor& metric) const;
  double energy(const SurfaceTensor& direction, const SurfaceTensor& metric) const;
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
