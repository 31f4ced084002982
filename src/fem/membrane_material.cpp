#include "fem/membrane_material.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot {
namespace {

double trace(const SurfaceTensor& inverse, const SurfaceTensor& a) {
  return inverse[0] * a[0] + 2.0 * inverse[1] * a[1] + inverse[2] * a[2];
}

double determinant(const SurfaceTensor& a) { return a[0] * a[2] - a[1] * a[1]; }

constexpr double infinity = std::numeric_limits<double>::infinity();

/// (exp(rate y) - 1) / rate, y itself for rate 0; infinite beyond the largest exponent.
double exponential(double rate, double y) {
  if (!(rate * y <= largest_exponent)) return infinity;
  return rate == 0 ? y : std::expm1(rate * y) / rate;
}

}  // namespace

double NeoHookean::energy(const SurfaceTensor& inverse, double rest_determinant,
                          const SurfaceTensor& a) const {
  const double det = determinant(a);
  if (!(det > 0 && a[0] > 0)) return infinity;
  return 0.5 * thickness * shear_modulus * (trace(inverse, a) + rest_determinant / det - 3.0);
}

MembraneSample NeoHookean::sample(const SurfaceTensor& inverse, double rest_determinant,
                                  const SurfaceTensor& a) const {
  MembraneSample out;
  out.energy = energy(inverse, rest_determinant, a);
  if (out.energy == infinity) return out;
  const double det = determinant(a);
  const double scale = 0.5 * thickness * shear_modulus;
  const Vec3 d_trace(inverse[0], 2.0 * inverse[1], inverse[2]);
  const Vec3 d_det(a[2], -2.0 * a[1], a[0]);
  Mat3 dd_det;
  dd_det << 0, 0, 1, 0, -2, 0, 1, 0, 0;
  const double q = rest_determinant / (det * det);
  out.gradient = scale * (d_trace - q * d_det);
  out.hessian = scale * (2.0 * q / det * d_det * d_det.transpose() - q * dd_det);
  return out;
}

double Demiray::energy(const SurfaceTensor& inverse, double rest_determinant, const SurfaceTensor& a) const {
  const double ground = NeoHookean{shear_modulus, thickness}.energy(inverse, rest_determinant, a);
  if (stiffening == 0) return ground;
  return exponential(2 * stiffening / (thickness * shear_modulus), ground);
}

MembraneSample Demiray::sample(const SurfaceTensor& inverse, double rest_determinant,
                               const SurfaceTensor& a) const {
  MembraneSample out = NeoHookean{shear_modulus, thickness}.sample(inverse, rest_determinant, a);
  if (stiffening == 0) return out;
  // W = (exp(rate G) - 1) / rate of the neo-Hookean energy G.
  const double rate = 2 * stiffening / (thickness * shear_modulus);
  const double energy = exponential(rate, out.energy);
  if (energy == infinity) return {energy};
  const double slope = std::exp(rate * out.energy);
  out.hessian = slope * (out.hessian + rate * out.gradient * out.gradient.transpose());
  out.gradient *= slope;
  out.energy = energy;
  return out;
}

double FibreFamily::energy(const SurfaceTensor& direction, const SurfaceTensor& a) const {
  if (stiffness == 0) return 0;  // no fibres, however stretched
  const double y = std::max(0.0, direction.dot(a) - 1.0);
  return 0.5 * thickness * stiffness * exponential(stiffening, y * y);
}

MembraneSample FibreFamily::sample(const SurfaceTensor& direction, const SurfaceTensor& a) const {
  MembraneSample out;
  out.energy = energy(direction, a);
  const double y = direction.dot(a) - 1.0;
  if (!(y > 0) || stiffness == 0 || out.energy == infinity) return out;
  const double exponent = stiffening * y * y;
  const double scale = thickness * stiffness * std::exp(exponent);
  out.gradient = scale * y * direction;
  out.hessian = scale * (1 + 2 * exponent) * direction * direction.transpose();
  return out;
}

Mat3 KoiterBending::hessian(const SurfaceTensor& inverse) const {
  const double i11 = inverse[0], i12 = inverse[1], i22 = inverse[2];
  // k:k = (A^-1 k):(A^-1 k)^T as a quadratic form in (k11, k12, k22).
  Mat3 square;
  square << i11 * i11, 2 * i11 * i12, i12 * i12,                  //
      2 * i11 * i12, 2 * (i11 * i22 + i12 * i12), 2 * i12 * i22,  //
      i12 * i12, 2 * i12 * i22, i22 * i22;
  const Vec3 t(i11, 2 * i12, i22);
  return 0.5 * rigidity() * (square + t * t.transpose());
}

double largest_stretch(const SurfaceTensor& inverse, const SurfaceTensor& a) {
  const double half_trace = 0.5 * trace(inverse, a);
  const double product = determinant(a) * determinant(inverse);
  return std::sqrt(half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - product)));
}

}  // namespace calot
