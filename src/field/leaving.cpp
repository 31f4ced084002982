#include "field/leaving.h"

#include <algorithm>
#include <cmath>

#include "field/teeth.h"

namespace calot {

void let_leave(Field& field, ToolIndex instrument) {
  for (Organ& organ : field.organs) {
    for (const GripPoint& grip : organ.grips)
      if (grip.instrument == instrument && is_bitten(organ))
        organ.leaving.push_back({instrument, grip.skin_point, leaving_time});
    std::erase_if(organ.grips, [&](const GripPoint& grip) { return grip.instrument == instrument; });
  }
}

namespace {

/// The way in the part of a motion, m, of all that a tool let go, on average and as fast as it began.
Vec3 mean_way(const Organ& organ, ToolIndex instrument) {
  const MotionPart& part = organ.state.motion;
  Vec3 sum = Vec3::Zero();
  int points = 0;
  for (const LeavingPoint& point : organ.leaving) {
    if (point.instrument != instrument) continue;
    sum += part.duration * organ.body->skin_point(point.skin_point, part.begin.velocity);
    ++points;
  }
  return sum / points;
}

}  // namespace

GripSprings leaving_springs(const Organ& organ) {
  GripSprings springs;
  const MotionPart& part = organ.state.motion;
  if (part.duration == 0) return springs;
  Vec3 together = Vec3::Zero();
  const LeavingPoint* last = nullptr;  // those of one tool follow each other
  for (const LeavingPoint& point : organ.leaving) {
    if (!last || last->instrument != point.instrument) together = mean_way(organ, point.instrument);
    last = &point;
    const bool out = point.time_left < 0.5 * part.duration;
    const double drag = out ? 0 : leaving_drag * std::exp((point.time_left - leaving_time) / leaving_decay);
    springs.row.push_back(point.skin_point);
    springs.target.push_back(organ.body->skin_point(point.skin_point, part.begin.x) + together);
    springs.stiffness.push_back(drag / part.duration);
  }
  return springs;
}

void end_leaving(Field& field, ToolIndex instrument) {
  for (Organ& organ : field.organs)
    std::erase_if(organ.leaving, [&](const LeavingPoint& point) { return point.instrument == instrument; });
}

void pass_leaving(Field& field, double duration) {
  for (Organ& organ : field.organs) {
    for (LeavingPoint& point : organ.leaving) point.time_left -= duration;
    // Nothing drags them in the last step: what crept until then is not at rest.
    std::erase_if(organ.leaving,
                  [&](const LeavingPoint& point) { return point.time_left < -0.5 * duration; });
  }
}

}  // namespace calot
