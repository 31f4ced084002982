#pragma once
// Lua's coroutine library, rebuilt so that no error of the budget is lost between coroutines. There is no
// close: it would run code of a dead coroutine where no hook fires.

struct lua_State;

namespace calot {

/// Pushes the library's table.
void push_coroutine_library(lua_State* L);

}  // namespace calot
