// What is near: patches of skin, pairs of points and simplices, pairs of edges, and how far motions are safe.

#include <algorithm>
#include <utility>

#include "group/body_problem.h"
#include "group/self_contact.h"
#include "joins/skin_join.h"

namespace calot {
namespace {

/// How far patches of skin are remembered, m: as groups of points of a skin with itself.
constexpr double patch_reach = 3e-3;
/// And pairs of edges: as much further than they act as pairs of points.
constexpr double edge_reach = self_edge_barrier.range + close_reach - self_barrier.range;

using Box = Eigen::AlignedBox3d;

std::array<VecX, 2> less(const std::array<VecX, 2>& x, const std::array<VecX, 2>& from) {
  return {x[0] - from[0], x[1] - from[1]};
}

}  // namespace

double SkinJoin::approach(const Parts& dx) const {
  return approach_of(skin_motion(*sides_[0].body, dx[0]), skin_motion(*sides_[1].body, dx[1]));
}

SkinJoin::PatchMoves SkinJoin::patch_moves(const Parts& dx) const {
  PatchMoves out;
  for (int k = 0; k < 2; ++k) {
    const Body& body = *sides_[k].body;
    if (body.beyond_nodes() > 0) {  // whatever moves, moves it all
      out[k].assign(sides_[k].patches.size(), skin_motion(body, dx[k]));
      continue;
    }
    for (int patch : sides_[k].patches) out[k].push_back(skin_motion(body, dx[k], body.face_nodes()[patch]));
  }
  return out;
}

// What two bodies do as one brings nothing nearer, nor does what they do elsewhere: of a gallbladder in its bed a part
// moves against the liver, and most with it.
template <class Need>
bool SkinJoin::remembered(const Parts& x, const Parts& from, double reach, const Need& need,
                          double largest_need) const {
  // Most that is asked follows a small correction: then all nodes together say enough, at a tenth of the cost.
  if (largest_need + approach(less(x, from)) <= reach) return true;
  const PatchMoves since = patch_moves(less(x, from)), since_patches = patch_moves(less(x, patches_x_));
  return std::all_of(near_patches_.begin(), near_patches_.end(), [&](const NearPatches& near) {
    const double wanted = need(near.one, near.other);
    return wanted + approach(since, near.one, near.other) <= reach ||
           wanted + approach(since_patches, near.one, near.other) <= near.apart;
  });
}

void SkinJoin::refresh_patches(const Parts& x, double need) const {
  if (patches_known_ && need + approach(less(x, patches_x_)) <= patches_reach_) return;
  patches_known_ = true;
  pairs_known_ = edges_known_ = false;
  patches_x_ = x;
  patches_reach_ = std::max(patch_reach, need);
  gather_patches(x);
}

namespace {

/// A patch of skin and what it lies in.
struct BoxedPatch {
  int patch;
  Box box;
};

Box around(const std::vector<BoxedPatch>& patches) {
  Box out;
  for (const BoxedPatch& patch : patches) out.extend(patch.box);
  return out;
}

std::vector<int> ids_of(const std::vector<BoxedPatch>& patches) {
  std::vector<int> out;
  for (const BoxedPatch& patch : patches) out.push_back(patch.patch);
  return out;
}

/// Leaves of either those that are nearer than `reach` (m) to any of the other.
void keep_near(std::array<std::vector<BoxedPatch>, 2>& patches, double reach) {
  const auto near = [&](const Box& a, const Box& b) { return a.squaredExteriorDistance(b) < reach * reach; };
  const std::array<Box, 2> whole{around(patches[0]), around(patches[1])};
  for (int k = 0; k < 2; ++k)
    std::erase_if(patches[k], [&](const BoxedPatch& one) { return !near(one.box, whole[1 - k]); });
  std::array<std::vector<BoxedPatch>, 2> kept;
  for (int k = 0; k < 2; ++k)
    std::copy_if(patches[k].begin(), patches[k].end(), std::back_inserter(kept[k]),
                 [&](const BoxedPatch& one) {
                   return std::any_of(patches[1 - k].begin(), patches[1 - k].end(),
                                      [&](const BoxedPatch& other) { return near(one.box, other.box); });
                 });
  patches = std::move(kept);
}

}  // namespace

/// Sees to it that the side has these patches; where each of them is among its own. Some that it had before may stay:
/// what they cost is less than to take patches anew.
std::vector<int> SkinJoin::keep_patches(Side& side, const std::vector<int>& near) const {
  const bool held = side.patches.size() <= 2 * near.size() &&
                    std::includes(side.patches.begin(), side.patches.end(), near.begin(), near.end());
  if (!held) {
    side.patches = near;
    take_patches(side);
  }
  std::vector<int> places;
  for (int patch : near)
    places.push_back(static_cast<int>(std::lower_bound(side.patches.begin(), side.patches.end(), patch) -
                                      side.patches.begin()));
  return places;
}

/// Patches of either skin that are near any of the other: by the boxes of their nodes, then of their points.
void SkinJoin::gather_patches(const Parts& x) const {
  std::array<std::vector<BoxedPatch>, 2> patches;
  for (int k = 0; k < 2; ++k) {
    const Side& side = sides_[k];
    for (const std::vector<int>& nodes : side.body->face_nodes())
      patches[k].push_back({static_cast<int>(patches[k].size()),
                            side.body->box_of(nodes, x[k], side.radius + side.body->beyond_nodes())});
  }
  near_ = false;
  near_patches_.clear();
  const double between = around(patches[0]).exteriorDistance(around(patches[1]));
  if (between >= patches_reach_) {
    patches_reach_ = between;
    return;
  }
  keep_near(patches, patches_reach_);
  at_x_ = {};
  ++looks_;
  for (int k = 0; k < 2; ++k)
    for (BoxedPatch& patch : patches[k]) patch.box = box_of_points(k, patch.patch, x);
  keep_near(patches, patches_reach_);
  near_ = !patches[0].empty();  // then the other's are not either
  if (!near_) return;
  std::array<std::vector<int>, 2> places;
  for (int k = 0; k < 2; ++k) places[k] = keep_patches(sides_[k], ids_of(patches[k]));
  for (std::size_t a = 0; a < patches[0].size(); ++a)
    for (std::size_t b = 0; b < patches[1].size(); ++b)
      if (const double apart = patches[0][a].box.exteriorDistance(patches[1][b].box); apart < patches_reach_)
        near_patches_.push_back({places[0][a], places[1][b], apart});
}

Eigen::AlignedBox3d SkinJoin::box_of_points(int k, int patch, const Parts& x) const {
  const Side& side = sides_[k];
  const int each = side.met.each;
  Box box;
  for (int t = patch * each; t < (patch + 1) * each; ++t) {
    const Triangle& corners = side.met.triangles[t];
    look_up(x, false, k, corners);
    for (int corner : corners) box.extend(side.at[corner]);
  }
  const Vec3 thick = Vec3::Constant(side.radius);
  return {box.min() - thick, box.max() + thick};
}

/// The part of a skin that lies on its patches, as others meet it.
void SkinJoin::take_patches(Side& side) const {
  const Body& body = *side.body;
  constexpr int none = -1;
  side.patch_of_point.assign(side.areas.size(), none);
  std::vector<Triangle> faces;
  std::vector<Segment> segments;
  side.triangles.clear();
  side.patch_of_simplex.clear();
  for (std::size_t place = 0; place < side.patches.size(); ++place) {
    const int patch = side.patches[place], first = patch * side.met.each;
    for (int t = first; t < first + side.met.each; ++t) {
      const Triangle& corners = side.met.triangles[t];
      for (int corner : corners) side.patch_of_point[corner] = static_cast<int>(place);
      if (!side.counts[t]) continue;
      if (corners[1] != corners[2])
        faces.push_back(corners);
      else if (corners[0] < corners[1])  // of the two triangles that a segment is
        segments.push_back({corners[0], corners[1]});
      else
        continue;
      side.triangles.push_back(t);
      side.patch_of_simplex.push_back(static_cast<int>(place));
    }
  }
  side.rows.clear();
  std::vector<double> areas(side.areas.size(), 0.0);
  for (std::size_t p = 0; p < areas.size(); ++p)
    if (side.patch_of_point[p] != none) side.rows.push_back(static_cast<int>(p)), areas[p] = side.areas[p];
  if (are_surfaces()) {
    if (!side.edges) side.edges.emplace(body.skin_rest(), side.met.triangles, side.counts);
    std::vector<int> edges;
    side.patch_of_edge.assign(side.edges->ends.size(), none);
    for (std::size_t k = 0; k < side.triangles.size(); ++k)
      for (int edge : side.edges->sides[side.triangles[k]]) {
        edges.push_back(edge);
        side.patch_of_edge[edge] = side.patch_of_simplex[k];
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    side.edge_tree = ItemTree(side.edges->middles(body.skin_rest()), std::move(edges));
  }
  side.skin.emplace(body.skin_rest(), std::move(faces), std::move(segments), side.radius, std::move(areas));
}

bool SkinJoin::all_are_at(const Parts& x) const {
  return at_x_[0].size() > 0 && at_x_[0] == x[0] && at_x_[1] == x[1];
}

void SkinJoin::look_up(const Parts& x, bool motions) const {
  if (!motions && all_are_at(x)) return;
  if (!motions) at_x_ = x;
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    for (int row : side.rows) (motions ? side.way : side.at)[row] = side.body->skin_point(row, x[k]);
  }
}

void SkinJoin::look_up(const Parts& x, bool motions, std::span<const SkinPair> pairs) const {
  if (!motions && all_are_at(x)) return;
  if (!motions && !pairs.empty()) at_x_ = {};
  ++looks_;
  for (const SkinPair& pair : pairs) {
    look_up(x, motions, pair.skin, {&pair.point, 1});
    look_up(x, motions, pair.other, sides_[pair.other].skin->corners(pair.simplex));
  }
}

void SkinJoin::look_up(const Parts& x, bool motions, std::span<const EdgesNear> pairs) const {
  if (!motions && all_are_at(x)) return;
  if (!motions && !pairs.empty()) at_x_ = {};
  ++looks_;
  for (const EdgesNear& pair : pairs) {
    look_up(x, motions, 0, sides_[0].edges->ends[pair.edge]);
    look_up(x, motions, 1, sides_[1].edges->ends[pair.other]);
  }
}

void SkinJoin::look_up(const Parts& x, bool motions, int skin, std::span<const int> points) const {
  Side& side = sides_[skin];
  for (int point : points)
    if (std::exchange(side.looked[point], looks_) != looks_)
      (motions ? side.way : side.at)[point] = side.body->skin_point(point, x[skin]);
}

std::array<PlacedSkin, 2> SkinJoin::placed(bool motions) const {
  std::array<PlacedSkin, 2> out;
  for (int k = 0; k < 2; ++k) out[k] = {&*sides_[k].skin, &sides_[k].at, motions ? &sides_[k].way : nullptr};
  return out;
}

std::array<PlacedEdges, 2> SkinJoin::placed_edges(bool motions) const {
  std::array<PlacedEdges, 2> out;
  for (int k = 0; k < 2; ++k) out[k] = {&*sides_[k].edges, &sides_[k].at, motions ? &sides_[k].way : nullptr};
  return out;
}

void SkinJoin::refresh_pairs(const Parts& x, double need) const {
  refresh_patches(x, need);
  if (!near_) return pairs_.clear();
  const auto needed = [&](int /*one*/, int /*other*/) { return need; };
  if (pairs_known_ && remembered(x, pairs_x_, close_reach, needed, need)) return;
  refresh_patches(x, close_reach);
  if (!near_) return pairs_.clear();
  find_pairs(x);
}

void SkinJoin::find_pairs(const Parts& x) const {
  look_up(x, false);
  pairs_ = skin_pairs(placed(false), {close_reach, 1}, workers_);
  gaps_.clear();
  for (const SkinPair& pair : pairs_) gaps_.push_back(gap_of(pair));
  pairs_x_ = x;
  pairs_known_ = true;
  ++searches_;
}

template <class Need>
const std::vector<SkinPair>& SkinJoin::choose_pairs(const Parts& x, const Need& need) const {
  chosen_.clear();
  if (pairs_.empty()) return chosen_;
  const PatchMoves since = patch_moves(less(x, pairs_x_));
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const SkinPair& pair = pairs_[k];
    std::array<int, 2> both{sides_[pair.skin].patch_of_point[pair.point],
                            sides_[pair.other].patch_of_simplex[pair.simplex]};
    if (pair.skin == 1) std::swap(both[0], both[1]);
    if (gaps_[k] < need(both[0], both[1]) + approach(since, both[0], both[1])) chosen_.push_back(pair);
  }
  look_up(x, false, chosen_);
  return chosen_;
}

