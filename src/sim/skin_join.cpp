#include "sim/skin_join.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "fem/links.h"
#include "sim/self_contact.h"

namespace calot {
namespace {

/// How far patches of skin are remembered, m: as groups of points of a skin with itself.
constexpr double patch_reach = 3e-3;

using Box = Eigen::AlignedBox3d;

/// Nodes of patches, increasing.
std::vector<int> nodes_of(const Body& body, const std::vector<int>& patches) {
  std::vector<char> hangs(body.nodes(), 0);
  for (int patch : patches)
    for (int node : body.face_nodes()[patch]) hangs[node] = 1;
  std::vector<int> out;
  for (int node = 0; node < body.nodes(); ++node)
    if (hangs[node]) out.push_back(node);
  return out;
}

std::array<VecX, 2> less(const std::array<VecX, 2>& x, const std::array<VecX, 2>& from) {
  return {x[0] - from[0], x[1] - from[1]};
}

}  // namespace

SkinJoin::Side SkinJoin::side_of(const Body& body, std::span<const JoinedPlace> joined) const {
  Side side;
  side.radius = body.thickest();
  const std::vector<Vec3>& rest = body.skin_rest();
  const auto left_out = [&](int point) {
    return std::any_of(joined.begin(), joined.end(), [&](const JoinedPlace& joint) {
      return (rest[point] - joint.place).norm() <= joint.within;
    });
  };
  const std::vector<Triangle>& triangles = body.skin().triangles;
  for (std::size_t p = 0; p < rest.size(); ++p)
    side.areas.push_back(left_out(static_cast<int>(p)) ? 0.0 : 0.5 * body.skin_areas()[p]);
  for (const Triangle& t : triangles) side.counts.push_back(std::none_of(t.begin(), t.end(), left_out));
  side.around.assign(rest.size(), -1);
  for (std::size_t t = triangles.size(); t-- > 0;)
    for (int corner : triangles[t]) side.around[corner] = static_cast<int>(t);
  side.at.assign(rest.size(), Vec3::Zero());
  side.way.assign(rest.size(), Vec3::Zero());
  side.looked.assign(rest.size(), 0);
  return side;
}

SkinJoin::SkinJoin(const Body& one, const Body& other, std::array<int, 2> bodies,
                   std::span<const JoinedPlace> joined)
    : bodies_(bodies), sides_{side_of(one, joined), side_of(other, joined)} {}

void SkinJoin::begin(std::span<const GroupPlace> bodies) const {
  const bool present = std::max(bodies_[0], bodies_[1]) < static_cast<int>(bodies.size());
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    if (!present) {
      side.body = nullptr;
      continue;
    }
    const GroupPlace& place = bodies[bodies_[k]];
    const Eigen::Index first = Eigen::Index{3} * place.first_node;
    if (side.body == nullptr || side.first != first || side.details != place.body->details()) {
      patches_known_ = pairs_known_ = false;
      found_ = {};
    }
    side.body = place.body;
    side.first = first;
    side.details = place.body->details();
  }
}

SkinJoin::Parts SkinJoin::parts_of(const VecX& x) const {
  Parts out;
  for (int k = 0; k < 2; ++k) out[k] = x.segment(sides_[k].first, sides_[k].body->rest().size());
  return out;
}

bool SkinJoin::idle(std::span<const SkinBounds> bodies) const {
  const SkinBounds &one = bodies[bodies_[0]], &other = bodies[bodies_[1]];
  // What safe_share() would look at.
  const double far = approach_of(one.motion, other.motion) / (1.0 - contact_keep);
  const double gap = one.box.exteriorDistance(other.box) - sides_[0].radius - sides_[1].radius;
  if (!(gap >= std::max(far, uncouple_above))) return false;
  lacking_ = false;
  return true;
}

