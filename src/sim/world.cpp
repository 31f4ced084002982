#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/hash.h"
#include "base/suggest.h"
#include "fem/assembly.h"
#include "sim/advance.h"
#include "sim/between_jaws.h"
#include "sim/body_kinds.h"
#include "sim/change_bodies.h"
#include "sim/clips.h"
#include "sim/current.h"
#include "sim/field_state.h"
#include "sim/field_tissues.h"
#include "sim/grip.h"
#include "sim/join_bodies.h"
#include "sim/laparoscope.h"
#include "sim/leak.h"
#include "sim/settle_field.h"
#include "sim/sight.h"
#include "sim/spill.h"
#include "sim/structural_extension.h"
#include "sim/tool_loads.h"
#include "sim/vibration.h"

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
  std::uint64_t field_hash = 0;
  /// The input of a step that left the field as it was, by every bit: the same again changes nothing either.
  std::optional<StepInput> still;

  void place_laparoscope(const InstrumentPose& pose);
  void observe(std::vector<WorldEvent> events, const std::vector<InstrumentAction>& actions);
  InstrumentState instrument_state(std::size_t index, const ToolLoad& load) const;
  OrganState organ_state(const Organ& organ) const;
  std::uint64_t hash_field() const;
  bool same_factors(const FieldState& state) const;
  std::uint64_t hash(std::uint64_t of_field) const;

  double time() const { return static_cast<double>(steps) / scene.solver.rate; }
  /// Changes the field's members; the report then is of them, with the events of the last step. On failure all is as it
  /// was before.
  template <class Change>
  auto change(const std::string& what, const Change& change) -> decltype(change());
  /// What change() must leave as it was on failure.
  Result<bool> settle_change(const std::string& what);
};

