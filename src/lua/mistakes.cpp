#include "lua/mistakes.h"

#include <algorithm>
#include <cstdlib>

#include "script/lua_headers.h"

namespace calot {
namespace {

constexpr const char* mistake_key = "calot.mistake";

}  // namespace

std::string text_or_type(lua_State* L, int index) {
  return lua_type(L, index) == LUA_TSTRING ? lua_tostring(L, index) : luaL_typename(L, index);
}

std::vector<std::string> keys_of(lua_State* L, int table) {
  std::vector<std::string> keys;
  for (lua_pushnil(L); lua_next(L, table) != 0; lua_pop(L, 1)) keys.emplace_back(lua_tostring(L, -2));
  std::sort(keys.begin(), keys.end());
  return keys;
}

void note_mistake(lua_State* L) {
  lua_pushboolean(L, 1);
  lua_setfield(L, LUA_REGISTRYINDEX, mistake_key);
}

bool take_mistake(lua_State* L) {
  const bool found = lua_getfield(L, LUA_REGISTRYINDEX, mistake_key) == LUA_TBOOLEAN;
  lua_pop(L, 1);
  lua_pushnil(L);
  lua_setfield(L, LUA_REGISTRYINDEX, mistake_key);
  return found;
}

void raise_mistake(lua_State* L, const std::string& message, const std::string& hint) {
  note_mistake(L);
  luaL_error(L, "%s (%s)", message.c_str(), hint.c_str());
  std::abort();  // luaL_error does not return
}

}  // namespace calot
