#include "world/come_to_rest.h"

#include <algorithm>

#include "motion/settle_field.h"
#include "organs/body_kinds.h"
#include "world/definition_digest.h"
#include "world/rest_state.h"

namespace calot {
namespace {

/// What holds organs only until they are filled goes; whether there was any.
Result<bool> release_all(Field& field) {
  bool released = false;
  for (Organ& organ : field.organs) {
    const Result<bool> let_go = release_filled(organ);
    if (!let_go) return let_go;
    released |= let_go.value();
  }
  if (released) field.group.forget_bodies();
  return released;
}

/// Each at rest where it is, and nothing that could move it on.
bool rests_alone(const AnatomyDefinition& anatomy, const Field& field) {
  return anatomy.joints.empty() && field.tissues.empty() &&
         std::all_of(field.organs.begin(), field.organs.end(),
                     [](const Organ& organ) { return is_hollow(organ.definition.shape); });
}

Result<bool> search_rest(Field& field, bool dynamic) {
  SolveStatistics statistics;
  const GroupSnapshot before = snapshot(field);
  Result<bool> rested = settle_field(field, "at rest", statistics);
  if (!rested && dynamic) {
    restore(field, before);
    rested = sink_field(field, statistics);
  }
  return rested;
}

Result<bool> find_rest(const SceneDefinition& scene, Field& field, KeptResults* kept) {
  const bool dynamic = scene.solver.motion == SolverMotion::dynamics;
  const bool in_company = field.organs.size() + field.tissues.size() > 1;
  if (kept == nullptr || !in_company) return search_rest(field, dynamic);
  const std::string key = rest_key(scene, field);
  if (const std::optional<std::string> bytes = kept->find(key))
    if (const std::optional<RestState> state = rest_state_of(*bytes); state && take_rest_state(*state, field))
      return true;
  Result<bool> rested = search_rest(field, dynamic);
  if (rested) kept->keep(key, to_bytes(rest_state(field)));
  return rested;
}

}  // namespace

Result<bool> come_to_rest(const SceneDefinition& scene, Field& field, KeptResults* kept) {
  const Result<bool> released = release_all(field);
  if (!released) return released;
  if (!released.value() && rests_alone(scene.anatomy, field)) return true;
  const std::vector<Ground> rough = field.ground;
  for (Ground& ground : field.ground) ground.friction = 0;
  field.group.friction = 0;
  const Result<bool> rested = find_rest(scene, field, kept);
  field.ground = rough;
  field.group.friction = scene.anatomy.friction;
  if (!rested) return rested;
  for (Organ& organ : field.organs) {
    const ShellBody* shell = organ.body->as_shell();
    if (shell == nullptr) continue;
    ShellBody at_rest = *shell;
    at_rest.keep_in_equilibrium(organ.state);
    organ.body = std::make_shared<const ShellBody>(std::move(at_rest));
  }
  return true;
}

}  // namespace calot