double SkinJoin::approach(const Parts& dx, bool near) const {
  std::array<SkinMoves, 2> moves;
  for (int k = 0; k < 2; ++k) {
    const Side& side = sides_[k];
    moves[k] = near ? skin_motion(*side.body, dx[k], side.nodes) : skin_motion(*side.body, dx[k]);
  }
  return approach_of(moves[0], moves[1]);
}

void SkinJoin::refresh_patches(const Parts& x, double need) const {
  if (patches_known_ && need + approach(less(x, patches_x_), false) <= patches_reach_) return;
  patches_known_ = true;
  pairs_known_ = false;
  patches_x_ = x;
  patches_reach_ = std::max(patch_reach, need);
  gather_patches(x);
}

/// Patches of either skin that are near any of the other, by the boxes of their nodes.
void SkinJoin::gather_patches(const Parts& x) const {
  std::array<std::vector<Box>, 2> boxes;
  std::array<Box, 2> whole;
  for (int k = 0; k < 2; ++k) {
    const Side& side = sides_[k];
    for (const std::vector<int>& nodes : side.body->face_nodes()) {
      boxes[k].push_back(side.body->box_of(nodes, x[k], side.radius + side.body->beyond_nodes()));
      whole[k].extend(boxes[k].back());
    }
  }
  near_ = false;
  const double between = whole[0].exteriorDistance(whole[1]);
  if (between >= patches_reach_) {
    patches_reach_ = between;
    return;
  }
  const double reach_squared = patches_reach_ * patches_reach_;
  std::array<std::vector<int>, 2> candidates;
  for (int k = 0; k < 2; ++k)
    for (std::size_t f = 0; f < boxes[k].size(); ++f)
      if (boxes[k][f].squaredExteriorDistance(whole[1 - k]) < reach_squared)
        candidates[k].push_back(static_cast<int>(f));
  std::array<std::vector<int>, 2> patches;
  for (int k = 0; k < 2; ++k)
    for (int f : candidates[k])
      if (std::any_of(candidates[1 - k].begin(), candidates[1 - k].end(), [&](int g) {
            return boxes[k][f].squaredExteriorDistance(boxes[1 - k][g]) < reach_squared;
          }))
        patches[k].push_back(f);
  near_ = !patches[0].empty();  // then the other's are not either
  if (!near_) return;
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    side.nodes = nodes_of(*side.body, patches[k]);
    if (side.patches == patches[k]) continue;
    side.patches = std::move(patches[k]);
    take_patches(side);
  }
}

/// The part of a skin that lies on its patches, as others meet it.
void SkinJoin::take_patches(Side& side) {
  const Body& body = *side.body;
  std::vector<char> used(side.areas.size(), 0);
  std::vector<Triangle> faces;
  std::vector<Segment> segments;
  side.triangles.clear();
  for (int patch : side.patches) {
    for (int t = patch * body.triangles_each(); t < (patch + 1) * body.triangles_each(); ++t) {
      const Triangle& corners = body.skin().triangles[t];
      for (int corner : corners) used[corner] = 1;
      if (!side.counts[t]) continue;
      if (corners[1] != corners[2])
        faces.push_back(corners);
      else if (corners[0] < corners[1])  // of the two triangles that a segment is
        segments.push_back({corners[0], corners[1]});
      else
        continue;
      side.triangles.push_back(t);
    }
  }
  side.rows.clear();
  std::vector<double> areas(side.areas.size(), 0.0);
  for (std::size_t p = 0; p < used.size(); ++p)
    if (used[p]) side.rows.push_back(static_cast<int>(p)), areas[p] = side.areas[p];
  side.skin.emplace(body.skin_rest(), std::move(faces), std::move(segments), side.radius, std::move(areas));
}

void SkinJoin::look_up(const Parts& x, bool motions) const {
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    for (int row : side.rows) (motions ? side.way : side.at)[row] = side.body->skin_point(row, x[k]);
  }
}

