// Which points of some skins may meet which simplices of others, and which edges which.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "collision/skin_contact.h"
#include "collision/skin_edges.h"

namespace calot {
namespace {

/// A box. The fourth coordinate is always 0: four are taken at a time.
struct Box {
  using Corner = Eigen::Array4d;
  Corner min = Corner::Constant(std::numeric_limits<double>::max());
  Corner max = Corner::Constant(std::numeric_limits<double>::lowest());

  static Box of_point(const Vec3& at) {
    const Corner corner(at[0], at[1], at[2], 0.0);
    return {corner, corner};
  }
  void extend(const Box& other) {
    min = min.min(other.min);
    max = max.max(other.max);
  }
  double length_squared() const {
    const Corner squares = (max - min).square();
    return squares[0] + squares[1] + squares[2];
  }
  double squared_distance(const Box& other) const {
    const Corner squares = (min - other.max).max(other.min - max).max(0.0).square();
    return squares[0] + squares[1] + squares[2];
  }
};

/// Where some points are, and how they move; null: they stay.
struct Bound {
  const Box* place;
  const Box* motion;
};

/// Around each item's points, in the tree's order, and around each group of items.
struct Boxes {
  std::vector<Box> own, group;

  Boxes() = default;
  template <class Corners>
  Boxes(const ItemTree& tree, const std::vector<Vec3>& values, const Corners& corners)
      : own(tree.order.size()), group(tree.nodes.size()) {
    for (std::size_t k = 0; k < own.size(); ++k)
      for (int point : corners(tree.order[k])) own[k].extend(Box::of_point(values[point]));
    for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
      const ItemTree::Node& node = tree.nodes[n];
      if (node.left >= 0)
        group[n].extend(group[node.left]), group[n].extend(group[node.right]);
      else
        for (int k = node.first; k < node.last; ++k) group[n].extend(own[k]);
    }
  }
};

/// What of a skin is looked at: its points, simplices or edges, in a tree. `corners(item)`: its points.
template <class Corners>
class Items {
 public:
  Items(const ItemTree& tree, const std::vector<Vec3>& points, const std::vector<Vec3>* motions,
        Corners corners)
      : tree_(&tree),
        points_(&points),
        motions_(motions),
        corners_(std::move(corners)),
        places_(tree, points, corners_) {
    if (motions) moves_ = Boxes(tree, *motions, corners_);
  }

  const ItemTree& tree() const { return *tree_; }
  std::span<const int> corners(const int& item) const { return corners_(item); }
  const Vec3& at(int point) const { return (*points_)[point]; }
  bool moves() const { return motions_ != nullptr; }
  Vec3 motion(int point) const { return motions_ ? (*motions_)[point] : Vec3::Zero().eval(); }
  /// Of an item, by its place in the tree's order.
  Bound own(int place) const { return {&places_.own[place], motions_ ? &moves_.own[place] : nullptr}; }
  Bound group(int node) const { return {&places_.group[node], motions_ ? &moves_.group[node] : nullptr}; }

 private:
  const ItemTree* tree_;
  const std::vector<Vec3>*points_, *motions_;
  Corners corners_;
  Boxes places_, moves_;
};

auto points_of(const PlacedSkin& placed) {
  return Items(placed.skin->point_tree(), *placed.points, placed.motions,
               [](const int& point) { return std::span<const int>(&point, 1); });
}
auto simplices_of(const PlacedSkin& placed) {
  return Items(placed.skin->simplex_tree(), *placed.points, placed.motions,
               [skin = placed.skin](const int& simplex) { return skin->corners(simplex); });
}
auto edges_of(const PlacedEdges& placed, const ItemTree& tree) {
  return Items(tree, *placed.points, placed.motions,
               [edges = placed.edges](const int& edge) { return std::span<const int>(edges->ends[edge]); });
}

/// Where an edge goes through a triangle.
std::optional<Vec3> pierced_at(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double begin = normal.dot(from - t[0]), end = normal.dot(to - t[0]);
  if ((begin > 0) == (end > 0)) return std::nullopt;
  const Vec3 place = from + begin / (begin - end) * (to - from);
  for (std::size_t k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(place - t[k]).dot(normal) < 0) return std::nullopt;
  return place;
}

/// Distance of a point and a simplex, or of two edges; of an edge and a triangle that it goes through, 0.
double distance_of(const std::array<Vec3, 3>& one, std::size_t corners, const std::array<Vec3, 3>& other,
                   std::size_t other_corners) {
  if (corners == 1) return nearest_point(one[0], {other.data(), other_corners}).distance;
  if (other_corners == 2) return between_edges({one[0], one[1], other[0], other[1]}).norm();
  return pierced_at(one[0], one[1], other) ? 0 : std::numeric_limits<double>::infinity();
}

/// Items of one skin against those of another.
template <class One, class Other>
class Search {
 public:
  /// `radii`: sum of both, m.
  Search(const One& one, const Other& other, const SkinReach& wanted, double radii)
      : one_(one),
        other_(other),
        wanted_(wanted),
        radii_(radii),
        moving_(one.moves() || other.moves()),
        still_reach_(reach(0)) {}

