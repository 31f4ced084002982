#pragma once
// Which points of an organ's skin may meet which of its triangles, and which edges which.

#include <array>
#include <span>
#include <utility>

#include "body/body.h"
#include "collision/skin_edges.h"

namespace calot {

class Workers;

/// What does not change of a skin that may meet itself.
struct SkinNet {
  std::vector<Vec3> rest;           ///< m, of each skin point
  std::vector<Triangle> triangles;  ///< corners increasing, so that two triangles see their edge alike
  std::vector<int> begin, around;  ///< triangles around point p: around[begin[p]] .. around[begin[p + 1] - 1]
  SurfaceEdges edges;
  std::vector<int> edge_begin, edges_around;  ///< edges at point p, as `begin` and `around`
  double apart = 0;                           ///< m, see neighbours()

  /// Points in groups of groups, by where they are at rest. The first node is the root; children follow their parent.
  struct Node {
    int first = 0, last = 0;  ///< of `order`
    int left = -1, right = -1;
    Eigen::AlignedBox3d rest;
  };
  std::vector<Node> nodes;
  std::vector<int> order;

  explicit SkinNet(const Body& body);
  /// Whether the point is so near to the triangle at rest (to one of its corners: 6 mm, or twice the widest gap of
  /// the skin's points if that is more) that they are one piece of wall. These do not meet: the wall's own stiffness
  /// keeps them in order, they would press on each other at rest, and as the barrier's range is a small part of that
  /// distance even wall shortened to a tenth presses on nothing.
  bool neighbours(int row, int triangle) const;
  /// As near as that by any of their ends.
  bool edges_neighbour(int edge, int other) const;

 private:
  void split(int node);
};

/// Where the skin's points are and, if given, how they are to move. Only what motions differ by is asked: a turn w x place of
/// the whole, which brings no two points nearer, may be left out of it.
struct SkinMotion {
  const std::vector<Vec3>& points;            ///< m
  const std::vector<Vec3>* motion = nullptr;  ///< m
  /// What is looked for: pairs nearer than this, m, and such that edges at them may be nearer than `edges_reach`, m; with a
  /// motion, those that could lose more than the share `lost` of their distance on the way.
  double reach = 0, edges_reach = 0, lost = 1;
};

/// Where a triangle's corners are, m.
inline std::array<Vec3, 3> corners_of(const Triangle& t, const std::vector<Vec3>& points) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}

/// A skin point and a triangle of the same skin that are no neighbours.
struct SelfPair {
  int skin_point = 0, triangle = 0;
  double distance = 0;  ///< m, when it was gathered; 0 of those on a way
};

using GroupPair = std::pair<int, int>;  ///< two of SkinNet::nodes without children, or one twice

/// Groups with points that are nearer than `skin.reach` to a triangle around a point of the other, but for neighbours; with
/// a motion, those with any pair that near_pairs() looks for. Of these two: several threads find the same as one.
std::vector<GroupPair> near_groups(const SkinNet& net, const SkinMotion& skin, Workers* workers = nullptr);
/// All pairs looked for among these groups, and some more; ordered by skin point, then triangle. Only points of the groups and
/// of the triangles around them are read.
std::vector<SelfPair> near_pairs(const SkinNet& net, const SkinMotion& skin,
                                 std::span<const GroupPair> groups, Workers* workers = nullptr);
/// All edges at the points of those pairs with edges of their triangles that may come within edges_reach of each other, edge
/// < other, but for neighbours; ordered. Where two edges come within d of each other an end of the shorter is as near to a
/// triangle at the other as hypot(d, half its length): what parts them is across both. Where `skin` stays these are
/// measured, and only those nearer than edges_reach returned.
std::vector<EdgesNear> edges_at(const SkinNet& net, std::span<const SelfPair> pairs, const SkinMotion& skin,
                                Workers* workers = nullptr);

}  // namespace calot