void SkinJoin::look_up(const Parts& x, bool motions, std::span<const SkinPair> pairs) const {
  ++looks_;
  const auto look = [&](int skin, int point) {
    Side& side = sides_[skin];
    if (std::exchange(side.looked[point], looks_) != looks_)
      (motions ? side.way : side.at)[point] = side.body->skin_point(point, x[skin]);
  };
  for (const SkinPair& pair : pairs) {
    look(pair.skin, pair.point);
    for (int corner : sides_[pair.other].skin->corners(pair.simplex)) look(pair.other, corner);
  }
}

std::array<PlacedSkin, 2> SkinJoin::placed(bool motions) const {
  std::array<PlacedSkin, 2> out;
  for (int k = 0; k < 2; ++k) out[k] = {&*sides_[k].skin, &sides_[k].at, motions ? &sides_[k].way : nullptr};
  return out;
}

void SkinJoin::refresh_pairs(const Parts& x, double need) const {
  refresh_patches(x, need);
  if (!near_) return pairs_.clear();
  if (pairs_known_ && need + approach(less(x, pairs_x_), true) <= close_reach) return;
  refresh_patches(x, close_reach);
  if (!near_) return pairs_.clear();
  look_up(x, false);
  pairs_ = skin_pairs(placed(false), {close_reach, 1});
  gaps_.clear();
  for (const SkinPair& pair : pairs_) gaps_.push_back(gap_of(pair));
  pairs_x_ = x;
  pairs_known_ = true;
  ++searches_;
}

const std::vector<SkinPair>& SkinJoin::pairs_below(const Parts& x, double need) const {
  refresh_pairs(x, need);
  chosen_.clear();
  if (pairs_.empty()) return chosen_;
  const double below = need + approach(less(x, pairs_x_), true);
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (gaps_[k] < below) chosen_.push_back(pairs_[k]);
  look_up(x, false, chosen_);
  return chosen_;
}

double SkinJoin::gap_of(const SkinPair& pair) const {
  const Side &one = sides_[pair.skin], &other = sides_[pair.other];
  std::array<Vec3, 3> corners;
  const std::span<const int> ids = other.skin->corners(pair.simplex);
  for (std::size_t k = 0; k < ids.size(); ++k) corners[k] = other.at[ids[k]];
  return nearest_point(one.at[pair.point], {corners.data(), ids.size()}).distance - one.radius - other.radius;
}

const std::vector<SkinTouch>& SkinJoin::touching(const VecX& x) const {
  static const std::vector<SkinTouch> none;
  if (!active()) return none;
  Parts parts = parts_of(x);
  if (!parts[0].allFinite() || !parts[1].allFinite()) return none;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const Parts& known = found_[k].x;
    if (known[0].size() == 0 || known[0] != parts[0] || known[1] != parts[1]) continue;
    newest_ = k;
    return found_[k].touches;
  }
  newest_ = 1 - newest_;
  Touching& found = found_[newest_];
  const std::vector<SkinPair>& pairs = pairs_below(parts, self_barrier.range);
  found.x = std::move(parts);
  found.touches.clear();
  if (!pairs.empty()) found.touches = skin_touches(placed(false), pairs, self_barrier.range);
  return found.touches;
}

double SkinJoin::gap(const VecX& x) const {
  double least = close_reach;
  if (!active()) return least;
  for (const SkinPair& pair : pairs_below(parts_of(x), close_reach)) least = std::min(least, gap_of(pair));
  return least;
}

double SkinJoin::value(const VecX& x) const {
  double sum = 0;
  for (const SkinTouch& touch : touching(x)) {
    // Parts that count negatively must not hide that skins are in each other.
    const double energy = self_barrier.sample(touch.gap).energy;
    if (!std::isfinite(energy)) return energy;
    sum += touch.area * energy;
  }
  return sum;
}

