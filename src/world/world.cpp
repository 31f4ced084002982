#include "world/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "acts/advance.h"
#include "acts/clearance.h"
#include "acts/clips.h"
#include "acts/current.h"
#include "acts/exchange.h"
#include "acts/ground_injury.h"
#include "acts/hands.h"
#include "base/hash.h"
#include "base/suggest.h"
#include "fem/assembly.h"
#include "field/change_bodies.h"
#include "field/divide_body.h"
#include "field/field_bytes.h"
#include "field/field_hash.h"
#include "field/field_state.h"
#include "field/field_tissues.h"
#include "field/join_bodies.h"
#include "field/roll.h"
#include "group/vibration.h"
#include "liquid/aspirate.h"
#include "liquid/leak.h"
#include "liquid/perforate.h"
#include "liquid/spill.h"
#include "motion/settle_field.h"
#include "motion/step_budget.h"
#include "motion/structural_extension.h"
#include "motion/tool_loads.h"
#include "organs/body_kinds.h"
#include "tools/laparoscope.h"
#include "world/come_to_rest.h"
#include "world/observe.h"
#include "world/report_states.h"
#include "world/sight.h"
#include "world/world_bytes.h"

namespace calot {
namespace {

Vec3 up_direction(const AnatomyDefinition& anatomy) {
  // The table turns the patient, so in the patient's frame gravity turns the other way: head up first (about
  // +x), then left side down (about +y).
  const Eigen::AngleAxisd head_up(-anatomy.table_head_up, Vec3::UnitX());
  const Eigen::AngleAxisd left_down(-anatomy.table_left_down, Vec3::UnitY());
  return (head_up * left_down * Vec3::UnitZ()).normalized();
}

/// Names are checked where they come in: one that is unknown here is a defect of the program.
[[noreturn]] void unknown_name(const std::string& what, const std::string& name) {
  throw std::logic_error("no " + what + " is called '" + name + "'");
}

}  // namespace

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

std::uint64_t World::Impl::find_hash_but_steps() const {
  WordHash hash;
  // Where the scene puts the laparoscope is no part of the state: a picture from elsewhere is another picture of it. Where it
  // was moved to is.
  StepReport unseen = report;
  if (report.laparoscope.pose == laparoscope.start()) unseen.laparoscope = {};
  MemberWriter{hash}(hash_of(field), unseen);
  return hash.value();
}

std::uint64_t World::Impl::hash(std::uint64_t but_steps) const {
  WordHash hash;
  MemberWriter{hash}(but_steps, steps);
  return hash.value();
}

Result<std::vector<WorldEvent>> World::Impl::move_tools(const std::vector<InstrumentPose>& commands) {
  return advance_unwedged(field, bring_tools(field, commands, report.instruments), report.statistics);
}

void World::Impl::observe_step(const std::vector<InstrumentAction>& actions, double duration,
                               std::vector<WorldEvent> events) {
  const StepReport before = report;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    field.tools[i].action = actions.empty() ? InstrumentAction::none : actions[i];
  feel_ports(field.tools, before.instruments, duration);
  report_states(field, report);
  report.balanced = report.statistics.balanced;
  const std::vector<WorldEvent> begun = observe(field, before, report);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    if (report.balanced)
      tool.over_limit = presses_too_hard(report.instruments[i], tool.definition.force_limit);
  }
  feel_stiffness(field.tools, before.instruments, report.instruments);
  const std::vector<WorldEvent> hurt = hurt_ground(field, report.balanced);
  const bool flows = std::any_of(field.tools.begin(), field.tools.end(),
                                 [](const Tool& tool) { return tool.action == InstrumentAction::activate; });
  // Of organs and strands alone: the report's have ground's in them.
  const std::vector<ToolLoad> loads = flows ? tool_loads(field) : std::vector<ToolLoad>(field.tools.size());
  const std::vector<WorldEvent> burnt = apply_current(field, loads, duration);
  report_burnt(field, report);
  events.insert(events.end(), begun.begin(), begun.end());
  events.insert(events.end(), hurt.begin(), hurt.end());
  events.insert(events.end(), burnt.begin(), burnt.end());
  place_events(field, report, events);
  report.events = std::move(events);
}

void World::Impl::keep_hash() {
  hash_but_steps = find_hash_but_steps();
  report.state_hash = hash(hash_but_steps);
}

