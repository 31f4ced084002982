#pragma once
// The one contact potential: a smooth barrier on signed distance (Incremental Potential Contact, Li et al.
// 2020, doi 10.1145/3386569.3392425, eq. 6, on distance itself).

#include "collision/shapes.h"

namespace calot {

/// Energy a unit area of skin and its derivatives by distance. Zero at and beyond `range`, infinite at 0, C2.
struct BarrierSample {
  double energy = 0;      ///< J/m^2
  double derivative = 0;  ///< Pa; minus the contact pressure
  double second = 0;      ///< Pa/m
};

struct Barrier {
  double range = 0.5e-3;    ///< m; distance below which skin and shape press on each other
  double stiffness = 20e3;  ///< Pa; scales the pressure
  /// Share of the range below which the barrier goes on as a parabola, C2: then it is finite everywhere, inside the
  /// shape too, and a solver may pass through places that no state may keep. 0: infinite at 0.
  double soft_share = 0;
  /// Pressure grows as 1 / distance^2 near 0, not as 1 / distance.
  bool steep = false;
  /// m, Pa: below this distance a steep barrier of that range and stiffness acts as well; 0: none does.
  double core = 0, core_stiffness = 0;
  bool operator==(const Barrier&) const = default;
  /// b(d) = -stiffness / range * (d - range)^2 ln(d / range): the pressure at d = range/2 is 1.2 stiffness.
  /// Steep: b(d) = 0.6 stiffness / range * (range - d)^3 / d, of the same pressure there.
  /// Without a soft share, at d <= 0 energy and second derivative are +infinity and the derivative is
  /// -infinity: not an error but a state no accepted step may reach; a line search sees it as a rejected trial.
  BarrierSample sample(double distance) const;
};

/// The largest share (0 to 1, to 1e-9 of the motion) of the straight motion from x to x + motion such that for
/// every share s up to it
///   distance(x + s * motion) >= keep * distance(x),  0 < keep < 1,
/// to the rounding of coordinates (1e-15 m at 1 m): conservative advancement on the signed distance (Li et
/// al. 2021, additive CCD, doi 10.1145/3450626.3459767), so no point ever crosses. A point that is already
/// inside (distance <= 0) or not finite gets 0.
double safe_share(const Vec3& x, const Vec3& motion, const Shape& shape, double keep);

}  // namespace calot
