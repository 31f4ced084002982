#pragma once
// The functions behind what demos command: motions, acts, exchanges.

#include <vector>

#include "lua/demo_script.h"
#include "lua/method_targets.h"

namespace calot {

/// The demo whose method was called; raises an error where the session is another one.
DemoScript& demo_of(lua_State* L, ScriptSession& session, const char* method);
/// The option `speed` of a motion, whose options are `api`.
double speed_option(Arguments& arguments, const char* api, double usual);

/// Of the classes Demo and DemoInstrument.
const std::vector<Method>& demo_methods();

}  // namespace calot
