#pragma once
// The functions behind what demos command: motions, acts, exchanges.

#include <vector>

#include "lua/demo_script.h"
#include "lua/method_targets.h"

namespace calot {

/// The demo whose method was called; raises an error where the session is another one.
DemoScript& demo_of(lua_State* L, ScriptSession& session, const char* method);
/// A call of a method that moves an instrument, or the laparoscope; `api`: the class that declares it.
struct DemoCall {
  DemoScript& demo;
  int instrument = 0;
  const char* api = nullptr;
};
// What both can do, as their classes declare it.
int move_to(lua_State* L, const DemoCall& call);
int move_by(lua_State* L, const DemoCall& call);
int rotate(lua_State* L, const DemoCall& call);
/// Of the classes Demo and DemoInstrument.
const std::vector<Method>& demo_methods();

}  // namespace calot