const std::vector<SkinPair>& SkinJoin::pairs_below(const Parts& x, double need) const {
  refresh_pairs(x, need);
  return choose_pairs(x, [&](int /*one*/, int /*other*/) { return need; });
}

void SkinJoin::refresh_edges(const Parts& x, double need) const {
  const double reach = std::max(need, edge_reach);
  refresh_patches(x, need);
  const auto needed = [&](int /*one*/, int /*other*/) { return need; };
  if (edges_known_ && remembered(x, edges_x_, edges_reach_, needed, need)) return;
  if (near_) refresh_patches(x, reach);
  if (!near_) return edges_.clear();
  find_edges(x, reach);
}

void SkinJoin::find_edges(const Parts& x, double reach) const {
  look_up(x, false);
  const std::array<PlacedEdges, 2> at = placed_edges(false);
  edges_ = near_edges(at[0], sides_[0].edge_tree, at[1], sides_[1].edge_tree, {reach, 1}, workers_);
  edges_x_ = x;
  edges_reach_ = reach;
  edges_known_ = true;
}

template <class Need>
const std::vector<EdgesNear>& SkinJoin::choose_edges(const Parts& x, const Need& need) const {
  chosen_edges_.clear();
  if (edges_.empty()) return chosen_edges_;
  const PatchMoves since = patch_moves(less(x, edges_x_));
  for (const EdgesNear& pair : edges_) {
    const int one = sides_[0].patch_of_edge[pair.edge], other = sides_[1].patch_of_edge[pair.other];
    if (pair.distance < need(one, other) + approach(since, one, other)) chosen_edges_.push_back(pair);
  }
  look_up(x, false, chosen_edges_);
  return chosen_edges_;
}