void World::Impl::place_laparoscope(const InstrumentPose& pose) {
  report.laparoscope.pose = pose;
  report.laparoscope.view = laparoscope.view(pose);
  report.laparoscope.distance = pose == laparoscope.start()
                                    ? scene.laparoscope.distance
                                    : (looked_at - report.laparoscope.view.position).norm();
}

void World::Impl::move_laparoscope(const InstrumentPose& pose, std::vector<WorldEvent>& events) {
  const std::string touched = report.laparoscope.touches;
  place_laparoscope(pose);
  Clearance nearest{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  std::string& touches = report.laparoscope.touches;
  touches.clear();
  for (const Organ& organ : field.organs) {
    const Clearance found = calot::clearance({laparoscope_end(laparoscope.port(), pose)}, organ);
    if (found.distance > 0 || found.distance >= nearest.distance) continue;
    nearest = found;
    touches = organ.definition.name;
  }
  if (!touches.empty() && touches != touched)
    events.push_back({EventKind::contact, 0, laparoscope_name, touches, 0, nearest.place});
}

const Sight& World::Impl::look() {
  const Vec3& lens = report.laparoscope.view.position;
  if (looked && looked->state_hash == report.state_hash && looked->sight.eye() == lens) return looked->sight;
  return looked.emplace(Looked{report.state_hash, Sight(field, lens)}).sight;
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

namespace {

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

/// What a scene says of its field before there is anything in it.
void set_field(const SceneDefinition& scene, Field& field) {
  field.tolerance = scene.solver.tolerance;
  if (scene.solver.motion == SolverMotion::dynamics) field.step_time = 1 / scene.solver.rate;
  field.scheme = scene.solver.extension_scheme;
  field.ground = ground_of(scene.anatomy);
}

/// What organs rest on alone.
ContactLoads loads_of_ground(const Field& field) {
  ContactLoads out;
  for (const Ground& ground : field.ground) out.shapes.push_back(contact_shape(ground.shape));
  return out;
}

/// `stop`: may be null.
FillingLimits filling_limits(const SolverDefinition& solver, const std::atomic<bool>* stop) {
  FillingLimits out{stop};
  out.sinks = solver.motion == SolverMotion::dynamics;
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
  self.scene = scene;
  if (self.scene.ports.empty()) self.scene.ports = default_ports();
  self.up = up_direction(scene.anatomy);
  set_field(scene, self.field);
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
  self.scene = scene;
  if (self.scene.ports.empty()) self.scene.ports = default_ports();
  self.up = up_direction(scene.anatomy);
  set_field(scene, self.field);
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

std::optional<Failure> World::Impl::check(const StepInput& input) const {
  if (input.instruments.size() != field.tools.size())
    return fail(FailureKind::internal, fmt::format("a step needs {} instrument poses, not {}",
                                                   field.tools.size(), input.instruments.size()));
  if (!input.actions.empty() && input.actions.size() != field.tools.size())
    return fail(FailureKind::internal, fmt::format("a step needs {} actions or none, not {}",
                                                   field.tools.size(), input.actions.size()));
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    const Tool& tool = field.tools[i];
    if (std::optional<Failure> wrong = check_pose(tool.definition.name, tool.geometry, input.instruments[i]))
      return wrong;
    if (input.actions.empty()) continue;
    if (std::optional<Failure> wrong = check_action(tool.definition, input.actions[i])) return wrong;
  }
  if (std::optional<Failure> wrong = check_waiting(field.tools, input)) return wrong;
  if (!input.laparoscope) return std::nullopt;
  return check_pose(laparoscope_name, laparoscope_geometry(), *input.laparoscope);
}

Result<std::vector<WorldEvent>> World::Impl::act(const StepInput& input) {
  const double duration = 1 / scene.solver.rate;
  const std::vector<WorldEvent> leaked = leak(field, duration);
  Result<std::vector<WorldEvent>> events = move_tools(input.instruments);
  if (!events) return events;
  fire_clips(field, input.actions, events.value());
  puncture(field, input.actions, events.value());
  events->insert(events->begin(), leaked.begin(), leaked.end());
  spill(field, duration);
  exchange_tools(field, input.actions, events.value());
  return events;
}

Result<StepReport> World::step(const StepInput& input) {
  Impl& self = *impl_;
  if (self.failed) return self.failure;
  if (std::optional<Failure> failure = self.check(input)) return *failure;
  self.report.statistics = {};
  if (self.scene.solver.skip_still && self.still == input) {
    ++self.steps;
    self.report.time = self.time();
    self.report.events.clear();
    self.report.state_hash = self.hash(self.hash_but_steps);
    return self.report;
  }
  const FieldState before = state();
  const std::uint64_t hash_before = self.hash_but_steps;
  self.field.time = static_cast<double>(self.steps + 1) / self.scene.solver.rate;
  Result<std::vector<WorldEvent>> events = self.act(input);
  if (self.field.stopped()) {
    // Whatever was given up on the way went another way by that.
    calot::restore(self.field, before);
    return fail(FailureKind::interrupted, "the step was interrupted");
  }
  if (!events) {
    self.failed = true;
    self.failure = events.failure();
    for (Problem& problem : self.failure.problems)
      problem.message += fmt::format(", at {:.3f} s", self.field.time);
    calot::restore(self.field, before);
    return self.failure;
  }
  ++self.steps;
  if (input.laparoscope) self.move_laparoscope(*input.laparoscope, events.value());
  self.report.time = self.time();
  self.observe_step(input.actions, 1 / self.scene.solver.rate, std::move(events).value());
  self.keep_hash();
  self.still.reset();
  if (self.hash_but_steps == hash_before && self.report.events.empty()) self.still = input;
  return self.report;
}

const SceneDefinition& World::scene() const { return impl_->scene; }
const StepReport& World::report() const { return impl_->report; }
std::uint64_t World::state_hash() const { return impl_->hash(impl_->find_hash_but_steps()); }

FieldState World::state() const {
  FieldState state = field_state(impl_->field);
  state.steps = impl_->steps;
  state.report = impl_->report;
  return state;
}

Result<bool> World::restore(const FieldState& state) {
  Impl& self = *impl_;
  if (!state.members || state.members->world != self.field.members->world)
    return fail(FailureKind::internal, "a field state can only be given back to the world it is of");
  calot::restore(self.field, state);
  self.steps = state.steps;
  self.report = state.report;
  self.hash_but_steps = self.find_hash_but_steps();
  self.still.reset();
  self.failed = false;
  return true;
}

std::string World::to_bytes() const {
  ByteWriter out;
  MemberWriter{out}(impl_->steps, impl_->report);
  add_bytes_of(impl_->field, out);
  return with_header(impl_->scene_digest, out.bytes());
}

Result<World> World::from_bytes(const SceneDefinition& scene, std::string_view bytes,
                                const std::atomic<bool>* stop, int threads, KeptResults* kept) {
  const Result<SavedWorld> saved = saved_world(bytes);
  if (!saved) return saved.failure();
  Result<World> world = create(scene, stop, threads, kept);
  if (!world) return world;
  Impl& self = *world->impl_;
  if (saved->scene != self.scene_digest)
    return fail(FailureKind::scenario, "the saved world is of another scene",
                "give the scene that it was saved of");
  if (self.take(saved->state)) return world;
  return fail(FailureKind::usage, "the saved world cannot be read: its parts do not fit together",
              "save it anew by this program");
}

Result<RestedOrgan> World::Impl::make_later(const OrganDefinition& definition) const {
  const SolverDefinition& solver = scene.solver;
  FillingLimits limits = filling_limits(solver, nullptr);
  return make_organ(definition, loads_of_ground(field), up, solver.tolerance,
                    definition.extensions ? solver.extension_levels : 0, &limits);
}

bool World::Impl::take(std::string_view state) {
  ByteReader in(state);
  MemberReader read{in};
  read(steps, report);
  read_field(
      read, [&](const OrganDefinition& definition) { return make_later(definition); }, field);
  if (!in.complete() || report.instruments.size() != field.tools.size()) return false;
  report.time = field.time = time();
  report.statistics = {};
  keep_hash();
  return true;
}

const std::vector<RestShift>& World::rest_shifts() const { return impl_->rest_shifts; }
Vec3 World::up() const { return impl_->up; }
const Field& World::field() const { return impl_->field; }

Vec3 World::port_position(const std::string& port) const {
  for (const PortDefinition& p : impl_->scene.ports)
    if (p.name == port) return p.position;
  unknown_name("port", port);
}

namespace {

/// Where a landmark of an organ that went was last.
const SkinPlace& last_place(const Field& field, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const BodyRecord* record = dot == std::string::npos ? nullptr : gone_body(field, name.substr(0, dot));
  if (record == nullptr || !record->gone->landmarks.contains(name.substr(dot + 1)))
    unknown_name("landmark", name);
  return record->gone->landmarks.at(name.substr(dot + 1));
}

}  // namespace

Vec3 World::landmark(const std::string& name) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, name);
  if (!there) return last_place(impl_->field, name).at;
  const Organ& organ = impl_->field.organ(there->organ);
  return organ.body->landmark_place(there->skin_point, organ.state.x);
}

Vec3 World::landmark_normal(const std::string& name) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, name);
  if (!there) return last_place(impl_->field, name).normal;
  // Its places lie inside of it: what comes to them comes from above.
  if (std::holds_alternative<RigidShape>(impl_->field.organ(there->organ).definition.shape)) return up();
  return skin_normals(there->organ)[there->skin_point];
}

