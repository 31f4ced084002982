#include "script/coroutines.h"

#include "script/lua_headers.h"
#include "script/sandbox.h"

namespace calot {
namespace {

constexpr int resume_cost = 200;  // instructions: a yield is a C++ exception
constexpr int creation_cost =
    1000;  // instructions: what a fresh coroutine may run before its hook first fires

lua_State* thread_argument(lua_State* L) {
  lua_State* thread = lua_tothread(L, 1);
  luaL_argexpected(L, thread != nullptr, 1, "coroutine");
  return thread;
}

bool can_start(lua_State* L, lua_State* thread) {
  if (thread == L) return false;
  const int status = lua_status(thread);
  if (status == LUA_YIELD) return true;
  lua_Debug frame;
  return status == LUA_OK && lua_getstack(thread, 0, &frame) == 0 && lua_gettop(thread) > 0;
}

/// Number of results moved to L, or -1 with the error's value on top of L.
int resume_thread(lua_State* L, lua_State* thread, int arguments) {
  Sandbox& sandbox = Sandbox::of(L);
  if (sandbox.owns(thread)) {
    lua_pushliteral(L, "the simulator resumes this coroutine itself");
    return -1;
  }
  if (!can_start(L, thread)) {
    lua_pushliteral(L, "cannot resume a coroutine that is dead or running");
    return -1;
  }
  if (lua_checkstack(thread, arguments) == 0) {
    lua_pushliteral(L, "too many arguments to resume");
    return -1;
  }
  sandbox.charge(L, resume_cost);
  lua_xmove(L, thread, arguments);
  int results = 0;
  const int status = lua_resume(thread, L, arguments, &results);
  if (status != LUA_OK && status != LUA_YIELD) {
    lua_xmove(thread, L, 1);
    sandbox.survive_error(L, status);
    return -1;
  }
  if (lua_checkstack(L, results + 1) == 0) {
    lua_pop(thread, results);
    lua_pushliteral(L, "too many results to resume");
    return -1;
  }
  lua_xmove(thread, L, results);
  return results;
}

int create(lua_State* L) {
  luaL_checktype(L, 1, LUA_TFUNCTION);
  Sandbox::of(L).charge(L, creation_cost);
  lua_State* thread = lua_newthread(L);
  lua_pushvalue(L, 1);
  lua_xmove(L, thread, 1);
  return 1;
}

int resume(lua_State* L) {
  lua_State* thread = thread_argument(L);
  const int results = resume_thread(L, thread, lua_gettop(L) - 1);
  lua_pushboolean(L, results >= 0);
  const int kept = results >= 0 ? results : 1;
  lua_insert(L, -(kept + 1));
  return kept + 1;
}

int wrapped(lua_State* L) {
  lua_State* thread = lua_tothread(L, lua_upvalueindex(1));
  const int results = resume_thread(L, thread, lua_gettop(L));
  if (results >= 0) return results;
  return lua_error(L);
}

int wrap(lua_State* L) {
  create(L);
  lua_pushcclosure(L, wrapped, 1);
  return 1;
}

}  // namespace

void push_coroutine_library(lua_State* L) {
  lua_pushcfunction(L, luaopen_coroutine);
  lua_call(L, 0, 1);
  lua_pushnil(L);
  lua_setfield(L, -2, "close");
  const luaL_Reg rebuilt[] = {{"create", create}, {"resume", resume}, {"wrap", wrap}, {nullptr, nullptr}};
  luaL_setfuncs(L, rebuilt, 0);
}

}  // namespace calot
