#include "session/skin_difference.h"

#include <algorithm>
#include <array>
#include <limits>

#include "collision/simplex_distance.h"
#include "field/field.h"
#include "geometry/tri_mesh.h"

namespace calot {
namespace {

/// A skin's motion at any place of it at rest.
class MotionField {
 public:
  explicit MotionField(const MovedSkin& skin) : skin_(skin), around_(skin.rest.size()) {
    for (std::size_t t = 0; t < skin.triangles.size(); ++t)
      for (int corner : skin.triangles[t]) around_[corner].push_back(t);
  }

  /// At the place nearest to `p` of the triangles about the point nearest to `p`.
  Vec3 at(const Vec3& p) const {
    const int point = nearest_of(skin_.rest, p);
    double least = std::numeric_limits<double>::infinity();
    Vec3 motion = skin_.motion[point];
    for (std::size_t t : around_[point]) {
      const Triangle& corners = skin_.triangles[t];
      const NearestPoint there = nearest_point(
          p, std::array{skin_.rest[corners[0]], skin_.rest[corners[1]], skin_.rest[corners[2]]});
      if (there.distance >= least) continue;
      least = there.distance;
      motion = Vec3::Zero();
      for (int k = 0; k < 3; ++k) motion += there.weight[k] * skin_.motion[corners[k]];
    }
    return motion;
  }

 private:
  const MovedSkin& skin_;
  std::vector<std::vector<std::size_t>> around_;  ///< triangles of each point
};

/// Since its skin points were at `first`, m.
MovedSkin moved_skin(const Organ& organ, const std::vector<Vec3>& first) {
  MovedSkin out{organ.body->skin_rest(), organ.body->skin_positions(organ.state.x), organ.body->skin_areas(),
                organ.body->skin().triangles};
  for (std::size_t p = 0; p < first.size(); ++p) {
    out.rest[p] -= organ.definition.neck;
    out.motion[p] -= first[p];
  }
  return out;
}

}  // namespace

std::optional<SkinDifference> skin_difference(const MovedSkin& skin, const MovedSkin& reference) {
  double largest_motion = 0;
  for (const Vec3& motion : reference.motion) largest_motion = std::max(largest_motion, motion.norm());
  if (!(largest_motion > 0)) return std::nullopt;
  const MotionField field(skin);
  double sum = 0, area = 0;
  SkinDifference out;
  for (std::size_t p = 0; p < reference.rest.size(); ++p) {
    const double apart = 100 * (field.at(reference.rest[p]) - reference.motion[p]).norm() / largest_motion;
    sum += reference.areas[p] * apart;
    area += reference.areas[p];
    out.largest_pct = std::max(out.largest_pct, apart);
  }
  out.mean_pct = sum / area;
  return out;
}

SkinDifferences::SkinDifferences(const World& world) {
  for (const Organ& organ : world.field().organs) first_.push_back(organ.body->skin_positions(organ.state.x));
}

std::optional<SkinDifference> SkinDifferences::of(const World& world, int index) const {
  const std::string& reference = world.scene().anatomy.organs[index].compared_with;
  const Organ *organ = nullptr, *other = nullptr;
  for (const Organ& one : world.field().organs) {
    if (one.record >= static_cast<int>(first_.size())) continue;  // it came later
    if (one.record == index) organ = &one;
    if (one.definition.name == reference) other = &one;
  }
  if (organ == nullptr || other == nullptr) return std::nullopt;
  return skin_difference(moved_skin(*organ, first_[organ->record]),
                         moved_skin(*other, first_[other->record]));
}

}  // namespace calot
