#pragma once
// What goes into a step and what comes out of it: plain data.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/events.h"
#include "tools/instrument.h"
#include "tools/laparoscope.h"
#include "tools/part_load.h"

namespace calot {

/// What who operates does besides moving instruments: it changes nothing in the world.
struct SessionAct {
  EventKind kind = EventKind::time_out;  ///< or bail_out, which ends the operation
  std::string text;                      ///< what is said: "landmarks named", "subtotal"; may be empty
  bool operator==(const SessionAct&) const = default;
};

/// Target poses at the end of the step, one an instrument in the definition's order: the only input there is,
/// whatever its source (demo, recording, live device).
struct StepInput {
  std::vector<InstrumentPose> instruments;
  std::vector<InstrumentAction> actions = {};  ///< one an instrument; empty: none acts
  /// Where the laparoscope is to be, about its port (tools/laparoscope.h); none: where it is.
  std::optional<InstrumentPose> laparoscope = {};
  std::vector<SessionAct> acts = {};  ///< in this step, in their order
  bool operator==(const StepInput&) const = default;
};

struct InstrumentState {
  InstrumentPose pose;
  Vec3 tip = Vec3::Zero();           ///< m
  Vec3 force = Vec3::Zero();         ///< N, of the tissue on the whole instrument: the sum of jaws and shaft
  Vec3 handle_force = Vec3::Zero();  ///< N, felt at the handle, lever about the trocar
  PartLoads parts;                   ///< by ToolPart
  const PartLoad& load_on(ToolPart part) const { return parts[static_cast<std::size_t>(part)]; }
  bool touching = false;
  std::string touches;  ///< name of the first organ, else tissue, that it touches; empty: none
  std::string holds;    ///< organ's name, empty when nothing is held
  int grip_points = 0;
  GripState grip = GripState::open;
  InstrumentAction action = InstrumentAction::none;
  int clips = 0;         ///< that it still carries
  double aspirated = 0;  ///< m^3, that it has drawn out
  bool waits = false;    ///< outside: another one is in its port
  /// N, the tissue's force at the tip that has the same moment about the trocar.
  Vec3 at_tip = Vec3::Zero();
  double lag = 0;            ///< m, of the tip behind where it is commanded to be: its hand gives way
  double pad_pressure = 0;   ///< Pa, mean, of pads that hold a wall: their pinch on its area
  std::string meets;         ///< another instrument that it presses on; empty: none
  double meeting_force = 0;  ///< N at the tip, of all that it presses on
  double roll_torque = 0;  ///< N m, of the tissue on it about the shaft, right-handed about its tip direction
  double roll_lag = 0;     ///< rad, about the shaft, from where it is commanded to be: its hand gives way
};
void visit_members(auto&& visit, MembersOf<InstrumentState> auto& state) {
  auto& [pose, tip, force, handle_force, parts, touching, touches, holds, grip_points, grip, action, clips,
         aspirated, waits, at_tip, lag, pad_pressure, meets, meeting_force, roll_torque, roll_lag] = state;
  visit(pose, tip, force, handle_force, parts, touching, touches, holds, grip_points, grip, action, clips,
        aspirated, waits, at_tip, lag, pad_pressure, meets, meeting_force, roll_torque, roll_lag);
}

struct ClipState {
  ClipSize size = ClipSize::ml;
  double share = 0;    ///< where it is, of the tube's length at rest from its start
  double opening = 0;  ///< share of the tube's width that it leaves open; 0: shut
};
void visit_members(auto&& visit, MembersOf<ClipState> auto& clip) {
  auto& [size, share, opening] = clip;
  visit(size, share, opening);
}

struct LaparoscopeState {
  InstrumentPose pose;
  LaparoscopePose view;
  double distance = 0;  ///< m, from the lens to where at rest the place was that the scene has it look at
  std::string touches = {};  ///< the organ that its end touched when it was moved last; empty: none
};
void visit_members(auto&& visit, MembersOf<LaparoscopeState> auto& state) {
  auto& [pose, view, distance, touches] = state;
  visit(pose, view, distance, touches);
}

struct OrganState {
  std::string name;
  int record = -1;         ///< on the world's roll: an organ's own as long as the world is not set back
  double pressure = 0;     ///< Pa, gauge, at the highest point
  double volume = 0;       ///< m^3 enclosed
  double energy = 0;       ///< J, wall
  double max_stretch = 1;  ///< largest principal stretch of the wall
  int extensions = 0;      ///< places where an instrument has structural extensions
  int details = 0;         ///< nodes that they add
  std::vector<ClipState> clips = {};  ///< in the order of their places
  double raw = 0;                     ///< m^2 that have lost their capsule to current
};
void visit_members(auto&& visit, MembersOf<OrganState> auto& state) {
  auto& [name, record, pressure, volume, energy, max_stretch, extensions, details, clips, raw] = state;
  visit(name, record, pressure, volume, energy, max_stretch, extensions, details, clips, raw);
}

struct TissueState {
  std::string name;
  int strands = 0, torn = 0;
  int blunt = 0;  ///< of those torn: by a pull, neither by current nor by blades
};
void visit_members(auto&& visit, MembersOf<TissueState> auto& state) {
  auto& [name, strands, torn, blunt] = state;
  visit(name, strands, torn, blunt);
}

/// What has left an organ of the scene and its pieces.
struct LostState {
  std::string name;
  double bile = 0, blood = 0;  ///< m^3, by openings
  double aspirated = 0;        ///< m^3, drawn out
};
void visit_members(auto&& visit, MembersOf<LostState> auto& state) {
  auto& [name, bile, blood, aspirated] = state;
  visit(name, bile, blood, aspirated);
}

/// What a step's solves took. Its counts are the same at every number of threads; times are no part of any hash.
struct SolveStatistics {
  int substeps = 0;  ///< parts of the motion that were kept
  int solves = 0;    ///< of the whole group for a balance, those that were given up included
  int newton_iterations = 0, factorisations = 0;
  int shifts = 0;           ///< of the factorisations, those of a matrix that was shifted
  int friction_rounds = 0;  ///< solves that only renewed what rubs
  /// By tool: angles of its jaws that were tried in this step.
  std::map<std::string, int> jaw_trials;
  /// By organ or tissue: Newton steps in which its forces were the furthest from balance.
  std::map<std::string, int> furthest;
  /// Its motion was not followed to the end, as its budget was spent (motion/step_budget.h), no balance found or no room left:
  /// tools came as far as they did, and the next step goes on from there.
  bool cut_short = false;
  /// Whether its last solve found a balance in which no more is asked of what is held than holds; else bodies stand where
  /// that left them.
  bool balanced = true;
  double residual = 0;  ///< of that solve where it found none: how far from balance, as of NewtonResult
  /// Changes of the active details, and those given up because the organ found no rest with them.
  int extensions_changed = 0, extensions_refused = 0;
  /// Wall time, not part of any hash: energies and their derivatives (those of contact too), factors, solves,
  /// and finding who meets whom and how far each may go; and changes of details, their solves included.
  double assembly_s = 0, factorisation_s = 0, solve_s = 0, contact_s = 0, extension_s = 0;
};

struct StepReport {
  double time = 0;  ///< s, at the end of the step
  std::vector<InstrumentState> instruments;
  LaparoscopeState laparoscope;
  std::vector<OrganState> organs;
  std::vector<TissueState> tissues;
  std::vector<LostState> lost;  ///< of those that have lost some, in the order in which they began to
  std::vector<WorldEvent> events;
  /// False: the step ended in no balance, and nothing is judged by its forces.
  bool balanced = true;
  SolveStatistics statistics;
  std::uint64_t state_hash = 0;
};
/// What the next step is told of the last one.
void visit_members(auto&& visit, MembersOf<StepReport> auto& report) {
  // The time follows from the steps, the hash from all that is visited; statistics are no part of any result.
  auto& [time, instruments, laparoscope, organs, tissues, lost, events, balanced, statistics, state_hash] =
      report;
  visit(instruments, laparoscope, organs, tissues, lost, events, balanced);
}

}  // namespace calot
