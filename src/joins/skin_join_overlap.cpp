// Whether two bodies are in each other: what no solve could bring apart, and an author must hear of.

#include <algorithm>
#include <iterator>
#include <limits>

#include "collision/simplex_distance.h"
#include "geometry/winding.h"
#include "group/self_contact.h"
#include "joins/skin_join.h"

namespace calot {
namespace {

void keep_deepest(std::optional<SkinOverlap>& best, const SkinOverlap& found) {
  if (!best || found.depth > best->depth) best = found;
}

}  // namespace

/// Both skins at one state, and what of either is known to cross the other.
struct SkinJoin::Crossing {
  std::array<std::vector<Vec3>, 2> at;
  std::array<Eigen::AlignedBox3d, 2> box;
  std::vector<SkinOverlap> found;
  /// Places on its edges, halfway between where these go into the other and out of it: no point may be inside.
  std::array<std::vector<Vec3>, 2> between;
};

void SkinJoin::find_crossings(const Parts& x, Crossing& out) const {
  for (const SkinPair& pair : pairs_below(x, 0))
    if (const double gap = gap_of(pair); gap <= 0)
      out.found.push_back({-gap, sides_[pair.skin].at[pair.point]});
  refresh_patches(x, close_reach);
  if (!are_surfaces() || !near_) return;
  look_up(x, false);
  for (int k = 0; k < 2; ++k) {
    const std::vector<PiercedTriangle> pierced =
        pierced_triangles(placed_edges(false)[k], sides_[k].edge_tree, placed(false)[1 - k]);
    for (std::size_t i = 0; i < pierced.size(); ++i) {
      out.found.push_back({0, pierced[i].place});
      if (i > 0 && pierced[i - 1].edge == pierced[i].edge)
        out.between[k].push_back(0.5 * (pierced[i - 1].place + pierced[i].place));
    }
  }
}

/// Of points of side k in the other, where that is a surface: where they are deepest, if any is inside.
std::optional<SkinOverlap> SkinJoin::deepest_inside(const Crossing& crossing, int k, bool hollow) const {
  const Side &one = sides_[k], &other = sides_[1 - k];
  if (other.radius > 0) return std::nullopt;
  const std::vector<Vec3>& around = crossing.at[1 - k];
  const std::vector<Triangle>& triangles = other.met.triangles;
  std::vector<Vec3> all, in_box = crossing.between[k];
  for (std::size_t p = 0; p < one.areas.size(); ++p)
    if (one.areas[p] > 0) all.push_back(crossing.at[k][p]);
  std::copy_if(all.begin(), all.end(), std::back_inserter(in_box),
               [&](const Vec3& p) { return crossing.box[1 - k].contains(p); });
  const auto is_inside = [&](const Vec3& p) {
    return crossing.box[1 - k].contains(p) && winding_number(p, around, triangles) > 0.5;
  };
  // Without a crossing all are inside or none is.
  if (in_box.empty() || (crossing.found.empty() && (hollow || !is_inside(in_box.front()))))
    return std::nullopt;
  const auto deep = [&](const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : triangles) {
      const std::array corners{around[t[0]], around[t[1]], around[t[2]]};
      const double widest = std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm());
      if ((p - corners[0]).norm() - widest < least)
        least = std::min(least, nearest_point(p, corners).distance);
    }
    return SkinOverlap{least + one.radius, p};
  };
  const auto deepest = [&](const std::vector<Vec3>& points, bool wanted) {
    constexpr std::size_t looked_at = 300;  // hundredths of a second
    std::optional<SkinOverlap> best;
    for (std::size_t p = 0; p < points.size(); p += 1 + points.size() / looked_at)
      if (is_inside(points[p]) == wanted) keep_deepest(best, deep(points[p]));
    return best;
  };
  const std::optional<SkinOverlap> in = deepest(in_box, true);
  if (!in || !hollow) return in;
  // What goes through a hollow wall may be nearer to being all inside.
  const std::optional<SkinOverlap> out = deepest(all, false);
  return out && out->depth < in->depth ? out : in;
}

std::optional<SkinOverlap> SkinJoin::overlap(const VecX& x, const std::array<bool, 2>& hollow) const {
  if (!active()) return std::nullopt;
  const Parts parts = parts_of(x);
  if (!skin_box(*sides_[0].body, parts[0]).intersects(skin_box(*sides_[1].body, parts[1])) && are_surfaces())
    return std::nullopt;
  Crossing crossing;
  find_crossings(parts, crossing);
  for (int k = 0; k < 2; ++k) {
    crossing.at[k] = sides_[k].body->skin_positions(parts[k]);
    for (const Vec3& p : crossing.at[k]) crossing.box[k].extend(p);
  }
  std::optional<SkinOverlap> deepest;
  for (const SkinOverlap& found : crossing.found) keep_deepest(deepest, found);
  for (int k = 0; k < 2; ++k)
    if (const auto found = deepest_inside(crossing, k, hollow[1 - k])) keep_deepest(deepest, *found);
  return deepest;
}

}  // namespace calot
