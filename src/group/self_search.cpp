#include "group/self_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/workers.h"
#include "collision/simplex_distance.h"
#include "geometry/turn.h"

namespace calot {
namespace {

constexpr int chunks_of_skin = 8;

/// What a triangle's corners differ by, m^2: their places at most and their motions.
struct Differences {
  double places = 0, motions = 0;
  Differences(const Triangle& t, const SkinMotion& skin) {
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      places = std::max(places, (skin.points[a] - skin.points[b]).squaredNorm());
      if (skin.motion) motions = std::max(motions, ((*skin.motion)[a] - (*skin.motion)[b]).squaredNorm());
    }
  }
  /// How much nearer another point may be to the triangle than to its corners: what a place in it can be from its nearest
  /// corner (1 / sqrt(3) of the longest edge) and, on a way, what the motions differ by: a pair that loses the share
  /// `lost` has a corner that comes so far nearer, but for that difference.
  double beside_corner(const SkinMotion& skin) const {
    return std::sqrt(places / 3) + std::sqrt(motions) / skin.lost;
  }
};

/// How long an edge between two points is at most, there and on the way, m.
double longest_on_way(const SkinMotion& skin, int p, int q) {
  const double length = (skin.points[p] - skin.points[q]).norm();
  return skin.motion ? length + ((*skin.motion)[p] - (*skin.motion)[q]).norm() : length;
}

/// How near a triangle must be to a point that the pair is looked for, m.
double reach_of_point(const SkinNet& net, const SkinMotion& skin, int p) {
  double longest = 0;
  for (int k = net.edge_begin[p]; k < net.edge_begin[p + 1]; ++k) {
    const auto& [a, b] = net.edges.ends[net.edges_around[k]];
    longest = std::max(longest, longest_on_way(skin, a, b));
  }
  return std::max(skin.reach, std::hypot(skin.edges_reach, 0.5 * longest));
}

/// Distance of two points less what they can lose of it.
double least_distance(const SkinMotion& skin, int p, int q) {
  const double distance = (skin.points[p] - skin.points[q]).norm();
  if (!skin.motion) return distance;
  return distance - ((*skin.motion)[p] - (*skin.motion)[q]).norm() / skin.lost;
}

bool one_piece(const SkinNet& net, int p, int q) {
  return (net.rest[p] - net.rest[q]).squaredNorm() < net.apart * net.apart;
}

/// Where a point meets triangles around another.
struct Near {
  double own = -1;     ///< m, how near a triangle must be to the point; below 0: not known yet
  double corners = 0;  ///< m, how much nearer another may be to a triangle around the point than to it
  void take(const Near& other) {
    own = std::max(own, other.own);
    corners = std::max(corners, other.corners);
  }
  /// How near this and the other must be that one meets a triangle around the other.
  double meets(const Near& other) const { return std::max(own + other.corners, other.own + corners); }
};

/// The same of points and of groups of them, found when asked for.
class Reaches {
 public:
  Reaches(const SkinNet& net, const SkinMotion& skin)
      : net_(net), skin_(skin), point_(net.rest.size()), group_(net.nodes.size()), box_(net.nodes.size()) {}

  const Near& of_point(int p) {
    Near& near = point_[p];
    if (near.own < 0) {
      near.own = reach_of_point(net_, skin_, p);
      for (int k = net_.begin[p]; k < net_.begin[p + 1]; ++k)
        near.corners =
            std::max(near.corners, Differences(net_.triangles[net_.around[k]], skin_).beside_corner(skin_));
    }
    return near;
  }
  /// Whether all of one group is too far from all of the other, as they stand; on a way nothing is said.
  bool apart(int a, int b) {
    if (skin_.motion) return false;
    const double near = of_group(a).meets(of_group(b));
    return box_[a].squaredExteriorDistance(box_[b]) >= near * near;
  }

 private:
  const Near& of_group(int n) {
    Near& near = group_[n];
    if (near.own >= 0) return near;
    for (int k = net_.nodes[n].first; k < net_.nodes[n].last; ++k) {
      box_[n].extend(skin_.points[net_.order[k]]);
      near.take(of_point(net_.order[k]));
    }
    return near;
  }