namespace {

/// Or a matrix, column by column.
template <class Numbers>
void add_vector(Hash& hash, const Numbers& v) {
  hash.add(v.size());
  hash.add(std::span<const double>(v.data(), static_cast<std::size_t>(v.size())));
}

void add_point(Hash& hash, const Vec3& p) { hash.add(std::span<const double>(p.data(), 3)); }

void add_motion(Hash& hash, const MotionPart& motion) {
  add_vector(hash, motion.begin.x);
  add_vector(hash, motion.begin.velocity);
  add_point(hash, motion.begin.centroid);
  hash.add(motion.duration);
}

void add_body_state(Hash& hash, const Organ& organ) {
  const BodyState& state = organ.state;
  add_vector(hash, state.x);
  hash.add(state.datum_pressure);
  hash.add(state.volume);
  for (int detail : organ.body->details()) hash.add(detail);
  for (const DetailShare& detail : state.shares) {
    hash.add(detail.share);
    hash.add(detail.leaving);
  }
  add_vector(hash, state.fading_load);
  if (state.motion.duration > 0) add_motion(hash, state.motion);
  for (const Extension& extension : organ.extensions) {
    hash.add(extension.shape);
    hash.add(extension.centre);
  }
  hash.add(organ.refused_details.has_value());
  if (organ.refused_details)
    for (int detail : *organ.refused_details) hash.add(detail);
}

void add_tissue(Hash& hash, const Tissue& tissue) {
  add_vector(hash, tissue.now.state.x);
  if (tissue.now.state.motion.duration > 0) add_motion(hash, tissue.now.state.motion);
  for (double opened : tissue.now.opened) hash.add(opened);
  for (std::size_t i = 0; i < tissue.now.heated.size(); ++i) {
    if (tissue.now.heated[i] == 0) continue;
    hash.add(i);
    hash.add(tissue.now.heated[i]);
  }
  hash.add(tissue.now.tearing);
}

void add_acts(Hash& hash, const Organ& organ) {
  for (const Clip& clip : organ.clips) {
    hash.add(static_cast<int>(clip.size));
    for (double v : {clip.at, clip.opening, clip.reach}) hash.add(v);
    add_point(hash, clip.legs);
    add_point(hash, clip.pressed);
  }
  for (int instrument : organ.unfelt) hash.add(instrument);
  for (const Opening& opening : organ.openings) {
    hash.add(opening.point);
    for (double v : {opening.area, opening.rate, opening.lost, opening.drop}) hash.add(v);
    hash.add(opening.leaks);
  }
  if (organ.left_in) hash.add(*organ.left_in);
}

void add_spill(Hash& hash, const Spill& spill) {
  for (const LostState& lost : spill.lost) {
    hash.add(lost.name);
    hash.add(lost.bile);
    hash.add(lost.blood);
  }
  for (const Drop& drop : spill.drops) {
    hash.add(static_cast<int>(drop.liquid));
    add_point(hash, drop.at);
    add_point(hash, drop.velocity);
    hash.add(drop.volume);
  }
  for (const Film& film : spill.films) {
    hash.add(film.on);
    for (const WetPoint& wet : film.wet) {
      hash.add(wet.point);
      for (double volume : wet.volume) hash.add(volume);
    }
  }
}

void add_stick_slip(Hash& hash, const StickSlip& hold) {
  hash.add(hold.limit);
  hash.add(hold.stiffness);
  add_point(hash, hold.anchor);
  add_point(hash, hold.normal);
}

void add_holds(Hash& hash, const Organ& organ) {
  for (const GripPoint& grip : organ.grips) {
    hash.add(grip.instrument);
    hash.add(grip.jaw);
    hash.add(grip.skin_point);
    add_point(hash, grip.local);
    hash.add(grip.stiffness);
  }
  for (const RubbingPoint& rubbing : organ.friction.points) {
    hash.add(rubbing.shape);
    hash.add(rubbing.point);
    add_stick_slip(hash, rubbing.hold);
  }
}

/// The factor that is kept serves the next steps, so their bits depend on it: what it makes of the constraints'
/// gradients, all together, stands for all of its entries, which would take a tenth of a step.
void add_factor(Hash& hash, const NewtonWorkspace& work) {
  hash.add(work.factored);
  hash.add(work.shifted);
  if (!work.factored) return;
  add_vector(hash, VecX(work.border.gradients.rowwise().sum()));
  add_vector(hash, VecX(work.border.answers.rowwise().sum()));
  add_vector(hash, work.border.complement);
}

void add_missed(Hash& hash, const MissedMotion& missed) {
  add_vector(hash, missed.dx);
  add_vector(hash, missed.dpressures);
  hash.add(missed.travel);
  hash.add(missed.iterations);
}

void add_rubbing(Hash& hash, const std::vector<SkinHold>& rubbing) {
  for (const SkinHold& held : rubbing) {
    hash.add(held.pair.point.body);
    hash.add(held.pair.point.row);
    hash.add(held.pair.on);
    for (const BodyPoint& point : held.place.points) {
      hash.add(point.body);
      hash.add(point.row);
    }
    hash.add(held.across);
    add_stick_slip(hash, held.hold);
  }
}

void add_pose(Hash& hash, const InstrumentPose& pose) {
  for (double v : {pose.pitch, pose.yaw, pose.insertion, pose.roll, pose.jaw}) hash.add(v);
}

void add_tool(Hash& hash, const Tool& tool) {
  const int grip = (tool.slipping ? 1 : 0) | (tool.lost ? 2 : 0) | (tool.beside ? 4 : 0) |
                   static_cast<int>(tool.action) << 3 | (tool.has_cut ? 64 : 0);
  hash.add(tool.jaw_stopped);
  hash.add(static_cast<unsigned char>(grip));
  if (has_action(tool.definition.type, InstrumentAction::fire)) hash.add(tool.clips);
  hash.add(tool.touched);
  hash.add(tool.over_limit);
  if (tool.dry > 0) hash.add(tool.dry);
  if (tool.on_clip || tool.beside_kept)
    hash.add(static_cast<unsigned char>((tool.on_clip ? 1 : 0) | (tool.beside_kept ? 2 : 0)));
  if (tool.burnt > 0) {
    hash.add(tool.burnt);
    hash.add(tool.burnt_record);
  }
  add_pose(hash, tool.pose);
}

void add_place(Hash& hash, const CarriedPlace& place) {
  for (int point : place.points) hash.add(point);
  for (double weight : place.weights) hash.add(weight);
}

/// Who is there, where that is not who the scene has.
void add_members(Hash& hash, const Field& field) {
  if (is_as_in_scene(field)) return;
  for (const Organ& organ : field.organs) {
    hash.add(organ.definition.name);
    add_vector(hash, organ.body->rest());
  }
  for (const FieldJoint& joint : field.membership.joints) {
    const JointLinks& links = joint.joint->links();
    for (int body : links.bodies) hash.add(body);
    hash.add(links.stiffness);
    for (const JointLinks::Link& link : links.links) {
      add_place(hash, link.one);
      add_place(hash, link.other);
      hash.add(link.length);
    }
  }
  for (const TiedPlace& tied : field.membership.tied) {
    for (int body : tied.bodies) hash.add(body);
    add_point(hash, tied.place.place);
    hash.add(tied.place.within);
  }
}

}  // namespace

