#pragma once
// What a world holds, for the files of this room that make it, move it, change who is in it and answer what is asked of it.

#include "fem/assembly.h"
#include "field/field.h"
#include "organs/body_kinds.h"
#include "tools/laparoscope.h"
#include "world/sight.h"
#include "world/world.h"

namespace calot {

struct World::Impl {
  explicit Impl(int threads) : workers(threads), assembly(workers) {
    if (workers.threads() > 1) field.assembly = &assembly;
  }
  Workers workers;
  Assembly assembly;
  SceneDefinition scene;
  Vec3 up = Vec3::UnitZ();
  Laparoscope laparoscope;
  Vec3 looked_at = Vec3::Zero();  ///< m, at rest
  Field field;
  StepReport report;
  long steps = 0;
  bool failed = false;
  Failure failure;
  std::string scene_digest;
  std::uint64_t hash_but_steps = 0;    ///< of the state, but for how many steps there were
  std::vector<RestShift> rest_shifts;  ///< one an organ of the scene
  /// The input of a step that left the field as it was, by every bit: the same again changes nothing either.
  std::optional<StepInput> still;
  struct Looked {
    std::uint64_t state_hash = 0;  ///< of the state that it was seen in
    Sight sight;
  };
  std::optional<Looked> looked;  ///< what was seen last

  /// Takes a scene, and what it says of its field before there is anything in it.
  void set_scene(const SceneDefinition& of_world);
  /// Why a step with this input is refused; none: it is not.
  std::optional<Failure> check(const StepInput& input) const;
  /// What happens in a step; on failure the field is to be given back.
  Result<std::vector<WorldEvent>> act(const StepInput& input);
  /// What happens on the tools' way.
  Result<std::vector<WorldEvent>> move_tools(const std::vector<InstrumentPose>& commands);
  /// Instruments in their ports, and the laparoscope where the scene has it.
  void bring_in_tools(const World& world);
  void bring_in_laparoscope(const World& world);
  void place_laparoscope(const InstrumentPose& pose);
  /// Moves it; what its end begins to touch is an event.
  void move_laparoscope(const InstrumentPose& pose, std::vector<WorldEvent>& events);
  /// From the laparoscope's lens, as all stands now.
  const Sight& look();
  /// Reports all as it stands after a step of `duration` s that raised these events already (without times), and lets
  /// current flow: what begins is an event, too.
  void observe_step(const std::vector<InstrumentAction>& actions, double duration,
                    std::vector<WorldEvent> events);
  std::uint64_t find_hash_but_steps() const;
  std::uint64_t hash(std::uint64_t but_steps) const;
  void keep_hash();

  /// An organ that comes later, of its definition.
  Result<RestedOrgan> make_later(const OrganDefinition& definition) const;
  /// Goes on from what to_bytes() had behind its header; whether it could.
  bool take(std::string_view state);

  double time() const { return static_cast<double>(steps) / scene.solver.rate; }
  /// Changes the field's members; the report then is of them, with the events of the last step. On failure all is as it
  /// was before.
  template <class Change>
  auto change(const std::string& what, const Change& change) -> decltype(change());
  /// What change() must leave as it was on failure.
  Result<bool> settle_change(const std::string& what);
};

/// What organs rest on alone.
ContactLoads loads_of_ground(const Field& field);
/// How far fillings are looked for; `stop`: may be null.
FillingLimits filling_limits(const SolverDefinition& solver, const std::atomic<bool>* stop);

}  // namespace calot
