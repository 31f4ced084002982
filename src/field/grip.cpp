#include "field/grip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "field/between_jaws.h"
#include "field/teeth.h"

namespace calot {
namespace {

/// Two walls between the pads, squeezed to this share of their thickness.
constexpr double fold_squeeze = 0.6;
bool faces_pad(const Vec3& local, const InstrumentGeometry& g, double range) {
  return local.x() < contact_inset && local.x() > -range && before_pad(local, g);
}

void sort_grips(Organ& organ) {
  std::sort(organ.grips.begin(), organ.grips.end(), [](const GripPoint& a, const GripPoint& b) {
    return std::tie(a.instrument, a.jaw, a.skin_point) < std::tie(b.instrument, b.jaw, b.skin_point);
  });
}

/// Both pads take hold of a tube's point where it is.
void hold_point(const Tool& tool, int instrument, Organ& organ, int point) {
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

void hold(const Tool& tool, int instrument, Organ& organ) {
  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  const std::vector<double>& radii = organ.body->skin_radii();
  std::array<std::vector<char>, 2> held{std::vector<char>(skin.size(), 0), std::vector<char>(skin.size(), 0)};
  for (const GripPoint& grip : organ.grips) held[grip.jaw][grip.skin_point] = 1;
  const Pose to_local[2] = {jaw_frame(tool.trocar, tool.pose, tool.geometry, 0).inverse(),
                            jaw_frame(tool.trocar, tool.pose, tool.geometry, 1).inverse()};
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
void hold_clips(const Tool& tool, int instrument, Organ& organ, const std::vector<ClipBetween>& clips) {
  for (const ClipBetween& clip : clips) {
    if (!both_face(tool, clip.place, pad_reach + clip.half_height)) continue;
    for (int point : clip.points) hold_point(tool, instrument, organ, point);
  }
}

}  // namespace

void take_hold(Field& field, int instrument) {
  const Tool& tool = field.tools[instrument];
  // Blades divide a tube, and a clip applier lets it be: neither has teeth.
  const bool teeth = instrument_row(tool.definition.type).jaws == JawUse::hold;
  for (Organ& organ : field.organs) {
    // What has slipped out bulges before the jaws that lost it: they catch none again until they have opened.
    if (tool.lost && organ.body->skin_radii().empty()) continue;
    if (!feels(organ, instrument) || (!teeth && !organ.body->skin_radii().empty()) || !is_bitten(organ))
      continue;
    const std::vector<ClipBetween> clips = clips_between(field, instrument, organ);
    if (clips.empty()) {
      hold(tool, instrument, organ);
    } else {
      hold_clips(tool, instrument, organ, clips);
    }
    sort_grips(organ);
  }
}

bool hold_by_clips(Field& field, int instrument) {
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
    for (int point : points) hold_point(field.tools[instrument], instrument, organ, point);
    sort_grips(organ);
  }
  return any;
}

void make_room(Field& field, int instrument, double jaw) {
  for (Organ& organ : field.organs)
    for (GripPoint& grip : organ.grips)
      if (grip.instrument == instrument)
        grip.local.x() = std::max(grip.local.x(), -grip.local.z() * std::tan(0.5 * jaw));
}

int grip_count(const Organ& organ, int instrument) {
  return static_cast<int>(std::count_if(organ.grips.begin(), organ.grips.end(),
                                        [&](const GripPoint& g) { return g.instrument == instrument; }));
}

double held_area(const Field& field, int instrument) {
  std::array<double, 2> area{};
  for (const Organ& organ : field.organs) {
    if (!clips_between(field, instrument, organ).empty()) continue;
    const RodBody* rod = rod_of(organ);
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      double own = organ.body->skin_areas()[grip.skin_point];
      // A rod's areas are its lengths times its radius.
      if (rod != nullptr) own *= rod->flat_width(grip.skin_point) / rod->outer_radius(grip.skin_point);
      area[grip.jaw] += own;
    }
  }
  return std::min(area[0], area[1]);
}

std::string held_organ(const Field& field, int instrument) {
  for (const Organ& organ : field.organs)
    if (grip_count(organ, instrument) > 0) return organ.definition.name;
  return {};
}

bool both_pads_hold(const Field& field, int instrument) {
  for (const Organ& organ : field.organs) {
    bool holds[2] = {false, false};
    for (const GripPoint& grip : organ.grips)
      if (grip.instrument == instrument) holds[grip.jaw] = true;
    if (holds[0] && holds[1]) return true;
  }
  return false;
}

namespace {

/// Half the height of a tube pressed flat, m: of the thickest place that a tool holds, or of a clip on it.
double flat_radius(const Field& field, int instrument, const Organ& organ) {
  double thickest = 0;
  for (const GripPoint& grip : organ.grips)
    if (grip.instrument == instrument)
      thickest = std::max(thickest, organ.body->core_radii()[static_cast<std::size_t>(grip.skin_point)]);
  // Skins are felt that far inside the pads, clips are not.
  for (const ClipBetween& clip : clips_between(field, instrument, organ))
    thickest = std::max(thickest, clip.half_height + contact_inset);
  return thickest;
}

}  // namespace

bool fold_fills_jaws(const Field& field, int instrument) {
  const Tool& tool = field.tools[instrument];
  for (const Organ& organ : field.organs) {
    int count[2] = {0, 0};
    double depth = 0;  // along the jaws
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      ++count[grip.jaw];
      depth += grip.local.z();
    }
    if (count[0] == 0 || count[1] == 0) continue;
    const double reach = 2.0 * depth / (count[0] + count[1]);
    if (!organ.body->skin_radii().empty()) {
      // A tube is pressed flat where the next angle leaves it no room.
      const double next = reach * std::sin(0.5 * std::max(0.0, tool.pose.jaw - grip_grid));
      if (next + 2 * contact_inset <= 2 * flat_radius(field, instrument, organ)) return true;
      continue;
    }
    if (reach * std::sin(0.5 * tool.pose.jaw) <= fold_squeeze * 2.0 * organ.definition.wall.thickness)
      return true;
  }
  return false;
}

GripSprings grip_springs(const Organ& organ, const std::vector<Tool>& tools,
                         const std::vector<InstrumentPose>& poses) {
  GripSprings springs;
  Pose jaw = Pose::Identity();
  const GripPoint* last = nullptr;  // those of one jaw follow each other
  for (const GripPoint& grip : organ.grips) {
    const Tool& tool = tools[grip.instrument];
    if (!last || last->instrument != grip.instrument || last->jaw != grip.jaw)
      jaw = jaw_frame(tool.trocar, poses[grip.instrument], tool.geometry, grip.jaw);
    last = &grip;
    springs.row.push_back(grip.skin_point);
    springs.target.push_back(jaw * grip.local);
    springs.stiffness.push_back(grip.stiffness);
    springs.pad.push_back(jaw.linear().col(0));
  }
  return springs;
}

}  // namespace calot