std::uint64_t World::Impl::hash_field() const {
  Hash hash;
  add_members(hash, field);
  for (const Organ& organ : field.organs) {
    add_body_state(hash, organ);
    add_holds(hash, organ);
    add_acts(hash, organ);
  }
  for (const Tissue& tissue : field.tissues) add_tissue(hash, tissue);
  add_missed(hash, field.group.missed);
  add_rubbing(hash, field.group.rubbing);
  add_factor(hash, field.group.work);
  for (const Tool& tool : field.tools) add_tool(hash, tool);
  add_spill(hash, field.spill);
  return hash.value();
}

/// The hash knows a factor only by what it makes of one vector.
bool World::Impl::same_factors(const FieldState& state) const {
  return field.group.work.factor.shares_factor_with(state.group.factor.factor);
}

std::uint64_t World::Impl::hash(std::uint64_t of_field) const {
  Hash hash;
  hash.add(of_field);
  hash.add(steps);
  const InstrumentPose& scope = report.laparoscope.pose;
  if (scope != laparoscope.start()) add_pose(hash, scope);
  return hash.value();
}

void World::Impl::place_laparoscope(const InstrumentPose& pose) {
  report.laparoscope.pose = pose;
  report.laparoscope.view = laparoscope.view(pose);
  report.laparoscope.distance = pose == laparoscope.start()
                                    ? scene.laparoscope.distance
                                    : (looked_at - report.laparoscope.view.position).norm();
}

InstrumentState World::Impl::instrument_state(std::size_t index, const ToolLoad& load) const {
  const Tool& tool = field.tools[index];
  InstrumentState state;
  state.pose = tool.pose;
  state.tip = tip_position(tool.trocar, tool.pose, tool.geometry);
  state.tip_force = load.force;
  // The force at the tip that has the same moment about the trocar: what touches the shaft has a shorter
  // lever.
  const Vec3 arm = state.tip - tool.trocar, axis = arm.normalized();
  const Vec3 at_tip = axis * axis.dot(load.force) + load.moment.cross(axis) / arm.norm();
  state.handle_force = handle_force(tool.trocar, tool.pose, tool.geometry, at_tip);
  for (const Organ& organ : field.organs) {
    const int held = grip_count(organ, static_cast<int>(index));
    state.grip_points += held;
    if (held > 0 && tool.jaw_stopped && state.holds.empty()) state.holds = organ.definition.name;
  }
  state.clips = tool.clips;
  state.touching = load.touches > 0;
  state.parts = load.parts;
  const bool closed = tool.pose.jaw <= 0.5 * grip_grid;
  const bool touches_jaws = load.parts[static_cast<std::size_t>(ToolPart::jaws)].touches > 0;
  if (!state.holds.empty()) {
    state.grip = GripState::holding;
  } else if (tool.lost) {
    state.grip = GripState::slipped;
  } else if (closed) {
    state.grip = tool.beside || touches_jaws ? GripState::beside : GripState::empty;
  }
  return state;
}

