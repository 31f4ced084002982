#include "lua/demo_script.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "acts/exchange.h"
#include "base/units.h"
#include "script/lua_headers.h"

namespace calot {
namespace {

constexpr double slack = 1e-9;               // s: what a sum of steps may be off
constexpr double jaw_duration = 0.5;         // s to open or close
constexpr double least_insertion = 25e-3;    // m: the jaws and a little more, out of the port
constexpr double dry_motion_duration = 0.1;  // s: what a motion counts for in a dry run

}  // namespace

DemoScript::DemoScript(Sandbox& sandbox, const ExerciseDefinition& exercise, int function,
                       const Parameters& parameters, std::vector<Problem>* problems)
    : ScriptSession(sandbox, exercise, "Demo", "DemoInstrument", parameters, problems), function_(function) {
  for (const InstrumentDefinition& instrument : exercise.scene.instruments)
    waits_.push_back(instrument.waits ? 1 : 0);
  waits_.push_back(0);
}

double DemoScript::time() const {
  if (checking()) return dry_time();
  return running_ >= 0 ? tasks_[static_cast<std::size_t>(running_)].clock : step_start_;
}

// ---- running

std::optional<Failure> DemoScript::start() {
  Result<lua_State*> thread = start_main(function_);
  if (!thread) return thread.failure();
  Task root;
  root.thread = thread.value();
  root.arguments = 2;
  root.clock = step_start_;
  tasks_.push_back(root);
  return std::nullopt;
}

std::optional<Failure> DemoScript::run_dry(const World* world) {
  if (function_ == 0) return std::nullopt;
  set_world(world);
  if (world != nullptr) make_paths(*world);
  std::optional<Failure> failure = start();
  if (!failure) failure = resume(0);
  end("it belonged to a dry run");
  return failure;
}

void DemoScript::make_paths(const World& world) {
  for (std::size_t i = 0; i < scene().instruments.size(); ++i) {
    paths_.emplace_back(world.port_position(scene().instruments[i].port), world.report().instruments[i].pose,
                        geometry(static_cast<int>(i)));
  }
  flows_.resize(paths_.size());
  fires_.resize(paths_.size());
  comings_.resize(paths_.size());
  paths_.emplace_back(world.laparoscope().port(), world.report().laparoscope.pose, geometry(laparoscope()));
}

Result<std::optional<StepInput>> DemoScript::next(const World& world, double dt) {
  if (function_ == 0 || (!tasks_.empty() && tasks_.front().state == Task::finished)) return {std::nullopt};
  sandbox().set_time(world.report().time);
  const Sandbox::Call call(sandbox());
  set_world(&world);
  step_start_ = world.report().time;
  const double end = step_start_ + dt;
  std::optional<Failure> failure = check_exchanges(world);
  if (!failure && tasks_.empty()) {
    make_paths(world);
    failure = start();
  }
  if (!failure) failure = ask_conditions(step_start_);
  if (!failure) failure = run_until(end);
  set_world(nullptr);
  if (failure) return *failure;
  StepInput input;
  for (std::size_t i = 0; i < scene().instruments.size(); ++i) {
    const InstrumentState& state = world.report().instruments[i];
    input.instruments.push_back(state.waits ? state.pose : paths_[i].pose(end));
  }
  // A pose that is made of its place anew differs by rounding: what was never moved stays where it is.
  if (const InstrumentPose pose = paths_.back().pose(end);
      paths_.back().busy_until() > 0 && pose != world.report().laparoscope.pose)
    input.laparoscope = pose;
  input.actions = actions(end);
  input.acts = std::exchange(acts_, {});
  return {std::optional<StepInput>(std::move(input))};
}

/// Tasks that wait for a condition are woken when it holds now.
std::optional<Failure> DemoScript::ask_conditions(double now) {
  for (Task& task : tasks_) {
    if (task.state != Task::condition || task.clock > now + slack) continue;
    bool answer = false;
    std::optional<Failure> failure =
        sandbox().protect([&](lua_State* L) { answer = ask_condition(L, task.predicate); });
    if (failure) return sandbox().laid_at(*failure, task.predicate);
    if (!end_condition(task, answer, now)) continue;
    luaL_unref(sandbox().state(), LUA_REGISTRYINDEX, task.predicate);
    task.clock = now;
    task.state = Task::ready;
  }
  return std::nullopt;
}

bool DemoScript::end_condition(Task& task, bool answer, double now) {
  const bool arrived = task.moving >= 0 && now >= task.arrives - slack;
  if (!answer && !arrived) return false;
  lua_pushboolean(task.thread, answer);
  task.arguments = 1;
  if (task.moving < 0) return true;
  InstrumentPath& path = paths_[static_cast<std::size_t>(task.moving)];
  path.halt(now);
  if (task.active) flows_[static_cast<std::size_t>(task.moving)].to = now;
  lua_pushnumber(task.thread, (path.tip() - task.moved_from).norm());
  task.arguments = 2;
  task.moving = -1;
  return true;
}

/// Runs what is due before `end`, earliest first.
std::optional<Failure> DemoScript::run_until(double end) {
  for (int waits = 0;; ++waits) {
    std::size_t first = tasks_.size();
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      const bool due = tasks_[i].state == Task::ready || tasks_[i].state == Task::until;
      if (!due || tasks_[i].clock > end + slack) continue;
      if (first == tasks_.size() || tasks_[i].clock < tasks_[first].clock) first = i;
    }
    if (first == tasks_.size()) return std::nullopt;
    if (waits > most_waits_per_step)
      return fail(FailureKind::resource, waits_message(), waits_hint(),
                  sandbox().blame(tasks_[first].thread).place);
    if (std::optional<Failure> failure = resume(first)) return failure;
    // A condition that begins at this step's very start is asked at once, like any met there.
    if (std::optional<Failure> failure = ask_conditions(step_start_)) return failure;
  }
}