const std::vector<EdgesNear>& SkinJoin::edges_below(const Parts& x, double need) const {
  chosen_edges_.clear();
  if (!are_surfaces()) return chosen_edges_;
  refresh_edges(x, need);
  return choose_edges(x, [&](int /*one*/, int /*other*/) { return need; });
}

double SkinJoin::edge_distance(const EdgesNear& pair) const {
  const std::array<PlacedEdges, 2> at = placed_edges(false);
  return nearest_of_edges(places_of(at[0], at[1], pair)).distance;
}

double SkinJoin::gap_of(const SkinPair& pair) const {
  const Side &one = sides_[pair.skin], &other = sides_[pair.other];
  std::array<Vec3, 3> corners;
  const std::span<const int> ids = other.skin->corners(pair.simplex);
  for (std::size_t k = 0; k < ids.size(); ++k) corners[k] = other.at[ids[k]];
  return nearest_point(one.at[pair.point], {corners.data(), ids.size()}).distance - one.radius - other.radius;
}

double SkinJoin::safe_share(const VecX& x, const VecX& step, double share) const {
  if (!active()) return share;
  const Parts from = parts_of(x), by = parts_of(step);
  for (int k = 0; k < 2; ++k)
    if (!from[k].allFinite() || !by[k].allFinite()) return share;
  // A pair that loses more than 1 - contact_keep of its gap had no more than this. What could meet on a longer way would
  // be everything: that is gone in parts.
  const double far = share * approach(by) / (1.0 - contact_keep);
  if (far == 0) return share;
  if (patches_known_ && far + approach(less(from, patches_x_)) <= patches_reach_ && !near_) return share;
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
  const double far = approach(step) / lost;
  refresh_patches(x, std::max(far, close_reach));
  if (!near_) return 1.0;
  const PatchMoves moves = patch_moves(step);
  const auto need = [&](int one, int other) { return approach(moves, one, other) / lost; };
  bool known = pairs_known_ && remembered(x, pairs_x_, close_reach, need, far);
  // What is found where all stands serves the solve that follows, too: what is found on a way does not.
  if (!known && (known = remembered(x, x, close_reach, need, far))) find_pairs(x);
  double share = 1.0;
  if (known) {
    const std::vector<SkinPair>& pairs = choose_pairs(x, need);
    if (!pairs.empty()) {
      look_up(step, true, pairs);
      share = calot::safe_share(placed(true), pairs, contact_keep);
    }
  } else {
    look_up(x, false);
    look_up(step, true);
    share = calot::safe_share(placed(true), skin_pairs(placed(true), {0, lost}, workers_), contact_keep);
  }
  if (!are_surfaces() || share == 0) return share;
  // Where points have stopped a motion already, edges are looked for on what is left of it.
  return share * safe_edges(x, {share * step[0], share * step[1]}, moves, share);
}

