#include "collision/friction.h"

namespace calot {

FrictionSample StickSlip::sample(const Vec3& x) const {
  if (!(limit > 0)) return {};
  const Mat3 across = Mat3::Identity() - normal * normal.transpose();
  const Vec3 u = across * (x - anchor);
  const double way = u.norm(), reach = limit / stiffness;
  if (way <= reach) return {0.5 * stiffness * way * way, stiffness * u, stiffness * across};
  const Vec3 along = u / way;
  return {limit * (way - 0.5 * reach), limit * along, limit / way * (across - along * along.transpose())};
}

Vec3 StickSlip::anchor_after(const Vec3& x) const {
  // On the sliding side of the kink, so that the tangent there foresees that it goes on sliding.
  constexpr double beyond = 1 + 1e-9;
  const Vec3 u = (x - anchor) - normal * normal.dot(x - anchor);
  const double way = u.norm(), reach = limit / stiffness;
  if (way <= reach) return anchor;
  return x - u * (beyond * reach / way);
}

StickSlip StickSlip::carried(const Pose& motion) const {
  StickSlip out = *this;
  out.anchor = motion * anchor;
  out.normal = motion.linear() * normal;
  return out;
}

}  // namespace calot
