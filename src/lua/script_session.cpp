#include "lua/script_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "anatomy/instruments.h"
#include "base/suggest.h"
#include "base/units.h"
#include "body/rod_body.h"
#include "field/roll.h"
#include "lua/handles.h"
#include "organs/strand_places.h"
#include "script/lua_headers.h"
#include "world/critical_view.h"

namespace calot {
namespace {

constexpr int most_dry_waits = 10'000;
constexpr int most_dry_asks = 1000;
constexpr int call_cost =
    500;  // instructions that a call with arguments counts for: they are copied and checked
constexpr std::size_t most_problems = 100;
constexpr std::size_t longest_message = 500;  // bytes

// What stands in for what only a world could answer: nothing, something usual, much.
constexpr int levels = 3;
constexpr double force_at[levels] = {0, 2, 10};  // N
constexpr double share_of_filling[levels] = {0.5, 1, 2};
constexpr double share_torn[levels] = {0, 0.5, 1};
constexpr double raw_surface[levels] = {0, 5e-6, 1e-3};  // m^2
constexpr double share_lost[levels] = {0, 0.1, 1};
constexpr double share_seen[levels] = {0, 0.5, 1};
constexpr double clear_by[levels] = {0, 5e-3, 50e-3};  // m
constexpr double usual_pressure = 12 * units::mmHg;
constexpr double usual_volume = 40 * units::mL;

std::string with_hint(const std::string& message, const std::string& hint) {
  return hint.empty() ? message : fmt::format("{} ({})", message, hint);
}

}  // namespace

ScriptSession::ScriptSession(Sandbox& sandbox, const ExerciseDefinition& exercise, std::string class_name,
                             std::string instrument_class, const Parameters& parameters,
                             std::vector<Problem>* problems)
    : sandbox_(sandbox),
      exercise_(exercise),
      class_name_(std::move(class_name)),
      instrument_class_(std::move(instrument_class)),
      parameters_(parameters),
      problems_(problems) {}

Result<lua_State*> ScriptSession::start_main(int function) {
  return sandbox_.start_thread(function, [this](lua_State* L) {
    push_session_handle(L, *this);
    push_parameters(L, parameters_);
  });
}

const World& ScriptSession::world(lua_State* L) const {
  if (world_ == nullptr) {
    luaL_error(L, "the t of %s works only inside it", class_name_ == "Steps" ? "steps" : "demo");
    std::abort();  // luaL_error does not return
  }
  return *world_;
}

bool ScriptSession::said_before(const Problem& problem) const {
  return std::any_of(problems_->begin(), problems_->end(), [&](const Problem& said) {
    return said.place.line == problem.place.line && said.message == problem.message;
  });
}

void ScriptSession::complain(lua_State* L, const std::string& message, const std::string& hint) {
  if (problems_ == nullptr) {
    luaL_where(L, 1);
    lua_pushstring(L, with_hint(shortened(message, longest_message), hint).c_str());
    lua_concat(L, 2);
    lua_error(L);
    std::abort();  // lua_error does not return
  }
  complained_ = true;
  const Blame blame = sandbox_.blame(L);
  if (problems_->size() + 1 >= most_problems) {
    if (problems_->size() < most_problems)
      problems_->push_back({blame.place, "more mistakes are not looked for until these are mended", {}});
    luaL_error(L, "too many mistakes");
    std::abort();  // luaL_error does not return
  }
  const std::string way = blame.inside + blame.callers, short_message = shortened(message, longest_message);
  const std::string said = way.empty() ? short_message : with_hint(short_message, hint) + way;
  const Problem problem{blame.place, said, way.empty() ? hint : std::string()};
  if (!said_before(problem)) problems_->push_back(problem);
}

int ScriptSession::organ(lua_State* L, const std::string& name) {
  if (!checking()) {
    const Result<OrganIndex> found = world(L).organ(name);
    if (found) return found->value;
    complain(L, found.failure());
    return -1;
  }
  std::vector<std::string> names;
  for (const OrganDefinition& organ : known_organs()) {
    if (organ.name == name) return static_cast<int>(names.size());
    names.push_back(organ.name);
  }
  complain(L, fmt::format("unknown organ \"{}\"", name), suggestion(name, names));
  return -1;
}

double ScriptSession::seen_area(lua_State* L, const std::array<Vec3, 3>& corners) {
  if (!checking()) return world(L).seen_area(corners);
  return share_seen[next_level()] * 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

bool ScriptSession::sees(lua_State* L, const Vec3& place) {
  return checking() ? next_guess() : world(L).sees(place);
}

bool ScriptSession::sees(lua_State* L, const std::string& landmark) {
  return checking() ? next_guess() : world(L).sees(landmark);
}

LaparoscopeState ScriptSession::lens(lua_State* L) {
  if (!checking()) return world(L).report().laparoscope;
  LaparoscopeState state;
  const LaparoscopeDefinition& scope = scene().laparoscope;
  state.view = laparoscope_pose(scope, port_position(scope.port), landmark(L, scope.look_at));
  // As it stands; near and not level; beyond what it looked at, with that behind it.
  constexpr double further[levels] = {0, 0.5, 1.2}, turned[levels] = {0, 0.5, 0};
  const int level = next_level();
  state.view.position += further[level] * scope.distance * state.view.direction;
  state.view.up = Eigen::AngleAxisd(turned[level], state.view.direction) * state.view.up;
  return state;
}

Vec3 ScriptSession::lens_axis(const LaparoscopeState& lens) const {
  return (lens.view.position - port_position(scene().laparoscope.port)).normalized();
}

Vec3 ScriptSession::port_position(const std::string& name) const {
  for (const PortDefinition& port : scene().ports.empty() ? default_ports() : scene().ports)
    if (port.name == name) return port.position;
  return Vec3::Zero();  // which is refused elsewhere
}

double ScriptSession::guessed_loss() { return share_lost[next_level()] * usual_volume; }

double ScriptSession::lost(lua_State* L, bool blood, const std::string& name) {
  std::vector<std::string> names;
  for (const OrganDefinition& organ : known_organs()) names.push_back(organ.name);
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) {
    complain(L, fmt::format("unknown organ \"{}\"", name), suggestion(name, names));
    return 0;
  }
  if (checking()) return guessed_loss();
  double sum = 0;
  for (const LostState& one : world(L).report().lost)
    if (name.empty() || one.name == name) sum += blood ? one.blood : one.bile;
  return sum;
}

bool ScriptSession::is_tissue(lua_State* L, const std::string& name) {
  std::vector<std::string> names;
  for (const auto* tissues : {&scene().anatomy.tissue, &later_tissues()})
    for (const TissueDefinition& tissue : *tissues) names.push_back(tissue.name);
  if (!checking()) {
    const Field& field = world(L).field();
    for (const Tissue& tissue : field.tissues) names.push_back(tissue.definition.name);
    if (gone_body(field, name) != nullptr) return true;
  }
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  complain(L, fmt::format("unknown tissue \"{}\"", name), suggestion(name, names));
  return false;
}

CriticalView ScriptSession::critical_view(lua_State* L, const CriticalViewQuestion& question) {
  for (const std::string* name : {&question.neck, &question.junction, &question.hilum}) {
    const bool gone =
        !checking() && gone_body(world(L).field(), name->substr(0, name->rfind('.'))) != nullptr;
    if (!gone && !is_landmark(L, *name)) return {};
  }
  if (!checking()) return world(L).critical_view(question);
  stand_in();
  const int level = next_level();
  CriticalView out;
  out.front = out.back = {1, share_seen[level]};
  out.plate = share_torn[level];
  out.structures = out.free = level;
  out.triangle_points = out.plate_points = out.structure_points = level;
  return out;
}

std::vector<ScriptSession::PresentStrand> ScriptSession::strands(lua_State* L, const std::string& name) {
  std::vector<PresentStrand> out;
  if (!is_tissue(L, name)) return out;
  if (checking()) {
    stand_in();
    const Vec3 at = landmark(L, scene().laparoscope.look_at);
    const Vec3 half(0, 0, 3e-3);  // m: it has a length, as every one has
    if (next_guess()) out.push_back({{at - half, at, at + half}});
    return out;
  }
  const Field& field = world(L).field();
  for (const Tissue& tissue : field.tissues) {
    if (tissue.definition.name != name) continue;
    const Organ& organ = field.organs[static_cast<std::size_t>(tissue.strands->bodies()[0])];
    const std::vector<StrandLine> lines = strand_lines(tissue, field.organs);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (!tissue.torn(i))
        out.push_back({lines[i], share_along(organ, tissue.strands->strands()[i].one),
                       tension_of(tissue, i, lines[i])});
  }
  return out;
}

double ScriptSession::torn(lua_State* L, const std::string& name) {
  if (!is_tissue(L, name)) return 0;
  if (checking()) return share_torn[next_level()];
  for (const TissueState& tissue : world(L).report().tissues)
    if (tissue.name == name) return static_cast<double>(tissue.torn) / tissue.strands;
  return 1;
}

std::vector<OrganDefinition> ScriptSession::known_organs() const {
  std::vector<OrganDefinition> all = scene().anatomy.organs;
  all.insert(all.end(), later_organs().begin(), later_organs().end());
  return all;
}

void ScriptSession::complain(lua_State* L, const Failure& failure) {
  std::string message, hint;
  for (const Problem& problem : failure.problems) {
    const std::string& path = problem.place.path;
    message +=
        fmt::format("{}{}{}{}", message.empty() ? "" : "; ", path, path.empty() ? "" : ": ", problem.message);
    if (hint.empty()) hint = problem.hint;
  }
  complain(L, message, hint);
}

bool ScriptSession::is_landmark(lua_State* L, const std::string& name) {
  if (!checking()) {
    const Result<Vec3> found = world(L).place(name);
    if (found) return true;
    complain(L, found.failure());
    return false;
  }
  const std::vector<std::string> names = landmark_names(known_organs());
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    if (has_world() && !world(L).place(name)) stand_in();  // it comes later
    return true;
  }
  complain(L, fmt::format("unknown landmark \"{}\"", name), suggestion(name, names));
  return false;
}