OrganState World::Impl::organ_state(const Organ& organ) const {
  OrganState state;
  state.name = organ.definition.name;
  state.record = organ.record;
  const VecX& x = organ.state.x;
  if (const Liquid* liquid = organ.body->liquid()) {
    state.pressure = liquid->pressure_at_top(x, organ.state.datum_pressure);
    state.volume = liquid->volume(x);
  }
  if (const RodBody* rod = rod_of(organ))
    for (const Clip& clip : organ.clips)
      state.clips.push_back({clip.size, rod->share_at(clip.at), clip.opening});
  state.energy = organ.body->strain_energy(x);
  state.max_stretch = organ.body->max_stretch(x);
  state.extensions = static_cast<int>(organ.extensions.size());
  state.details = static_cast<int>(organ.body->details().size());
  return state;
}

namespace {

/// Those of one name are pieces of one tissue, whose organ was divided.
std::vector<TissueState> tissue_states(const Field& field) {
  std::vector<TissueState> out;
  for (const Tissue& tissue : field.tissues) {
    const auto same = [&](const TissueState& state) { return state.name == tissue.definition.name; };
    auto at = std::find_if(out.begin(), out.end(), same);
    if (at == out.end()) at = out.insert(out.end(), {tissue.definition.name, 0, 0});
    at->strands += static_cast<int>(tissue.now.opened.size());
    at->torn += tissue.torn();
  }
  return out;
}

}  // namespace

namespace {

/// Where an instrument is pressed hardest, m; none where it touches nothing.
std::optional<Vec3> touched_place(const InstrumentState& state) {
  const PartLoad* hardest = nullptr;
  for (const PartLoad& load : state.parts)
    if (load.touches > 0 && (hardest == nullptr || load.largest > hardest->largest)) hardest = &load;
  return hardest == nullptr ? std::nullopt : std::optional<Vec3>(hardest->at);
}

/// Walls that are stretched so far that they open, or too far, since this step.
void judge_stretch(const Field& field, const std::vector<OrganState>& before,
                   const std::vector<OrganState>& now, std::vector<WorldEvent>& events) {
  for (std::size_t k = 0; k < now.size(); ++k) {
    const OrganDefinition& organ = field.organs[k].definition;
    const auto begins = [&](double limit) {
      return now[k].max_stretch > limit &&
             std::none_of(before.begin(), before.end(), [&](const OrganState& one) {
               return one.record == now[k].record && one.max_stretch > limit;
             });
    };
    if (begins(organ.wall.overstretch))
      events.push_back({EventKind::overstretch, 0, "", organ.name, now[k].max_stretch});
    if (is_hollow(organ.shape) && begins(organ.wall.perforation_stretch))
      events.push_back({EventKind::perforation, 0, "", organ.name, 0, std::nullopt, EventCause::stretch});
  }
}

}  // namespace

