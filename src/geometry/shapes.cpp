#include "geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace calot {

namespace {

/// The gallbladder's radius at height zeta in [0, 1] of its length, not yet scaled: a tube that widens in an
/// S-curve, closed by two caps. The squared radius has a simple zero at either end, so the poles are round.
double pear_radius(double zeta) {
  constexpr double neck = 0.22;    // of the body's radius: a neck of 8 to 10 mm for a body of 35 mm
  constexpr double middle = 0.36;  // where the taper is steepest
  constexpr double taper = 0.17;   // how gently it widens
  constexpr double tip = 0.03;     // height of the neck's cap
  const double tube = neck + (1 - neck) * 0.5 * (1 + std::tanh((zeta - middle) / taper));
  return tube * std::sqrt(std::tanh(zeta / tip) * std::max(0.0, 1 - std::pow(zeta, 6)));
}

/// The largest pear_radius, by golden-section search (it has one maximum).
double widest_pear_radius() {
  const double ratio = 1 / std::numbers::phi;
  double low = 0, high = 1;
  while (high - low > 1e-9) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    (pear_radius(a) < pear_radius(b) ? low : high) = pear_radius(a) < pear_radius(b) ? a : b;
  }
  return pear_radius(low);
}

}  // namespace

Profile sphere_profile(double radius) {
  return {[radius](double s) {
    const double angle = std::numbers::pi * s;
    return Vec2(radius * std::sin(angle), -radius * std::cos(angle));
  }};
}

Profile pear_profile(double length, double width) {
  const double scale = 0.5 * width / widest_pear_radius();
  return {[length, scale](double s) {
    // Height grows with the square of the distance from a pole, radius with the distance: smooth there.
    const double zeta = 0.5 * (1 - std::cos(std::numbers::pi * s));
    return Vec2(scale * pear_radius(zeta), length * zeta);
  }};
}

double pear_spacing(const Vec3& position, double length) {
  const double t = std::clamp((position.z() / length - 0.125) / 0.375, 0.0, 1.0);
  return 0.6 + 0.4 * t * t * (3 - 2 * t);
}

TriMesh rectangle(double width, double height, int columns, int rows) {
  TriMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.points.emplace_back(width * (static_cast<double>(i) / columns - 0.5),
                               height * (static_cast<double>(j) / rows - 0.5), 0.0);
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + columns + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

}  // namespace calot