bool ScriptSession::can_use_jaws(lua_State* L, int instrument, const std::string& command) {
  const InstrumentDefinition& definition = scene().instruments[static_cast<std::size_t>(instrument)];
  if (has_jaws(definition.type)) return true;
  complain(L,
           fmt::format("{} is for jaws, and {} is a {}, which has none", command, definition.name,
                       to_text(definition.type)),
           "push with approach and move_by, or give it another type");
  return false;
}

bool ScriptSession::can_act(lua_State* L, int instrument, InstrumentAction action,
                            const std::string& command) {
  const InstrumentDefinition& definition = scene().instruments[static_cast<std::size_t>(instrument)];
  if (has_action(definition.type, action)) return true;
  std::string types;
  for (const InstrumentRow& row : instrument_rows())
    if (has_action(row.type, action)) types += (types.empty() ? "" : ", ") + std::string(row.name);
  complain(L,
           fmt::format("{} is for what can {}, which {} cannot: its type is {}", command, to_text(action),
                       definition.name, to_text(definition.type)),
           "give it another type: " + types);
  return false;
}

std::pair<Vec3, Vec3> ScriptSession::along(lua_State* L, const std::string& name, double share) {
  const int index = organ(L, name);
  if (index < 0) return {Vec3::Zero(), Vec3::UnitX()};
  if (checking() && !has_world()) {
    stand_in();
    const OrganShape shape = known_organ(index).shape;
    const auto* tube = std::get_if<TubeShape>(&shape);
    if (tube && tube->points.size() < 2) return {Vec3::Zero(), Vec3::UnitX()};  // which is refused elsewhere
    if (tube) return {tube->points.front(), (tube->points.back() - tube->points.front()).normalized()};
  } else if (const Result<OrganIndex> there = world(L).organ(name)) {
    const Organ& organ = world(L).field().organ(there.value());
    if (const RodBody* rod = organ.body->as_tube()) {
      const double at = rod->at_share(share);
      return {rod->place_at(at, organ.state.x), rod->frame_at(at, organ.state.x).col(0)};
    }
  } else {
    stand_in();  // it comes later
    return {Vec3::Zero(), Vec3::UnitX()};
  }
  complain(L, fmt::format("'{}' is no tube", name), "name a duct or a vessel");
  return {Vec3::Zero(), Vec3::UnitX()};
}

