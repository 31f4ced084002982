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

/// What details among the nodes add to the motion.
template <class Node>
double motion_of_details(const Body& body, const VecX& dx, int count, const Node& node) {
  const int coarse = body.coarse_nodes();
  std::vector<double> of_level(body.levels_used() + 1, 0.0);
  for (int i = 0; i < count; ++i) {
    if (node(i) < coarse) continue;
    double& largest = of_level[body.level_of_detail(node(i) - coarse)];
    largest = std::max(largest, dx.segment<3>(Eigen::Index{3} * node(i)).norm());
  }
  double out = 0;
  for (double largest : of_level) out += largest;
  return out;
}

/// `node(i)`: the i-th of `count` nodes.
template <class Node>
SkinMoves motion_of(const Body& body, const VecX& dx, int count, const Node& node) {
  if (body.beyond_nodes() > 0) return {motion_beyond(body, dx), 0};
  SkinMoves out;
  const int coarse = body.coarse_nodes();
  for (int i = 0; i < count; ++i)
    if (node(i) < coarse) out.box.extend(dx.segment<3>(Eigen::Index{3} * node(i)));
  if (coarse < body.nodes()) out.further = motion_of_details(body, dx, count, node);
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
