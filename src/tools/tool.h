#pragma once
// An instrument of the world: its definition, where it is now, and how it moves between two poses.

#include <array>
#include <string>
#include <vector>

#include "collision/shapes.h"
#include "joins/strand_touch.h"
#include "tools/instrument.h"
#include "tools/part_load.h"

namespace calot {

/// Of what draws liquid out (aspirate.h).
struct NeedleState {
  int record = -1;        ///< on the world's roll: the organ that it is in; none: -1
  int point = 0;          ///< that organ's skin point where it went in
  double drawn = 0;       ///< m^3, since it did
  double drawn_ever = 0;  ///< m^3, of all organs
  bool empty = false;     ///< it drew at the last step and was in nothing, for events
};
void visit_members(auto&& visit, MembersOf<NeedleState> auto& needle) {
  auto& [record, point, drawn, drawn_ever, empty] = needle;
  visit(record, point, drawn, drawn_ever, empty);
}

/// What other tools press it with (hands.h).
struct MeetingState {
  Vec3 force = Vec3::Zero();  ///< N at the tip, of the same moment about the trocar
  std::string with;           ///< the first of those tools; empty: none
};
void visit_members(auto&& visit, MembersOf<MeetingState> auto& meeting) {
  auto& [force, with] = meeting;
  visit(force, with);
}

/// One ground that jaws, or what a shaft ends in, press on.
struct GroundTouch {
  std::string ground;
  Vec3 force = Vec3::Zero();  ///< N, on the tool
  Vec3 at = Vec3::Zero();     ///< m, where it presses hardest
  double largest = 0;         ///< N, there
  bool conducts = false;      ///< by what current flows through, too
};
void visit_members(auto&& visit, MembersOf<GroundTouch> auto& touch) {
  auto& [ground, force, at, largest, conducts] = touch;
  visit(ground, force, at, largest, conducts);
}

/// What ground does to it, as it was when hands brought it there last (hands.h).
struct GroundLoad {
  Vec3 force = Vec3::Zero();  ///< N at the tip, of the same moment about the trocar
  PartLoads parts;            ///< by ToolPart; the organ is the ground's name
  std::vector<GroundTouch> touched = {};
  bool touches() const {
    return parts[static_cast<std::size_t>(ToolPart::jaws)].touches > 0 ||
           parts[static_cast<std::size_t>(ToolPart::shaft)].touches > 0;
  }
};
void visit_members(auto&& visit, MembersOf<GroundLoad> auto& load) {
  auto& [force, parts, touched] = load;
  visit(force, parts, touched);
}

/// How it hurts a ground that it touches, for events: until it is off it, each of these is one.
struct GroundHurt {
  std::string ground;
  bool thrust = false, current = false, blades = false;
};
void visit_members(auto&& visit, MembersOf<GroundHurt> auto& hurt) {
  auto& [ground, thrust, current, blades] = hurt;
  visit(ground, thrust, current, blades);
}

/// All of a tool that a step changes.
struct ToolState {
  InstrumentPose pose;
  bool over_limit = false;   ///< when forces were in balance last, for events
  bool jaw_stopped = false;  ///< the jaws rest on what they hold
  bool lost = false;  ///< what it held slid off; until the jaws open or hold again, they take hold of no wall
  bool beside =
      false;  ///< it closed with skin at one pad only; until the jaws open or hold again; for reports
  InstrumentAction action = InstrumentAction::none;
  double dry = 0;  ///< s for which its current has flowed and it touched nothing, up to what is an event
  bool slipping = false;  ///< the fold slid through the jaws at the last step, for events
  bool has_cut = false;   ///< its blades divided something since they opened last, for events
  int clips = 0;          ///< that it still carries
  bool on_clip = false, beside_kept = false;  ///< its current was let flow there at the last step, for events
  bool waits = false;                         ///< outside: another one is in its port (acts/exchange.h)
  NeedleState needle = {};
  InstrumentPose command = {};  ///< of the last step: a hand that gives way is not there
  bool closes = false;          ///< its jaws were commanded to close further in the last step
  /// N/m, how the force on the tip grew with its way: along the force and across it; 0: none that counts.
  double tissue_stiffness = 0, stiffness_across = 0;
  double roll_stiffness =
      0;  ///< N m/rad, how the tissue's torque about the shaft grew with its roll; 0: none that counts
  MeetingState meeting = {};
  GroundLoad ground = {};
  std::vector<GroundHurt> hurts_ground = {};
  Vec3 drag = Vec3::Zero();  ///< N at the hand, of the port's seal in the last step (hands.h)
  bool pressing =
      false;  ///< what is between its jaws carries the pinch: they turn as that gives way or pushes