std::optional<Failure> DemoScript::resume(std::size_t index) {
  running_ = static_cast<int>(index);
  tasks_[index].state = Task::ready;
  Result<bool> finished = sandbox().resume(tasks_[index].thread, std::exchange(tasks_[index].arguments, 0));
  running_ = -1;
  if (!finished) return finished.failure();
  if (finished.value()) {
    finish(index);
  } else if (tasks_[index].state == Task::ready && !checking()) {
    return fail(FailureKind::scenario, "the demo called coroutine.yield", "wait with t:wait or t:wait_until",
                sandbox().blame(tasks_[index].thread).place);
  }
  return std::nullopt;
}

void DemoScript::finish(std::size_t index) {
  tasks_[index].state = Task::finished;
  const int parent = tasks_[index].parent;
  if (parent < 0) {
    if (!checking()) end(fmt::format("the demo had ended at {:g} s", tasks_[index].clock));
    return;
  }
  Task& waiting = tasks_[static_cast<std::size_t>(parent)];
  waiting.clock = std::max(waiting.clock, tasks_[index].clock);
  if (--waiting.open_children == 0) waiting.state = Task::ready;
}

// ---- methods

int DemoScript::task_of(lua_State* L) const {
  for (std::size_t i = 0; i < tasks_.size(); ++i)
    if (tasks_[i].thread == L) return static_cast<int>(i);
  return -1;
}

DemoScript::Task* DemoScript::current(lua_State* L) {
  const int task = task_of(L);
  if (task >= 0 && task == running_) return &tasks_[static_cast<std::size_t>(task)];
  complain(L, "the demo moves and waits in its own coroutine only",
           "not inside a predicate or another coroutine");
  return nullptr;
}

int DemoScript::dry_wait(lua_State* L, std::optional<double> duration) {
  if (current(L) == nullptr) return 0;
  if (end_dry_run(L, duration)) return lua_yield(L, 0);
  lua_pushboolean(L, 1);
  return 1;
}