void World::Impl::observe(std::vector<WorldEvent> events, const std::vector<InstrumentAction>& actions) {
  const std::vector<ToolLoad> loads = tool_loads(field);
  report.time = time();
  report.instruments.clear();
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    report.instruments.push_back(instrument_state(i, loads[i]));
  const std::vector<OrganState> before = std::exchange(report.organs, {});
  for (const Organ& organ : field.organs) report.organs.push_back(organ_state(organ));

  // Events are raised when a condition begins, not while it lasts.
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const InstrumentState& state = report.instruments[i];
    const std::string& organ = loads[i].organ;
    if (state.touching && !tool.touched)
      events.push_back({EventKind::contact, 0, tool.definition.name, organ, 0, touched_place(state)});
    const InstrumentAction asked = actions.empty() ? InstrumentAction::none : actions[i];
    if (asked == InstrumentAction::activate && tool.action != asked)
      events.push_back({EventKind::activation, 0, tool.definition.name, organ, 0, touched_place(state)});
    tool.action = report.instruments[i].action = asked;
    const double force = state.tip_force.norm();
    const bool over = force > tool.definition.force_limit;
    if (over && !tool.over_limit)
      events.push_back({EventKind::overforce, 0, tool.definition.name, organ, force, touched_place(state)});
    tool.touched = state.touching;
    tool.over_limit = over;
  }
  for (const WorldEvent& event : apply_current(field, report.instruments, 1 / scene.solver.rate))
    events.push_back(event);
  report.tissues = tissue_states(field);
  report.lost = field.spill.lost;
  judge_stretch(field, before, report.organs, events);
  for (WorldEvent& event : events) {
    event.time = report.time;
    for (std::size_t i = 0; i < field.tools.size() && !event.place; ++i)
      if (field.tools[i].definition.name == event.instrument) event.place = report.instruments[i].tip;
  }
  report.events = std::move(events);
  field_hash = hash_field();
  report.state_hash = hash(field_hash);
}

namespace {

constexpr double waiting_depth = 30e-3;  // m: a tool in its trocar before its first move

}  // namespace

