// Which points of some skins may meet which simplices of others.

#include <algorithm>

#include "collision/skin_contact.h"

namespace calot {
namespace {

using Box = Eigen::AlignedBox3d;

/// Of a tree's groups: where they are and how they move.
struct GroupBoxes {
  std::vector<Box> place, motion;

  /// `points(item, visit)` visits the points of an item.
  template <class Points>
  GroupBoxes(const ItemTree& tree, const PlacedSkin& skin, const Points& points)
      : place(tree.nodes.size()), motion(tree.nodes.size()) {
    for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
      const ItemTree::Node& node = tree.nodes[n];
      if (node.left >= 0) {
        place[n] = place[node.left].merged(place[node.right]);
        motion[n] = motion[node.left].merged(motion[node.right]);
        continue;
      }
      for (int k = node.first; k < node.last; ++k) {
        points(tree.order[k], [&](int point) {
          place[n].extend((*skin.points)[point]);
          motion[n].extend(skin.motions ? (*skin.motions)[point] : Vec3::Zero().eval());
        });
      }
    }
  }
};

struct SkinBoxes {
  const PlacedSkin* skin;
  GroupBoxes points, simplices;

  explicit SkinBoxes(const PlacedSkin& placed)
      : skin(&placed),
        points(placed.skin->point_tree(), placed, [](int point, const auto& visit) { visit(point); }),
        simplices(placed.skin->simplex_tree(), placed, [&](int simplex, const auto& visit) {
          for (int corner : placed.skin->corners(simplex)) visit(corner);
        }) {}
};

/// Points of one skin against simplices of another.
class Search {
 public:
  Search(int skin, const SkinBoxes& one, int other, const SkinBoxes& two, const SkinReach& wanted,
         std::vector<SkinPair>& out)
      : skin_(skin),
        other_(other),
        one_(one),
        two_(two),
        wanted_(wanted),
        radii_(one.skin->skin->radius() + two.skin->skin->radius()),
        out_(out) {}

  void visit(int a, int b) {
    const ItemTree::Node &p = one_.skin->skin->point_tree().nodes[a],
                         &q = two_.skin->skin->simplex_tree().nodes[b];
    const double near = group_reach(a, b);
    if (one_.points.place[a].squaredExteriorDistance(two_.simplices.place[b]) >= near * near) return;
    if (p.left < 0 && q.left < 0) {
      compare(a, b);
    } else if (q.left < 0 || (p.left >= 0 && p.last - p.first >= q.last - q.first)) {
      visit(p.left, b);
      visit(p.right, b);
    } else {
      visit(a, q.left);
      visit(a, q.right);
    }
  }

 private:
  /// How far apart centres may be that are looked for, if they move by that against each other.
  double reach(double motion) const { return radii_ + std::max(wanted_.reach, motion / wanted_.lost); }

  double group_reach(int a, int b) const {
    return reach(one_.points.motion[a].merged(two_.simplices.motion[b]).sizes().norm());
  }

  void compare(int a, int b) {
    const ItemTree &points = one_.skin->skin->point_tree(), &simplices = two_.skin->skin->simplex_tree();
    const ItemTree::Node &p = points.nodes[a], &q = simplices.nodes[b];
    const double near = group_reach(a, b);
    for (int i = p.first; i < p.last; ++i) {
      const int point = points.order[i];
      if (two_.simplices.place[b].squaredExteriorDistance((*one_.skin->points)[point]) >= near * near)
        continue;
      for (int j = q.first; j < q.last; ++j)
        if (meet(point, simplices.order[j])) out_.push_back({skin_, point, other_, simplices.order[j]});
    }
  }

  bool meet(int point, int simplex) const {
    const PlacedSkin &one = *one_.skin, &two = *two_.skin;
    const std::span<const int> ids = two.skin->corners(simplex);
    std::array<Vec3, 3> corners;
    Box box;
    double motion = 0;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      corners[k] = (*two.points)[ids[k]];
      box.extend(corners[k]);
      Vec3 against = Vec3::Zero();
      if (one.motions) against += (*one.motions)[point];
      if (two.motions) against -= (*two.motions)[ids[k]];
      motion = std::max(motion, against.squaredNorm());
    }
    const Vec3& p = (*one.points)[point];
    const double near = reach(std::sqrt(motion));
    // Most are told apart by the box alone, which costs a tenth.
    return box.squaredExteriorDistance(p) < near * near &&
           nearest_point(p, {corners.data(), ids.size()}).distance < near;
  }

  int skin_, other_;
  const SkinBoxes &one_, &two_;
  const SkinReach& wanted_;
  double radii_;
  std::vector<SkinPair>& out_;
};

}  // namespace

ItemTree::ItemTree(const std::vector<Vec3>& centres, std::vector<int> items) : order(std::move(items)) {
  constexpr int few = 8;
  if (order.empty()) return;
  nodes.push_back({0, static_cast<int>(order.size())});
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Node node = nodes[n];
    if (node.last - node.first <= few) continue;
    Box box;
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

std::vector<SkinPair> skin_pairs(std::span<const PlacedSkin> skins, const SkinReach& looked_for) {
  std::vector<SkinBoxes> boxes;
  for (const PlacedSkin& skin : skins) boxes.emplace_back(skin);
  std::vector<SkinPair> out;
  for (std::size_t a = 0; a < skins.size(); ++a) {
    for (std::size_t b = 0; b < skins.size(); ++b) {
      if (a == b || skins[a].skin->point_tree().nodes.empty() || skins[b].skin->simplex_tree().nodes.empty())
        continue;
      Search(static_cast<int>(a), boxes[a], static_cast<int>(b), boxes[b], looked_for, out).visit(0, 0);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace calot
