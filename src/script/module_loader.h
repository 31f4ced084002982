#pragma once

struct lua_State;

namespace calot {

/// require: "calot" is built in; other names ("grips", "grips.fold") are files below the scenario's own
/// folder or the project's modules, and nothing outside them: no dots upward, no absolute paths, no links
/// out.
int require_module(lua_State* L);

/// Makes the table at the top of the stack the module of that name and pops it.
void add_builtin_module(lua_State* L, const char* name);

}  // namespace calot