namespace {

/// Hollow organs have come to rest alone: what is tied to them, or has no rest of its own, moves them on. Without
/// friction, whose anchors belong to shapes that the tools' will come before.
Result<bool> bring_to_rest_together(Field& field, const AnatomyDefinition& anatomy, bool dynamic) {
  bool released = false;
  for (Organ& organ : field.organs) {
    const Result<bool> let_go = release_filled(organ);
    if (!let_go) return let_go.failure();
    released |= let_go.value();
  }
  if (released) field.group.forget_bodies();
  const bool alone = anatomy.joints.empty() && field.tissues.empty() && !released &&
                     std::all_of(field.organs.begin(), field.organs.end(),
                                 [](const Organ& organ) { return is_hollow(organ.definition.shape); });
  if (alone) return true;
  SolveStatistics statistics;
  const std::vector<Ground> rough = field.ground;
  for (Ground& ground : field.ground) ground.friction = 0;
  field.group.friction = 0;
  const GroupSnapshot before = snapshot(field);
  Result<bool> rested = settle_field(field, "at rest", statistics);
  if (!rested && dynamic) {
    restore(field, before);
    rested = sink_field(field, statistics);
  }
  field.ground = rough;
  field.group.friction = anatomy.friction;
  if (!rested) return rested;
  for (Organ& organ : field.organs) {
    const ShellBody* shell = shell_of(organ);
    if (shell == nullptr) continue;
    ShellBody at_rest = *shell;
    at_rest.keep_in_equilibrium(organ.state);
    organ.body = std::make_shared<const ShellBody>(std::move(at_rest));
  }
  return true;
}

}  // namespace

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::create(const SceneDefinition& scene, const std::atomic<bool>* stop, int threads) {
  std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  auto impl = std::make_unique<Impl>(threads);
  impl->scene = scene;
  if (impl->scene.ports.empty()) impl->scene.ports = default_ports();
  impl->up = up_direction(scene.anatomy);
  impl->field.tolerance = scene.solver.tolerance;
  if (scene.solver.motion == SolverMotion::dynamics) impl->field.step_time = 1 / scene.solver.rate;
  impl->field.scheme = scene.solver.extension_scheme;
  impl->field.ground = ground_of(scene.anatomy);
  ContactLoads still;
  for (const Ground& ground : impl->field.ground) still.shapes.push_back(contact_shape(ground.shape));
  FillingLimits limits{stop};
  limits.sinks = scene.solver.motion == SolverMotion::dynamics;
  for (std::size_t k = 0; k < scene.anatomy.organs.size(); ++k) {
    const OrganDefinition& definition = scene.anatomy.organs[k];
    Result<RestedOrgan> made = make_organ(definition, still, impl->up, scene.solver.tolerance,
                                          definition.extensions ? scene.solver.extension_levels : 0, &limits);
    if (made) {
      impl->field.add(std::move(made).value());
      continue;
    }
    Failure failure = at_organ(made.failure(), k);
    if (failure.kind != FailureKind::scenario) return failure;
    problems.insert(problems.end(), failure.problems.begin(), failure.problems.end());
  }
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  if (Result<bool> joined = join_bodies(scene.anatomy, impl->field); !joined) return joined.failure();
  if (Result<bool> made = add_tissues(scene.anatomy, impl->up, impl->field); !made) return made.failure();
  if (Result<bool> rested = bring_to_rest_together(impl->field, scene.anatomy, limits.sinks); !rested)
    return rested.failure();
  impl->field.up = impl->up;
  impl->field.heart_rate = scene.anatomy.heart_rate;
  if (!impl->field.organs.empty())
    impl->field.middle = impl->field.organs[0].body->skin_point(0, impl->field.organs[0].state.x);
  World world(std::move(impl));
  for (const InstrumentDefinition& definition : scene.instruments) {
    Tool tool;
    tool.definition = definition;
    tool.geometry = instrument_geometry(definition.type);
    tool.trocar = world.port_position(definition.port);
    if (has_action(definition.type, InstrumentAction::fire)) tool.clips = definition.clips;
    // Waiting in the trocar, closed, pointing at the first organ, just far enough in to be seen to come.
    const Vec3 aim = world.impl_->field.organs.empty() ? Vec3(tool.trocar - Vec3::UnitZ())
                                                       : Vec3(world.skin_positions(0).front());
    tool.pose = pose_reaching(tool.trocar, aim, 0.0, 0.0, tool.geometry);
    tool.pose.insertion = waiting_depth;
    world.impl_->field.tools.push_back(tool);
  }
  if (scene.laparoscope.distance < scene.solver.extension_view) {
    const auto [organ, skin_point] = find_landmark(world.impl_->field.organs, scene.laparoscope.look_at);
    if (skin_point >= 0) world.impl_->field.viewed = ViewedPlace{organ, skin_point};
    SolveStatistics statistics;
    for (Organ& each : world.impl_->field.organs) follow_contacts(world.impl_->field, each, statistics);
  }
  world.impl_->looked_at = world.landmark(scene.laparoscope.look_at);
  world.impl_->laparoscope =
      Laparoscope(scene.laparoscope, world.port_position(scene.laparoscope.port), world.impl_->looked_at);
  world.impl_->place_laparoscope(world.impl_->laparoscope.start());
  if (Result<bool> clear = check_clear(world.impl_->field); !clear) return clear.failure();
  world.impl_->field.membership.of_scene = world.impl_->field.organs.size();
  world.impl_->field.membership.scene_joints = world.impl_->field.membership.joints.size();
  keep_members(world.impl_->field);
  world.impl_->observe({}, {});
  return world;
}

