#pragma once
// setmetatable and getmetatable that let no script see when memory is collected. The table that Lua itself
// looks into is a hidden one that holds no __gc, __close or __mode, whatever is written into the script's own
// and whenever; its entries ask the script's own, so metamethods may come late, as they may in Lua.

struct lua_State;

namespace calot {

int set_metatable(lua_State* L);
int get_metatable(lua_State* L);

/// As luaL_getmetafield: pushes the field of the script's own metatable and returns its type; pushes nothing
/// and returns LUA_TNIL where there is none.
int get_metafield(lua_State* L, int index, const char* event);

}  // namespace calot