void ScriptSession::expect_kind(lua_State* L, int index, const std::string& method) {
  const OrganDefinition organ =
      checking() ? known_organ(index) : world(L).field().organs[static_cast<std::size_t>(index)].definition;
  const auto expect = [&](bool is_it, const char* is_not, const char* hint) {
    if (!is_it) complain(L, fmt::format("'{}' is {}", organ.name, is_not), hint);
  };
  if (method == "clips" || method == "divided")
    expect(std::holds_alternative<TubeShape>(organ.shape), "no tube", "name a duct or a vessel");
  else if (method == "raw")
    expect(has_capsule(organ.shape), "no lobe: it has no capsule", "name a liver");
  else
    expect(is_hollow(organ.shape), "no hollow organ: it keeps no liquid",
           "name a gallbladder, or another organ with bile");
}

bool ScriptSession::divided(lua_State* L, const std::string& name) {
  if (checking()) {
    const int index = organ(L, name);
    if (index >= 0) expect_kind(L, index, "divided");
    return index >= 0;
  }
  if (const BodyRecord* record = gone_body(world(L).field(), name)) return !record->gone->pieces.empty();
  return organ(L, name) < 0;
}

Vec3 ScriptSession::landmark(lua_State* L, const std::string& name) const {
  if (!checking()) return world(L).landmark(name);
  if (has_world())
    if (const Result<Vec3> found = world(L).place(name)) return found.value();
  for (const OrganDefinition& organ : known_organs())
    for (const Landmark& row : landmark_rows())
      if (name == organ.name + "." + row.name) return organ.neck + row.along * (organ.fundus - organ.neck);
  return Vec3::Zero();  // complained about already
}