int DemoScript::sleep_until(lua_State* L, double time) {
  Task* task = current(L);
  if (task == nullptr) return 0;
  task->clock = time;
  if (checking()) return dry_wait(L, dry_motion_duration);
  task->state = Task::until;
  return lua_yield(L, 0);
}

int DemoScript::wait(lua_State* L, double duration) {
  if (current(L) == nullptr) return 0;
  if (checking()) return dry_wait(L, duration);
  return sleep_until(L, current(L)->clock + duration);
}

int DemoScript::wait_until(lua_State* L, int predicate) {
  Task* task = current(L);
  if (task == nullptr) return 0;
  if (checking()) {
    ask_dry(L, predicate);
    return dry_wait(L, std::nullopt);
  }
  task->predicate = predicate;
  task->state = Task::condition;
  return lua_yield(L, 0);
}

int DemoScript::together(lua_State* L) {
  if (current(L) == nullptr) return 0;
  const std::size_t parent = static_cast<std::size_t>(running_);
  const int count = lua_gettop(L) - 1;
  for (int i = 0; i < count; ++i) {
    Task child;
    child.thread = sandbox().adopt_thread(L);
    child.parent = static_cast<int>(parent);
    child.clock = tasks_[parent].clock;
    lua_pushvalue(L, i + 2);
    lua_xmove(L, child.thread, 1);
    tasks_.push_back(child);
  }
  tasks_[parent].open_children = count;
  tasks_[parent].state = Task::children;
  if (checking()) return run_children_dry(L, tasks_.size() - static_cast<std::size_t>(count));
  return lua_yield(L, 0);
}

/// One after the other, whatever becomes of each.
int DemoScript::run_children_dry(lua_State* L, std::size_t first) {
  const int parent = running_;
  for (std::size_t i = first; i < tasks_.size() && tasks_[i].parent == parent; ++i) {
    const std::optional<Failure> failure = resume(i);
    running_ = parent;
    if (!failure || is_no_mistake(*failure)) continue;
    sandbox().charge(L, 0);  // raises what no script survives
    for (const Problem& problem : failure->problems) problems()->push_back(problem);
  }
  tasks_[static_cast<std::size_t>(parent)].state = Task::ready;
  return dry_wait(L, std::nullopt);
}

std::optional<Vec3> DemoScript::known_tip(int instrument) const {
  if (paths_.empty()) return std::nullopt;
  return paths_[static_cast<std::size_t>(instrument)].tip();
}

InstrumentPath* DemoScript::free_path(lua_State* L, int instrument) {
  const Task* task = current(L);
  if (task == nullptr) return nullptr;
  InstrumentPath& path = paths_[static_cast<std::size_t>(instrument)];
  if (path.busy_until() <= task->clock + slack) return &path;
  complain(L, "this instrument is being moved by another function of t:together",
           "move each instrument in one of them");
  return nullptr;
}

InstrumentGeometry DemoScript::geometry(int instrument) const {
  if (instrument == laparoscope()) return laparoscope_geometry();
  return instrument_geometry(scene().instruments[static_cast<std::size_t>(instrument)].type);
}

bool DemoScript::can_reach(lua_State* L, const InstrumentPath& path, const Vec3& tip) {
  using units::mm;
  const double distance = (tip - path.trocar()).norm();
  const double most = path.geometry().max_insertion;
  if (distance >= least_insertion && distance <= most) return true;
  if (checking() && stood_in()) return true;  // it may never go there
  complain(
      L,
      fmt::format("the tip cannot go to ({:.1f}, {:.1f}, {:.1f}) mm: that is {:.0f} mm from its port",
                  tip.x() / mm, tip.y() / mm, tip.z() / mm, distance / mm),
      fmt::format("stay between {:.0f} and {:.0f} mm, or use another port", least_insertion / mm, most / mm));
  return false;
}