double World::clearance(ToolIndex instrument, OrganIndex organ) const {
  return calot::clearance(impl_->field.tool(instrument), impl_->field.organ(organ)).distance;
}

// m before a place: as thick as what a triangle is stretched between.
constexpr double looked_through = 2e-3;

double World::seen_area(const std::array<Vec3, 3>& corners) const {
  return calot::seen_area(impl_->look(), impl_->report.laparoscope.view,
                          impl_->scene.laparoscope.field_of_view, corners, looked_through);
}

bool World::sees(const Vec3& place, const std::string& through) const {
  return is_in_field(impl_->report.laparoscope.view, impl_->scene.laparoscope.field_of_view, place) &&
         impl_->look().sees_past_ground(place, looked_through, through);
}

bool World::sees(const std::string& landmark) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, landmark);
  const bool rigid =
      there && std::holds_alternative<RigidShape>(impl_->field.organ(there->organ).definition.shape);
  return sees(this->landmark(landmark),
              rigid ? impl_->field.organ(there->organ).definition.name : std::string());
}

const Laparoscope& World::laparoscope() const { return impl_->laparoscope; }

CriticalView World::critical_view(const CriticalViewQuestion& question) const {
  const HepatocysticTriangle triangle{landmark(question.neck), landmark(question.junction),
                                      landmark(question.hilum)};
  return calot::critical_view(impl_->field, triangle, impl_->look(), question);
}