Vec3 ScriptSession::landmark_normal(lua_State* L, const std::string& name) const {
  if (!checking() || world(L).place(name)) return world(L).landmark_normal(name);
  return world(L).up();
}

Vec3 ScriptSession::tip(lua_State* L, int instrument) {
  if (!checking()) return world(L).report().instruments[static_cast<std::size_t>(instrument)].tip;
  const std::optional<Vec3> known = known_tip(instrument);
  return known ? *known : stand_in_instrument(instrument).tip;
}

double ScriptSession::clearance(lua_State* L, int instrument, const std::string& name) {
  const int found = organ(L, name);
  if (checking() || found < 0) return clear_by[next_level()];
  return world(L).clearance(ToolIndex{static_cast<std::size_t>(instrument)},
                            OrganIndex{static_cast<std::size_t>(found)});
}

Vec3 ScriptSession::shaft_axis(lua_State* L, int instrument) {
  const std::string& port = scene().instruments[static_cast<std::size_t>(instrument)].port;
  return (tip(L, instrument) - world(L).port_position(port)).normalized();
}

TouchedPlace ScriptSession::contact(lua_State* L, int instrument,
                                    const std::function<ToolPart(const InstrumentState&)>& choose) {
  const std::vector<std::string> landmarks =
      checking() ? landmark_names(scene().anatomy.organs) : world(L).landmarks();
  TouchedPlace place;
  if (checking()) {
    if (landmarks.empty()) return place;
    place.organ = scene().anatomy.organs.front().name;
    place.landmark = landmarks.front();
    place.at = landmark(L, place.landmark);
    place.force = stand_in_instrument(instrument).force.norm();
    return place;
  }
  const InstrumentState& state = world(L).report().instruments[static_cast<std::size_t>(instrument)];
  place.part = choose(state);
  const PartLoad& load = state.load_on(place.part);
  if (load.touches == 0) return place;
  place.at = load.at;
  place.organ = load.organ;
  place.force = load.force.norm();
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::string& name : landmarks) {
    const double distance = (world(L).landmark(name) - load.at).norm();
    if (name.substr(0, name.rfind('.')) != load.organ || distance >= nearest) continue;
    nearest = distance;
    place.landmark = name;
  }
  return place;
}