bool DemoScript::can_open(lua_State* L, int instrument, double jaw) {
  const double most = geometry(instrument).jaw_opening;
  if (jaw <= most + slack) return true;
  const InstrumentDefinition& definition = scene().instruments[static_cast<std::size_t>(instrument)];
  complain(L,
           fmt::format("{} cannot open by {:.0f} degrees: a {} opens by {:.0f}", definition.name,
                       jaw / units::deg, to_text(definition.type), most / units::deg),
           "give a smaller angle, or none: as far as it opens");
  return false;
}

int DemoScript::in_port_of(int waiting) const {
  const std::vector<InstrumentDefinition>& all = scene().instruments;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (waits_[i] == 0 && all[i].port == all[static_cast<std::size_t>(waiting)].port)
      return static_cast<int>(i);
  return waiting;
}

bool DemoScript::is_in_port(lua_State* L, int instrument) {
  if (!waits(instrument)) return true;
  const std::vector<InstrumentDefinition>& all = scene().instruments;
  const std::string& name = all[static_cast<std::size_t>(instrument)].name;
  complain(L,
           fmt::format("{} waits outside: {} is in its port", name,
                       all[static_cast<std::size_t>(in_port_of(instrument))].name),
           fmt::format("have it come in first: t.{}:exchange()", name));
  return false;
}

template <typename Motion>
int DemoScript::play_motion(lua_State* L, int instrument, double dry_duration, const Motion& motion) {
  if (!is_in_port(L, instrument)) return 0;
  if (checking() && !has_world()) return dry_wait(L, dry_duration);
  InstrumentPath* path = free_path(L, instrument);
  if (path == nullptr) return 0;
  const std::optional<double> end = motion(*path, current(L)->clock);
  return end ? sleep_until(L, *end) : 0;
}

int DemoScript::approach(lua_State* L, int instrument, const Approach& how) {
  if (how.jaw && !can_use_jaws(L, instrument, "approach's jaw")) return 0;
  if (!can_open(L, instrument, how.jaw.value_or(0))) return 0;
  const auto motion = [&](InstrumentPath& path, double now) -> std::optional<double> {
    const Vec3 normal = landmark_normal(L, how.landmark);
    const Vec3 open_tip = landmark(L, how.landmark) + how.offset - how.depth * normal;
    const double jaw = how.jaw.value_or(path.geometry().jaw_opening);
    const Vec3 tip = closed_tip(path.trocar(), open_tip, jaw, path.geometry());
    // Straight in at the end, halfway between the shaft's way and the skin's normal: both jaws come down
    // together.
    const Vec3 shaft = (tip - path.trocar()).normalized();
    const Vec3 outward = (normal - shaft).norm() > 1e-3 ? (normal - shaft).normalized() : normal;
    const Vec3 before = tip + how.clearance * outward;
    if (!can_reach(L, path, before) || !can_reach(L, path, tip)) return std::nullopt;
    if (path.geometry().has_jaws()) path.set_jaw(now, jaw, jaw_duration);
    path.move(now, before, how.speed);
    path.move(now, tip, how.speed);
    return path.busy_until();
  };
  return play_motion(L, instrument, dry_motion_duration, motion);
}

int DemoScript::set_jaw(lua_State* L, int instrument, const std::string& method,
                        std::optional<double> angle) {
  if (!can_use_jaws(L, instrument, method) || !can_open(L, instrument, angle.value_or(0))) return 0;
  return play_motion(L, instrument, dry_motion_duration, [&](InstrumentPath& path, double now) {
    path.set_jaw(now, angle.value_or(path.geometry().jaw_opening), jaw_duration);
    return path.busy_until();
  });
}

int DemoScript::move_to(lua_State* L, int instrument, const Vec3& tip, double speed) {
  const auto motion = [&](InstrumentPath& path, double now) -> std::optional<double> {
    const Vec3 closed = closed_tip(path.trocar(), tip, path.jaw(), path.geometry());
    if (!can_reach(L, path, closed)) return std::nullopt;
    path.move(now, closed, speed);
    return path.busy_until();
  };
  return play_motion(L, instrument, dry_motion_duration, motion);
}

