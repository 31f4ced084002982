#include "tools/laparoscope.h"

#include <cmath>
#include <numbers>

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

Shape laparoscope_end(const Vec3& port, const InstrumentPose& pose) {
  const InstrumentGeometry geometry = laparoscope_geometry();
  const Vec3 tip = tip_position(port, pose, geometry), way = (tip - port).normalized();
  return Capsule{tip - 30e-3 * way, tip - geometry.shaft_radius * way, geometry.shaft_radius};
}

double horizon_off_level(const LaparoscopePose& view) {
  const Vec3 across = view.direction.cross(Vec3::UnitZ());
  if (across.norm() <= 1e-6) return 0;
  const Vec3 level = across.cross(view.direction).normalized();
  return std::atan2(level.cross(view.up).dot(view.direction), level.dot(view.up));
}

std::optional<Vec2> place_in_picture(const LaparoscopePose& view, double field_of_view, const Vec3& place) {
  const Vec3 way = place - view.position;
  const double depth = way.dot(view.direction), edge = depth * std::tan(0.5 * field_of_view);
  if (!(depth > 0)) return std::nullopt;
  return Vec2(way.dot(view.direction.cross(view.up)), way.dot(view.up)) / edge;
}

bool is_in_field(const LaparoscopePose& view, double field_of_view, const Vec3& place) {
  return (place - view.position).normalized().dot(view.direction) >= std::cos(0.5 * field_of_view);
}

Laparoscope::Laparoscope(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target)
    : scope_(scope), port_(port), stands_(laparoscope_pose(scope, port, target)) {
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
  const bool level = scope_.horizon == Horizon::level && across.norm() > 1e-6;
  view.up = level ? across.cross(view.direction).normalized() : Vec3(tip.linear() * level_up_);
  return view;
}

std::optional<InstrumentPose> Laparoscope::looking_at(const Vec3& place, double distance) const {
  LaparoscopeDefinition scope = scope_;
  scope.distance = distance;
  const LaparoscopePose wanted = laparoscope_pose(scope, port_, place);
  if (!((wanted.position - port_).dot(place - port_) > 0)) return std::nullopt;
  InstrumentPose pose = pose_reaching(port_, wanted.position, 0, 0, laparoscope_geometry());
  // About the shaft, from the way that the picture's upward direction has at roll 0 to where it is to be: an angled optic's
  // view is in one plane with it.
  const Mat3 to_tip = hinge_frame(port_, pose, laparoscope_geometry()).linear().transpose();
  const Vec3 up = to_tip * wanted.up;
  pose.roll = std::remainder(std::atan2(up.y(), up.x()) - std::atan2(level_up_.y(), level_up_.x()),
                             2 * std::numbers::pi);
  return pose;
}

}  // namespace calot
