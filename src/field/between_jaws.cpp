#include "field/between_jaws.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "body/rod_body.h"

namespace calot {
namespace {

/// Share of the way between two places of the hinge's frame at which it meets the plane in which the jaws open.
std::optional<double> meets_plane(const Vec3& from, const Vec3& to) {
  if ((from.y() < 0) == (to.y() < 0)) return std::nullopt;
  return from.y() / (from.y() - to.y());
}

double gap_at(double z, double jaw) { return 2 * z * std::sin(0.5 * jaw); }

/// Whether a place of that plane is before both pads.
bool before_both(const Tool& tool, double jaw, const Vec3& at) {
  const double half = 0.5 * jaw, s = std::sin(half), c = std::cos(half);
  const double reach = at.z() * c + std::abs(at.x()) * s;  // along the nearer jaw
  return std::abs(at.x()) * c <= at.z() * s && at.z() > 0 && reach < tool.geometry.jaw_length;
}

/// Anywhere over the pads' width.
bool is_between_pads(const Tool& tool, const Vec3& at) {
  const Vec3 local = hinge_frame(tool.trocar, tool.pose, tool.geometry).inverse() * at;
  return std::abs(local.y()) < 0.5 * tool.geometry.jaw_width && before_both(tool, tool.pose.jaw, local);
}

}  // namespace

bool feels(const Organ& organ, ToolIndex instrument) {
  return !std::binary_search(organ.unfelt.begin(), organ.unfelt.end(), instrument);
}

std::vector<TubeBetween> tubes_between(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  std::vector<TubeBetween> out;
  if (tool.waits) return out;
  const Pose to_hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).inverse();
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const Organ& organ = field.organs[k];
    const RodBody* rod = organ.body->as_tube();
    if (rod == nullptr || !feels(organ, instrument)) continue;
    std::vector<Vec3> line = rod->skin_positions(organ.state.x);
    for (Vec3& p : line) p = to_hinge * p;
    for (std::size_t p = 0; p + 1 < line.size(); ++p) {
      const std::optional<double> share = meets_plane(line[p], line[p + 1]);
      if (!share) continue;
      const Vec3 at = line[p] + *share * (line[p + 1] - line[p]);
      if (!before_both(tool, tool.pose.jaw, at)) continue;
      const double place = static_cast<double>(p) + *share;
      out.push_back({OrganIndex(k), place, at, (line[p + 1] - line[p]).normalized(),
                     gap_at(at.z(), tool.pose.jaw), rod->outer_radius(place)});
    }
  }
  return out;
}

std::vector<ClipBetween> clips_between(const Field& field, ToolIndex instrument, const Organ& organ) {
  std::vector<ClipBetween> out;
  if (field.tool(instrument).waits || !feels(organ, instrument)) return out;
  const RodBody* rod = organ.body->as_tube();
  for (std::size_t c = 0; c < organ.clips.size(); ++c) {
    const Clip& clip = organ.clips[c];
    if (!rod->has(clip.at)) continue;
    const Vec3 place = rod->place_at(clip.at, organ.state.x);
    if (!is_between_pads(field.tool(instrument), place)) continue;
    const double half = rod->flat_half_height(clip.at, clip.opening) + clip_row(clip.size).wire;
    const int before = std::min(static_cast<int>(clip.at), static_cast<int>(rod->last_point()) - 1);
    out.push_back({static_cast<int>(c), place, half, {before, before + 1}});
  }
  return out;
}

bool is_passed(const Tool& tool, const Vec3& from, const Vec3& to, double angle) {
  const Pose to_hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).inverse();
  const Vec3 a = to_hinge * from, b = to_hinge * to;
  const std::optional<double> share = meets_plane(a, b);
  if (!share) return false;
  const Vec3 at = a + *share * (b - a);
  return before_both(tool, tool.pose.jaw, at) &&
         (tool.pose.jaw <= angle || !before_both(tool, tool.pose.jaw - angle, at));
}

}  // namespace calot
