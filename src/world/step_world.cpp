#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "acts/advance.h"
#include "acts/clearance.h"
#include "acts/clips.h"
#include "acts/current.h"
#include "acts/exchange.h"
#include "acts/ground_injury.h"
#include "acts/hands.h"
#include "base/hash.h"
#include "field/field_bytes.h"
#include "field/field_hash.h"
#include "field/field_state.h"
#include "liquid/aspirate.h"
#include "liquid/leak.h"
#include "liquid/spill.h"
#include "motion/tool_loads.h"
#include "world/observe.h"
#include "world/report_states.h"
#include "world/world_bytes.h"
#include "world/world_impl.h"

namespace calot {

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

}  // namespace calot