// ---- dry runs

bool ScriptSession::next_guess() {
  stood_in_ = true;
  if (!asking_) guess_ = !guess_;
  return guess_;
}

int ScriptSession::next_level() {
  stood_in_ = true;
  if (!asking_) level_ = (level_ + 1) % levels;
  return level_;
}

InstrumentState ScriptSession::stand_in_instrument(int instrument) {
  const int level = next_level();
  const InstrumentDefinition& definition = scene().instruments[static_cast<std::size_t>(instrument)];
  InstrumentState state;
  state.tip = port_position(definition.port);
  if (!scene().anatomy.organs.empty()) {  // from the port to the organ
    const double way = 0.5 + 0.25 * level;
    state.tip += way * (scene().anatomy.organs.front().fundus - state.tip);
  }
  state.tip = known_tip(instrument).value_or(state.tip);
  state.force = Vec3(0, 0, force_at[level]);
  state.handle_force = state.force;
  state.roll_torque = 5e-3 * state.force.z();  // N m: on an arm of 5 mm
  state.touching = level > 0;
  const std::size_t grip = static_cast<std::size_t>(2 * level + (guess_ ? 1 : 0));
  state.grip = static_cast<GripState>(grip % grip_state_names().size());
  return state;
}

OrganState ScriptSession::stand_in_organ(int organ) {
  const int level = next_level();
  const double share = share_of_filling[level];
  const BileDefinition bile = known_organ(organ).bile;
  OrganState state;
  state.pressure = share * bile.fill_pressure.value_or(usual_pressure);
  state.volume = share * bile.fill_volume.value_or(usual_volume);
  state.raw = raw_surface[level];
  return state;
}

bool ScriptSession::ask_condition(lua_State* L, int predicate) {
  const int top = lua_gettop(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, predicate);
  lua_call(L, 0, LUA_MULTRET);
  const bool returned = lua_gettop(L) > top;
  const int type = returned ? lua_type(L, top + 1) : LUA_TNONE;
  const bool answer = returned && lua_toboolean(L, top + 1) != 0;
  lua_settop(L, top);
  if (returned && type != LUA_TNUMBER && type != LUA_TSTRING) return answer;
  lua_Debug info;
  lua_rawgeti(L, LUA_REGISTRYINDEX, predicate);
  lua_getinfo(L, ">S", &info);
  const char* what = returned ? lua_typename(L, type) : "nothing";
  lua_pushfstring(L,
                  "%s:%d: the condition returns %s%s, not true or false (write return before what is asked)",
                  info.short_src, info.linedefined, returned ? "a " : "", what);
  lua_error(L);
  std::abort();  // lua_error does not return
}

void ScriptSession::ask_dry(lua_State* L, int predicate) {
  if (++asked_ > most_dry_asks) return;
  const bool guess = guess_, stood_in = stood_in_;
  const int level = level_;
  asking_ = true;
  for (int i = 0; i < 2 * levels; ++i) {
    guess_ = i % 2 == 0;
    level_ = (i / 2 + 1) % levels;  // the usual first
    const std::optional<Failure> failure =
        sandbox_.protect([&](lua_State* main) { ask_condition(main, predicate); });
    if (!failure || is_no_mistake(*failure)) continue;
    sandbox_.charge(L, 0);  // raises what no script survives
    for (const Problem& problem : sandbox_.laid_at(*failure, predicate).problems)
      if (!said_before(problem)) problems_->push_back(problem);
    break;
  }
  asking_ = false;
  guess_ = guess;
  stood_in_ = stood_in;
  level_ = level;
}

