#include "body/skin_bounds.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace calot {
namespace {

using Box = Eigen::AlignedBox3d;

/// Of the skin's points where these lie beyond the nodes: as one piece, and what that leaves.
Box motion_beyond(const Body& body, const VecX& dx) {
  const Eigen::Map<const Eigen::Matrix3Xd> moves(dx.data(), 3, body.nodes());
  const Vec3 mean = moves.rowwise().mean();
  const Eigen::Matrix3Xd rest = moves.colwise() - mean;
  const Vec3 further = Vec3::Constant(body.largest_motion(Eigen::Map<const VecX>(rest.data(), rest.size())));
  return {mean - further, mean + further};
}

/// `node(i)`: the i-th of `count` nodes.
template <class Node>
SkinMoves motion_of(const Body& body, const VecX& dx, int count, const Node& node) {
  if (body.beyond_nodes() > 0) return {motion_beyond(body, dx), 0};
  SkinMoves out;
  std::vector<double> of_level(body.levels_used() + 1, 0.0);
  for (int i = 0; i < count; ++i) {
    const Vec3 move = dx.segment<3>(Eigen::Index{3} * node(i));
    if (node(i) < body.coarse_nodes()) {
      out.box.extend(move);
    } else {
      double& largest = of_level[body.level_of_detail(node(i) - body.coarse_nodes())];
      largest = std::max(largest, move.norm());
    }
  }
  for (double largest : of_level) out.further += largest;
  return out;
}

}  // namespace

Box skin_box(const Body& body, const VecX& x) {
  std::vector<int> all(body.nodes());
  std::iota(all.begin(), all.end(), 0);
  return body.box_of(all, x, body.beyond_nodes());
}

SkinMoves skin_motion(const Body& body, const VecX& dx) {
  return motion_of(body, dx, body.nodes(), [](int i) { return i; });
}

SkinMoves skin_motion(const Body& body, const VecX& dx, std::span<const int> nodes) {
  return motion_of(body, dx, static_cast<int>(nodes.size()), [&](int i) { return nodes[i]; });
}

double approach_of(const SkinMoves& one, const SkinMoves& other) {
  const Box both = one.box.merged(other.box);
  return one.further + other.further + (both.isEmpty() ? 0.0 : both.sizes().norm());
}

}  // namespace calot
