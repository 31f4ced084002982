#pragma once
// Where a laparoscope is, and where it looks.

#include "tools/instrument.h"

namespace calot {

struct LaparoscopePose {
  Vec3 position = Vec3::Zero();                        ///< m, of the lens
  Vec3 direction = Vec3::UnitY(), up = Vec3::UnitZ();  ///< unit
};
void visit_members(auto&& visit, MembersOf<LaparoscopePose> auto& pose) {
  auto& [position, direction, up] = pose;
  visit(position, direction, up);
}
/// Of a laparoscope through `port` that looks at `target` from `distance`. An angled optic looks down (posteriorly) from its
/// shaft by `angle`, in the vertical plane through port and target, so the shaft runs above the line of sight; the horizon is
/// level (screen up is as much +z as it can be, screen right is the patient's left). Where the port is too near for that
/// (within about `distance`), the tip lies on the line through port and target, at `distance`, with the optic's angle left
/// out.
LaparoscopePose laparoscope_pose(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target);

/// How far it goes in: a shaft of 10 mm, 310 mm long, without jaws. Tissue does not feel it.
InstrumentGeometry laparoscope_geometry();

/// A laparoscope in its port, about which it pivots as an instrument does. Its optic is fixed to the shaft, so roll turns
/// the way an angled one looks; the camera on it is held so that the horizon stays level.
class Laparoscope {
 public:
  Laparoscope() = default;
  /// Stands as laparoscope_pose() says, until it is moved.
  Laparoscope(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target);

  /// As an instrument's, jaw 0: the lens is its tip. Where laparoscope_pose() has it outside its port (the port is nearer
  /// to the target than the lens is to be), this is in the port, as deep as it was outside.
  const InstrumentPose& start() const { return start_; }
  /// From a pose; where that is start(), laparoscope_pose() by every bit.
  LaparoscopePose view(const InstrumentPose& pose) const;

 private:
  Vec3 port_ = Vec3::Zero();
  InstrumentPose start_;
  LaparoscopePose stands_;
  Vec3 along_ = Vec3::UnitZ(),
       level_up_ = Vec3::UnitX();  ///< the view and its upward direction, in the tip's frame
};

}  // namespace calot