double SkinJoin::safe_edges(const Parts& x, const Parts& step, const PatchMoves& whole,
                            double share_of_whole) const {
  // Edges that lie across each other when the motion ends were far apart before, and lost most of that: what counts is
  // how near they come.
  constexpr double most = self_edge_barrier.range, nearest = contact_keep * most, lost = 1.0 - contact_keep;
  const auto need = [&](int one, int other) {
    const double motion = share_of_whole * approach(whole, one, other);
    return std::min(motion / lost, motion + nearest);
  };
  const double far = approach(step) / lost;
  bool known = edges_known_ && remembered(x, edges_x_, edges_reach_, need, far);
  // As in safe_part().
  if (!known && (known = remembered(x, x, edge_reach, need, far))) find_edges(x, edge_reach);
  std::vector<EdgesNear> on_way;
  if (known) {
    on_way = choose_edges(x, need);
    look_up(step, true, on_way);
  } else {
    look_up(x, false);
    look_up(step, true);
    const std::array<PlacedEdges, 2> moving = placed_edges(true);
    on_way = near_edges(moving[0], sides_[0].edge_tree, moving[1], sides_[1].edge_tree, {0, lost, nearest},
                        workers_);
  }
  const std::array<PlacedEdges, 2> moving = placed_edges(true);
  double share = 1.0;
  for (const EdgesNear& pair : on_way)
    share = calot::safe_share(moving[0], moving[1], pair, contact_keep, share, most);
  return share;
}

}  // namespace calot
