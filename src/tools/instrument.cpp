#include "tools/instrument.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace calot {
namespace {

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// Columns: the hinge frame's axes in the world.
Mat3 hinge_rotation(const InstrumentPose& pose) {
  const double half_turn = 180 * units::deg;
  // A positive yaw turns the tip to +x, which is a negative turn about y for a shaft along -z.
  return turn(pose.pitch, Vec3::UnitX()) * turn(-pose.yaw, Vec3::UnitY()) * turn(half_turn, Vec3::UnitX()) *
         turn(pose.roll, Vec3::UnitZ());
}

/// Closed form, so that the tip does not inherit the rounding of four turns.
Vec3 shaft_direction(const InstrumentPose& pose) {
  return {std::sin(pose.yaw), std::cos(pose.yaw) * std::sin(pose.pitch),
          -std::cos(pose.yaw) * std::cos(pose.pitch)};
}

/// Opening the jaws draws their ends back by this much along the shaft, m.
double jaw_setback(double jaw, const InstrumentGeometry& geometry) {
  const double s = std::sin(jaw / 4);
  return geometry.jaw_length * 2 * s * s;  // 1 - cos(jaw / 2)
}

double tip_depth(const InstrumentPose& pose, const InstrumentGeometry& geometry) {
  return pose.insertion - jaw_setback(pose.jaw, geometry);
}

RoundedBox jaw_box(const Pose& frame, const InstrumentGeometry& geometry) {
  const Vec3 outer_half(geometry.jaw_thickness / 2, geometry.jaw_width / 2, geometry.jaw_length / 2);
  const Vec3 centre(geometry.jaw_thickness / 2, 0.0, geometry.jaw_length / 2);
  return {frame * Pose(Eigen::Translation3d(centre)), outer_half - Vec3::Constant(geometry.jaw_rounding),
          geometry.jaw_rounding};
}

/// A rod's end: a neck that grows out of the shaft, and the electrode that it carries.
std::vector<Shape> rod_end(const Pose& hinge, const InstrumentGeometry& geometry) {
  const auto at = [&](double z) { return Vec3(hinge * Vec3(0, 0, z)); };
  const double back = geometry.jaw_length - geometry.electrode_length + geometry.electrode_radius;
  const double front = geometry.jaw_length - geometry.electrode_radius;
  return {Capsule{at(-geometry.shaft_radius), at(back), geometry.neck_radius},
          Capsule{at(back), hinge * Vec3(geometry.electrode_aside, 0, front), geometry.electrode_radius}};
}

}  // namespace

InstrumentGeometry instrument_geometry(InstrumentType type) { return instrument_row(type).geometry; }

std::optional<JawWindow> jaw_window(const InstrumentGeometry& geometry) {
  if (!geometry.fenestrated) return std::nullopt;
  const double wide = 0.5 * geometry.jaw_width;
  return JawWindow{0.30 * geometry.jaw_length, 0.82 * geometry.jaw_length, 0.40 * wide, 0.30 * wide};
}

Pose hinge_frame(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry) {
  Pose frame = Pose::Identity();
  frame.linear() = hinge_rotation(pose);
  frame.translation() = trocar + shaft_direction(pose) * (pose.insertion - geometry.jaw_length);
  return frame;
}

Pose jaw_frame(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry, int jaw) {
  const double side = jaw == 0 ? 0.0 : 180 * units::deg;
  Pose frame = hinge_frame(trocar, pose, geometry);
  frame.linear() = frame.linear() * turn(side, Vec3::UnitZ()) * turn(pose.jaw / 2, Vec3::UnitY());
  return frame;
}

Vec3 handle_position(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry) {
  return trocar - shaft_direction(pose) * (geometry.working_length - pose.insertion);
}

std::vector<Shape> instrument_shapes(const Vec3& trocar, const InstrumentPose& pose,
                                     const InstrumentGeometry& geometry) {
  const Vec3 shaft_end =
      trocar + shaft_direction(pose) * (pose.insertion - geometry.jaw_length - geometry.shaft_radius);
  const Capsule shaft{handle_position(trocar, pose, geometry), shaft_end, geometry.shaft_radius};
  if (!geometry.has_jaws()) {
    const std::vector<Shape> end = rod_end(hinge_frame(trocar, pose, geometry), geometry);
    return {shaft, end[0], end[1]};
  }
  return {shaft, jaw_box(jaw_frame(trocar, pose, geometry, 0), geometry),
          jaw_box(jaw_frame(trocar, pose, geometry, 1), geometry)};
}

Vec3 tip_position(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry) {
  return trocar + shaft_direction(pose) * tip_depth(pose, geometry);
}

InstrumentPose pose_reaching(const Vec3& trocar, const Vec3& tip, double roll, double jaw,
                             const InstrumentGeometry& geometry) {
  const Vec3 reach = tip - trocar;
  InstrumentPose pose;
  pose.roll = roll;
  pose.jaw = jaw;
  pose.insertion = reach.norm() + jaw_setback(jaw, geometry);
  if (reach.squaredNorm() > 0) {
    pose.pitch = std::atan2(reach.y(), -reach.z());
    pose.yaw = std::atan2(reach.x(), std::hypot(reach.y(), reach.z()));
  }
  return pose;
}

Vec3 handle_force(const Vec3& /*trocar*/, const InstrumentPose& pose, const InstrumentGeometry& geometry,
                  const Vec3& tip_force) {
  const Vec3 along = shaft_direction(pose);
  const Vec3 axial = along * along.dot(tip_force);
  const double lever = tip_depth(pose, geometry) / (geometry.working_length - pose.insertion);
  return axial - (tip_force - axial) * lever;
}

std::optional<Failure> check_pose(const std::string& name, const InstrumentGeometry& g,
                                  const InstrumentPose& pose) {
  const bool finite = std::isfinite(pose.pitch + pose.yaw + pose.insertion + pose.roll + pose.jaw);
  const double slack = g.has_jaws() ? 1e-9 : 0;
  if (finite && pose.insertion >= 0 && pose.insertion <= g.max_insertion && pose.jaw >= -slack &&
      pose.jaw <= g.jaw_opening + slack &&
      std::max({std::abs(pose.pitch), std::abs(pose.yaw), std::abs(pose.roll)}) < 100)
    return std::nullopt;
  return fail(
      FailureKind::scenario,
      fmt::format(
          "instrument '{}' cannot take the pose pitch {:.3g}, yaw {:.3g}, roll {:.3g}, jaw {:.3g} rad, "
          "insertion {:.3g} m",
          name, pose.pitch, pose.yaw, pose.roll, pose.jaw, pose.insertion),
      fmt::format("its insertion is 0 to {:.2f} m, {}", g.max_insertion,
                  g.has_jaws() ? fmt::format("its jaws open from 0 to {:.2f} rad", g.jaw_opening)
                               : "it has no jaws: its jaw angle is 0"));
}

std::optional<Failure> check_action(const InstrumentDefinition& definition, InstrumentAction action) {
  if (has_action(definition.type, action)) return std::nullopt;
  return fail(FailureKind::scenario,
              fmt::format("instrument '{}' cannot {}: its type is {}", definition.name, to_text(action),
                          to_text(definition.type)),
              "give the action to an instrument that knows it");
}

}  // namespace calot
