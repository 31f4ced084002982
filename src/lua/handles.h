#pragma once
// t and its instruments in Lua: what they are made of, and how a method finds its session again.

#include "lua/script_session.h"

struct lua_State;

namespace calot {

/// Makes the classes of all handles known to the state. Call it protected.
void open_handles(lua_State* L);

/// Pushes a new t for the session.
void push_session_handle(lua_State* L, ScriptSession& session);

/// What a handle is of. Of t itself the instrument is -1, of the laparoscope ScriptSession::laparoscope().
struct HandleTarget {
  ScriptSession* session = nullptr;
  int instrument = -1;
};

/// The handle at index 1 of a call of `class_name`'s method. Raises an error for anything else (a dot instead
/// of a colon) and for handles whose session has ended.
HandleTarget handle_target(lua_State* L, const char* method);

}  // namespace calot
