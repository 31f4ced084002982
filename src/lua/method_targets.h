#pragma once
// What all methods begin with: whose handle it is that they were called with.

#include "lua/handles.h"
#include "lua/script_session.h"
#include "script/lua_headers.h"

namespace calot {

/// A method's row: the handle's class, the name, and what Lua calls.
struct Method {
  const char* class_name;
  const char* name;
  lua_CFunction function;
};

/// For methods without parameters: Arguments' check alone, cheap enough for predicates.
void take_nothing(lua_State* L, ScriptSession& session, const char* method);

// Functions can be taken from one handle and called with another: each checks whose it is, or raises an error.

HandleTarget instrument_target(lua_State* L, const char* method);
/// That of t.laparoscope.
ScriptSession& laparoscope_target(lua_State* L, const char* method);
ScriptSession& session_target(lua_State* L, const char* method);

/// A field of the table on top of the stack.
void set_number(lua_State* L, const char* key, double number);
/// {x, y, z}
int push_vector(lua_State* L, const Vec3& vector);
/// Where a place is, m, that is given as a point or as a landmark; none after a complaint. Calls arguments.finish().
std::optional<Vec3> place_argument(lua_State* L, ScriptSession& session, Arguments& arguments,
                                   const std::string& name);

}  // namespace calot
