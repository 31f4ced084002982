#include "sim/skin_difference.h"

#include <algorithm>
#include <array>
#include <limits>

#include "sim/organ.h"

namespace calot {
namespace {

using Shares = std::array<double, 3>;

/// Shares of the corners at the place of a triangle nearest to `p`, where that is inside; else at the nearest corner
/// or on the nearest edge.
Shares nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = ab.cross(ac);
  const double u = (p - a).cross(ac).dot(normal) / normal.squaredNorm(),
               v = ab.cross(p - a).dot(normal) / normal.squaredNorm();
  if (u >= 0 && v >= 0 && u + v <= 1) return {1 - u - v, u, v};
  const Vec3 corners[3] = {a, b, c};
  Shares best{1, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = corners[k], &to = corners[(k + 1) % 3];
    const double share = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    const double distance = (p - from - share * (to - from)).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = {0, 0, 0};
    best[k] = 1 - share;
    best[(k + 1) % 3] = share;
  }
  return best;
}

/// A skin's motion at any place of it at rest.
class MotionField {
 public:
  explicit MotionField(const MovedSkin& skin) : skin_(skin), around_(skin.rest.size()) {
    for (std::size_t t = 0; t < skin.triangles.size(); ++t)
      for (int corner : skin.triangles[t]) around_[corner].push_back(t);
  }

  /// At the place nearest to `p` of the triangles about the point nearest to `p`.
  Vec3 at(const Vec3& p) const {
    const auto nearer = [&](const Vec3& a, const Vec3& b) {
      return (a - p).squaredNorm() < (b - p).squaredNorm();
    };
    const auto point = std::min_element(skin_.rest.begin(), skin_.rest.end(), nearer) - skin_.rest.begin();
    double least = std::numeric_limits<double>::infinity();
    Vec3 motion = skin_.motion[point];
    for (std::size_t t : around_[point]) {
      const Triangle& corners = skin_.triangles[t];
      const Shares shares =
          nearest_in_triangle(p, skin_.rest[corners[0]], skin_.rest[corners[1]], skin_.rest[corners[2]]);
      Vec3 place = Vec3::Zero(), moved = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        place += shares[k] * skin_.rest[corners[k]];
        moved += shares[k] * skin_.motion[corners[k]];
      }
      const double distance = (place - p).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      motion = moved;
    }
    return motion;
  }

 private:
  const MovedSkin& skin_;
  std::vector<std::vector<std::size_t>> around_;  ///< triangles of each point
};

}  // namespace

MovedSkin moved_skin(const Organ& organ, const std::vector<Vec3>& first) {
  MovedSkin out{organ.body.skin_rest(), organ.body.skin_positions(organ.state.x), organ.body.skin_areas(),
                organ.body.skin().triangles};
  for (std::size_t p = 0; p < first.size(); ++p) {
    out.rest[p] -= organ.definition.neck;
    out.motion[p] -= first[p];
  }
  return out;
}

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

}  // namespace calot