  /// hit(item, other item, their distance) of all that are looked for, in no order, but always the same.
  template <class Hit>
  auto find(const Hit& hit, Workers* workers) const {
    const std::vector<NodePair> starts = first_pairs();
    std::vector<std::vector<decltype(hit(0, 0, 0.0))>> found(starts.size() + 1);
    for_each_chunk(workers, static_cast<int>(starts.size()), [&](int k) {
      visit(starts[k],
            [&](int item, int other, double distance) { found[k].push_back(hit(item, other, distance)); });
    });
    auto& out = found.back();
    for (std::size_t k = 0; k < starts.size(); ++k) out.insert(out.end(), found[k].begin(), found[k].end());
    return std::move(out);
  }

 private:
  struct NodePair {
    int one, other;
  };
  bool are_leaves(const NodePair& at) const {
    return one_.tree().nodes[at.one].left < 0 && other_.tree().nodes[at.other].left < 0;
  }
  /// The two halves of the larger of both.
  std::array<NodePair, 2> halves(const NodePair& at) const {
    const ItemTree::Node &p = one_.tree().nodes[at.one], &q = other_.tree().nodes[at.other];
    if (q.left < 0 || (p.left >= 0 && p.last - p.first >= q.last - q.first))
      return {{{p.left, at.other}, {p.right, at.other}}};
    return {{{at.one, q.left}, {at.one, q.right}}};
  }
  /// Whence all is reached that is not too far apart: enough of them to be shared by threads.
  std::vector<NodePair> first_pairs() const {
    constexpr std::size_t enough = 16;
    std::vector<NodePair> out;
    if (one_.tree().nodes.empty() || other_.tree().nodes.empty()) return out;
    out.push_back({0, 0});
    for (bool split = true; split && out.size() < enough;) {
      split = false;
      for (const NodePair& at : std::exchange(out, {})) {
        if (are_far(one_.group(at.one), other_.group(at.other))) continue;
        if (are_leaves(at)) {
          out.push_back(at);
          continue;
        }
        split = true;
        for (const NodePair& half : halves(at)) out.push_back(half);
      }
    }
    return out;
  }

  template <class Found>
  void visit(const NodePair& at, const Found& found) const {
    if (are_far(one_.group(at.one), other_.group(at.other))) return;
    if (are_leaves(at)) return compare(at, found);
    for (const NodePair& half : halves(at)) visit(half, found);
  }

  /// How far apart items may be that are looked for, if they move by that against each other.
  double reach(double motion) const {
    return radii_ + std::min(std::max(wanted_.reach, motion / wanted_.lost), wanted_.nearer + motion);
  }

  /// Whether what is in these bounds is too far apart, or stays so.
  bool are_far(const Bound& one, const Bound& other) const {
    const double apart_squared = one.place->squared_distance(*other.place);
    if (!moving_) return apart_squared >= still_reach_ * still_reach_;
    Box motion = motion_of(one);
    motion.extend(motion_of(other));
    if (apart_squared > 0) {
      const double near = reach(std::sqrt(motion.length_squared()));
      if (apart_squared >= near * near) return true;
    }
    return stay_apart(one, other, 0.5 * (motion.min + motion.max));
  }

  static const Box& motion_of(const Bound& of) {
    static const Box none = Box::of_point(Vec3::Zero());
    return of.motion ? *of.motion : none;
  }

  /// `common`: what both move by beside.
  bool stay_apart(const Bound& one, const Bound& other, const Box::Corner& common) const {
    if (std::isinf(wanted_.nearer)) return false;
    const auto swept = [&](const Bound& of) {
      return Box{of.place->min + (motion_of(of).min - common).min(0.0),
                 of.place->max + (motion_of(of).max - common).max(0.0)};
    };
    const double near = radii_ + wanted_.nearer;
    return swept(one).squared_distance(swept(other)) >= near * near;
  }

  template <class Found>
  void compare(const NodePair& at, const Found& found) const {
    const ItemTree::Node &p = one_.tree().nodes[at.one], &q = other_.tree().nodes[at.other];
    const Bound others = other_.group(at.other);
    for (int i = p.first; i < p.last; ++i) {
      const Bound own = one_.own(i);
      if (are_far(own, others)) continue;
      // Most are told apart by their boxes alone, which costs a tenth.
      for (int j = q.first; j < q.last; ++j)
        if (!are_far(own, other_.own(j))) meet(one_.tree().order[i], other_.tree().order[j], found);
    }
  }

  template <class Found>
  void meet(const int& item, const int& other, const Found& found) const {
    const std::span<const int> ids = one_.corners(item), other_ids = other_.corners(other);
    std::array<Vec3, 3> corners, other_corners;
    for (std::size_t i = 0; i < ids.size(); ++i) corners[i] = one_.at(ids[i]);
    for (std::size_t k = 0; k < other_ids.size(); ++k) other_corners[k] = other_.at(other_ids[k]);
    const double near = moving_ ? reach(std::sqrt(largest_motion_squared(ids, other_ids))) : still_reach_;
    const double distance = distance_of(corners, ids.size(), other_corners, other_ids.size());
    if (distance < near) found(item, other, distance);
  }

