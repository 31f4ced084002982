#include "joins/joint.h"

#include <algorithm>

#include "fem/links.h"

namespace calot {
namespace {

constexpr int fewest_points = 3;

using Skin = std::vector<Vec3>;

}  // namespace

Result<JointLinks> joint_links(const Body& one, const Body& other, std::array<int, 2> bodies,
                               const Vec3& place, double radius, double stiffness) {
  return joint_links(one, other, {one.skin_rest(), other.skin_rest()}, bodies, place, radius, stiffness);
}

Result<JointLinks> joint_links(const Body& one, const Body& other, const std::array<Skin, 2>& skins,
                               std::array<int, 2> bodies, const Vec3& place, double radius,
                               double stiffness) {
  if (!(radius > 0) || !(stiffness > 0) || bodies[0] == bodies[1])
    return fail(FailureKind::scenario,
                "the joint of '" + one.name() + "' and '" + other.name() +
                    "' needs two bodies, a radius and a stiffness above 0",
                "join two different bodies and give the joint a size and a stiffness");
  JointLinks out;
  out.bodies = bodies;
  int held = 0;
  const PointsByDistance on_other = points_by_distance(skins[1], place);
  for (const auto& [distance, point] : points_by_distance(skins[0], place)) {
    if (held >= fewest_points && distance > radius) break;
    ++held;
    const CarriedPlace end{{point}, {1.0}};
    if (std::optional<CarriedPlace> there = carried_place(skins[1], skins[0][point], radius)) {
      out.links.push_back({end, std::move(*there), 0});
      continue;
    }
    // A line: to its nearest point, and as far as a radius or more along it on both sides.
    const Vec3 middle = skins[1][on_other[0].second];
    std::array<int, 3> feet{on_other[0].second, -1, -1};
    for (const auto& [unused, foot] : on_other) {
      const Vec3 arm = skins[1][foot] - middle;
      if (arm.norm() < radius) continue;
      if (feet[1] < 0) feet[1] = foot;
      if (arm.dot(skins[1][feet[1]] - middle) < 0) {
        feet[2] = foot;
        break;
      }
    }
    for (int foot : feet)
      if (foot >= 0) out.links.push_back({end, {{foot}, {1.0}}, (skins[1][foot] - skins[0][point]).norm()});
  }
  out.stiffness = stiffness / held;
  return out;
}

void Joint::begin(std::span<const GroupPlace> bodies) const {
  if (std::max(links_.bodies[0], links_.bodies[1]) >= static_cast<int>(bodies.size())) {
    rows_ = {};
    nodes_.clear();
    first_ = {-1, -1};
    return;
  }
  bool same = true;
  for (int k = 0; k < 2; ++k) {
    const GroupPlace& place = bodies[links_.bodies[k]];
    same &= first_[k] == place.first_node && details_[k] == place.body->details();
    first_[k] = place.first_node;
    details_[k] = place.body->details();
  }
  if (same) return;
  rows_ = {};
  for (const JointLinks::Link& link : links_.links) {
    for (int k = 0; k < 2; ++k) {
      const StencilTable& skin = bodies[links_.bodies[k]].body->skin().stencils;
      append_place(k == 0 ? link.one : link.other, skin, first_[k], rows_);
    }
  }
  nodes_ = rows_.node;
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  find_tied();
}

void Joint::find_tied() const {
  const std::size_t count = nodes_.size();
  tied_.assign(count * count, 0.0);
  for (std::size_t link = 0; link < links_.links.size(); ++link) {
    if (links_.links[link].length > 0) continue;
    std::vector<double> weights(count, 0.0);  // of the way from one place to the other
    for (int k = 0; k < 2; ++k) {
      const std::size_t row = 2 * link + static_cast<std::size_t>(k);
      for (int e = rows_.begin[row]; e < rows_.begin[row + 1]; ++e)
        weights[std::lower_bound(nodes_.begin(), nodes_.end(), rows_.node[e]) - nodes_.begin()] +=
            k == 0 ? rows_.value[e] : -rows_.value[e];
    }
    for (std::size_t b = 0; b < count; ++b)
      for (std::size_t a = b; weights[b] != 0 && a < count; ++a)
        tied_[b * count + a] += links_.stiffness * weights[a] * weights[b];
  }
}

Joint::Pull Joint::pull(std::size_t link, const VecX& x) const {
  const int row = 2 * static_cast<int>(link);
  const Vec3 arm = blend(rows_, rows_.value, row, x) - blend(rows_, rows_.value, row + 1, x);
  return {arm, arm.norm()};
}

double Joint::value(const VecX& x) const {
  double sum = 0;
  for (std::size_t i = 0; 2 * i < static_cast<std::size_t>(rows_.rows()); ++i) {
    const double longer = pull(i, x).distance - links_.links[i].length;
    sum += 0.5 * links_.stiffness * longer * longer;
  }
  return sum;
}

Vec3 Joint::slope(std::size_t link, const VecX& x) const {
  const Pull at = pull(link, x);
  const JointLinks::Link& of = links_.links[link];
  if (of.length == 0) return links_.stiffness * at.arm;
  return at.tension(of, links_.stiffness) * at.arm / at.distance;
}

void Joint::add_gradient(const VecX& x, VecX& gradient) const {
  for (int row = 0; row < rows_.rows(); row += 2) {
    const Vec3 by_one = slope(static_cast<std::size_t>(row) / 2, x);
    spread(rows_, row, by_one, gradient);
    spread(rows_, row + 1, -by_one, gradient);
  }
}

Vec3 Joint::force(const VecX& x) const {
  Vec3 sum = Vec3::Zero();
  for (int row = 0; row < rows_.rows(); row += 2) sum += slope(static_cast<std::size_t>(row) / 2, x);
  return sum;
}

void Joint::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  for (std::size_t b = 0; b < nodes_.size(); ++b)
    for (std::size_t a = b; a < nodes_.size(); ++a)
      if (const double tied = tied_[b * nodes_.size() + a]; tied != 0)
        matrix.add(nodes_[a], nodes_[b], tied * Mat3::Identity());
  for (int row = 0; row < rows_.rows(); row += 2) {
    const auto link = static_cast<std::size_t>(row) / 2;
    const double length = links_.links[link].length;
    if (length == 0) continue;
    const Pull at = pull(link, x);
    const Vec3 along = at.arm / at.distance;
    const Mat3 h = links_.stiffness *
                   (Mat3::Identity() - length / at.distance * (Mat3::Identity() - along * along.transpose()));
    Eigen::Matrix<double, 12, 12> both = Eigen::Matrix<double, 12, 12>::Zero();
    both.block<3, 3>(0, 0) = both.block<3, 3>(3, 3) = h;
    both.block<3, 3>(0, 3) = both.block<3, 3>(3, 0) = -h;
    add_points_hessian(rows_, {row, row + 1, -1, -1}, both, matrix);
  }
}

void Joint::add_cliques(const VecX&, bool, std::vector<std::vector<int>>& cliques) const {
  if (!nodes_.empty()) cliques.push_back(nodes_);
}

}  // namespace calot
