#pragma once

struct lua_State;

namespace calot {

/// Makes what `require "calot"` gives: units, anatomy, score, exercise. Call it protected.
void open_calot_module(lua_State* L);

}  // namespace calot