int DemoScript::move_by(lua_State* L, int instrument, const Vec3& vector, double speed) {
  const auto motion = [&](InstrumentPath& path, double now) -> std::optional<double> {
    const Vec3 tip = path.tip() + vector;
    if (!can_reach(L, path, tip)) return std::nullopt;
    path.move(now, tip, speed);
    return path.busy_until();
  };
  return play_motion(L, instrument, dry_motion_duration, motion);
}

int DemoScript::look_at(lua_State* L, const LookAt& how) {
  const auto motion = [&](InstrumentPath& path, double now) -> std::optional<double> {
    const std::optional<InstrumentPose> pose = world(L).laparoscope().looking_at(how.place, how.distance);
    if (!pose) {
      complain(L,
               fmt::format("the laparoscope cannot look at it from {:.0f} mm: its port is nearer than that",
                           how.distance / units::mm),
               "give a smaller distance");
      return std::nullopt;
    }
    const Vec3 lens = tip_position(path.trocar(), *pose, path.geometry());
    if (!can_reach(L, path, lens)) return std::nullopt;
    path.move(now, lens, how.speed);
    // By the shorter way round.
    path.rotate(now, path.roll() + std::remainder(pose->roll - path.roll(), 2 * std::numbers::pi),
                default_turning_speed);
    return path.busy_until();
  };
  return play_motion(L, laparoscope(), dry_motion_duration, motion);
}

int DemoScript::dry_move_until(lua_State* L, const MoveUntil& how) {
  if (current(L) == nullptr) return 0;
  ask_dry(L, how.predicate);
  if (end_dry_run(L, dry_motion_duration)) return lua_yield(L, 0);
  lua_pushboolean(L, next_guess());
  lua_pushnumber(L, how.limit);
  return 2;
}

int DemoScript::move_until(lua_State* L, int instrument, const MoveUntil& how) {
  if (!is_in_port(L, instrument)) return 0;
  if (how.active && !can_act(L, instrument, InstrumentAction::activate, "move_until's active")) return 0;
  if (checking() && !has_world()) return dry_move_until(L, how);
  InstrumentPath* path = free_path(L, instrument);
  if (path == nullptr) return 0;
  Vec3 along = how.along;
  if (along.isZero()) along = path->tip() - path->trocar();
  if (!how.towards.empty()) along = landmark(L, how.towards) - tip(L, instrument);
  const Vec3 furthest = path->tip() + how.limit * along.normalized();
  if (!can_reach(L, *path, furthest)) return 0;
  Task& task = *current(L);
  task.moved_from = path->tip();
  path->move(task.clock, furthest, how.speed);
  if (checking()) {
    task.clock = path->busy_until();
    return dry_move_until(L, how);
  }
  task.moving = instrument;
  task.arrives = path->busy_until();
  task.active = how.active;
  if (how.active)
    flows_[static_cast<std::size_t>(instrument)] = {task.clock, task.arrives, InstrumentAction::activate};
  task.predicate = how.predicate;
  task.state = Task::condition;
  return lua_yield(L, 0);
}

int DemoScript::activate(lua_State* L, int instrument, double duration) {
  return act_for(L, instrument, InstrumentAction::activate, duration);
}

int DemoScript::aspirate(lua_State* L, int instrument, double duration) {
  return act_for(L, instrument, InstrumentAction::aspirate, duration);
}

int DemoScript::act_for(lua_State* L, int instrument, InstrumentAction action, double duration) {
  if (!can_act(L, instrument, action, to_text(action))) return 0;
  return play_motion(L, instrument, duration, [&](InstrumentPath&, double now) {
    flows_[static_cast<std::size_t>(instrument)] = {now, now + duration, action};
    return now + duration;
  });
}

