#pragma once
// An organ of the world: its structure, where it is now, and what grips it.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "body/body_handle.h"
#include "body/shell_body.h"
#include "group/equilibrium.h"
#include "organs/body_origin.h"
#include "tools/instrument.h"
#include "tools/tool_index.h"

namespace calot {

/// A skin point that a pad holds: it keeps its place along the pad until it slips, is drawn off or the jaw opens.
struct GripPoint {
  ToolIndex instrument;
  int jaw = 0;
  int skin_point = 0;
  Vec3 local = Vec3::Zero();  ///< m, in the jaw's frame
  double stiffness = 0;       ///< N/m; falls to nothing as the grip is released
  bool leaves = false;        ///< it was drawn off its pad, and is let go as the next step begins
  bool operator==(const GripPoint&) const = default;
};
void visit_members(auto&& visit, MembersOf<GripPoint> auto& grip) {
  auto& [instrument, jaw, skin_point, local, stiffness, leaves] = grip;
  visit(instrument, jaw, skin_point, local, stiffness, leaves);
}

/// A skin point that jaws have let go: it rubs on the opening pads until it is out of them (leaving.h).
struct LeavingPoint {
  ToolIndex instrument;
  int skin_point = 0;
  double time_left = 0;  ///< s, until it is free
};
void visit_members(auto&& visit, MembersOf<LeavingPoint> auto& point) {
  auto& [instrument, skin_point, time_left] = point;
  visit(instrument, skin_point, time_left);
}

/// Where details are active: around a skin point that a shape of the surroundings is near to.
struct Extension {
  int shape = 0;   ///< -1: none, the laparoscope looks there
  int centre = 0;  ///< skin point
  bool operator==(const Extension&) const = default;
};
void visit_members(auto&& visit, MembersOf<Extension> auto& extension) {
  auto& [shape, centre] = extension;
  visit(shape, centre);
}

/// What the active details were chosen by.
struct ContactPlace {
  VecX x;
  std::vector<InstrumentPose> poses;
  std::vector<GripPoint> grips;
  std::vector<Extension> extensions;
  std::vector<DetailShare> shares;
  std::vector<int> details;
  std::optional<std::vector<int>> refused_details;
  bool operator==(const ContactPlace& other) const {
    return x.size() == other.x.size() && x == other.x && poses == other.poses && grips == other.grips &&
           extensions == other.extensions && shares == other.shares && details == other.details &&
           refused_details == other.refused_details;
  }
};

/// A clip on a tube.
struct Clip {
  ClipSize size = ClipSize::ml;
  double at = 0;       ///< where: skin points from the tube's start
  double opening = 0;  ///< share of its width that is not between the legs
  /// Unit, where the legs point and along what they press, in the tube's frame there (RodBody::frame_at).
  Vec3 legs = Vec3::Zero(), pressed = Vec3::Zero();
  double reach = 0;  ///< m, by how much the legs' ends are past the tube's middle
  bool shut() const { return opening <= 0; }
  bool operator==(const Clip&) const = default;
};
void visit_members(auto&& visit, MembersOf<Clip> auto& clip) {
  auto& [size, at, opening, legs, pressed, reach] = clip;
  visit(size, at, opening, legs, pressed, reach);
}

/// Where what an organ holds can leave it: the end of a divided tube, or a hole in a wall (leak.h).
struct Opening {
  int point = 0;      ///< skin point: a tube's first or last where it was divided, else where the hole is
  double area = 0;    ///< m^2, of a hole; a tube's end is as wide as its lumen
  std::string cause;  ///< the instrument that made it; may be empty
  double rate = 0;    ///< m^3/s, in the last step
  double lost = 0;    ///< m^3, since it began to leak last
  double drop = 0;    ///< m^3, that has left it and hangs on it still
  bool leaks = false;
};
void visit_members(auto&& visit, MembersOf<Opening> auto& hole) {
  auto& [point, area, cause, rate, lost, drop, leaks] = hole;
  visit(point, area, cause, rate, lost, drop, leaks);
}

/// Radius of a place that current burns, m: what it brings into a wall nearer to the place's middle than this, at rest,
/// counts together. A wall's burn_energy boils away a spot that wide, and the hole that it leaves is as wide.
inline constexpr double burn_radius = 1e-3;
/// What current has brought into a wall at one place.
struct Burn {
  Vec3 at = Vec3::Zero();  ///< m, the place's middle, where the wall is at rest
  double energy = 0;       ///< J, ever
  bool told = false;       ///< the event raw_surface has said so of it
};
void visit_members(auto&& visit, MembersOf<Burn> auto& burn) {
  auto& [at, energy, told] = burn;
  visit(at, energy, told);
}

/// All of an organ that a step changes, but for its body, which another one replaces.
struct OrganMotion {
  BodyState state;
  std::vector<GripPoint> grips;       ///< ordered by instrument, jaw, skin_point
  std::vector<LeavingPoint> leaving;  ///< in the order in which they were let go
  std::vector<Extension> extensions;  ///< ordered by shape
  /// Details that found no rest when they were tried last: not tried again until others are wanted.
  std::optional<std::vector<int>> refused_details;
  FrictionLoad friction;    ///< at the last equilibrium, each hold in its shape's frame (rubbing.h)
  std::vector<Clip> clips;  ///< ordered by place
  /// Instruments whose jaws it does not feel, increasing: they cut it, and it is between them still.
  std::vector<ToolIndex> unfelt;
  std::vector<Opening> openings;  ///< ordered as they were made, but a tube's by their points
  /// m^3, what is left in a tube that nothing feeds; none: it is full.
  std::optional<double> left_in;
  std::vector<Burn> burns;  ///< in the order in which they began
  bool is_shut() const {    ///< by a clip
    return std::any_of(clips.begin(), clips.end(), [](const Clip& clip) { return clip.shut(); });
  }
};
void visit_members(auto&& visit, MembersOf<OrganMotion> auto& motion) {
  auto& [state, grips, leaving, extensions, refused_details, friction, clips, unfelt, openings, left_in,
         burns] = motion;
  visit(state, grips, leaving, extensions, refused_details, friction, clips, unfelt, openings, left_in,
        burns);
}

struct Organ : OrganMotion {
  /// At rest where the body is; the body is not null.
  Organ(OrganDefinition definition, BodyPointer body);

