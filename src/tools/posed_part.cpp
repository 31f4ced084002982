#include "tools/posed_part.h"

#include <cmath>

namespace calot {
namespace {

const ToolVector& levers() {
  static const ToolVector all{turn_lever, turn_lever, 1.0, roll_lever, jaw_lever, 1.0};
  return all;
}

}  // namespace

ToolVector tool_coordinates(const InstrumentPose& pose) {
  return levers().cwiseProduct(ToolVector{pose.pitch, pose.yaw, pose.insertion, pose.roll, pose.jaw, 0.0});
}

InstrumentPose pose_at(const ToolVector& q) {
  const ToolVector at = q.cwiseQuotient(levers());
  return {at[0], at[1], at[2], at[3], at[4]};
}

PosedPart::PosedPart(const Tool& tool, const InstrumentPose& pose, int part) {
  const Pose hinge = hinge_frame(tool.trocar, pose, tool.geometry);
  const bool is_jaw = part > 0 && tool.geometry.has_jaws();
  frame_ = is_jaw ? jaw_frame(tool.trocar, pose, tool.geometry, part - 1) : hinge;
  turns_.setZero();
  shifts_.setZero();
  const auto turn = [&](int unknown, const Vec3& axis, const Vec3& through) {
    turns_.col(unknown) = axis / levers()[unknown];
    shifts_.col(unknown) = -axis.cross(through) / levers()[unknown];
  };
  turn(0, Vec3::UnitX(), tool.trocar);
  turn(1, {0, -std::cos(pose.pitch), -std::sin(pose.pitch)}, tool.trocar);  // minus the pitched y
  shifts_.col(2) = hinge.linear().col(2);
  turn(3, hinge.linear().col(2), tool.trocar);
  if (is_jaw) turn(4, 0.5 * frame_.linear().col(1), hinge.translation());
}

Eigen::Matrix<double, 3, 6> PosedPart::slopes(const Vec3& p) const {
  Eigen::Matrix<double, 3, 6> out = shifts_;
  for (int i = 0; i < 5; ++i) out.col(i) += turns_.col(i).cross(p);
  return out;
}

ToolMatrix PosedPart::curvature(const Vec3& p, const Vec3& force) const {
  const Eigen::Matrix<double, 3, 6> u = slopes(p);
  ToolMatrix out = ToolMatrix::Zero();
  for (int i = 0; i < 5; ++i)
    for (int j = i; j < 5; ++j) out(i, j) = out(j, i) = force.dot(turns_.col(i).cross(u.col(j)));
  return out;
}

PointAndTool PosedPart::carried_gradient(const Vec3& x, const Vec3& gradient) const {
  PointAndTool out;
  out << gradient, -slopes(x).transpose() * gradient;
  return out;
}

PointAndToolMatrix PosedPart::carried_hessian(const Vec3& x, const Vec3& gradient,
                                              const Mat3& hessian) const {
  const Eigen::Matrix<double, 3, 6> u = slopes(x), pulled = hessian * u;
  ToolMatrix own = u.transpose() * pulled;
  Eigen::Matrix<double, 3, 6> mixed = -pulled;
  for (int i = 0; i < 5; ++i) {
    mixed.col(i) += turns_.col(i).cross(gradient);
    for (int j = i; j < 5; ++j) {
      const double bent = gradient.dot(turns_.col(j).cross(u.col(i)));
      own(i, j) += bent;
      if (i != j) own(j, i) += bent;
    }
  }
  PointAndToolMatrix out;
  out << hessian, mixed, mixed.transpose(), own;
  return out;
}

CarriedDistance carried_distance(const Tool& tool, const InstrumentPose& pose, int part, double grown,
                                 const Vec3& x) {
  const PosedPart posed(tool, pose, part);
  const Shape shape = offset(instrument_shapes(tool.trocar, pose, tool.geometry)[part], grown);
  const DistanceSlope slope = distance_slope(shape, x);
  return {slope.distance, posed.carried_gradient(x, slope.gradient),
          posed.carried_hessian(x, slope.gradient, distance_hessian(shape, x, slope))};
}

}  // namespace calot
