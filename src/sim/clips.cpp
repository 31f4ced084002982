#include "sim/clips.h"

#include <algorithm>
#include <cmath>

#include "sim/between_jaws.h"
#include "sim/change_bodies.h"
#include "sim/spill.h"

namespace calot {
namespace {

/// What is left open of less than that is shut: legs are not measured more finely.
constexpr double shut = 0.02;

/// Share of a flat tube's width that is not between the legs.
double left_open(const Tool& tool, const TubeBetween& tube, const RodBody& rod, double leg) {
  const FlatRing ring = rod.ring_at(tube.at);
  const double slant = std::max(0.2, std::abs(tube.along.y()) / std::hypot(tube.along.y(), tube.along.z()));
  const double half = (ring.lumen > 0 ? ring.half_width(ring.lumen) : ring.outer) / slant;
  const double tip = tool.geometry.jaw_length * std::cos(0.5 * tool.pose.jaw), crown = tip - leg;
  const double held = std::min(tube.place.z() + half, tip) - std::max(tube.place.z() - half, crown);
  const double open = 1 - std::clamp(held / (2 * half), 0.0, 1.0);
  return open < shut ? 0 : open;
}

void fire(Field& field, int instrument, std::vector<WorldEvent>& events) {
  Tool& tool = field.tools[instrument];
  if (tool.clips == 0) return;
  --tool.clips;
  const ClipRow& row = clip_row(tool.definition.clip);
  const Mat3 hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear();
  const double tip = tool.geometry.jaw_length * std::cos(0.5 * tool.pose.jaw);
  bool holds = false;
  for (const TubeBetween& tube : tubes_between(field, instrument)) {
    const Organ& organ = field.organs[tube.organ];
    const RodBody& rod = *rod_of(organ);
    const double open = left_open(tool, tube, rod, row.leg);
    const Mat3 to_tube = rod.frame_at(tube.at, organ.state.x).transpose() * hinge;
    Clip clip{row.size, tube.at, open, to_tube.col(2), to_tube.col(0), tip - tube.place.z()};
    const Vec3 at = rod.place_at(tube.at, organ.state.x);
    const std::string name = organ.definition.name;
    const InjuryDefinition& injury = organ.definition.injury;
    const std::string called =
        clip.shut() ? injury.at(injury.closed, way_from_start(rod, tube.at)) : injury.partly;
    set_clip(field, tube.organ, clip);
    events.push_back({EventKind::clip, 0, tool.definition.name, name, open, at});
    if (!called.empty())
      events.push_back({EventKind::injury, 0, tool.definition.name, name, 0, at, EventCause::clip, called});
    holds = true;
  }
  if (holds) return;
  const Vec3 middle =
      hinge_frame(tool.trocar, tool.pose, tool.geometry).translation() + (tip - 0.5 * row.leg) * hinge.col(2);
  drop_clip(field, row.size, middle, hinge.col(2));
  events.push_back({EventKind::clip_dropped, 0, tool.definition.name, {}, 0});
}

}  // namespace

void fire_clips(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < actions.size(); ++i)
    if (actions[i] == InstrumentAction::fire && field.tools[i].action != InstrumentAction::fire)
      fire(field, static_cast<int>(i), events);
}

}  // namespace calot