const Tessellation& World::skin(OrganIndex organ) const { return impl_->field.organ(organ).body->skin(); }
std::vector<Vec3> World::skin_positions(OrganIndex organ) const {
  return impl_->field.organ(organ).body->skin_positions(impl_->field.organ(organ).state.x);
}
std::vector<Vec3> World::skin_normals(OrganIndex organ) const {
  return impl_->field.organ(organ).body->skin_normals(impl_->field.organ(organ).state.x);
}
const std::vector<Triangle>& World::drawn_triangles(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn_triangles();
}
const std::vector<Vec3>& World::drawn_rest(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn_rest();
}
DrawnSurface World::drawn(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn(impl_->field.organ(organ).state.x);
}

Result<double> World::lowest_frequency(OrganIndex index) const {
  const Organ& organ = impl_->field.organ(index);
  const ShellBody* shell = organ.body->as_shell();
  if (shell == nullptr)
    return fail(
        FailureKind::simulation,
        fmt::format("'{}' is no hollow organ: its natural frequency is not known", organ.definition.name));
  const BodyMass mass(*shell, organ.state.x, organ.definition.wall.thickness, organ.definition.bile.density);
  return calot::lowest_frequency(*shell, contact_loads(impl_->field, organ, present_poses(impl_->field)),
                                 organ.state, mass);
}

// ---- bodies that come and go

/// Where masses count the next step brings what changed into motion. Else all must come to rest first.
Result<bool> World::Impl::settle_change(const std::string& what) {
  if (field.step_time > 0) return true;
  return settle_field(field, what, report.statistics);
}

template <class Change>
auto World::Impl::change(const std::string& what, const Change& change) -> decltype(change()) {
  if (failed) return failure;
  const FieldState before = field_state(field);
  auto done = change();
  if (!done) return done;
  if (Result<bool> settled = settle_change(what); !settled) {
    calot::restore(field, before);
    return settled.failure();
  }
  // What hands felt was of what has changed.
  for (Tool& tool : field.tools) tool.tissue_stiffness = tool.stiffness_across = tool.roll_stiffness = 0;
  report_states(field, report);
  keep_hash();
  still.reset();
  return done;
}

Result<OrganIndex> World::organ(const std::string& name) const { return find_body(impl_->field, name); }
Result<OrganIndex> World::organ(const BodyHandle& handle) const { return find_body(impl_->field, handle); }
BodyHandle World::handle(OrganIndex organ) const { return handle_of(impl_->field, organ); }