std::array<StencilPoint, 4> SkinJoin::points_of(const SkinTouch& touch) const {
  const auto point = [&](int skin, int row) -> StencilPoint {
    const Side& side = sides_[skin];
    return {&side.body->skin().stencils, row, static_cast<int>(side.first / 3)};
  };
  std::array<StencilPoint, 4> out{point(touch.skin, touch.point)};
  for (int k = 0; k < touch.part.corners; ++k) out[k + 1] = point(touch.other, touch.part.corner[k]);
  return out;
}

void SkinJoin::add_gradient(const VecX& x, VecX& gradient) const {
  for (const SkinTouch& touch : touching(x)) {
    const Eigen::Matrix<double, 12, 1> slope = touch_gradient(touch, self_barrier.sample(touch.gap));
    const std::array<StencilPoint, 4> points = points_of(touch);
    for (int k = 0; k <= touch.part.corners; ++k) {
      const StencilTable& table = *points[k].table;
      for (int e = table.begin[points[k].row]; e < table.begin[points[k].row + 1]; ++e)
        gradient.segment<3>(Eigen::Index{3} * (points[k].first_node + table.node[e])) +=
            table.value[e] * slope.segment<3>(3 * k);
    }
  }
}

Vec3 SkinJoin::force(const VecX& x) const {
  Vec3 sum = Vec3::Zero();
  for (const SkinTouch& touch : touching(x)) {
    const Vec3 on_point = -touch_gradient(touch, self_barrier.sample(touch.gap)).head<3>();
    sum += touch.skin == 0 ? Vec3(-on_point) : on_point;
  }
  return sum;
}

/// Of the pair that is nearest, where its points were looked up last.
RubbingPlace SkinJoin::rubbing_place(const SkinPair& pair) const {
  const Side &one = sides_[pair.skin], &other = sides_[pair.other];
  const auto of_one = [&](int row) { return BodyPoint{bodies_[pair.skin], row}; };
  const auto of_other = [&](int row) { return BodyPoint{bodies_[pair.other], row}; };
  const std::span<const int> corners = other.skin->corners(pair.simplex);
  if (other.skin->is_triangle(pair.simplex))
    return {{of_one(pair.point), of_other(corners[0]), of_other(corners[1]), of_other(corners[2])}, false};
  const Triangle& t = one.body->skin().triangles[one.around[pair.point]];
  if (t[1] == t[2]) {  // a line, too
    const int beside = t[0] == pair.point ? t[1] : t[0];
    return {{of_one(pair.point), of_other(corners[0]), of_other(corners[1]), of_one(beside)}, true};
  }
  const Vec3& point = one.at[pair.point];
  const bool first = (other.at[corners[0]] - point).norm() <= (other.at[corners[1]] - point).norm();
  return {{of_other(corners[first ? 0 : 1]), of_one(t[0]), of_one(t[1]), of_one(t[2])}, false};
}

std::vector<SkinPress> SkinJoin::pressing(const VecX& x) const {
  const std::vector<SkinTouch> touches = touching(x);
  std::vector<SkinPress> out;
  if (touches.empty()) return out;
  const std::vector<SkinPair>& pairs = pairs_below(parts_of(x), self_barrier.range);
  std::size_t at = 0;
  const auto nearest = [&](const SkinTouch& touch) {  // both are ordered by skin and point
    const auto before = [&](const SkinPair& pair) {
      return std::tie(pair.skin, pair.point) < std::tie(touch.skin, touch.point);
    };
    while (before(pairs[at])) ++at;
    const SkinPair* best = &pairs[at];
    double least = gap_of(*best);
    for (; at < pairs.size() && pairs[at].skin == touch.skin && pairs[at].point == touch.point; ++at)
      if (const double gap = gap_of(pairs[at]); gap < least) least = gap, best = &pairs[at];
    return *best;
  };
  for (std::size_t k = 0; k < touches.size();) {
    const SkinTouch& touch = touches[k];
    SkinPress press{{{bodies_[touch.skin], touch.point}, bodies_[touch.other]},
                    {},
                    Vec3::Zero(),
                    sides_[touch.skin].areas[touch.point]};
    for (; k < touches.size() && touches[k].skin == touch.skin && touches[k].point == touch.point; ++k)
      press.force -= touch_gradient(touches[k], self_barrier.sample(touches[k].gap)).head<3>();
    press.place = rubbing_place(nearest(touch));
    out.push_back(press);
  }
  return out;
}