  const SkinNet& net_;
  const SkinMotion& skin_;
  std::vector<Near> point_, group_;
  std::vector<Eigen::AlignedBox3d> box_;
};

/// The nodes' boxes as the skin is now.
class Boxes {
 public:
  Boxes(const SkinNet& net, const SkinMotion& skin, Workers* workers)
      : net_(net),
        skin_(skin),
        reach_(net.rest.size()),
        now_(net.nodes.size()),
        shift_(net.nodes.size()),
        way_(net.nodes.size()),
        near_(net.nodes.size()) {
    find_reaches(workers);
    const auto columns = [](const std::vector<Vec3>& points) {
      return Eigen::Map<const Eigen::Matrix3Xd>(points[0].data(), 3,
                                                static_cast<Eigen::Index>(points.size()));
    };
    const Mat3 turn = best_turn(columns(net.rest), columns(skin.points));
    scale_ = spread_of(columns(skin.points)) / spread_of(columns(net.rest));
    find_boxes(turn, workers);
  }

  /// All groups that are near each other.
  std::vector<GroupPair> near(Workers* workers) const {
    // Pairs of nodes high up, in the order in which they would be visited one by one; each is visited by itself.
    std::vector<GroupPair> high = {{0, 0}};
    for (int round = 0; round < 8; ++round) {
      std::vector<GroupPair> next;
      for (const auto& [a, b] : high)
        descend(
            a, b, [&](int p, int q) { next.emplace_back(p, q); }, next);
      high = std::move(next);
    }
    const int size = static_cast<int>(high.size()), chunks = std::min(size, 16);
    std::vector<std::vector<GroupPair>> found(static_cast<std::size_t>(chunks));
    for_each_chunk(workers, chunks, [&](int k) {
      const Chunk chunk = chunk_of(size, chunks, k);
      for (int i = chunk.begin; i < chunk.end; ++i) visit(high[i].first, high[i].second, found[k]);
    });
    std::vector<GroupPair> out;
    for (const std::vector<GroupPair>& of_chunk : found)
      out.insert(out.end(), of_chunk.begin(), of_chunk.end());
    return out;
  }

 private:
  void find_reaches(Workers* workers) {
    const int size = static_cast<int>(net_.triangles.size());
    std::vector<double> beside_corner(net_.triangles.size());
    for_each_chunk(workers, chunks_of_skin, [&](int k) {
      const Chunk chunk = chunk_of(size, chunks_of_skin, k);
      for (int t = chunk.begin; t < chunk.end; ++t)
        beside_corner[t] = Differences(net_.triangles[t], skin_).beside_corner(skin_);
    });
    for (int t = 0; t < size; ++t)
      for (int p : net_.triangles[t]) reach_[p].corners = std::max(reach_[p].corners, beside_corner[t]);
    const int points = static_cast<int>(reach_.size());
    for_each_chunk(workers, chunks_of_skin, [&](int k) {
      const Chunk chunk = chunk_of(points, chunks_of_skin, k);
      for (int p = chunk.begin; p < chunk.end; ++p)
        reach_[p].own = skin_.motion ? reach_of_point(net_, skin_, p) : skin_.reach;
    });
  }

  void find_boxes(const Mat3& turn, Workers* workers) {
    const int size = static_cast<int>(net_.nodes.size());
    for_each_chunk(workers, chunks_of_skin, [&](int chunk_index) {
      const Chunk chunk = chunk_of(size, chunks_of_skin, chunk_index);
      for (int n = chunk.begin; n < chunk.end; ++n) {
        const SkinNet::Node& node = net_.nodes[n];
        if (node.left >= 0) continue;
        for (int k = node.first; k < node.last; ++k) {
          const int p = net_.order[k];
          now_[n].extend(skin_.points[p]);
          shift_[n].extend(skin_.points[p] - scale_ * (turn * net_.rest[p]));
          if (skin_.motion) way_[n].extend((*skin_.motion)[p]);
          near_[n].take(reach_[p]);
        }
      }
    });
    for (int n = size - 1; n >= 0; --n) {
      const SkinNet::Node& node = net_.nodes[n];
      if (node.left < 0) continue;
      now_[n] = now_[node.left].merged(now_[node.right]);
      shift_[n] = shift_[node.left].merged(shift_[node.right]);
      way_[n] = way_[node.left].merged(way_[node.right]);
      for (int child : {node.left, node.right}) near_[n].take(near_[child]);
    }
  }

