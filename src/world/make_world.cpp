#include <algorithm>

#include "acts/exchange.h"
#include "acts/hands.h"
#include "field/change_bodies.h"
#include "field/field_tissues.h"
#include "field/join_bodies.h"
#include "motion/step_budget.h"
#include "motion/structural_extension.h"
#include "motion/tool_loads.h"
#include "organs/body_kinds.h"
#include "world/come_to_rest.h"
#include "world/report_states.h"
#include "world/world_bytes.h"
#include "world/world_impl.h"

namespace calot {

ContactLoads loads_of_ground(const Field& field) {
  ContactLoads out;
  for (const Ground& ground : field.ground) out.shapes.push_back(contact_shape(ground.shape));
  return out;
}

FillingLimits filling_limits(const SolverDefinition& solver, const std::atomic<bool>* stop) {
  FillingLimits out{stop};
  out.sinks = solver.motion == SolverMotion::dynamics;
  return out;
}

namespace {

Vec3 up_direction(const AnatomyDefinition& anatomy) {
  // The table turns the patient, so in the patient's frame gravity turns the other way: head up first (about
  // +x), then left side down (about +y).
  const Eigen::AngleAxisd head_up(-anatomy.table_head_up, Vec3::UnitX());
  const Eigen::AngleAxisd left_down(-anatomy.table_left_down, Vec3::UnitY());
  return (head_up * left_down * Vec3::UnitZ()).normalized();
}

std::vector<RestShift> shifts_from_drawn(const std::vector<Organ>& organs) {
  std::vector<RestShift> out;
  for (const Organ& organ : organs) {
    const std::vector<Vec3>& drawn = organ.body->skin_rest();
    const std::vector<Vec3> now = organ.body->skin_positions(organ.state.x);
    const auto shift = [&](std::size_t i) { return (now[i] - drawn[i]).norm(); };
    std::size_t furthest = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (shift(i) > shift(furthest)) furthest = i;
    const auto nearer = [&](const auto& a, const auto& b) {
      return (drawn[a.second] - drawn[furthest]).norm() < (drawn[b.second] - drawn[furthest]).norm();
    };
    const auto near = std::min_element(organ.landmarks.begin(), organ.landmarks.end(), nearer);
    out.push_back({shift(furthest), near == organ.landmarks.end() ? std::string() : near->first});
  }
  return out;
}

/// All organs of a scene, in its order, each as make_organ() has it; after a failure that is not the scenario's there may be
/// fewer. A lobe is half of the time that it takes: two threads make lobes and what is filled at once.
std::vector<std::optional<Result<RestedOrgan>>> make_organs(const SceneDefinition& scene,
                                                            const OrganSetting& setting, Workers& workers) {
  const std::vector<OrganDefinition>& organs = scene.anatomy.organs;
  std::vector<std::optional<Result<RestedOrgan>>> out(organs.size());
  const auto make_those = [&](bool lobes) {
    for (std::size_t k = 0; k < organs.size(); ++k) {
      if (std::holds_alternative<LobeShape>(organs[k].shape) != lobes) continue;
      // No lobe is filled, and nothing of the others is kept: limits and kept results are each one thread's alone.
      OrganSetting own = setting;
      if (organs[k].extensions) own.levels = scene.solver.extension_levels;
      if (lobes)
        own.limits = nullptr;
      else
        own.kept = nullptr;
      out[k] = make_organ(body_kinds()[organs[k].shape.index()], organs[k], own);
      if (!*out[k] && out[k]->failure().kind != FailureKind::scenario) return;
    }
  };
  do_at_once(
      &workers, [&] { make_those(true); }, [&] { make_those(false); });
  return out;
}

/// Adds the organs of a scene, each as make_organ() has it. Fails (scenario) with the problems of all of them.
Result<bool> add_organs(const SceneDefinition& scene, const OrganSetting& setting, Workers& workers,
                        Field& field) {
  auto organs = make_organs(scene, setting, workers);
  std::vector<Problem> problems;
  for (std::size_t k = 0; k < organs.size(); ++k) {
    if (!organs[k]) continue;  // after what failed
    if (*organs[k]) {
      field.add(std::move(*organs[k]).value());
      continue;
    }
    Failure failure = at_organ(organs[k]->failure(), k);
    if (failure.kind != FailureKind::scenario) return failure;
    problems.insert(problems.end(), failure.problems.begin(), failure.problems.end());
  }
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  return true;
}

/// An instrument in its trocar (m) before the first step: closed, pointing at the first organ, just far enough in to be
/// seen to come.
Tool tool_at_port(const InstrumentDefinition& definition, const Vec3& trocar, const Field& field) {
  Tool tool;
  tool.definition = definition;
  tool.waits = definition.waits;
  tool.geometry = instrument_geometry(definition.type);
  tool.trocar = trocar;
  if (has_action(definition.type, InstrumentAction::fire)) tool.clips = definition.clips;
  const Vec3 aim = field.organs.empty()
                       ? Vec3(tool.trocar - Vec3::UnitZ())
                       : Vec3(field.organs[0].body->skin_positions(field.organs[0].state.x).front());
  tool.pose = pose_reaching(tool.trocar, aim, 0.0, 0.0, tool.geometry);
  tool.pose.insertion = port_depth;
  tool.command = tool.pose;
  return tool;
}

/// Gives the organs the details that the laparoscope sees at a landmark.
void look_closely(const std::string& landmark, Field& field) {
  field.viewed = find_landmark(field.organs, landmark);
  SolveStatistics statistics;
  for (Organ& each : field.organs) follow_contacts(field, each, statistics);
}

}  // namespace

Result<World> World::create(const SceneDefinition& scene, const std::atomic<bool>* stop, int threads,
                            KeptResults* kept) {
  std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  World world(std::make_unique<Impl>(threads));
  Impl& self = *world.impl_;
  self.set_scene(scene);
  self.field.stop = stop;
  const ContactLoads still = loads_of_ground(self.field);
  FillingLimits limits = filling_limits(scene.solver, stop);
  if (Result<bool> added = add_organs(scene, {still, self.up, scene.solver.tolerance, 0, &limits, kept},
                                      self.workers, self.field);
      !added)
    return added.failure();
  if (Result<bool> joined = join_bodies(scene.anatomy, self.field); !joined) return joined.failure();
  if (Result<bool> made = add_tissues(scene.anatomy, self.up, self.field); !made) return made.failure();
  if (Result<bool> rested = come_to_rest(scene, self.field, kept); !rested) return rested.failure();
  self.rest_shifts = shifts_from_drawn(self.field.organs);
  self.bring_in_tools(world);
  if (scene.laparoscope.distance < scene.solver.extension_view)
    look_closely(scene.laparoscope.look_at, self.field);
  self.bring_in_laparoscope(world);
  if (Result<bool> clear = check_clear(self.field); !clear) return clear.failure();
  if (Result<bool> apart = check_apart(self.field); !apart) return apart.failure();
  int nodes = 0;
  for (const Organ& organ : self.field.organs) nodes += organ.body->nodes();
  self.field.budget = budget_of(nodes);
  keep_members(self.field);
  self.scene_digest = calot::scene_digest(self.scene, self.field);
  self.observe_step({}, 1 / scene.solver.rate, {});
  self.keep_hash();
  return world;
}

void World::Impl::set_scene(const SceneDefinition& of_world) {
  scene = of_world;
  if (scene.ports.empty()) scene.ports = default_ports();
  up = up_direction(scene.anatomy);
  field.tolerance = scene.solver.tolerance;
  if (scene.solver.motion == SolverMotion::dynamics) field.step_time = 1 / scene.solver.rate;
  field.scheme = scene.solver.extension_scheme;
  field.ground = ground_of(scene.anatomy);
}

void World::Impl::bring_in_tools(const World& world) {
  field.up = up;
  field.heart_rate = scene.anatomy.heart_rate;
  if (!field.organs.empty()) field.middle = field.organs[0].body->skin_point(0, field.organs[0].state.x);
  for (const InstrumentDefinition& definition : scene.instruments)
    field.tools.push_back(tool_at_port(definition, world.port_position(definition.port), field));
}

void World::Impl::bring_in_laparoscope(const World& world) {
  looked_at = world.landmark(scene.laparoscope.look_at);
  laparoscope = Laparoscope(scene.laparoscope, world.port_position(scene.laparoscope.port), looked_at);
  place_laparoscope(laparoscope.start());
}

Result<World> World::as_drawn(const SceneDefinition& scene, std::vector<Vec3>& overlaps, KeptResults* kept) {
  std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  World world(std::make_unique<Impl>(1));
  Impl& self = *world.impl_;
  self.set_scene(scene);
  const ContactLoads still = loads_of_ground(self.field);
  OrganSetting setting{still, self.up, scene.solver.tolerance, 0, nullptr, kept, true};
  if (Result<bool> added = add_organs(scene, setting, self.workers, self.field); !added)
    return added.failure();
  // Where they are tied they may be in each other: a joint that cannot be made ties nothing.
  for (const JointDefinition& joint : scene.anatomy.joints)
    static_cast<void>(add_joint(joint, true, self.field));
  renew_joins(self.field);
  overlaps = overlap_places(self.field);
  self.bring_in_tools(world);
  self.bring_in_laparoscope(world);
  keep_members(self.field);
  report_states(self.field, self.report);
  self.failed = true;
  self.failure = fail(FailureKind::scenario, "a scene that is refused can be looked at, and not played");
  return world;
}

Result<RestedOrgan> World::Impl::make_later(const OrganDefinition& definition) const {
  const SolverDefinition& solver = scene.solver;
  FillingLimits limits = filling_limits(solver, nullptr);
  return make_organ(definition, loads_of_ground(field), up, solver.tolerance,
                    definition.extensions ? solver.extension_levels : 0, &limits);
}

}  // namespace calot
