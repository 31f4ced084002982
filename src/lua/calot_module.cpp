#include "lua/calot_module.h"

#include <fmt/format.h>

#include "base/suggest.h"
#include "lua/api_table.h"
#include "lua/mistakes.h"
#include "script/binding.h"
#include "script/module_loader.h"

namespace calot {
namespace {

/// Pushes a copy of the table at `index`: constructors never change what an author gave them.
void push_copy(lua_State* L, int index) {
  lua_newtable(L);
  if (lua_isnoneornil(L, index)) return;
  for (lua_pushnil(L); lua_next(L, index) != 0;) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -4);
  }
}

void check_table(lua_State* L, int index, const char* name) {
  if (!lua_istable(L, index)) luaL_error(L, "%s needs a table: %s { ... }", name, name);
}

/// The copy remembers who made it: the reader then knows what it has before it.
int marked(lua_State* L, const char* name, const char* kind) {
  check_table(L, 1, name);
  push_copy(L, 1);
  lua_pushstring(L, kind);
  lua_setfield(L, -2, "kind");
  return 1;
}

int exercise(lua_State* L) { return marked(L, "calot.exercise", "exercise"); }
int weighted(lua_State* L) { return marked(L, "calot.score.weighted", "weighted"); }
int benchmark(lua_State* L) { return marked(L, "calot.score.benchmark", "benchmark"); }
int penalty(lua_State* L) { return marked(L, "calot.score.penalty", "penalty"); }

int procedure(lua_State* L) { return marked(L, "calot.score.procedure", "procedure"); }
int score_time(lua_State* L) { return marked(L, "calot.score.time", "time"); }

/// Its table may be left out: everything in it has a default.
int score_critical_view(lua_State* L) {
  if (lua_gettop(L) == 0) lua_newtable(L);
  return marked(L, "calot.score.critical_view", "critical_view");
}

int rule(lua_State* L) {
  if (!lua_isfunction(L, 1))
    luaL_error(L, "calot.score.rule needs a function: calot.score.rule(function(run) ... end)");
  lua_newtable(L);
  lua_pushvalue(L, 1);
  lua_setfield(L, -2, "judge");
  lua_pushstring(L, "rule");
  lua_setfield(L, -2, "kind");
  return 1;
}

int anatomy(lua_State* L) {
  if (lua_type(L, 1) != LUA_TSTRING)
    return luaL_error(L, "calot.anatomy needs an anatomy's name, such as calot.anatomy(\"standard\")");
  if (!lua_isnoneornil(L, 2)) check_table(L, 2, "calot.anatomy's second argument");
  push_copy(L, 2);
  lua_pushvalue(L, 1);
  lua_setfield(L, -2, "base");
  return 1;
}

int refuse(lua_State* L) {
  const int level = static_cast<int>(luaL_optinteger(L, 2, 1));
  const std::string message = luaL_checkstring(L, 1);
  note_mistake(L);
  luaL_where(L, level);
  lua_pushstring(L, message.c_str());
  lua_concat(L, 2);
  return lua_error(L);
}

/// Reading a member that is not there. Upvalues: the module's name, its table.
int unknown_member(lua_State* L) {
  const std::vector<std::string> names = keys_of(L, lua_upvalueindex(2));
  const std::string wanted = text_or_type(L, 2);
  return luaL_error(L, "%s has no \"%s\" (%s)", lua_tostring(L, lua_upvalueindex(1)), wanted.c_str(),
                    suggestion(wanted, names).c_str());
}

int read_only(lua_State* L) { return luaL_error(L, "the calot module cannot be changed"); }

/// Replaces the table at the top by an empty one that reads through to it and cannot be written.
void seal(lua_State* L, const char* name) {
  lua_newtable(L);
  lua_newtable(L);
  lua_pushvalue(L, -3);  // members first, then unknown_member
  lua_newtable(L);
  lua_pushstring(L, name);
  lua_pushvalue(L, -3);
  lua_pushcclosure(L, guarded<unknown_member>, 2);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, -2);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, read_only);
  lua_setfield(L, -2, "__newindex");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
  lua_remove(L, -2);
}

struct Function {
  const char* owner;
  const char* name;
  lua_CFunction function;
};

const Function functions[] = {{"calot", "exercise", exercise},
                              {"calot", "anatomy", anatomy},
                              {"calot", "refuse", guarded<refuse>},
                              {"score", "weighted", weighted},
                              {"score", "benchmark", benchmark},
                              {"score", "penalty", penalty},
                              {"score", "procedure", procedure},
                              {"score", "time", score_time},
                              {"score", "critical_view", score_critical_view},
                              {"score", "rule", rule}};

void push_functions(lua_State* L, const std::string& owner) {
  lua_newtable(L);
  for (const Function& function : functions) {
    if (owner != function.owner) continue;
    lua_pushcfunction(L, function.function);
    lua_setfield(L, -2, function.name);
  }
}

void push_units(lua_State* L) {
  lua_newtable(L);
  for (const ApiUnit& unit : api_units()) {
    lua_pushnumber(L, unit.factor);
    lua_setfield(L, -2, unit.name.c_str());
  }
}

}  // namespace

void open_calot_module(lua_State* L) {
  push_functions(L, "calot");
  push_functions(L, "score");
  seal(L, "calot.score");
  lua_setfield(L, -2, "score");
  push_units(L);
  seal(L, "calot.units");
  lua_setfield(L, -2, "units");
  seal(L, "calot");
  add_builtin_module(L, "calot");
}

}  // namespace calot
