#pragma once
// Organs, tools and what carries them.

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "fem/assembly.h"
#include "field/members.h"
#include "field/spilled.h"
#include "joins/skin_rubbing.h"
#include "organs/tissue.h"
#include "tools/field_shape.h"
#include "tools/step_report.h"
#include "tools/tool.h"

namespace calot {

/// What the last first-order answer to the tools' motion missed. The next motion misses nearly the same, as it is of
/// the second order in the way.
struct MissedMotion {
  VecX dx;                 ///< m, 3 a node of all members; empty: none known
  VecX dpressures;         ///< Pa, one an organ
  double travel = 0;       ///< of the tool that travelled furthest, m
  int by_last_factor = 0;  ///< iterations that took it, of the last factor
};

/// How the organs of a field are solved together, kept from one solve to the next.
struct Group {
  /// Without nodes until it is asked for (GroupProblem::prepare).
  NewtonWorkspace work{BlockMatrix(0, {})};
  GroupPatterns patterns;
  std::vector<JoinPointer> joins;
  MissedMotion missed;
  double friction = 0;            ///< Coulomb's, of skins of different bodies on each other
  std::vector<SkinHold> rubbing;  ///< at the last equilibrium (body_rubbing.h)

  /// After a body has become another one: nothing that was made for it serves.
  void forget_bodies() {
    work = NewtonWorkspace(BlockMatrix(0, {}));
    patterns = {};
  }
};

/// A shape that stays.
struct Ground {
  std::string name;
  Shape shape;
  double friction = 0;      ///< Coulomb's
  bool broad = true;        ///< felt by few points; by all as instruments are where it is false
  std::string injury = {};  ///< what it is called when it is hurt; empty: nothing hurts it
  double thrust_limit = 0;  ///< N, from which on a thrust does
};

/// Where ground was hurt.
struct Wound {
  std::string ground;
  Vec3 at = Vec3::Zero();  ///< m
};
void visit_members(auto&& visit, MembersOf<Wound> auto& wound) {
  auto& [ground, at] = wound;
  visit(ground, at);
}

/// Newton iterations of a step where masses count.
struct StepBudget {
  int begin = 14;    ///< having taken these it begins nothing more: no part, no other angle of jaws, no slip
  int balance = 20;  ///< that the balance where it ends may take beyond
};

/// Of solves on the way through a step where masses count: what presses and what slips is decided by forces to a
/// hundredth. The last solve of each step is balanced to the field's tolerance.
inline constexpr double rough_tolerance = 1e-3;

struct Field {
  std::vector<Organ> organs;
  std::vector<Tissue> tissues;  ///< between them
  Group group;
  std::vector<Tool> tools;
  std::vector<Ground> ground;
  Barrier barrier = contact_barrier;
  double tolerance = 1e-6;
  /// What is solved for now is on the way to where the step ends: balanced to rough_tolerance it serves. At the end of
  /// each step it is false.
  bool rough = false;
  double step_time = 0;       ///< s that a step takes where masses count; 0: statics
  double time = 0;            ///< s, at the end of the present step
  StepBudget budget;          ///< what a step may take where masses count (motion/step_budget.h)
  Spill spill;                ///< what has left the organs
  std::vector<Wound> wounds;  ///< of ground, in their order
  double heart_rate = 0;      ///< a minute
  Vec3 up = Vec3::UnitZ();
  Vec3 middle = Vec3::Zero();        ///< m, of the first organ at rest
  std::optional<OrganPoint> viewed;  ///< what the laparoscope looks at from near by
  ExtensionScheme scheme = ExtensionScheme::condensed;
  Assembly* assembly = nullptr;  ///< the world's threads; null: one does all
  /// Becomes true when nobody waits any more for what is being solved for; null: somebody always does.
  const std::atomic<bool>* stop = nullptr;
  Membership membership;
  std::shared_ptr<const FieldMembers> members;  ///< as it is now, for states; null before keep_members()
  std::uint64_t lives = 0;                      ///< that were given to bodies

  bool stopped() const { return stop != nullptr && *stop; }
  /// What a body is touched by that has this place among its shapes.
  FieldShape shape(int index) const { return FieldShape::at(index, tools.size()); }
  Organ& organ(OrganIndex at) { return organs[at.value]; }
  const Organ& organ(OrganIndex at) const { return organs[at.value]; }
  Tool& tool(ToolIndex at) { return tools[at.value]; }
  const Tool& tool(ToolIndex at) const { return tools[at.value]; }
  /// Null: one thread does all.
  Workers* workers() const { return workers_of(assembly); }
  /// The scene's next organ. The first one's last factor serves on.
  void add(RestedOrgan made);
  /// Puts an organ on the roll.
  void enrol(Organ& organ);
};

/// The organ that has this place on the roll, or that of this name; none: it is not in the field.
std::optional<OrganIndex> organ_of_record(const Field& field, int record);
std::optional<OrganIndex> organ_called(const Field& field, const std::string& name);

std::vector<InstrumentPose> present_poses(const Field& field);
/// Where the nodes of each organ are, m.
std::vector<VecX> present_places(const Field& field);
/// The anatomy's ground, its support last.
std::vector<Ground> ground_of(const AnatomyDefinition& anatomy);

/// All that moves of the organs, cheap to copy: what failed is undone by it.
struct GroupSnapshot {
  std::vector<OrganSnapshot> organs;
  std::vector<TissueMotion> tissues;
  NewtonWorkspace::Kept factor = NewtonWorkspace(BlockMatrix(0, {})).keep();
  GroupPatterns patterns;  ///< without values
  MissedMotion missed;
  std::vector<SkinHold> rubbing;
};
GroupSnapshot snapshot(const Field& field);
/// The field must have the organs that it is of.
void restore(Field& field, const GroupSnapshot& snapshot);

}  // namespace calot
