#include "fem/ring.h"

#include <numbers>

namespace calot {
namespace {

using std::numbers::pi;

/// Closing of a ring of unit radius and rigidity under a unit load; and the integral of sqrt(sin) from 0 to pi.
constexpr double ring_closing = pi / 4 - 2 / pi, loop_height = 2.3962804694711844;
constexpr double power = 8 / (ring_closing * loop_height * loop_height);

}  // namespace

FlatRing FlatRing::of_tube(double young, double radius, double wall) {
  const double rigidity = young * wall * wall * wall / 12;
  return {.stiffness = rigidity / (ring_closing * radius * radius * radius),
          .lumen = 2 * radius - wall,
          .outer = radius + 0.5 * wall};
}

SectionSample FlatRing::sample(double closing, double pressure) const {
  const double left = 1 - closing / lumen;
  if (!(left > 0)) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {infinity, infinity, infinity};
  }
  const double flat = 1 / (left * left), round = std::pow(left, power - 2);
  const double scale = stiffness / power, push = 0.5 * pi * pressure;
  // The energy as it cancels least: (1/left - 1) - (1 - left^(power - 1)) / (power - 1).
  const double share = closing / lumen;
  const double lost = -std::expm1((power - 1) * std::log1p(-share)) / (power - 1);
  return {scale * lumen * lumen * (share / left - lost) + 0.5 * push * closing * closing,
          scale * lumen * (flat - round) + push * closing,
          scale * (2 * flat / left + (power - 2) * round / left) + push};
}

bool FlatRing::stands(double pressure) const {
  // Where the slope of the force is least, of its two powers.
  const double least_at = std::pow(6 / ((power - 2) * (power - 3)), 1 / power);
  const double least = (2 + (power - 2) * std::pow(least_at, power)) / (power * std::pow(least_at, 3));
  return stiffness * least + 0.5 * pi * pressure > 0;
}

double FlatRing::lumen_area(double closing) const { return 0.25 * pi * (lumen * lumen - closing * closing); }

double FlatRing::half_width(double closing) const { return outer + (0.5 * pi - 1) * 0.5 * closing; }

}  // namespace calot
