#include "field/take_hold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "field/between_jaws.h"
#include "field/grip.h"
#include "field/teeth.h"

namespace calot {
namespace {

bool faces_pad(const Vec3& local, const InstrumentGeometry& g, double range) {
  return local.x() < contact_inset && local.x() > -range && before_pad(local, g);
}

/// Both pads take hold of a tube's point where it is.
void hold_point(const Tool& tool, ToolIndex instrument, Organ& organ, int point) {
  for (int jaw : {0, 1}) {
    const auto held = [&](const GripPoint& grip) {
      return grip.instrument == instrument && grip.jaw == jaw && grip.skin_point == point;
    };
    if (std::any_of(organ.grips.begin(), organ.grips.end(), held)) continue;
    const Pose to_local = jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).inverse();
    organ.grips.push_back(
        {instrument, jaw, point, to_local * organ.body->skin_point(point, organ.state.x), grip_stiffness});
  }
}

bool both_face(const Tool& tool, const Vec3& place, double range) {
  for (int jaw : {0, 1})
    if (!faces_pad(jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw).inverse() * place, tool.geometry,
                   range))
      return false;
  return true;
}

void hold(const Tool& tool, ToolIndex instrument, Organ& organ) {
  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  const std::vector<double>& radii = organ.body->skin_radii();
  std::array<std::vector<char>, 2> held{std::vector<char>(skin.size(), 0), std::vector<char>(skin.size(), 0)};
  for (const GripPoint& grip : organ.grips) held[grip.jaw][grip.skin_point] = 1;
  const std::array<Pose, 2> to_local = to_jaws(tool);
  for (std::size_t p = 0; p < skin.size(); ++p) {
    const Vec3 local[2] = {to_local[0] * skin[p], to_local[1] * skin[p]};
    // A wall is held by the nearer pad, a tube by both, each on its side.
    const bool wall = radii.empty();
    if (wall && (held[0][p] || held[1][p])) continue;
    for (int jaw : {0, 1}) {
      if (held[jaw][p] || (wall && (local[0].x() >= local[1].x()) != (jaw == 0))) continue;
      if (faces_pad(local[jaw], tool.geometry, pad_reach + (wall ? 0.0 : radii[p])))
        organ.grips.push_back({instrument, jaw, static_cast<int>(p), local[jaw], grip_stiffness});
    }
  }
}

/// Clips keep the pads off the wall beside them.
void hold_clips(const Tool& tool, ToolIndex instrument, Organ& organ, const std::vector<ClipBetween>& clips) {
  for (const ClipBetween& clip : clips) {
    if (!both_face(tool, clip.place, pad_reach + clip.half_height)) continue;
    for (int point : clip.points) hold_point(tool, instrument, organ, point);
  }
}

}  // namespace

void sort_grips(Organ& organ) {
  std::sort(organ.grips.begin(), organ.grips.end(), [](const GripPoint& a, const GripPoint& b) {
    return std::tie(a.instrument, a.jaw, a.skin_point) < std::tie(b.instrument, b.jaw, b.skin_point);
  });
}

void take_hold(Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  // Blades divide a tube, and a clip applier lets it be: neither has teeth.
  const bool teeth = instrument_row(tool.definition.type).jaws == JawUse::hold;
  for (Organ& organ : field.organs) {
    // What has slipped out bulges before the jaws that lost it: they catch none again until they have opened.
    if (tool.lost && !organ.body->is_line()) continue;
    if (!feels(organ, instrument) || (!teeth && organ.body->is_line()) || !is_bitten(organ)) continue;
    const std::vector<ClipBetween> clips = clips_between(field, instrument, organ);
    if (clips.empty()) {
      hold(tool, instrument, organ);
    } else {
      hold_clips(tool, instrument, organ, clips);
    }
    sort_grips(organ);
  }
}

bool hold_by_clips(Field& field, ToolIndex instrument) {
  bool any = false;
  for (Organ& organ : field.organs) {
    if (grip_count(organ, instrument) == 0) continue;
    std::vector<int> points;
    for (const ClipBetween& clip : clips_between(field, instrument, organ))
      points.insert(points.end(), clip.points.begin(), clip.points.end());
    if (points.empty()) continue;
    any = true;
    std::erase_if(organ.grips, [&](const GripPoint& grip) {
      return grip.instrument == instrument &&
             std::find(points.begin(), points.end(), grip.skin_point) == points.end();
    });
    for (int point : points) hold_point(field.tool(instrument), instrument, organ, point);
    sort_grips(organ);
  }
  return any;
}

void make_room(Field& field, ToolIndex instrument, double jaw) {
  for (Organ& organ : field.organs)
    for (GripPoint& grip : organ.grips)
      if (grip.instrument == instrument)
        grip.local.x() = std::max(grip.local.x(), -grip.local.z() * std::tan(0.5 * jaw));
}

}  // namespace calot
