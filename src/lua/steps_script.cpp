#include "lua/steps_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/suggest.h"
#include "field/divide_body.h"
#include "script/lua_headers.h"
#include "session/metrics.h"

namespace calot {
namespace {

constexpr double slack = 1e-9;  // s: what a sum of steps may be off
constexpr std::size_t most_steps = 1000;

constexpr std::size_t most_notes = 1000, longest_note = 200, longest_unit = 20;  // what a report has room for

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

StepsScript::StepsScript(Sandbox& sandbox, const ExerciseDefinition& exercise, int function,
                         const Parameters& parameters, std::vector<Problem>* problems)
    : ScriptSession(sandbox, exercise, "Steps", "Instrument", parameters, problems), function_(function) {}

std::optional<Failure> StepsScript::start() {
  Result<lua_State*> thread = start_main(function_);
  if (!thread) return thread.failure();
  thread_ = thread.value();
  Result<bool> finished = sandbox().resume(thread_, 2);
  if (!finished) return finished.failure();
  finished_ = finished.value();
  return std::nullopt;
}

Result<StepsScript::Declared> StepsScript::run_dry() {
  declared_.later = ScriptSession::later_organs();
  if (std::optional<Failure> failure = start()) return *failure;
  declared_.complete = finished_;
  end("it belonged to a dry run");
  return declared_;
}

Result<bool> StepsScript::advance(World& world, Progress& progress, double dt) {
  if (finished_) return true;
  sandbox().set_time(world.report().time);
  const Sandbox::Call call(sandbox());
  set_world(&world);
  progress_ = &progress;
  changing_ = &world;
  Result<bool> result = false;
  if (thread_ == nullptr) {
    for (const std::string& hold : exercise().hold_names) progress.set_metric(hold + ".time_in_s", 0);
    now_ = world.report().time - dt;
    if (std::optional<Failure> failure = start()) result = *failure;
  }
  now_ = world.report().time;
  if (result) result = run();
  set_world(nullptr);
  progress_ = nullptr;
  changing_ = nullptr;
  return result;
}

/// Lets the coroutine run on as long as nothing makes it wait.
Result<bool> StepsScript::run() {
  for (int waits = 0; !finished_; ++waits) {
    // What is reached exactly at the limit is reached.
    Result<bool> over = is_over();
    if (!over) return over.failure();
    const bool answer = over.value();
    if (!answer && !pass_limit()) return false;
    if (waits >= most_waits_per_step)
      return fail(FailureKind::resource, waits_message(), waits_hint(), sandbox().blame(thread_).place);
    if (std::optional<Failure> failure = wake(answer)) return *failure;
  }
  progress_->end_step(now_, "done");
  end(fmt::format("steps had ended at {:g} s", now_));
  return true;
}

/// True when the running step's limit has passed just now: its wait ends unanswered.
bool StepsScript::pass_limit() {
  const StepRecord* step = progress_->running();
  if (step == nullptr || step->limit <= 0 || now_ < step->started + step->limit - slack) return false;
  progress_->end_step(now_, "timeout");
  timed_out_ = true;
  return true;
}

Result<bool> StepsScript::ask(int predicate) {
  bool answer = false;
  std::optional<Failure> failure =
      sandbox().protect([&](lua_State* L) { answer = ask_condition(L, predicate); });
  if (failure) return sandbox().laid_at(*failure, predicate);
  return answer;
}

Result<bool> StepsScript::is_over() {
  switch (wait_.kind) {
    case Wait::Kind::none:
      return fail(FailureKind::scenario, "steps called coroutine.yield",
                  "wait with t:wait, t:wait_until or t:hold", sandbox().blame(thread_).place);
    case Wait::Kind::time:
      return now_ >= wait_.until - slack;
    case Wait::Kind::condition:
      return timed_out_ ? Result<bool>(true) : ask(wait_.predicate);
    case Wait::Kind::hold:
      break;
  }
  Result<bool> inside = ask(wait_.predicate);
  if (!inside) return inside;
  if (inside.value()) {
    const auto before = progress_->metrics().find(wait_.metric);
    const double sum = before != progress_->metrics().end() ? before->second : 0;
    progress_->set_metric(wait_.metric, sum + (now_ - wait_.last));
    wait_.held += now_ - wait_.last;
  }
  wait_.last = now_;
  return wait_.held >= wait_.duration - slack;
}

std::optional<Failure> StepsScript::wake(bool answer) {
  if (wait_.predicate != 0) luaL_unref(sandbox().state(), LUA_REGISTRYINDEX, wait_.predicate);
  wait_ = {};
  lua_pushboolean(thread_, answer);
  Result<bool> finished = sandbox().resume(thread_, 1);
  if (!finished) return finished.failure();
  finished_ = finished.value();
  return std::nullopt;
}

// ---- methods

bool StepsScript::may_wait(lua_State* L, const char* method) {
  if (L == thread_ || (checking() && thread_ == nullptr)) return true;
  complain(L, fmt::format("t:{} was called inside a predicate or another coroutine", method),
           "call it in steps itself");
  return false;
}

bool StepsScript::is_name(lua_State* L, const std::string& what, const std::string& name) {
  FieldCheck check;
  if (check.identifier("", name, "a " + what)) return true;
  for (const Problem& problem : check.take()) complain(L, problem.message, problem.hint);
  return false;
}

int StepsScript::suspend(lua_State* L, Wait wait) {
  wait_ = std::move(wait);
  return lua_yield(L, 0);
}

int StepsScript::dry_wait(lua_State* L, std::optional<double> duration) {
  if (end_dry_run(L, duration)) return lua_yield(L, 0);
  lua_pushboolean(L, 1);
  return 1;
}

/// What a wait for a predicate returns without waiting: in a dry run, and once the step's limit has passed.
std::optional<int> StepsScript::answered_at_once(lua_State* L, int predicate) {
  if (checking()) {
    std::erase(declared_.waited, current_);
    ask_dry(L, predicate);
    return dry_wait(L, std::nullopt);
  }
  if (!timed_out_) return std::nullopt;
  lua_pushboolean(L, 0);
  return 1;
}

int StepsScript::wait(lua_State* L, double duration) {
  if (!may_wait(L, "wait")) return 0;
  if (checking()) return dry_wait(L, duration);
  Wait wait;
  wait.kind = Wait::Kind::time;
  wait.until = now_ + duration;
  return suspend(L, std::move(wait));
}

int StepsScript::wait_until(lua_State* L, int predicate) {
  if (!may_wait(L, "wait_until")) return 0;
  if (const std::optional<int> results = answered_at_once(L, predicate)) return *results;
  Wait wait;
  wait.kind = Wait::Kind::condition;
  wait.predicate = predicate;
  return suspend(L, std::move(wait));
}

void StepsScript::step(lua_State* L, const std::string& name, const std::string& title,
                       const StepOptions& options) {
  if (!may_wait(L, "step") || !is_name(L, "step", name)) return;
  if (declared_.steps.size() >= most_steps) {
    luaL_error(L, "more than %d steps", static_cast<int>(most_steps));
    std::abort();  // luaL_error does not return
  }
  std::vector<std::string> taken = {"total", "note"};
  for (const InstrumentDefinition& instrument : scene().instruments) taken.push_back(instrument.name);
  for (const OrganDefinition& organ : scene().anatomy.organs) taken.push_back(organ.name);
  if (contains(taken, name))
    return complain(L, fmt::format("a step cannot be called \"{}\": metrics of that name exist", name),
                    "rename the step");
  if (contains(declared_.steps, name))
    return complain(L, fmt::format("there is a step \"{}\" already", name), "give each step its own name");
  declared_.steps.push_back(name);
  declared_.waited.push_back(name);
  current_ = name;
  limit_ = options.limit;
  if (checking()) return;
  timed_out_ = false;
  progress_->begin_step(now_, name, title, options);
}

void StepsScript::note(lua_State* L, const std::string& name, const Value& value, const std::string& unit) {
  if (!is_name(L, "note", name)) return;
  Note note{now_, {}, name, {}, unit};
  switch (value.kind) {
    case Value::Kind::number:
      if (!std::isfinite(value.number))
        return complain(L, fmt::format("{} = {} cannot be noted", name, value.number),
                        "give a finite number");
      if (!contains(declared_.notes, name)) declared_.notes.push_back(name);
      note.value = value.number;
      break;
    case Value::Kind::boolean:
      note.value = value.boolean;
      break;
    case Value::Kind::text:
      note.value = value.text;
      break;
    default:
      return complain(L, fmt::format("{} cannot be noted as {}", name, name_of(value.kind)),
                      "give a number, a text, or true or false");
  }
  if (value.text.size() > longest_note || unit.size() > longest_unit)
    return complain(L, "this note is too long",
                    fmt::format("a text has up to {} bytes, a unit {}", longest_note, longest_unit));
  if (checking()) return;
  if (progress_->notes().size() >= most_notes)
    return complain(L, fmt::format("there are {} notes already", most_notes),
                    "note a value when it is final, not in every step of the simulation");
  progress_->add_note(std::move(note));
}

int StepsScript::count(lua_State* L, const std::string& event, const std::string& organ) {
  if (checking() && !organ.empty()) expect_place(L, organ);
  if (checking()) return next_guess() ? 100 : 0;  // more than any loop waits for, or none
  world(L);                                       // raises what is wrong outside of steps
  const std::vector<SessionEvent>& events = progress_->events();
  return static_cast<int>(std::count_if(
      events.begin(), events.end(), [&](const SessionEvent& one) { return is_event(one, event, organ); }));
}

void StepsScript::expect_place(lua_State* L, const std::string& name) {
  const std::vector<std::string> names = place_names(scene().anatomy, later_organs(), later_tissues());
  if (!is_place(name, names)) complain(L, fmt::format("unknown organ \"{}\"", name), suggestion(name, names));
}

void StepsScript::missed(lua_State* L, const std::string& why) {
  if (!may_wait(L, "missed")) return;
  if (checking()) {
    std::erase(declared_.waited, current_);  // it can end otherwise than by waiting
    return;
  }
  world(L);  // raises what is wrong outside of steps
  progress_->end_step(now_, "missed", why);
}

std::vector<SessionEvent> StepsScript::events(lua_State* L) {
  if (checking()) {
    stand_in();
    return {};
  }
  world(L);
  return progress_->events();
}

bool StepsScript::may_change(lua_State* L, const char* method) {
  if (!may_wait(L, method)) return false;
  if (!checking()) world(L);  // raises what is wrong outside of steps
  return true;
}

void StepsScript::bring_later(const OrganDefinition& organ) {
  for (const OrganDefinition& known : known_organs())
    if (known.name == organ.name) return;
  declared_.later.push_back(organ);
}

void StepsScript::expect_tube(lua_State* L, const OrganDefinition& organ, const std::string& act,
                              const std::string& done) {
  if (!std::holds_alternative<TubeShape>(organ.shape)) complain(L, no_tube(organ, act, done));
}

int StepsScript::divide(lua_State* L, const std::string& name, double share) {
  if (!may_change(L, "divide")) return 0;
  const int organ = this->organ(L, name);
  const std::array<std::string, 2> pieces = piece_names(name);
  if (checking() && organ >= 0) {
    OrganDefinition piece = known_organ(organ);
    expect_tube(L, piece, "divide", "divided");
    for (const std::string& of : pieces) {
      piece.name = of;
      bring_later(piece);
    }
  }
  if (!checking()) {
    const Result<Division> done = changing_->divide(name, share);
    if (!done) complain(L, done.failure());
    share = done->share;
  }
  lua_pushstring(L, pieces[0].c_str());
  lua_pushstring(L, pieces[1].c_str());
  lua_pushnumber(L, share);
  return 3;
}

void StepsScript::clip(lua_State* L, const std::string& name, double share, ClipSize size) {
  if (!may_change(L, "clip")) return;
  const int organ = this->organ(L, name);
  if (organ < 0) return;
  if (checking()) return expect_tube(L, known_organ(organ), "clip", "clipped");
  if (const Result<bool> done = changing_->clip(name, share, size); !done) complain(L, done.failure());
}

void StepsScript::remove(lua_State* L, const std::string& name, const std::string& why) {
  if (!may_change(L, "remove") || organ(L, name) < 0 || checking()) return;
  if (const Result<bool> done = changing_->remove(name, why); !done) complain(L, done.failure());
}

void StepsScript::add(lua_State* L, const OrganDefinition& organ) {
  if (!may_change(L, "add")) return;
  if (checking()) {
    if (std::vector<Problem> problems = validate(organ); !problems.empty())
      return complain(L, Failure{FailureKind::scenario, std::move(problems)});
    return bring_later(organ);
  }
  if (const Result<OrganIndex> done = changing_->add(organ); !done) complain(L, done.failure());
}

void StepsScript::release(lua_State* L, const std::string& name, const std::string& held) {
  if (!may_change(L, "release")) return;
  const int organ = this->organ(L, name);
  if (organ < 0) return;
  if (!checking()) {
    if (const Result<bool> done = changing_->release(name, held); !done) complain(L, done.failure());
    return;
  }
  std::vector<std::string> names;
  for (const HeldRegion& region : known_organ(organ).held)
    if (!region.while_filled) names.push_back(region.name);
  if (!contains(names, held))
    complain(L, fmt::format("nothing called \"{}\" holds '{}'", held, name),
             names.empty() ? "nothing holds it" : suggestion(held, names));
}

void StepsScript::add_tissue(lua_State* L, const TissueDefinition& tissue) {
  if (!may_change(L, "add_tissue")) return;
  if (!checking()) {
    if (const Result<bool> done = changing_->add_tissue(tissue); !done) complain(L, done.failure());
    return;
  }
  std::vector<std::string> organs;
  for (const OrganDefinition& organ : known_organs()) organs.push_back(organ.name);
  if (std::vector<Problem> problems = validate(tissue, organs); !problems.empty())
    return complain(L, Failure{FailureKind::scenario, std::move(problems)});
  declared_.later_tissues.push_back(tissue);
}

void StepsScript::remove_tissue(lua_State* L, const std::string& name) {
  if (!may_change(L, "remove_tissue") || !is_tissue(L, name) || checking()) return;
  if (const Result<bool> done = changing_->remove_tissue(name); !done) complain(L, done.failure());
}

double StepsScript::bleed(lua_State* L, const std::string& name, double share, double width) {
  if (!may_change(L, "bleed")) return share;
  const int organ = this->organ(L, name);
  if (organ < 0) return share;
  if (checking()) {
    expect_tube(L, known_organ(organ), "open", "opened");
    return share;
  }
  const Result<double> done = changing_->open_tube(name, share, width);
  if (!done) complain(L, done.failure());
  return done ? done.value() : share;
}

void StepsScript::tie(lua_State* L, const JointDefinition& joint) {
  if (!may_change(L, "tie") || !is_landmark(L, joint.from) || !is_landmark(L, joint.to) || checking()) return;
  if (const Result<bool> done = changing_->tie(joint); !done) complain(L, done.failure());
}

void StepsScript::untie(lua_State* L, const std::string& one, const std::string& other) {
  if (!may_change(L, "untie") || organ(L, one) < 0 || organ(L, other) < 0 || checking()) return;
  if (const Result<bool> done = changing_->untie(one, other); !done) complain(L, done.failure());
}

int StepsScript::hold(lua_State* L, const std::string& name, int predicate, double duration) {
  if (!may_wait(L, "hold") || !is_name(L, "hold", name)) return 0;
  if (!step_tried_) {
    complain(L, "t:hold before the first t:step", "start a step: its name is part of the metric's");
    return 0;
  }
  if (limit_ > 0 && duration > limit_)
    complain(L, fmt::format("{:g} s are to be held in a step whose limit is {:g} s", duration, limit_),
             "give the step a longer limit, or hold it for less time");
  const std::string full = current_ + "." + name;
  if (!current_.empty() && !contains(declared_.holds, full)) declared_.holds.push_back(full);
  if (const std::optional<int> results = answered_at_once(L, predicate)) return *results;
  Wait wait;
  wait.kind = Wait::Kind::hold;
  wait.predicate = predicate;
  wait.metric = full + ".time_in_s";
  wait.duration = duration;
  wait.last = now_;
  return suspend(L, std::move(wait));
}

}  // namespace calot
