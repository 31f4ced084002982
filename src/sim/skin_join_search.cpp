// What is near: patches of skin, pairs of points and simplices, pairs of edges, and how far motions are safe.

#include <algorithm>
#include <utility>

#include "sim/self_contact.h"
#include "sim/skin_join.h"

namespace calot {
namespace {

/// How far patches of skin are remembered, m: as groups of points of a skin with itself.
constexpr double patch_reach = 3e-3;
/// And pairs of edges: as much further than they act as pairs of points.
constexpr double edge_reach = self_edge_barrier.range + close_reach - self_barrier.range;

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
  const double between = around(patches[0]).exteriorDistance(around(patches[1]));
  if (between >= patches_reach_) {
    patches_reach_ = between;
    return;
  }
  keep_near(patches, patches_reach_);
  ++looks_;
  for (int k = 0; k < 2; ++k)
    for (BoxedPatch& patch : patches[k]) patch.box = box_of_points(k, patch.patch, x);
  keep_near(patches, patches_reach_);
  near_ = !patches[0].empty();  // then the other's are not either
  if (!near_) return;
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    std::vector<int> ids;
    for (const BoxedPatch& patch : patches[k]) ids.push_back(patch.patch);
    side.nodes = nodes_of(*side.body, ids);
    if (side.patches == ids) continue;
    side.patches = std::move(ids);
    take_patches(side);
  }
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
  std::vector<char> used(side.areas.size(), 0);
  std::vector<Triangle> faces;
  std::vector<Segment> segments;
  side.triangles.clear();
  for (int patch : side.patches) {
    for (int t = patch * side.met.each; t < (patch + 1) * side.met.each; ++t) {
      const Triangle& corners = side.met.triangles[t];
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
  if (are_surfaces()) {
    if (!side.edges) side.edges.emplace(body.skin_rest(), side.met.triangles, side.counts);
    std::vector<int> edges;
    for (int t : side.triangles)
      edges.insert(edges.end(), side.edges->sides[t].begin(), side.edges->sides[t].end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    side.edge_tree = ItemTree(side.edges->middles(body.skin_rest()), std::move(edges));
  }
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
  for (const SkinPair& pair : pairs) {
    look_up(x, motions, pair.skin, {&pair.point, 1});
    look_up(x, motions, pair.other, sides_[pair.other].skin->corners(pair.simplex));
  }
}

void SkinJoin::look_up(const Parts& x, bool motions, std::span<const EdgesNear> pairs) const {
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

bool SkinJoin::edges_remembered(const Parts& x, double need) const {
  return edges_known_ && need + approach(less(x, edges_x_), true) <= edges_reach_;
}

void SkinJoin::refresh_edges(const Parts& x, double need) const {
  const double reach = std::max(need, edge_reach);
  refresh_patches(x, need);
  if (edges_remembered(x, need)) return;
  edges_.clear();
  if (near_) refresh_patches(x, reach);
  if (!near_) return;
  look_up(x, false);
  const std::array<PlacedEdges, 2> at = placed_edges(false);
  edges_ = near_edges(at[0], sides_[0].edge_tree, at[1], sides_[1].edge_tree, {reach, 1});
  edges_x_ = x;
  edges_reach_ = reach;
  edges_known_ = true;
}

const std::vector<EdgesNear>& SkinJoin::edges_below(const Parts& x, double need) const {
  chosen_edges_.clear();
  if (!are_surfaces()) return chosen_edges_;
  refresh_edges(x, need);
  if (edges_.empty()) return chosen_edges_;
  const double below = need + approach(less(x, edges_x_), true);
  for (const EdgesNear& pair : edges_)
    if (pair.distance < below) chosen_edges_.push_back(pair);
  look_up(x, false, chosen_edges_);
  return chosen_edges_;
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
  double share = 1.0;
  if (far <= close_reach) {
    const std::vector<SkinPair>& pairs = pairs_below(x, far);
    if (!pairs.empty()) {
      look_up(step, true, pairs);
      share = calot::safe_share(placed(true), pairs, contact_keep);
    }
  } else {
    look_up(x, false);
    look_up(step, true);
    share = calot::safe_share(placed(true), skin_pairs(placed(true), {0, lost}), contact_keep);
  }
  if (!are_surfaces() || share == 0) return share;
  // Where points have stopped a motion already, edges are looked for on what is left of it.
  return share * safe_edges(x, {share * step[0], share * step[1]});
}

double SkinJoin::safe_edges(const Parts& x, const Parts& step) const {
  // Edges that lie across each other when the motion ends were far apart before, and lost most of that: what counts is
  // how near they come.
  constexpr double most = self_edge_barrier.range, nearest = contact_keep * most, lost = 1.0 - contact_keep;
  const double motion = approach(step, true), far = std::min(motion / lost, motion + nearest);
  std::vector<EdgesNear> on_way;
  if (far <= close_reach && edges_remembered(x, far)) {
    on_way = edges_below(x, far);
    look_up(step, true, on_way);
  } else {
    look_up(x, false);
    look_up(step, true);
    const std::array<PlacedEdges, 2> moving = placed_edges(true);
    on_way = near_edges(moving[0], sides_[0].edge_tree, moving[1], sides_[1].edge_tree, {0, lost, nearest});
  }
  const std::array<PlacedEdges, 2> moving = placed_edges(true);
  double share = 1.0;
  for (const EdgesNear& pair : on_way)
    share = calot::safe_share(moving[0], moving[1], pair, contact_keep, share, most);
  return share;
}

}  // namespace calot
