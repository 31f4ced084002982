#include "joins/skin_rubbing.h"

#include <algorithm>
#include <set>

#include "fem/links.h"
#include "geometry/turn.h"

namespace calot {
namespace {

StencilPoint stencil_point(std::span<const GroupPlace> bodies, const BodyPoint& point) {
  const GroupPlace& place = bodies[static_cast<std::size_t>(point.body)];
  return {&place.body->skin().stencils, point.row, place.first_node};
}

Vec3 place_of(const StencilPoint& point, const VecX& x) {
  const StencilTable& table = *point.table;
  Vec3 sum = Vec3::Zero();
  for (int e = table.begin[point.row]; e < table.begin[point.row + 1]; ++e)
    sum += table.value[e] * x.segment<3>(Eigen::Index{3} * (point.first_node + table.node[e]));
  return sum;
}

/// The frame's first axis and what spans its plane beside it.
struct Edges {
  Vec3 along, third;
  Edges(const std::array<Vec3, 4>& at, bool lines)
      : along(at[2] - at[1]), third(at[3] - (lines ? at[0] : at[1])) {}
};

}  // namespace

std::array<Vec3, 4> BodyPlaces::of(const RubbingPlace& place) const {
  std::array<Vec3, 4> out;
  for (std::size_t k = 0; k < 4; ++k) out[k] = place_of(stencil_point(bodies_, place.points[k]), x_);
  return out;
}

double BodyPlaces::across(const RubbingPlace& place) const {
  if (!place.lines) return 1;
  // Sines of the angle between lines that roll on each other, and that hold each other in every direction.
  constexpr double rolls = 0.3, holds = 0.7;
  const Edges edges(of(place), true);
  const double sine = edges.along.cross(edges.third).norm() / (edges.along.norm() * edges.third.norm());
  const double share = std::clamp((sine - rolls) / (holds - rolls), 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

namespace {

RubbingFrame frame_of(const std::array<Vec3, 4>& at, bool lines, double across) {
  const Edges edges(at, lines);
  const double length = edges.along.norm();
  const Vec3 first = edges.along / length, arm = at[0] - at[1];
  // Where nothing across the first axis counts any plane does.
  const Vec3 normal =
      across > 0 ? Vec3(edges.along.cross(edges.third).normalized()) : Vec3(first.unitOrthogonal());
  const Vec3 second = normal.cross(first);
  RubbingFrame out;
  out.across = across;
  out.turn << first, second, normal;
  // The frame's turn by the edges' motions.
  Mat3 by_along = (normal * second.transpose() - second * normal.transpose()) / length,
       by_third = Mat3::Zero();
  if (across > 0) {
    const double height = edges.third.dot(second), share = edges.third.dot(first) / length;
    by_third = first * normal.transpose() / height;
    by_along -= share * by_third;
  }
  const Mat3 counted = Vec3(1, across, across).asDiagonal() * out.turn.transpose();
  const Mat3 turned = counted * cross_matrix(arm);
  out.at = counted * arm;
  out.slopes = {counted, -counted - turned * by_along, turned * by_along, turned * by_third};
  out.slopes[lines ? 0 : 1] -= turned * by_third;
  return out;
}

using Slope = Eigen::Matrix<double, 12, 1>;
using Bend = Eigen::Matrix<double, 12, 12>;

Slope slope_by_points(const RubbingFrame& frame, const Vec3& by_place) {
  Slope out;
  for (int k = 0; k < 4; ++k)
    out.segment<3>(3 * k) = frame.slopes[static_cast<std::size_t>(k)].transpose() * by_place;
  return out;
}

/// What the frame's turning adds to the Hessian, by differences of the slopes: exact to 1e-9 of itself. The first
/// point's part follows, as nothing changes with a motion of all.
Bend turning(const std::array<Vec3, 4>& at, bool lines, double across, const Vec3& by_place) {
  const double step = 1e-6 * (at[2] - at[1]).norm();
  Bend out = Bend::Zero();
  for (int k = 3; k < 12; ++k) {
    std::array<Vec3, 4> ahead = at, behind = at;
    const auto point = static_cast<std::size_t>(k / 3);
    ahead[point][k % 3] += step;
    behind[point][k % 3] -= step;
    out.col(k) = (slope_by_points(frame_of(ahead, lines, across), by_place) -
                  slope_by_points(frame_of(behind, lines, across), by_place)) /
                 (2 * step);
    out.col(k % 3) -= out.col(k);
  }
  return 0.5 * (out + out.transpose());
}

}  // namespace

RubbingFrame BodyPlaces::frame(const RubbingPlace& place, double across) const {
  return frame_of(of(place), place.lines, across);
}

const SkinHold* find_hold(std::span<const SkinHold> holds, const RubbingPair& pair) {
  const auto at =
      std::lower_bound(holds.begin(), holds.end(), pair,
                       [](const SkinHold& hold, const RubbingPair& key) { return hold.pair < key; });
  return at != holds.end() && at->pair == pair ? &*at : nullptr;
}

std::array<StencilPoint, 4> SkinRubbing::points_of(const RubbingPlace& place) const {
  std::array<StencilPoint, 4> out;
  for (std::size_t k = 0; k < 4; ++k) out[k] = stencil_point(bodies_, place.points[k]);
  return out;
}

double SkinRubbing::value(const VecX& x) const {
  const BodyPlaces places(bodies_, x);
  double sum = 0;
  for (const SkinHold& held : holds_) sum += held.hold.sample(places.frame(held).at).energy;
  return sum;
}

void SkinRubbing::add_gradient(const VecX& x, VecX& gradient) const {
  const BodyPlaces places(bodies_, x);
  for (const SkinHold& held : holds_) {
    const RubbingFrame frame = places.frame(held);
    const Slope slope = slope_by_points(frame, held.hold.sample(frame.at).gradient);
    const std::array<StencilPoint, 4> points = points_of(held.place);
    for (std::size_t k = 0; k < 4; ++k) {
      const StencilTable& table = *points[k].table;
      const Vec3 force = slope.segment<3>(3 * static_cast<Eigen::Index>(k));
      for (int e = table.begin[points[k].row]; e < table.begin[points[k].row + 1]; ++e)
        gradient.segment<3>(Eigen::Index{3} * (points[k].first_node + table.node[e])) +=
            table.value[e] * force;
    }
  }
}

void SkinRubbing::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  const BodyPlaces places(bodies_, x);
  lacking_ = false;
  for (const SkinHold& held : holds_) {
    const std::array<Vec3, 4> at = places.of(held.place);
    const RubbingFrame frame = frame_of(at, held.place.lines, held.across);
    const FrictionSample sample = held.hold.sample(frame.at);
    Eigen::Matrix<double, 3, 12> slopes;
    for (int k = 0; k < 4; ++k) slopes.block<3, 3>(0, 3 * k) = frame.slopes[static_cast<std::size_t>(k)];
    const Bend bend = slopes.transpose() * sample.hessian * slopes +
                      turning(at, held.place.lines, held.across, sample.gradient);
    lacking_ |= !add_points_hessian(points_of(held.place), bend, matrix);
  }
}

void SkinRubbing::add_cliques(const VecX& /*x*/, bool /*close*/,
                              std::vector<std::vector<int>>& cliques) const {
  std::set<std::array<std::array<int, 2>, 4>> patches;  // each a body and one of its patches
  for (const SkinHold& held : holds_) {
    std::array<std::array<int, 2>, 4> of{};
    for (std::size_t k = 0; k < 4; ++k) {
      const BodyPoint& point = held.place.points[k];
      const Body& body = *bodies_[static_cast<std::size_t>(point.body)].body;
      of[k] = {point.body, body.skin().at[static_cast<std::size_t>(point.row)].face};
    }
    std::sort(of.begin(), of.end());
    patches.insert(of);
  }
  for (const auto& of : patches) {
    std::vector<int> clique;
    for (const auto& [body, face] : of) {
      const GroupPlace& place = bodies_[static_cast<std::size_t>(body)];
      for (int node : place.body->face_nodes()[static_cast<std::size_t>(face)])
        clique.push_back(place.first_node + node);
    }
    std::sort(clique.begin(), clique.end());
    clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
    cliques.push_back(std::move(clique));
  }
}

}  // namespace calot
