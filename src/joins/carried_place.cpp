#include "joins/carried_place.h"

#include <algorithm>
#include <map>

#include "numerics/modes.h"

namespace calot {
namespace {

using Skin = std::vector<Vec3>;

/// Skin points and their distances from a place, not ordered.
PointsByDistance distances(const Skin& skin, const Vec3& place) {
  PointsByDistance out;
  for (std::size_t i = 0; i < skin.size(); ++i)
    out.emplace_back((skin[i] - place).norm(), static_cast<int>(i));
  return out;
}

/// Those of them that are nearer than `reach`, by their distance: to order a whole skin of thousands of points for each
/// of hundreds of joined ones took a seventh of the time to set up a field.
PointsByDistance within(const PointsByDistance& points, double reach) {
  PointsByDistance out;
  for (const auto& point : points)
    if (point.first < reach) out.push_back(point);
  std::sort(out.begin(), out.end());
  return out;
}

/// The least weights of these points, all within `reach`, that sum to 1 and give the place; none where they do not span it.
std::optional<CarriedPlace> weights_within(const Skin& skin, const Vec3& place,
                                           const PointsByDistance& points, double reach) {
  constexpr double exact = 1e-9;  // of the reach
  constexpr double flat = 1e-10;  // of the points' largest second moment, what rounding leaves across a plane
  CarriedPlace out;
  std::vector<double> nearness;
  for (const auto& [distance, point] : points) {
    out.points.push_back(point);
    const double share = distance / reach;
    nearness.push_back((1 - share * share) * (1 - share * share));
  }
  if (out.points.empty()) return {};
  const auto count = static_cast<Eigen::Index>(out.points.size());
  Eigen::Matrix4Xd places(4, count);
  for (Eigen::Index i = 0; i < count; ++i) places.col(i) << 1, (skin[out.points[i]] - place) / reach;
  const Eigen::Map<const VecX> near(nearness.data(), count);
  const Eigen::Matrix4d products = places * near.asDiagonal() * places.transpose();
  const std::optional<Modes> spread = modes(products);
  if (!spread) return {};
  // The least solution of products * x = wanted: points in one plane or on one line leave some of its modes without
  // stiffness.
  const Eigen::Vector4d wanted = Eigen::Vector4d::UnitX();
  Eigen::Vector4d solution = Eigen::Vector4d::Zero();
  for (Eigen::Index k = 0; k < 4; ++k)
    if (spread->values[k] > flat * spread->values[3])
      solution += spread->vectors(0, k) / spread->values[k] * spread->vectors.col(k);
  const VecX weights = near.asDiagonal() * (places.transpose() * solution);
  if (!((places * weights - wanted).norm() < exact)) return {};
  out.weights.assign(weights.data(), weights.data() + count);
  return out;
}

double total(const CarriedPlace& place) {
  double sum = 0;
  for (double weight : place.weights) sum += std::abs(weight);
  return sum;
}

}  // namespace

PointsByDistance points_by_distance(const Skin& skin, const Vec3& place) {
  PointsByDistance out = distances(skin, place);
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<CarriedPlace> carried_place(const Skin& skin, const Vec3& place, double radius) {
  constexpr double calm = 3, wildest = 8, wider = 1.25;
  const PointsByDistance points = distances(skin, place);
  const auto [nearest, furthest] = std::minmax_element(points.begin(), points.end());
  std::optional<CarriedPlace> best;
  for (double reach = nearest->first + radius;; reach *= wider) {
    std::optional<CarriedPlace> found = weights_within(skin, place, within(points, reach), reach);
    if (found && (!best || total(*found) < total(*best))) best = std::move(found);
    if (best && total(*best) <= calm) return best;
    if (reach > furthest->first) break;
  }
  return best && total(*best) <= wildest ? best : std::nullopt;
}

Vec3 carried_to(const CarriedPlace& place, const std::vector<Vec3>& skin) {
  Vec3 at = Vec3::Zero();
  for (std::size_t i = 0; i < place.points.size(); ++i) at += place.weights[i] * skin[place.points[i]];
  return at;
}

void append_place(const CarriedPlace& place, const StencilTable& skin, int first_node, StencilTable& rows) {
  std::map<int, double> weights;
  for (std::size_t i = 0; i < place.points.size(); ++i)
    for (int e = skin.begin[place.points[i]]; e < skin.begin[place.points[i] + 1]; ++e)
      weights[first_node + skin.node[e]] += place.weights[i] * skin.value[e];
  for (const auto& [node, weight] : weights) {
    rows.node.push_back(node);
    rows.value.push_back(weight);
  }
  rows.begin.push_back(static_cast<int>(rows.node.size()));
}

}  // namespace calot