Result<StepReport> World::step(const StepInput& input) {
  Impl& self = *impl_;
  if (self.failed) return self.failure;
  if (input.instruments.size() != self.field.tools.size())
    return fail(FailureKind::internal, fmt::format("a step needs {} instrument poses, not {}",
                                                   self.field.tools.size(), input.instruments.size()));
  if (!input.actions.empty() && input.actions.size() != self.field.tools.size())
    return fail(FailureKind::internal, fmt::format("a step needs {} actions or none, not {}",
                                                   self.field.tools.size(), input.actions.size()));
  for (std::size_t i = 0; i < self.field.tools.size(); ++i) {
    const Tool& tool = self.field.tools[i];
    if (std::optional<Failure> failure =
            check_pose(tool.definition.name, tool.geometry, input.instruments[i]))
      return *failure;
    if (input.actions.empty()) continue;
    if (std::optional<Failure> failure = check_action(tool.definition, input.actions[i])) return *failure;
  }
  if (input.laparoscope)
    if (std::optional<Failure> failure =
            check_pose(laparoscope_name, laparoscope_geometry(), *input.laparoscope))
      return *failure;
  self.report.statistics = {};
  if (self.scene.solver.skip_still && self.still == input) {
    ++self.steps;
    self.report.time = self.time();
    self.report.events.clear();
    self.report.state_hash = self.hash(self.field_hash);
    return self.report;
  }
  const FieldState before = state();
  const std::uint64_t hash_before = self.field_hash;
  self.field.time = static_cast<double>(self.steps + 1) / self.scene.solver.rate;
  const double duration = 1 / self.scene.solver.rate;
  const std::vector<WorldEvent> leaked = leak(self.field, duration);
  Result<std::vector<WorldEvent>> events = advance(self.field, input.instruments, self.report.statistics);
  if (!events) {
    self.failed = true;
    self.failure = events.failure();
    for (Problem& problem : self.failure.problems)
      problem.message +=
          fmt::format(", at {:.3f} s", static_cast<double>(self.steps + 1) / self.scene.solver.rate);
    calot::restore(self.field, before);
    return self.failure;
  }
  fire_clips(self.field, input.actions, events.value());
  events->insert(events->begin(), leaked.begin(), leaked.end());
  spill(self.field, duration);
  ++self.steps;
  if (input.laparoscope) self.place_laparoscope(*input.laparoscope);
  self.observe(std::move(events).value(), input.actions);
  self.still.reset();
  if (self.field_hash == hash_before && self.report.events.empty() && self.same_factors(before))
    self.still = input;
  return self.report;
}

const SceneDefinition& World::scene() const { return impl_->scene; }
const StepReport& World::report() const { return impl_->report; }
std::uint64_t World::state_hash() const { return impl_->hash(impl_->hash_field()); }

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
  self.field_hash = self.hash_field();
  self.still.reset();
  self.failed = false;
  return true;
}
Vec3 World::up() const { return impl_->up; }
const Field& World::field() const { return impl_->field; }

Vec3 World::port_position(const std::string& port) const {
  for (const PortDefinition& p : impl_->scene.ports)
    if (p.name == port) return p.position;
  unknown_name("port", port);
}

namespace {

/// Where a landmark is, or was last.
SkinPlace skin_place(const Field& field, const std::string& name) {
  const auto [organ, skin_point] = find_landmark(field.organs, name);
  if (skin_point >= 0) {
    const Organ& at = field.organs[organ];
    return {at.body->surface_point(skin_point, at.state.x), at.body->skin_normals(at.state.x)[skin_point]};
  }
  const std::size_t dot = name.rfind('.');
  const BodyRecord* record = dot == std::string::npos ? nullptr : gone_body(field, name.substr(0, dot));
  if (record == nullptr || !record->gone->landmarks.contains(name.substr(dot + 1)))
    unknown_name("landmark", name);
  return record->gone->landmarks.at(name.substr(dot + 1));
}

}  // namespace

Vec3 World::landmark(const std::string& name) const { return skin_place(impl_->field, name).at; }
Vec3 World::landmark_normal(const std::string& name) const { return skin_place(impl_->field, name).normal; }

double World::seen_area(const std::array<Vec3, 3>& corners) const {
  constexpr double margin = 2e-3;  // m: as thick as what such a triangle is stretched between
  return calot::seen_area(impl_->field, impl_->report.laparoscope.view,
                          impl_->scene.laparoscope.field_of_view, corners, margin);
}

CriticalView World::critical_view(const CriticalViewQuestion& question) const {
  const HepatocysticTriangle triangle{landmark(question.neck), landmark(question.junction),
                                      landmark(question.hilum)};
  return calot::critical_view(impl_->field, triangle, impl_->report.laparoscope.view.position, question);
}

