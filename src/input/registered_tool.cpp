#include "input/registered_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace calot {

RegisteredTool::RegisteredTool(const Registration& registration, const ForeignInstrument& tool,
                               const Vec3& port, const LiveInstrument& instrument)
    : registration_(registration),
      tool_(tool),
      port_(port),
      trocar_(instrument.trocar),
      geometry_(instrument.geometry) {
  axes_ << registration.x_axis, registration.y_axis, registration.z_axis;
}

InstrumentPose RegisteredTool::pose(const ForeignSample& sample) {
  const double jaw = jaw_of(sample);
  InstrumentPose pose;
  if (sample.pivot) {
    pose = *sample.pivot;
    pose.pitch *= registration_.angle_unit;
    pose.yaw *= registration_.angle_unit;
    pose.insertion *= registration_.unit;
    pose.jaw = jaw;
  } else {
    const Vec3 tip = trocar_ + axes_ * (sample.tip - port_) * registration_.unit;
    pose = pose_reaching(trocar_, tip, 0, jaw, geometry_);
  }
  roll_ = sample.roll ? *sample.roll * registration_.angle_unit : roll_of(sample, pose);
  pose.roll = roll_;
  return pose;
}

/// Of the sample's `across` about the shaft, within half a turn of the one before.
double RegisteredTool::roll_of(const ForeignSample& sample, const InstrumentPose& pose) const {
  if (!sample.across) return roll_;
  const Mat3 frame = hinge_frame(Vec3::Zero(), pose, geometry_).linear();
  const Vec3 across = axes_ * *sample.across;
  const double x = across.dot(frame.col(0)), y = across.dot(frame.col(1));
  if (std::hypot(x, y) < 1e-6) return roll_;  // it looks along the shaft
  return roll_ + std::remainder(std::atan2(y, x) - roll_, 2 * std::numbers::pi);
}

double RegisteredTool::jaw_of(const ForeignSample& sample) {
  if (!sample.jaw || !geometry_.has_jaws()) return 0;
  const double jaw = tool_.jaw_closed ? (*sample.jaw - *tool_.jaw_closed) /
                                            (*tool_.jaw_open - *tool_.jaw_closed) * geometry_.jaw_opening
                                      : *sample.jaw * registration_.angle_unit;
  const double held = std::clamp(jaw, 0.0, geometry_.jaw_opening);
  if (std::abs(held - jaw) > 1e-9) ++held_jaws_;
  return held;
}

}  // namespace calot