void SkinJoin::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  lacking_ = false;
  const std::vector<SkinTouch>& touches = touching(x);
  if (touches.empty()) return;
  const Parts parts = parts_of(x);
  for (const SkinTouch& touch : touches) {
    const Side& other = sides_[touch.other];
    std::array<Vec3, 3> corners;
    for (int k = 0; k < touch.part.corners; ++k)
      corners[k] = other.body->skin_point(touch.part.corner[k], parts[touch.other]);
    const bool complete = add_points_hessian(
        points_of(touch),
        touch_hessian(touch, {corners.data(), static_cast<std::size_t>(touch.part.corners)},
                      self_barrier.sample(touch.gap)),
        matrix);
    lacking_ |= !complete;
  }
}

void SkinJoin::add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const {
  if (!active()) return;
  const double below = close ? couple_below : uncouple_above;
  std::set<std::array<int, 2>> patches;  // of the first body and of the other
  for (const SkinPair& pair : pairs_below(parts_of(x), below)) {
    if (gap_of(pair) >= below) continue;
    const Side &one = sides_[pair.skin], &other = sides_[pair.other];
    std::array<int, 2> both{one.body->skin().at[pair.point].face,
                            other.triangles[pair.simplex] / other.body->triangles_each()};
    if (pair.skin == 1) std::swap(both[0], both[1]);
    patches.insert(both);
  }
  for (const std::array<int, 2>& both : patches) {
    std::vector<int> clique;
    for (int k = 0; k < 2; ++k)
      for (int node : sides_[k].body->face_nodes()[both[k]])
        clique.push_back(static_cast<int>(sides_[k].first / 3) + node);
    std::sort(clique.begin(), clique.end());
    cliques.push_back(std::move(clique));
  }
}

double SkinJoin::safe_share(const VecX& x, const VecX& step, double share) const {
  if (!active()) return share;
  const Parts from = parts_of(x), by = parts_of(step);
  for (int k = 0; k < 2; ++k)
    if (!from[k].allFinite() || !by[k].allFinite()) return share;
  // A pair that loses more than 1 - contact_keep of its gap had no more than this. What could meet on a longer way would
  // be everything: that is gone in parts.
  const double far = share * approach(by, false) / (1.0 - contact_keep);
  if (far == 0) return share;
  if (patches_known_ && far + approach(less(from, patches_x_), false) <= patches_reach_ && !near_)
    return share;
  const int parts = 1 + static_cast<int>(far / (0.5 * patch_reach));
  const double part = share / parts;
  for (int k = 0; k < parts; ++k) {
    const Parts at{from[0] + k * part * by[0], from[1] + k * part * by[1]};
    const double safe = safe_part(at, {part * by[0], part * by[1]});
    if (safe < 1.0) return (k + safe) * part;
  }
  return share;
}

double SkinJoin::safe_part(const Parts& x, const Parts& step) const {
  constexpr double lost = 1.0 - contact_keep;
  refresh_patches(x, approach(step, false) / lost);
  if (!near_) return 1.0;
  const double far = approach(step, true) / lost;
  if (far <= close_reach) {
    const std::vector<SkinPair>& pairs = pairs_below(x, far);
    if (pairs.empty()) return 1.0;
    look_up(step, true, pairs);
    return calot::safe_share(placed(true), pairs, contact_keep);
  }
  look_up(x, false);
  look_up(step, true);
  return calot::safe_share(placed(true), skin_pairs(placed(true), {0, lost}), contact_keep);
}

}  // namespace calot
