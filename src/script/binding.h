#pragma once
// How a C++ function becomes one that Lua can call.

#include <exception>

#include "script/lua_headers.h"

namespace calot {

/// F with every std::exception turned into a Lua error at the caller's line. Lua's own exceptions pass: they
/// are no std::exception.
template <lua_CFunction F>
int guarded(lua_State* L) {
  try {
    return F(L);
  } catch (const std::exception& error) {
    luaL_where(L, 1);
    lua_pushstring(L, error.what());
    lua_concat(L, 2);
  }
  return lua_error(L);
}

}  // namespace calot
