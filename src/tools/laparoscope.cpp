#include "tools/laparoscope.h"

#include <cmath>

namespace calot {

LaparoscopePose laparoscope_pose(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target) {
  const Vec3 line = (target - port).normalized();
  const double reach = (target - port).norm();
  // Horizontal axis of the vertical plane; straight up or down any will do.
  Vec3 across = line.cross(Vec3::UnitZ());
  across = across.norm() > 1e-6 ? across.normalized() : Vec3::UnitX();

  // Triangle port - tip - target: the view leaves the tip at `angle` below the shaft, so the law of cosines
  // gives the inserted length and the law of sines how far the view dips below the line from port to target.
  const double sine = std::sin(scope.angle) * scope.distance / reach;
  double dip = 0;
  if (std::abs(sine) < 1) {
    const double inserted = reach * std::sqrt(1 - sine * sine) - scope.distance * std::cos(scope.angle);
    if (inserted > 0) dip = scope.angle - std::asin(sine);
  }
  LaparoscopePose out;
  out.direction = Eigen::AngleAxisd(-dip, across) * line;
  out.position = target - scope.distance * out.direction;
  out.up = across.cross(out.direction);
  return out;
}

InstrumentGeometry laparoscope_geometry() {
  InstrumentGeometry geometry;
  geometry.shaft_radius = 5e-3;
  geometry.jaw_length = geometry.jaw_opening = 0;
  geometry.fenestrated = false;
  return geometry;
}

Laparoscope::Laparoscope(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target)
    : port_(port), stands_(laparoscope_pose(scope, port, target)) {
  const Vec3 shaft = stands_.position - port;
  const bool inside = shaft.dot(target - port) > 0;
  start_ = pose_reaching(port, inside ? stands_.position : Vec3(port - shaft), 0, 0, laparoscope_geometry());
  const Mat3 to_tip = hinge_frame(port, start_, laparoscope_geometry()).linear().transpose();
  along_ = to_tip * stands_.direction;
  level_up_ = to_tip * stands_.up;
}

LaparoscopePose Laparoscope::view(const InstrumentPose& pose) const {
  if (pose == start_) return stands_;
  const Pose tip = hinge_frame(port_, pose, laparoscope_geometry());
  LaparoscopePose view;
  view.position = tip.translation();
  view.direction = tip.linear() * along_;
  const Vec3 across = view.direction.cross(Vec3::UnitZ());
  // Straight up or down there is no horizon: the camera turns with the shaft.
  view.up = across.norm() > 1e-6 ? across.cross(view.direction).normalized() : Vec3(tip.linear() * level_up_);
  return view;
}

}  // namespace calot