  void visit(int a, int b, std::vector<GroupPair>& out) const {
    descend(
        a, b, [&](int p, int q) { visit(p, q, out); }, out);
  }

  /// Adds the pair to `out` where it is near and has no children, else calls below(p, q) for the pairs of their children.
  template <class Below>
  void descend(int a, int b, const Below& below, std::vector<GroupPair>& out) const {
    const SkinNet::Node &p = net_.nodes[a], &q = net_.nodes[b];
    if (p.rest.merged(q.rest).sizes().squaredNorm() < net_.apart * net_.apart) return;
    double near = near_[a].meets(near_[b]);
    if (skin_.motion) near += way_[a].merged(way_[b]).sizes().norm() / skin_.lost;
    if (now_[a].squaredExteriorDistance(now_[b]) >= near * near) return;
    // Most of the wall has moved and turned as one piece, but for being blown up: what was apart there still is.
    if (shift_[a].merged(shift_[b]).sizes().norm() <= scale_ * net_.apart - near) return;
    if (p.left < 0 && q.left < 0) {
      if (any_near(p, q)) out.emplace_back(a, b);
    } else if (a == b) {
      below(p.left, p.left);
      below(p.left, p.right);
      below(p.right, p.right);
    } else if (q.left < 0 || (p.left >= 0 && p.last - p.first >= q.last - q.first)) {
      below(p.left, b);
      below(p.right, b);
    } else {
      below(a, q.left);
      below(a, q.right);
    }
  }

  bool any_near(const SkinNet::Node& a, const SkinNet::Node& b) const {
    for (int i = a.first; i < a.last; ++i) {
      for (int j = b.first; j < b.last; ++j) {
        const int p = net_.order[i], q = net_.order[j];
        if (!one_piece(net_, p, q) && least_distance(skin_, p, q) < reach_[p].meets(reach_[q])) return true;
      }
    }
    return false;
  }

  const SkinNet& net_;
  const SkinMotion& skin_;
  std::vector<Near> reach_;  ///< of points
  double scale_ = 1;         ///< of the whole, against rest
  std::vector<Eigen::AlignedBox3d> now_,
      shift_,               ///< places, and what scale and turn leave of motions since rest
      way_;                 ///< motions to come; empty where there are none
  std::vector<Near> near_;  ///< the largest of a node's reaches
};

}  // namespace

namespace {

/// Values by their keys, 0 up to `keys`, as they came: of[begin[key]] .. of[begin[key + 1] - 1]. for_each(use) calls
/// use(key, value) for all of them, and is called twice.
struct ByKey {
  std::vector<int> begin, of;

