#pragma once
// A rigid instrument pivoting about its trocar, and the shapes that touch the tissue.

#include <optional>
#include <vector>

#include "anatomy/instruments.h"
#include "base/status.h"
#include "collision/shapes.h"
#include "geometry/state_members.h"

namespace calot {

/// Where an instrument is, about its trocar. With pitch = yaw = 0 the shaft points along -z (into the
/// abdomen).
struct InstrumentPose {
  double pitch = 0;  ///< rad, about +x; positive turns the tip cephalad (+y)
  double yaw = 0;  ///< rad, about the pitched shaft's own y axis; positive turns the tip to patient left (+x)
  double insertion =
      0;            ///< m, trocar to the tip of the closed jaws along the shaft: opening them leaves it alone
  double roll = 0;  ///< rad about the shaft, right-handed about its outward (tip) direction
  double jaw = 0;   ///< rad between the two jaws; 0 is closed on nothing, and all there is without jaws
  bool operator==(const InstrumentPose&) const = default;
};
void visit_members(auto&& visit, MembersOf<InstrumentPose> auto& pose) {
  auto& [pitch, yaw, insertion, roll, jaw] = pose;
  visit(pitch, yaw, insertion, roll, jaw);
}

/// The opening in a fenestrated jaw, m: from `start` to `end` along it, narrowing, with round corners.
struct JawWindow {
  double start, end, start_half, end_half;
};

InstrumentGeometry instrument_geometry(InstrumentType type);
/// None for jaws that are solid, or where there are none.
std::optional<JawWindow> jaw_window(const InstrumentGeometry& geometry);

/// The frame of the tip: origin at the hinge, +z along the shaft outward (tip direction), jaws open in its xz
/// plane. At pitch = yaw = roll = 0 its axes are the patient's +x, -y, -z. The hinge is insertion -
/// jaw_length deep.
Pose hinge_frame(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry);

/// Frame of jaw 0 or 1: origin at the hinge, +z along the jaw, +x from the pad into the jaw's back. The pad
/// (the gripping face) is the plane x = 0 of this frame; closed (jaw = 0) the two pads coincide. Jaw 0 opens
/// to the hinge frame's +x, jaw 1 to its -x, by half of pose.jaw each.
Pose jaw_frame(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry, int jaw);

/// Where the hand holds it: on the shaft's axis, working_length behind the tip of the closed jaws, m.
Vec3 handle_position(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry);

inline constexpr int shapes_per_tool = 3;  ///< shaft and two more, whatever the type

/// Shaft (capsule from the handle whose round end stops at the hinge), jaw 0, jaw 1, in this order. A jaw's
/// box spans 0 to jaw_thickness, -jaw_width/2 to jaw_width/2 and 0 to jaw_length of its frame. Without jaws: shaft
/// and neck, capsules on the shaft's axis, and the electrode, one whose end stands electrode_aside off it to the hinge
/// frame's +x; where it is furthest in is the tip.
std::vector<Shape> instrument_shapes(const Vec3& trocar, const InstrumentPose& pose,
                                     const InstrumentGeometry& geometry);

/// Whether current flows through a shape: through jaws, and of what a rod ends in through the electrode alone.
inline bool conducts(const InstrumentGeometry& geometry, int part) {
  return part == 2 || (part == 1 && geometry.has_jaws());
}

/// The tip: middle of the jaws' pad ends, on the shaft's axis, jaw_length * cos(jaw / 2) beyond the hinge.
Vec3 tip_position(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry);

/// The pose (roll and jaw as given) that puts tip_position at `tip`: pitch in (-180, 180], yaw in [-90, 90]
/// deg. With the tip in the trocar itself no direction is defined: pitch = yaw = 0. Insertion is not held to
/// max_insertion.
InstrumentPose pose_reaching(const Vec3& trocar, const Vec3& tip, double roll, double jaw,
                             const InstrumentGeometry& geometry = {});

/// Force the instrument exerts on the hand for a force `tip_force` of the tissue on the tip (N): the axial
/// part passes through; the lateral part is turned round and scaled by the lever about the trocar, tip depth
/// over (working_length - insertion). No trocar friction. The work at the handle equals the work at the tip.
/// Needs insertion < working_length (at which the handle is in the trocar and the lever infinite).
Vec3 handle_force(const Vec3& trocar, const InstrumentPose& pose, const InstrumentGeometry& geometry,
                  const Vec3& tip_force);

// Inputs come from files and devices too: what an instrument, called `name`, cannot do is refused (scenario).

/// Insertion, jaw, and angles of less than 100 rad.
std::optional<Failure> check_pose(const std::string& name, const InstrumentGeometry& geometry,
                                  const InstrumentPose& pose);
std::optional<Failure> check_action(const InstrumentDefinition& definition, InstrumentAction action);

}  // namespace calot