  /// 1/rad: how the logarithm of what presses its jaws apart grew as they opened, when that was found last; 0: never.
  double pinch_slope = 0;

  /// Whether tissue keeps its jaws from closing.
  bool jaws_rest() const { return jaw_stopped || pressing; }
};
void visit_members(auto&& visit, MembersOf<ToolState> auto& state) {
  auto& [pose, over_limit, jaw_stopped, lost, beside, action, dry, slipping, has_cut, clips, on_clip,
         beside_kept, waits, needle, command, closes, tissue_stiffness, stiffness_across, roll_stiffness,
         meeting, ground, hurts_ground, drag, pressing, pinch_slope] = state;
  visit(pose, over_limit, jaw_stopped, lost, beside, action, dry, slipping, has_cut, clips, on_clip,
        beside_kept, waits, needle, command, closes, tissue_stiffness, stiffness_across, roll_stiffness,
        meeting, ground, hurts_ground, drag, pressing, pinch_slope);
}

struct Tool : ToolState {
  InstrumentDefinition definition;
  InstrumentGeometry geometry;
  Vec3 trocar = Vec3::Zero();  ///< m
};
inline ToolState& state_of(Tool& tool) { return tool; }
inline const ToolState& state_of(const Tool& tool) { return tool; }

/// From the world to the frame of each jaw, where the tool stands (jaw_frame()).
std::array<Pose, 2> to_jaws(const Tool& tool);

InstrumentPose interpolate(const InstrumentPose& a, const InstrumentPose& b, double share);
/// Of each tool; as many of a as of b.
std::vector<InstrumentPose> interpolate(const std::vector<InstrumentPose>& a,
                                        const std::vector<InstrumentPose>& b, double share);

/// Far from all: a shape that is not felt, m.
inline const Capsule nowhere{Vec3(1e3, 1e3, 1e3), Vec3(1e3, 1e3, 1e3), 1e-3};
/// instrument_shapes() of a tool at a pose; of one that waits outside all are nowhere.
std::vector<Shape> shapes_in_field(const Tool& tool, const InstrumentPose& pose);

/// Frame (to world) that shape `part` (0 shaft, 1 and 2 the jaws) is fixed in.
Pose part_frame(const Tool& tool, const InstrumentPose& pose, int part);

/// Rigid motion (world to world) of shape `part` (0 shaft, 1 and 2 the jaws, or what a rod ends in) from one pose to
/// another.
Pose part_motion(const Tool& tool, const InstrumentPose& from, const InstrumentPose& to, int part);

/// Bound on the way that any point of a tool's part inside the field travels between two poses, m.
double travel_bound(const Tool& tool, const InstrumentPose& a, const InstrumentPose& b);

/// Shares (0, 1] of a motion at which closing jaws reach multiples of `grid`, increasing: the only moments at
/// which grips are taken, so that what is gripped does not depend on the rate of the steps. Of two motions in
/// a row the first has the angle at which they meet.
std::vector<double> closing_stops(const InstrumentPose& from, const InstrumentPose& to, double grid);

}  // namespace calot