Result<Division> World::divide(const std::string& name, double share) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  const Result<bool> clear = free_of_clips(impl_->field.organ(organ.value()), share, 0, "divided");
  if (!clear) return clear.failure();
  return impl_->change(fmt::format("after '{}' was divided", name),
                       [&] { return divide_body(impl_->field, organ.value(), share, impl_->time()); });
}

Result<bool> World::clip(const std::string& name, double share, ClipSize size) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was clipped", name),
                       [&] { return clip_body(impl_->field, organ.value(), share, size); });
}

Result<bool> World::remove(const std::string& name, const std::string& why) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was removed", name),
                       [&] { return remove_body(impl_->field, organ.value(), why, impl_->time()); });
}

namespace {

/// Paths of what was added begin with what it is.
Failure of_added(Failure failure, const char* what) {
  for (Problem& problem : failure.problems)
    if (problem.place.path.starts_with('.')) problem.place.path.insert(0, what);
  return failure;
}

}  // namespace

Result<OrganIndex> World::add(const OrganDefinition& definition) {
  if (std::vector<Problem> problems = validate(definition); !problems.empty())
    return Failure{FailureKind::scenario, std::move(problems)};
  const auto make = [&](const OrganDefinition& one) { return impl_->make_later(one); };
  Result<OrganIndex> added = impl_->change(fmt::format("after '{}' came", definition.name),
                                           [&] { return add_body(impl_->field, definition, make); });
  return added ? added : of_added(added.failure(), "organ");
}

Result<bool> World::release(const std::string& name, const std::string& held) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was let go", name),
                       [&] { return release_body(impl_->field, organ.value(), held); });
}

Result<bool> World::add_tissue(const TissueDefinition& definition) {
  std::vector<std::string> organs;
  for (const Organ& organ : impl_->field.organs) organs.push_back(organ.definition.name);
  if (std::vector<Problem> problems = validate(definition, organs); !problems.empty())
    return Failure{FailureKind::scenario, std::move(problems)};
  Result<bool> added = impl_->change(fmt::format("after '{}' came", definition.name),
                                     [&] { return calot::add_tissue(impl_->field, definition); });
  return added ? added : of_added(added.failure(), "tissue");
}

Result<bool> World::remove_tissue(const std::string& name) {
  return impl_->change(fmt::format("after '{}' was removed", name),
                       [&] { return calot::remove_tissue(impl_->field, name, impl_->time()); });
}

Result<double> World::open_tube(const std::string& name, double share, double width) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  const Result<bool> clear = free_of_clips(impl_->field.organ(organ.value()), share, 0, "opened");
  if (!clear) return clear.failure();
  return impl_->change(fmt::format("after '{}' was opened", name),
                       [&] { return calot::open_tube(impl_->field.organ(organ.value()), share, width); });
}

Result<bool> World::tie(const JointDefinition& joint) {
  for (const std::string& name : {joint.from, joint.to})
    if (Result<Vec3> there = place(name); !there) return there.failure();
  if (joint.from.substr(0, joint.from.rfind('.')) == joint.to.substr(0, joint.to.rfind('.')))
    return fail(FailureKind::scenario, "an organ is tied to itself", "name a place on another organ");
  return impl_->change(fmt::format("after '{}' was tied to '{}'", joint.from, joint.to),
                       [&] { return tie_bodies(impl_->field, joint); });
}

Result<bool> World::untie(const std::string& one, const std::string& other) {
  const Result<OrganIndex> first = organ(one), second = organ(other);
  if (!first) return first.failure();
  if (!second) return second.failure();
  return impl_->change(fmt::format("after '{}' and '{}' were untied", one, other),
                       [&] { return untie_bodies(impl_->field, first.value(), second.value()); });
}

Result<Vec3> World::place(const std::string& name) const {
  const std::size_t dot = name.rfind('.');
  if (find_landmark(impl_->field.organs, name)) return landmark(name);
  if (dot != std::string::npos && gone_body(impl_->field, name.substr(0, dot)) != nullptr)
    if (const Result<OrganIndex> there = organ(name.substr(0, dot)); !there) return there.failure();
  return fail(FailureKind::scenario, fmt::format("unknown landmark \"{}\"", name),
              suggestion(name, landmarks()));
}

std::vector<std::string> World::landmarks() const {
  std::vector<std::string> names;
  for (const Organ& organ : impl_->field.organs)
    for (const auto& [name, point] : organ.landmarks) names.push_back(organ.definition.name + "." + name);
  return names;
}

double World::deepest_penetration() const { return calot::deepest_penetration(impl_->field); }

}  // namespace calot