  template <class ForEach>
  ByKey(std::size_t keys, const ForEach& for_each) : begin(keys + 1, 0) {
    for_each([&](int key, int) { ++begin[key + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    of.resize(static_cast<std::size_t>(begin.back()));
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for_each([&](int key, int value) { of[next[key]++] = value; });
  }
};

/// Which of `items`, each a list of points, are around each point.
template <class Items>
ByKey around_points(std::size_t points, const Items& items) {
  return {points, [&](const auto& use) {
            for (std::size_t k = 0; k < items.size(); ++k)
              for (int p : items[k]) use(p, static_cast<int>(k));
          }};
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  return triangles;
}

}  // namespace

SkinNet::SkinNet(const Body& body)
    : rest(body.skin_rest()),
      triangles(sorted(body.skin().triangles)),
      edges(rest, triangles),
      order(rest.size()) {
  constexpr double one_piece = 6e-3;  // m
  apart = std::max(one_piece, 2 * body.widest_skin_gap());
  ByKey of_points = around_points(rest.size(), triangles),
        edges_of_points = around_points(rest.size(), edges.ends);
  begin = std::move(of_points.begin);
  around = std::move(of_points.of);
  edge_begin = std::move(edges_of_points.begin);
  edges_around = std::move(edges_of_points.of);
  std::iota(order.begin(), order.end(), 0);
  nodes.push_back({0, static_cast<int>(rest.size()), -1, -1, {}});
  for (std::size_t n = 0; n < nodes.size(); ++n) split(static_cast<int>(n));
}

void SkinNet::split(int n) {
  constexpr int few = 6;  // points
  Node node = nodes[n];
  for (int k = node.first; k < node.last; ++k) node.rest.extend(rest[order[k]]);
  if (node.last - node.first > few) {
    int axis = 0;
    node.rest.sizes().maxCoeff(&axis);
    const int middle = (node.first + node.last) / 2;
    std::nth_element(
        order.begin() + node.first, order.begin() + middle, order.begin() + node.last,
        [&](int a, int b) { return rest[a][axis] != rest[b][axis] ? rest[a][axis] < rest[b][axis] : a < b; });
    node.left = static_cast<int>(nodes.size());
    node.right = node.left + 1;
    nodes.push_back({node.first, middle, -1, -1, {}});
    nodes.push_back({middle, node.last, -1, -1, {}});
  }
  nodes[n] = node;
}

bool SkinNet::neighbours(int row, int triangle) const {
  const Triangle& t = triangles[triangle];
  return std::any_of(t.begin(), t.end(),
                     [&](int p) { return (rest[row] - rest[p]).squaredNorm() < apart * apart; });
}

bool SkinNet::edges_neighbour(int edge, int other) const {
  for (int p : edges.ends[edge])
    for (int q : edges.ends[other])
      if (one_piece(*this, p, q)) return true;
  return false;
}

std::vector<GroupPair> near_groups(const SkinNet& net, const SkinMotion& skin, Workers* workers) {
  return Boxes(net, skin, workers).near(workers);
}

namespace {

/// A point, and another around which a triangle may be near it.
struct Meeting {
  int row = 0, corner = 0;
};

/// Those of some of the groups.
void meet(const SkinNet& net, const SkinMotion& skin, std::span<const GroupPair> groups,
          std::vector<Meeting>& found) {
  Reaches reaches(net, skin);
  const auto meet = [&](int row, int corner, double distance) {
    if (distance < reaches.of_point(row).own + reaches.of_point(corner).corners)
      found.push_back({row, corner});
  };
  for (const auto& [a, b] : groups) {
    if (reaches.apart(a, b)) continue;
    for (int i = net.nodes[a].first; i < net.nodes[a].last; ++i) {
      for (int j = a == b ? i + 1 : net.nodes[b].first; j < net.nodes[b].last; ++j) {
        const int p = net.order[i], q = net.order[j];
        if (one_piece(net, p, q)) continue;
        const double distance = least_distance(skin, p, q);
        meet(p, q, distance);
        meet(q, p, distance);
      }
    }
  }
}

/// The triangles around the corners that some points meet, as far as they are looked for.
void measure(const SkinNet& net, const SkinMotion& skin, const ByKey& corners, std::span<const int> rows,
             std::vector<SelfPair>& pairs) {
  std::vector<int> seen_by(net.triangles.size(), -1), triangles;
  for (int row : rows) {
    triangles.clear();
    for (int k = corners.begin[row]; k < corners.begin[row + 1]; ++k)
      for (int i = net.begin[corners.of[k]]; i < net.begin[corners.of[k] + 1]; ++i)
        if (std::exchange(seen_by[net.around[i]], row) != row) triangles.push_back(net.around[i]);
    std::sort(triangles.begin(), triangles.end());
    const double reach = skin.motion ? 0 : reach_of_point(net, skin, row);
    for (int triangle : triangles) {
      if (net.neighbours(row, triangle)) continue;
      SelfPair pair{row, triangle, 0};
      if (!skin.motion)
        pair.distance =
            nearest_point(skin.points[row], corners_of(net.triangles[triangle], skin.points)).distance;
      if (skin.motion || pair.distance < reach) pairs.push_back(pair);
    }
  }
}

/// What find(some of the items, its results) adds to the results for all items, in their order.
template <class Found, class Item, class Find>
std::vector<Found> in_chunks(std::span<const Item> items, Workers* workers, const Find& find) {
  constexpr int few = 64;  // not worth another chunk
  const int size = static_cast<int>(items.size()), chunks = std::clamp(size / few, 1, 8);
  std::vector<std::vector<Found>> of_chunk(static_cast<std::size_t>(chunks));
  for_each_chunk(workers, chunks, [&](int k) {
    const Chunk chunk = chunk_of(size, chunks, k);
    find(items.subspan(chunk.begin, chunk.end - chunk.begin), of_chunk[k]);
  });
  std::vector<Found> out = std::move(of_chunk[0]);
  for (int k = 1; k < chunks; ++k) out.insert(out.end(), of_chunk[k].begin(), of_chunk[k].end());
  return out;
}

}  // namespace

std::vector<SelfPair> near_pairs(const SkinNet& net, const SkinMotion& skin,
                                 std::span<const GroupPair> groups, Workers* workers) {
  const std::vector<Meeting> meetings = in_chunks<Meeting>(
      groups, workers,
      [&](std::span<const GroupPair> some, std::vector<Meeting>& out) { meet(net, skin, some, out); });
  const ByKey corners(net.rest.size(), [&](const auto& use) {
    for (const Meeting& met : meetings) use(met.row, met.corner);
  });
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(net.rest.size()); ++row)
    if (corners.begin[row] < corners.begin[row + 1]) rows.push_back(row);
  return in_chunks<SelfPair>(
      std::span<const int>(rows), workers,
      [&](std::span<const int> some, std::vector<SelfPair>& out) { measure(net, skin, corners, some, out); });
}

namespace {

/// Calls met(lower, higher) for edges at a pair's point and of its triangle that may be near each other.
template <class Met>
void for_edges_of(const SkinNet& net, const SkinMotion& skin, const SelfPair& pair, const Met& met) {
  const auto length_squared = [&](int edge) {
    const auto& [a, b] = net.edges.ends[edge];
    return (skin.points[a] - skin.points[b]).squaredNorm();
  };
  const auto& sides = net.edges.sides[pair.triangle];
  double lengths_squared[3];
  for (int i = 0; i < 3; ++i) lengths_squared[i] = length_squared(sides[i]);
  const double room_squared = pair.distance * pair.distance - skin.edges_reach * skin.edges_reach;
  for (int k = net.edge_begin[pair.skin_point]; k < net.edge_begin[pair.skin_point + 1]; ++k) {
    const int edge = net.edges_around[k];
    const double own_squared = length_squared(edge);
    for (int i = 0; i < 3; ++i)
      if (skin.motion || 4 * room_squared <= std::min(own_squared, lengths_squared[i]))
        met(std::min(edge, sides[i]), std::max(edge, sides[i]));
  }
}

}  // namespace

std::vector<EdgesNear> edges_at(const SkinNet& net, std::span<const SelfPair> pairs, const SkinMotion& skin,
                                Workers* workers) {
  // For each edge those of higher number that it meets at the pairs, most of them several times.
  const ByKey met(net.edges.ends.size(), [&](const auto& use) {
    for (const SelfPair& pair : pairs) for_edges_of(net, skin, pair, use);
  });
  std::vector<int> meeting;
  for (int edge = 0; edge < static_cast<int>(net.edges.ends.size()); ++edge)
    if (met.begin[edge] < met.begin[edge + 1]) meeting.push_back(edge);
  const PlacedEdges edges{&net.edges, &skin.points};
  return in_chunks<EdgesNear>(
      std::span<const int>(meeting), workers, [&](std::span<const int> some, std::vector<EdgesNear>& out) {
        std::vector<int> seen_with(net.edges.ends.size(), -1);
        for (int edge : some) {
          const std::size_t first = out.size();
          for (int k = met.begin[edge]; k < met.begin[edge + 1]; ++k) {
            const int other = met.of[k];
            if (std::exchange(seen_with[other], edge) == edge || net.edges_neighbour(edge, other)) continue;
            EdgesNear pair{edge, other, 0};
            if (!skin.motion) pair.distance = nearest_of_edges(places_of(edges, edges, pair)).distance;
            if (skin.motion || pair.distance < skin.edges_reach) out.push_back(pair);
          }
          std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                    [](const EdgesNear& a, const EdgesNear& b) { return a.other < b.other; });
        }
      });
}

}  // namespace calot
