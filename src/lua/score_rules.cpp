#include "lua/score_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/suggest.h"
#include "lua/method_targets.h"
#include "lua/methods.h"
#include "lua/mistakes.h"
#include "script/binding.h"
#include "script/lua_headers.h"
#include "session/metrics.h"
#include "tools/events.h"

namespace calot {
namespace {

constexpr std::size_t most_times = 10000;

void set_text(lua_State* L, const char* key, const std::string& text) {
  lua_pushlstring(L, text.data(), text.size());
  lua_setfield(L, -2, key);
}

/// Absent rather than empty, as `if event.cause then` reads.
void set_some(lua_State* L, const char* key, const std::string& text) {
  if (!text.empty()) set_text(L, key, text);
}

void push_event(lua_State* L, const SessionEvent& event) {
  lua_createtable(L, 0, 9);
  set_text(L, "event", to_text(event.kind));
  set_number(L, "time", event.time);
  set_text(L, "step", event.step);
  set_some(L, "instrument", event.instrument);
  set_some(L, "organ", event.organ);
  if (*event_row(event.kind).value != 0) set_number(L, "value", event.value);
  set_some(L, "cause", to_text(event.cause));
  set_some(L, "text", event.text);
  if (!event.place) return;
  lua_createtable(L, 3, 0);
  for (int i = 0; i < 3; ++i) {
    lua_pushnumber(L, (*event.place)[i]);
    lua_rawseti(L, -2, i + 1);
  }
  lua_setfield(L, -2, "place");
}

void push_step(lua_State* L, const StepRecord& step) {
  lua_createtable(L, 0, 4);
  set_text(L, "name", step.name);
  set_text(L, "outcome", step.outcome);
  set_number(L, "started", step.started);
  set_number(L, "ended", step.ended);
}

template <class T>
void push_list(lua_State* L, const std::vector<T>& list, void (*push)(lua_State*, const T&)) {
  lua_createtable(L, static_cast<int>(list.size()), 0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    push(L, list[i]);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
}

/// Of a run's metatable: the names that events' organs have.
constexpr const char* places_key = "calot.places";

/// A table with these keys.
void push_names(lua_State* L, const std::vector<std::string>& names) {
  lua_createtable(L, 0, static_cast<int>(names.size()));
  for (const std::string& name : names) {
    lua_pushboolean(L, 1);
    lua_setfield(L, -2, name.c_str());
  }
}

/// Of a metric that was not measured. Upvalue 1: those there may be, as keys.
int missing_metric(lua_State* L) {
  const std::string name = text_or_type(L, 2);
  lua_pushvalue(L, 2);
  if (lua_isnil(L, 2) || lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
    const std::vector<std::string> names = keys_of(L, lua_upvalueindex(1));
    raise_mistake(L, fmt::format("unknown metric \"{}\"", name), suggestion(name, names));
  }
  lua_pushnil(L);
  return 1;
}

void set_metrics(lua_State* L, const RuleRun& run) {
  lua_newtable(L);
  for (const auto& [name, value] : run.metrics) set_number(L, name.c_str(), value);
  if (run.metric_names != nullptr) {
    lua_newtable(L);
    push_names(L, *run.metric_names);
    lua_pushcclosure(L, guarded<missing_metric>, 1);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
  }
  lua_setfield(L, -2, "metrics");
}

/// The last of each name.
void set_notes(lua_State* L, const Progress& progress) {
  lua_newtable(L);
  for (const Note& note : progress.notes()) {
    if (const auto* text = std::get_if<std::string>(&note.value))
      lua_pushlstring(L, text->data(), text->size());
    else if (const auto* flag = std::get_if<bool>(&note.value))
      lua_pushboolean(L, *flag);
    else
      lua_pushnumber(L, std::get<double>(note.value));
    lua_setfield(L, -2, note.name.c_str());
  }
  lua_setfield(L, -2, "notes");
}

int missing_member(lua_State* L) {
  const std::vector<std::string> names = {"count", "events", "metrics", "notes", "params", "steps", "times"};
  const std::string wanted = text_or_type(L, 2);
  raise_mistake(L, fmt::format("run has no \"{}\"", wanted), suggestion(wanted, names));
}

void push_run(lua_State* L, const RuleRun& run) {
  lua_newtable(L);
  push_list(L, run.progress.events(), push_event);
  lua_setfield(L, -2, "events");
  push_list(L, run.progress.steps(), push_step);
  lua_setfield(L, -2, "steps");
  set_metrics(L, run);
  set_notes(L, run.progress);
  push_parameters(L, run.parameters);
  lua_setfield(L, -2, "params");
  for (const char* method : {"count", "times"}) {
    lua_pushcfunction(L, method_function("Run", method));
    lua_setfield(L, -2, method);
  }
  lua_newtable(L);
  lua_pushcfunction(L, guarded<missing_member>);
  lua_setfield(L, -2, "__index");
  // When a session is judged, an organ that this patient does not have is one that nothing befell.
  if (run.metric_names != nullptr) {
    push_names(
        L, place_names(run.exercise.scene.anatomy, run.exercise.later_organs, run.exercise.later_tissues));
    lua_setfield(L, -2, places_key);
  }
  lua_setmetatable(L, -2);
}

/// Complains of a name that no event's organ has: an organ's, or a piece's of one.
void expect_place(lua_State* L, const std::string& name) {
  if (luaL_getmetafield(L, 1, places_key) == LUA_TNIL) return;
  const std::vector<std::string> names = keys_of(L, lua_gettop(L));
  lua_pop(L, 1);
  if (!is_place(name, names))
    raise_mistake(L, fmt::format("unknown organ \"{}\"", name), suggestion(name, names));
}

/// Calls `found` with the time of each event that run:method(event, organ) asks for.
template <class Found>
void for_events(lua_State* L, const char* method, const Found& found) {
  lua_settop(L, 3);
  if (!lua_istable(L, 1) || lua_getfield(L, 1, "events") != LUA_TTABLE)
    luaL_error(L, "run:%s must be called with a colon, as in run:%s(\"cut\")", method, method);
  if (lua_type(L, 2) != LUA_TSTRING || !event_called(lua_tostring(L, 2))) {
    const std::string wanted = text_or_type(L, 2);
    raise_mistake(L, fmt::format("unknown event \"{}\"", wanted), suggestion(wanted, event_names()));
  }
  const std::string organ = lua_isnoneornil(L, 3) ? "" : luaL_checkstring(L, 3);
  if (!organ.empty()) expect_place(L, organ);
  const int events = lua_gettop(L);
  const auto text_of = [&](const char* key) {
    const std::string text = lua_getfield(L, -1, key) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    lua_pop(L, 1);
    return text;
  };
  for (lua_Integer i = 1; lua_rawgeti(L, events, i) == LUA_TTABLE; ++i) {
    WorldEvent event;
    const std::optional<EventKind> kind = event_called(text_of("event"));
    event.organ = text_of("organ");
    lua_getfield(L, -1, "time");
    event.time = lua_tonumber(L, -1);
    lua_pop(L, 2);
    event.kind = kind.value_or(EventKind::contact);
    if (kind && is_event(event, lua_tostring(L, 2), organ)) found(event.time);
  }
  lua_pop(L, 1);
}

/// Where the function was written.
Place place_of_rule(Sandbox& sandbox, int rule) {
  lua_State* L = sandbox.state();
  lua_Debug info;
  lua_rawgeti(L, LUA_REGISTRYINDEX, rule);
  lua_getinfo(L, ">S", &info);
  const std::string* file = sandbox.file_of(info);
  return {file != nullptr ? *file : sandbox.options().script.string(), std::max(0, info.linedefined), {}};
}

struct RawAnswer {
  bool yes_no = false;  ///< the share is to be true or false
  bool is_share = false, is_text = false;
  std::string share_kind, times_problem;
  RuleAnswer answer;
};

/// The times on top of the stack.
void read_times(lua_State* L, RawAnswer& raw) {
  if (lua_isnil(L, -1)) return;
  if (!lua_istable(L, -1)) {
    raw.times_problem = fmt::format("times that are {}", luaL_typename(L, -1));
    return;
  }
  const lua_Unsigned count = lua_rawlen(L, -1);
  if (count > most_times) raw.times_problem = fmt::format("more than {} times", most_times);
  for (lua_Unsigned i = 1; i <= count && raw.times_problem.empty(); ++i) {
    lua_rawgeti(L, -1, static_cast<lua_Integer>(i));
    const double time = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : -1;
    lua_pop(L, 1);
    if (!std::isfinite(time) || time < 0)
      raw.times_problem = fmt::format("a time, the {}., that is no number of seconds from 0 on", i);
    raw.answer.times.push_back(time);
  }
}

/// All that is wrong with the kinds of what was returned; of the values too where these count.
std::vector<Problem> problems_of(const RawAnswer& raw, const Place& place, bool values_count) {
  std::vector<Problem> problems;
  const std::string hint =
      fmt::format("return {}, a reason in a sentence, and the times behind it or nothing",
                  raw.yes_no ? "true or false" : "a share of 0 to 1");
  const auto add = [&](const std::string& what) {
    problems.push_back({place, "the rule returns " + what, hint});
  };
  if (!raw.is_share)
    add(fmt::format("no {} but {}", raw.yes_no ? "true or false" : "share", raw.share_kind));
  else if (values_count && !(raw.answer.share >= 0 && raw.answer.share <= 1))
    add(fmt::format("the share {:g}, which is not within 0 and 1", raw.answer.share));
  if (!raw.is_text || raw.answer.reason.empty()) add("no reason");
  if (raw.answer.reason.size() > longest_reason)
    add(fmt::format("a reason of {} bytes, more than {}", raw.answer.reason.size(), longest_reason));
  if (!raw.times_problem.empty()) add(raw.times_problem);
  return problems;
}

std::optional<Failure> call_rule(Sandbox& sandbox, int rule, const RuleRun& run, RawAnswer& raw) {
  std::optional<Failure> failure = sandbox.protect([&](lua_State* L) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, rule);
    push_run(L, run);
    lua_call(L, 1, 3);
    read_times(L, raw);
    raw.is_share = lua_type(L, -3) == (raw.yes_no ? LUA_TBOOLEAN : LUA_TNUMBER);
    raw.share_kind = luaL_typename(L, -3);
    raw.is_text = lua_type(L, -2) == LUA_TSTRING;
    if (raw.is_share) raw.answer.share = raw.yes_no ? lua_toboolean(L, -3) : lua_tonumber(L, -3);
    if (raw.is_text) raw.answer.reason = lua_tostring(L, -2);
  });
  if (failure) failure = sandbox.laid_at(*failure, rule);
  return failure;
}

}  // namespace