  /// Of a point of one against one of the other, m^2.
  double largest_motion_squared(std::span<const int> ids, std::span<const int> other_ids) const {
    double out = 0;
    for (int id : ids)
      for (int other : other_ids) out = std::max(out, (one_.motion(id) - other_.motion(other)).squaredNorm());
    return out;
  }

  const One& one_;
  const Other& other_;
  const SkinReach& wanted_;
  double radii_;
  bool moving_;
  double still_reach_;  ///< m, where nothing moves
};

}  // namespace

ItemTree::ItemTree(const std::vector<Vec3>& centres, std::vector<int> items) : order(std::move(items)) {
  constexpr int few = 8;
  if (order.empty()) return;
  nodes.push_back({0, static_cast<int>(order.size())});
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node node = nodes[n];
    if (node.last - node.first <= few) continue;
    Eigen::AlignedBox3d box;
    for (int k = node.first; k < node.last; ++k) box.extend(centres[order[k]]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const int middle = (node.first + node.last) / 2;
    std::nth_element(order.begin() + node.first, order.begin() + middle, order.begin() + node.last,
                     [&](int a, int b) {
                       const double at = centres[a][axis], other = centres[b][axis];
                       return at != other ? at < other : a < b;
                     });
    node.left = static_cast<int>(nodes.size());
    node.right = node.left + 1;
    nodes[n] = node;
    nodes.push_back({node.first, middle});
    nodes.push_back({middle, node.last});
  }
}

std::vector<SkinPair> skin_pairs(std::span<const PlacedSkin> skins, const SkinReach& looked_for,
                                 Workers* workers) {
  std::vector<std::optional<decltype(points_of(skins[0]))>> points(skins.size());
  std::vector<std::optional<decltype(simplices_of(skins[0]))>> simplices(skins.size());
  for_each_chunk(workers, 2 * static_cast<int>(skins.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk) / 2;
    if (chunk % 2 == 0)
      points[k].emplace(points_of(skins[k]));
    else
      simplices[k].emplace(simplices_of(skins[k]));
  });
  std::vector<SkinPair> out;
  for (std::size_t a = 0; a < skins.size(); ++a)
    for (std::size_t b = 0; b < skins.size(); ++b) {
      if (a == b) continue;
      const double radii = skins[a].skin->radius() + skins[b].skin->radius();
      const auto hit = [&](int point, int simplex, double /*distance*/) {
        return SkinPair{static_cast<int>(a), point, static_cast<int>(b), simplex};
      };
      const std::vector<SkinPair> found =
          Search(*points[a], *simplices[b], looked_for, radii).find(hit, workers);
      out.insert(out.end(), found.begin(), found.end());
    }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<EdgesNear> near_edges(const PlacedEdges& one, const ItemTree& of_one, const PlacedEdges& other,
                                  const ItemTree& of_other, const SkinReach& looked_for, Workers* workers) {
  std::optional<decltype(edges_of(one, of_one))> edges, others;
  do_at_once(
      workers, [&] { edges.emplace(edges_of(one, of_one)); },
      [&] { others.emplace(edges_of(other, of_other)); });
  const bool moving = one.motions || other.motions;
  const auto hit = [&](int edge, int other_edge, double distance) {
    return EdgesNear{edge, other_edge, moving ? 0 : distance};
  };
  std::vector<EdgesNear> out = Search(*edges, *others, looked_for, 0).find(hit, workers);
  std::sort(out.begin(), out.end(), [](const EdgesNear& a, const EdgesNear& b) {
    return std::tie(a.edge, a.other) < std::tie(b.edge, b.other);
  });
  return out;
}

std::vector<PiercedTriangle> pierced_triangles(const PlacedEdges& one, const ItemTree& of_one,
                                               const PlacedSkin& other) {
  constexpr double reach = 1e-9;  // m: more than none
  const auto at = [&](int point) { return (*other.points)[point]; };
  const auto edges = edges_of(one, of_one);
  const auto simplices = simplices_of(other);
  const SkinReach looked_for{reach, 1};
  const auto both = [](int edge, int simplex, double /*distance*/) { return std::pair(edge, simplex); };
  std::vector<PiercedTriangle> out;
  for (const auto& [edge, simplex] : Search(edges, simplices, looked_for, 0).find(both, nullptr)) {
    const auto [from, to] = one.edges->ends[edge];
    const Triangle& t = other.skin->triangle(simplex);
    if (const auto place = pierced_at((*one.points)[from], (*one.points)[to], {at(t[0]), at(t[1]), at(t[2])}))
      out.push_back({edge, simplex, *place});
  }
  std::sort(out.begin(), out.end(), [](const PiercedTriangle& a, const PiercedTriangle& b) {
    return std::tie(a.edge, a.simplex) < std::tie(b.edge, b.simplex);
  });
  return out;
}

}  // namespace calot
