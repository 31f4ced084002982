#include "world/come_to_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "acts/advance.h"
#include "field/moving_bodies.h"
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

/// What rubs in a field.
struct Roughness {
  std::vector<Ground> ground;
  double between = 0;

  explicit Roughness(const Field& field) : ground(field.ground), between(field.group.friction) {}
  void give(Field& field) const {
    field.ground = ground;
    field.group.friction = between;
  }
  static void take(Field& field) {
    for (Ground& one : field.ground) one.friction = 0;
    field.group.friction = 0;
  }
};

/// m/s, faster than anything at rest; and of how many steps in a row.
constexpr double still_speed = 1e-3;
constexpr int still_steps = 5;

struct Fastest {
  std::size_t body = 0;
  double speed = 0;  ///< m/s
};
Fastest fastest(const Field& field) {
  Fastest out;
  for (std::size_t k = 0; k < moving_bodies(field); ++k) {
    const BodyState& state = state_of(field, k);
    const double speed = body_of(field, k).largest_motion(present_motion(body_of(field, k), state).velocity);
    if (speed > out.speed) out = {k, speed};
  }
  return out;
}

/// The organ that is furthest from where it was.
struct Drift {
  std::size_t organ = 0;
  double way = 0;  ///< m, of its node that went least
};
Drift furthest(const Field& field, const std::vector<VecX>& from) {
  Drift out;
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const VecX way = field.organs[k].state.x - from[k];
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index node = 0; node < field.organs[k].body->coarse_nodes(); ++node)
      least = std::min(least, way.segment<3>(3 * node).norm());
    if (least > out.way) out = {k, least};
  }
  return out;
}

/// Of the body that this is said of, which may be an organ.
Failure never_rests(const Field& field, std::size_t body, const std::string& what) {
  const Failure out = fail(
      FailureKind::scenario,
      fmt::format("organ '{}' never comes to rest: {}", member_name(field, static_cast<int>(body)), what),
      "let something hold it; on a table that is tilted (table_head_up, table_left_down) it slides off "
      "ground without friction");
  return body < field.organs.size() ? at_organ(out, body) : out;
}

/// Lets all bodies fall as they would in a session, but in longer steps, which damp what swings, until they lie still:
/// where no solve finds a rest at once, as of what folds, rolls or hangs by a thread. Fails (scenario) where they do not
/// within half a minute of their time, or one goes further than an abdomen is wide.
Result<bool> fall_to_rest(const Roughness& rough, Field& field) {
  constexpr double step = 0.04, longest = 30;  // s
  constexpr double width = 0.3;                // m, of an abdomen
  const double usual = std::exchange(field.step_time, step);
  rough.give(field);
  const std::vector<VecX> from = present_places(field);
  int still = 0;
  Result<bool> fell = true;
  for (int k = 0; k < longest / step && still < still_steps && fell; ++k) {
    SolveStatistics statistics;
    const Result<std::vector<WorldEvent>> events = advance(field, {}, statistics);
    if (!events) fell = events.failure();
    still = events && fastest(field).speed < still_speed ? still + 1 : 0;
    const Drift drift = furthest(field, from);
    if (fell && drift.way > width)
      fell = never_rests(field, drift.organ, fmt::format("it has fallen or slid {:.0f} mm", 1e3 * drift.way));
  }
  if (const Fastest moving = fastest(field); fell && still < still_steps)
    fell =
        never_rests(field, moving.body,
                    fmt::format("it still moves by {:.1f} mm/s after {:g} s", 1e3 * moving.speed, longest));
  Roughness::take(field);
  field.step_time = usual;
  for (std::size_t k = 0; k < moving_bodies(field); ++k) state_of(field, k).motion = {};
  for (Organ& organ : field.organs) organ.friction = {};
  field.group.rubbing.clear();
  return fell;
}

Result<bool> search_rest(const SceneDefinition& scene, const Roughness& rough, Field& field) {
  const bool dynamic = scene.solver.motion == SolverMotion::dynamics;
  SolveStatistics statistics;
  const GroupSnapshot before = snapshot(field);
  Result<bool> rested = settle_at_rest(field, statistics);
  if (!rested && dynamic) {
    restore(field, before);
    rested = sink_field(field, statistics);
  }
  if (rested || !dynamic) return rested;
  restore(field, before);
  return fall_to_rest(rough, field);
}

Result<bool> find_rest(const SceneDefinition& scene, const Roughness& rough, Field& field,
                       KeptResults* kept) {
  const bool in_company = field.organs.size() + field.tissues.size() > 1;
  if (kept == nullptr || !in_company) return search_rest(scene, rough, field);
  const std::string key = rest_key(scene, field);
  if (const std::optional<std::string> bytes = kept->find(key))
    if (const std::optional<RestState> state = rest_state_of(*bytes); state && take_rest_state(*state, field))
      return true;
  Result<bool> rested = search_rest(scene, rough, field);
  if (rested) kept->keep(key, to_bytes(rest_state(field)));
  return rested;
}

}  // namespace

Result<bool> come_to_rest(const SceneDefinition& scene, Field& field, KeptResults* kept) {
  const Result<bool> released = release_all(field);
  if (!released) return released;
  if (!released.value() && rests_alone(scene.anatomy, field)) return true;
  const Roughness rough(field);
  Roughness::take(field);
  // Nobody waits for a step on the way: what sinks or falls may be followed in many parts.
  const StepBudget usual = std::exchange(field.budget, StepBudget{.begin = 500});
  const Result<bool> rested = find_rest(scene, rough, field, kept);
  field.budget = usual;
  rough.give(field);
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