void push_events(lua_State* L, const std::vector<SessionEvent>& events) { push_list(L, events, push_event); }

int count_events_of_run(lua_State* L) {
  lua_Integer count = 0;
  for_events(L, "count", [&](double) { ++count; });
  lua_pushinteger(L, count);
  return 1;
}

int times_of_events_of_run(lua_State* L) {
  std::vector<double> times;
  for_events(L, "times", [&](double time) { times.push_back(time); });
  lua_createtable(L, static_cast<int>(times.size()), 0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    lua_pushnumber(L, times[i]);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return 1;
}

Result<RuleAnswer> ask_rule(Sandbox& sandbox, int rule, const RuleRun& run, bool yes_no) {
  RawAnswer raw;
  raw.yes_no = yes_no;
  if (std::optional<Failure> failure = call_rule(sandbox, rule, run, raw)) return *failure;
  std::vector<Problem> problems = problems_of(raw, place_of_rule(sandbox, rule), true);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  std::sort(raw.answer.times.begin(), raw.answer.times.end());
  raw.answer.share += 0.0;  // no minus zero
  return raw.answer;
}

std::optional<Failure> try_rule(Sandbox& sandbox, int rule, const RuleRun& nothing, bool yes_no) {
  RawAnswer raw;
  raw.yes_no = yes_no;
  take_mistake(sandbox.state());  // one that a script caught itself
  std::optional<Failure> failure = call_rule(sandbox, rule, nothing, raw);
  const bool mistake = take_mistake(sandbox.state());
  if (failure && (mistake || failure->kind != FailureKind::scenario)) return failure;
  if (failure) return std::nullopt;
  std::vector<Problem> problems = problems_of(raw, place_of_rule(sandbox, rule), false);
  if (problems.empty()) return std::nullopt;
  return Failure{FailureKind::scenario, std::move(problems)};
}

}  // namespace calot
