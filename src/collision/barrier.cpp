#include "collision/barrier.h"

#include <cmath>
#include <limits>

namespace calot {

BarrierSample Barrier::sample(double distance) const {
  if (distance >= range) return {};
  if (const double start = soft_share * range; distance < start) {
    const BarrierSample at = sample(start);
    const double beyond = distance - start, slope = at.derivative + beyond * at.second;
    return {at.energy + beyond * (at.derivative + 0.5 * beyond * at.second), slope, at.second};
  }
  if (distance <= 0) {
    const double infinity = std::numeric_limits<double>::infinity();
    return {infinity, -infinity, infinity};
  }
  if (steep) {
    const double left = range - distance, by = 0.6 * stiffness / range, per = left / distance;
    return {by * left * left * per, -by * left * per * (3 + per), by * per * (6 + 6 * per + 2 * per * per)};
  }
  const double scale = -stiffness / range;
  const double gap = distance - range, log_ratio = std::log(distance / range), share = gap / distance;
  BarrierSample out{scale * gap * gap * log_ratio, scale * gap * (2 * log_ratio + share),
                    scale * (2 * log_ratio + 4 * share - share * share)};
  if (distance < core) {
    const BarrierSample of_core =
        Barrier{.range = core, .stiffness = core_stiffness, .steep = true}.sample(distance);
    out.energy += of_core.energy;
    out.derivative += of_core.derivative;
    out.second += of_core.second;
  }
  return out;
}

// The shapes are convex, so the distance never falls below its tangent: Newton steps from the safe side.
double safe_share(const Vec3& x, const Vec3& motion, const Shape& shape, double keep) {
  constexpr int max_steps = 256;
  constexpr double negligible = 1e-9;  // of the whole motion
  double share = 0, target = 0;
  for (int step = 0; step < max_steps; ++step) {
    const DistanceSlope now = distance_slope(shape, x + share * motion);
    if (step == 0) target = keep * now.distance;
    const double room = now.distance - target;
    if (!(room > 0)) return share;
    const double approach = -now.gradient.dot(motion);
    if (approach * (1.0 - share) <= room) return 1.0;
    const double advance = room / approach;
    if (!(advance > negligible)) return share;
    share += advance;
  }
  return share;
}

}  // namespace calot