int DemoScript::fire(lua_State* L, int instrument) {
  if (!can_act(L, instrument, InstrumentAction::fire, "fire")) return 0;
  constexpr double trigger = 0.3;  // s, to press it and to let it go
  return play_motion(L, instrument, trigger, [&](InstrumentPath&, double now) {
    fires_[static_cast<std::size_t>(instrument)] = now;
    return now + trigger;
  });
}

int DemoScript::exchange(lua_State* L, int instrument, const Exchange& how) {
  const auto i = static_cast<std::size_t>(instrument);
  if (!waits(instrument)) {
    complain(L, fmt::format("{} is in its port already", scene().instruments[i].name),
             "exchange is for an instrument that waits outside, as others of its port do at the start");
    return 0;
  }
  const auto there = static_cast<std::size_t>(in_port_of(instrument));
  if (checking() && !has_world()) {
    std::swap(waits_[i], waits_[there]);
    return dry_wait(L, how.duration);
  }
  InstrumentPath* leaving = free_path(L, static_cast<int>(there));
  if (leaving == nullptr) return 0;
  const Vec3 way = (leaving->tip() - leaving->trocar()).normalized();
  leaving->move(current(L)->clock, leaving->trocar() + port_depth * way, how.speed);
  if (leaving->jaw() > 0) leaving->set_jaw(leaving->busy_until(), 0, jaw_duration);
  const double out = leaving->busy_until();
  InstrumentPose pose = leaving->pose(out);
  pose.roll = pose.jaw = 0;
  paths_[i] = InstrumentPath(leaving->trocar(), pose, geometry(instrument));
  comings_[i] = Coming{out, sandbox().blame(L).place};
  std::swap(waits_[i], waits_[there]);
  return sleep_until(L, out + how.duration);
}

/// Those that were asked to come in with the last step have.
std::optional<Failure> DemoScript::check_exchanges(const World& world) {
  for (std::size_t i = 0; i < comings_.size(); ++i) {
    if (!comings_[i] || comings_[i]->at) continue;
    const Place place = comings_[i]->place;
    comings_[i].reset();
    if (!world.report().instruments[i].waits) continue;
    const std::string& name = scene().instruments[i].name;
    std::string why;
    for (const WorldEvent& event : world.report().events)
      if (event.kind == EventKind::blocked_exchange && event.instrument == name) why = event.text;
    return fail(FailureKind::scenario, fmt::format("{} cannot come in: {}", name, why),
                "let go of what is held, and draw the instrument back, before t." + name + ":exchange()",
                place);
  }
  return std::nullopt;
}

/// What each instrument does in the step that ends then: current or suction for a while, a trigger is pulled once.
std::vector<InstrumentAction> DemoScript::actions(double end) {
  std::vector<InstrumentAction> out;
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    const Flow& flow = flows_[i];
    const bool flows = flow.from < end - slack && end <= flow.to + slack;
    out.push_back(flows ? flow.action : InstrumentAction::none);
    if (fires_[i] && *fires_[i] < end - slack) {
      out.back() = InstrumentAction::fire;
      fires_[i].reset();
    }
    if (comings_[i] && comings_[i]->at && *comings_[i]->at < end - slack) {
      out.back() = InstrumentAction::exchange;
      comings_[i]->at.reset();
    }
  }
  return out;
}

/// In the step in which the calling function is.
void DemoScript::act(lua_State* L, EventKind kind, const std::string& text) {
  if (current(L) == nullptr) return;
  Result<SessionAct> act = read_session_act(to_text(kind), text);
  if (!act) return complain(L, act.failure());
  if (!checking()) acts_.push_back(std::move(act).value());
}

int DemoScript::rotate(lua_State* L, int instrument, double angle, double speed) {
  return play_motion(L, instrument, dry_motion_duration, [&](InstrumentPath& path, double now) {
    path.rotate(now, path.roll() + angle, speed);
    return path.busy_until();
  });
}

}  // namespace calot