const Tessellation& World::skin(int organ) const { return impl_->field.organs[organ].body->skin(); }
std::vector<Vec3> World::skin_positions(int organ) const {
  return impl_->field.organs[organ].body->skin_positions(impl_->field.organs[organ].state.x);
}
std::vector<Vec3> World::skin_normals(int organ) const {
  return impl_->field.organs[organ].body->skin_normals(impl_->field.organs[organ].state.x);
}
const std::vector<Triangle>& World::drawn_triangles(int organ) const {
  return impl_->field.organs[organ].body->drawn_triangles();
}
const std::vector<Vec3>& World::drawn_rest(int organ) const {
  return impl_->field.organs[organ].body->drawn_rest();
}
DrawnSurface World::drawn(int organ) const {
  return impl_->field.organs[organ].body->drawn(impl_->field.organs[organ].state.x);
}

Result<double> World::lowest_frequency(int index) const {
  const Organ& organ = impl_->field.organs[index];
  const ShellBody* shell = shell_of(organ);
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
  report.organs.clear();
  for (const Organ& organ : field.organs) report.organs.push_back(organ_state(organ));
  report.tissues = tissue_states(field);
  const std::vector<ToolLoad> loads = tool_loads(field);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    report.instruments[i] = instrument_state(i, loads[i]);
    report.instruments[i].action = field.tools[i].action;
  }
  field_hash = hash_field();
  report.state_hash = hash(field_hash);
  still.reset();
  return done;
}

Result<int> World::organ(const std::string& name) const { return find_body(impl_->field, name); }
Result<int> World::organ(const BodyHandle& handle) const { return find_body(impl_->field, handle); }
BodyHandle World::handle(int organ) const { return handle_of(impl_->field, organ); }

Result<Division> World::divide(const std::string& name, double share) {
  const Result<int> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was divided", name),
                       [&] { return divide_body(impl_->field, organ.value(), share, impl_->time()); });
}

Result<bool> World::remove(const std::string& name, const std::string& why) {
  const Result<int> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was removed", name),
                       [&] { return remove_body(impl_->field, organ.value(), why, impl_->time()); });
}

Result<int> World::add(const OrganDefinition& definition) {
  if (std::vector<Problem> problems = validate(definition); !problems.empty())
    return Failure{FailureKind::scenario, std::move(problems)};
  const SolverDefinition& solver = impl_->scene.solver;
  ContactLoads still;
  for (const Ground& ground : impl_->field.ground) still.shapes.push_back(contact_shape(ground.shape));
  FillingLimits limits;
  limits.sinks = solver.motion == SolverMotion::dynamics;
  const OrganSetting setting{still, impl_->up, solver.tolerance,
                             definition.extensions ? solver.extension_levels : 0, &limits};
  Result<int> added = impl_->change(fmt::format("after '{}' came", definition.name),
                                    [&] { return add_body(impl_->field, definition, setting); });
  if (added) return added;
  Failure failure = added.failure();
  for (Problem& problem : failure.problems)  // of its definition
    if (problem.place.path.starts_with('.')) problem.place.path.insert(0, "organ");
  return failure;
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
  const Result<int> first = organ(one), second = organ(other);
  if (!first) return first.failure();
  if (!second) return second.failure();
  return impl_->change(fmt::format("after '{}' and '{}' were untied", one, other),
                       [&] { return untie_bodies(impl_->field, first.value(), second.value()); });
}

Result<Vec3> World::place(const std::string& name) const {
  const std::size_t dot = name.rfind('.');
  if (find_landmark(impl_->field.organs, name).second >= 0) return landmark(name);
  if (dot != std::string::npos && gone_body(impl_->field, name.substr(0, dot)) != nullptr)
    if (const Result<int> there = organ(name.substr(0, dot)); !there) return there.failure();
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