  OrganDefinition definition;
  BodyPointer body;              ///< never null
  mutable ContactSearch search;  ///< remembers where it looked last: what it finds does not depend on it
  std::map<std::string, int> landmarks;  ///< skin point of each
  /// Where the details were found to be those that are wanted: remembered, no part of any result.
  std::optional<ContactPlace> looked_at;
  int record = -1;  ///< on the field's roll (members.h)
  BodyOrigin origin;
  bool of_specimen = false;  ///< a piece that the patient's was cut off from
};

inline OrganMotion& motion_of(Organ& organ) { return organ; }
inline const OrganMotion& motion_of(const Organ& organ) { return organ; }

/// What current has taken off its capsule, m^2: what it brought there by the wall's raw_energy; 0 of what has no capsule.
double raw_area(const Organ& organ);

/// All that a step changes. `search` only remembers.
struct OrganSnapshot : OrganMotion {
  BodyPointer body;
};
OrganSnapshot snapshot(const Organ& organ);
void restore(Organ& organ, const OrganSnapshot& snapshot);

/// An organ that has come to rest alone, and what was kept of its last solve.
struct RestedOrgan {
  Organ organ;
  NewtonWorkspace work;
};

/// Its name in single quotes, for messages.
std::string quoted(const Organ& organ);

/// A failure of make_organ, whose problems' paths start at the organ (".bile"), as one of the scene's
/// organ of that index.
Failure at_organ(Failure failure, std::size_t index);

/// A skin point of an organ of a field.
struct OrganPoint {
  OrganIndex organ;
  int skin_point = 0;
};
void visit_members(auto&& visit, MembersOf<OrganPoint> auto& point) {
  auto& [organ, skin_point] = point;
  visit(organ, skin_point);
}
/// Of "organ.landmark"; none: there is none.
std::optional<OrganPoint> find_landmark(const std::vector<Organ>& organs, const std::string& name);

/// A failed solve in words: what happened, and what to change (simulation); one that was stopped was interrupted.
Failure solve_failure(const NewtonResult& result, const std::string& organ, const std::string& when);
/// The same of a scene that has no rest, which is for its author to mend (scenario), unless a value is not finite.
Failure no_rest_failure(const NewtonResult& result, const std::string& organ, const std::string& when);

}  // namespace calot
