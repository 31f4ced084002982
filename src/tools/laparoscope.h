#pragma once
// Where a laparoscope is, and where it looks.

#include <optional>

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

/// rad, how far the camera is turned about its line of sight from where its horizon is level, right-handed about the way it
/// looks: clockwise for who stands behind it. 0 where it looks straight up or down, as there is no horizon.
double horizon_off_level(const LaparoscopePose& view);
/// Where a place, m, is in the picture of a lens with this field of view, rad, without the lens' barrel distortion: to the right
/// and up from the middle, as shares of the round field's radius. None: it is not before the lens.
std::optional<Vec2> place_in_picture(const LaparoscopePose& view, double field_of_view, const Vec3& place);
/// Whether it is within the round field, hidden or not.
bool is_in_field(const LaparoscopePose& view, double field_of_view, const Vec3& place);

/// How far it goes in: a shaft of 10 mm, 310 mm long, without jaws. Tissue does not feel it.
InstrumentGeometry laparoscope_geometry();
/// The last 30 mm of its shaft, whose end is the lens.
Shape laparoscope_end(const Vec3& port, const InstrumentPose& pose);

/// A laparoscope in its port, about which it pivots as an instrument does. Its optic is fixed to the shaft, so roll turns
/// the way an angled one looks: at roll 0 of where it starts, down from its shaft. The camera on it is held so that the horizon
/// stays level, or is fixed to the shaft and turns with it (Horizon).
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
  /// From where a place, m, is seen in the middle of the picture from `distance` m, with the optic down from the shaft as
  /// laparoscope_pose() has it, and the horizon level. None: the port is nearer to the place than that.
  std::optional<InstrumentPose> looking_at(const Vec3& place, double distance) const;
  const Vec3& port() const { return port_; }

 private:
  LaparoscopeDefinition scope_;
  Vec3 port_ = Vec3::Zero();
  InstrumentPose start_;
  LaparoscopePose stands_;
  Vec3 along_ = Vec3::UnitZ(),
       level_up_ = Vec3::UnitX();  ///< the view and its upward direction, in the tip's frame
};

}  // namespace calot