bool ScriptSession::end_dry_run(lua_State* L, std::optional<double> duration) {
  dry_time_ += duration.value_or(0);
  if (!duration || dry_time_ >= stalled_since_ + 1 / scene().solver.rate) {
    stalled_since_ = dry_time_;
    stalled_waits_ = 0;
  } else if (++stalled_waits_ > most_waits_per_step) {
    complain(L, waits_message(), waits_hint());
    return true;
  }
  return ++dry_waits_ > most_dry_waits || dry_time_ > exercise_.time_limit;
}

std::string ScriptSession::waits_message() {
  return fmt::format("more than {} waits within one simulated step: a loop in which no time passes?",
                     most_waits_per_step);
}

std::string ScriptSession::waits_hint() {
  return "wait for some time, such as t:wait(0.1 * s), in each round";
}

// ---- arguments

Value Arguments::values_of(lua_State* L, const ApiFunction& function, FieldCheck& check) {
  Value values;
  values.kind = Value::Kind::table;
  for (std::size_t i = 0; i < function.parameters.size(); ++i) {
    const int index = static_cast<int>(i) + 2;  // 1 is the handle
    if (lua_isnoneornil(L, index)) continue;
    const std::string& name = function.parameters[i].name;
    Result<Value> value = read_value(L, index, name);
    if (value) {
      values.fields.push_back({name, std::move(value).value()});
      continue;
    }
    for (const Problem& problem : value.failure().problems)
      check.problem(problem.place.path, problem.message, problem.hint);
    values.fields.push_back({name, Value{}});
  }
  return values;
}

KeyTable Arguments::table_of(const ApiFunction& function) {
  return {function.full_name(), function.doc, function.parameters, {}};
}

Arguments::Arguments(lua_State* L, ScriptSession& session, const std::string& owner,
                     const std::string& method)
    : L_(L),
      session_(session),
      function_(api_function(owner, method)),
      values_(values_of(L, function_, check_)),
      api_(table_of(function_)),
      reader_(check_, &values_, "", api_) {
  session.sandbox().charge(L, call_cost);
  const int expected = static_cast<int>(function_.parameters.size());
  if (lua_gettop(L) - 1 > expected) {
    check_.problem("", fmt::format("{} arguments are too many", lua_gettop(L) - 1),
                   fmt::format("it takes {}", expected));
  }
  finish();
}

bool Arguments::finish() {
  for (const Problem& problem : check_.take()) {
    good_ = false;
    const std::string& path = problem.place.path;
    session_.complain(
        L_, fmt::format("{}{}{}: {}", function_.full_name(), path.empty() ? "" : ": ", path, problem.message),
        problem.hint);
  }
  return good_;
}

double Arguments::number(const std::string& name, double fallback) const {
  reader_.take(name, fallback);
  return fallback;
}

std::string Arguments::text(const std::string& name) const {
  std::string text;
  reader_.take(name, text);
  return text;
}

int Arguments::function(const std::string& name) const {
  const Value* value = reader_.take(name);
  if (value == nullptr) return 0;
  lua_rawgeti(L_, LUA_REGISTRYINDEX, value->function);
  // A coroutine that was wrapped is a function of C as well, which knows its thread.
  const bool is_method = lua_iscfunction(L_, -1) != 0 && lua_getupvalue(L_, -1, 1) == nullptr;
  lua_pop(L_, 1);
  if (is_method)
    session_.complain(
        L_, fmt::format("{}: {} is a method, which is called of something", function_.full_name(), name),
        "write function() return t.left:holds() end");
  return value->function;
}

std::optional<Vec3> Arguments::point(const Value& value, const std::string& name) {
  std::optional<Vec3> point = read_point(check_, value, name);
  const Key* key = api_.find(name);
  if (point && key != nullptr && !check_.place_within(name, *point, key->high, "a place in the abdomen"))
    return std::nullopt;
  return point;
}

TableReader Arguments::table(const std::string& name, const std::string& api) {
  return {check_, reader_.take(name), name, api_table(api)};
}

}  // namespace calot
