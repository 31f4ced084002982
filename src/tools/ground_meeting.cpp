#include "tools/ground_meeting.h"

#include <algorithm>
#include <numeric>

#include "group/body_problem.h"

namespace calot {

GroundMeeting::GroundMeeting(const Tool& tool, int first_node, const std::vector<Shape>& ground,
                             const Barrier& barrier)
    : tool_(tool), first_node_(first_node), points_(tool_points(tool.geometry)), barrier_(barrier) {
  for (const Shape& shape : ground) ground_.push_back(contact_shape(shape));
}

template <class Use>
void GroundMeeting::for_near(const VecX& x, double reach, const Use& use) const {
  const PosedTool posed(tool_, unknowns(x));
  const Vec3 inwards = posed.parts[0].frame().linear().col(2);
  const auto is_inside = [&](const Vec3& at) { return (at - tool_.trocar).dot(inwards) >= 0; };
  for (std::size_t k = 0; k < ground_.size(); ++k)
    for_points_near(posed, points_, ground_[k], box_around(ground_[k], reach), reach,
                    [&](const ToolPoint& point, const Vec3& at, const PosedPart& part) {
                      if (is_inside(at)) use(k, point, at, part);
                    });
}

double GroundMeeting::value(const VecX& x) const {
  double sum = 0;
  for_near(x, barrier_.range, [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart&) {
    sum += point.area * barrier_.sample(signed_distance(ground_[k], at) - point.radius).energy;
  });
  return sum;
}

void GroundMeeting::add_gradient(const VecX& x, VecX& gradient) const {
  for_near(x, barrier_.range,
           [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart& part) {
             const DistanceSlope d = distance_slope(ground_[k], at);
             const double slope = point.area * barrier_.sample(d.distance - point.radius).derivative;
             gradient.segment<6>(Eigen::Index{3} * first_node_) +=
                 part.slopes(at).transpose() * (slope * d.gradient);
           });
}

void GroundMeeting::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  ToolMatrix sum = ToolMatrix::Zero();
  const double hardest = barrier_.sample(barrier_.soft_share * barrier_.range).derivative;
  for_near(
      x, barrier_.range, [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart& part) {
        const DistanceSlope d = distance_slope(ground_[k], at);
        const BarrierSample b = barrier_.sample(d.distance - point.radius);
        const double pressed = std::max(b.derivative, hardest);
        const Mat3 bend = point.area * (b.second * d.gradient * d.gradient.transpose() +
                                        pressed * distance_hessian(ground_[k], at, d));
        const Eigen::Matrix<double, 3, 6> slopes = part.slopes(at);
        sum += slopes.transpose() * bend * slopes + part.curvature(at, point.area * pressed * d.gradient);
      });
  matrix.add(first_node_, first_node_, sum.topLeftCorner<3, 3>());
  matrix.add(first_node_ + 1, first_node_, sum.bottomLeftCorner<3, 3>());
  matrix.add(first_node_ + 1, first_node_ + 1, sum.bottomRightCorner<3, 3>());
}

void GroundMeeting::add_cliques(const VecX& /*x*/, bool /*close*/,
                                std::vector<std::vector<int>>& cliques) const {
  std::vector<int>& nodes = cliques.emplace_back(tool_nodes);
  std::iota(nodes.begin(), nodes.end(), first_node_);
}

namespace {

/// How a point that a tool carries goes, from one pose to another.
struct PointWay {
  const Tool& tool;
  InstrumentPose from, to;
  const ToolPoint& point;
  Vec3 at(double share) const {
    return PosedPart(tool, interpolate(from, to, share), point.part).frame() * point.local;
  }
};

/// The share of the way, `share` at most, that keeps the point, `here` (m) before, off the core of a shape, `gap` m away
/// before; where it is inside already, goes no deeper by more than the guard. The way is bent: what it may stray from its
/// chord falls with the square of the share.
double share_off(const PointWay& way, const Vec3& here, const Shape& core, double gap, double share) {
  if (gap <= 0) {
    while (share > 1e-6 && signed_distance(core, way.at(share)) < gap - contact_guard) share *= 0.5;
    return share > 1e-6 ? share : 0;
  }
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double bend = point_bend(way.tool, way.from, interpolate(way.from, way.to, share), here);
    if (bend <= 0.25 * gap)
      return share * calot::safe_share(here, way.at(share) - here, offset(core, bend), contact_keep);
    share *= 0.5;
  }
  return 0;
}

}  // namespace

double GroundMeeting::safe_share(const VecX& x, const VecX& step, double share) const {
  const InstrumentPose from = pose_at(unknowns(x)), to = pose_at(unknowns(x) + unknowns(step));
  const double travel = travel_bound(tool_, from, interpolate(from, to, share));
  if (travel == 0) return share;
  for_near(x, travel / (1 - contact_keep),
           [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart&) {
             const Shape core = offset(core_of(ground_[k]), point.radius);
             const double gap = signed_distance(core, at);
             if ((1 - contact_keep) * gap > travel) return;
             share = share_off(PointWay{tool_, from, to, point}, at, core, gap, share);
           });
  return share;
}

std::vector<GroundMeeting::Press> GroundMeeting::presses(const VecX& x) const {
  std::vector<Press> out;
  for_near(x, barrier_.range, [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart&) {
    const DistanceSlope d = distance_slope(ground_[k], at);
    const double push = -point.area * barrier_.sample(d.distance - point.radius).derivative;
    out.push_back({k, point.part, at - point.radius * d.gradient, push * d.gradient});
  });
  return out;
}

double GroundMeeting::gap(const VecX& x, double most) const {
  double least = most;
  for_near(x, most, [&](std::size_t k, const ToolPoint& point, const Vec3& at, const PosedPart&) {
    least = std::min(least, signed_distance(ground_[k], at) - point.radius - contact_inset);
  });
  return least;
}

}  // namespace calot
