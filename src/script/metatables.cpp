#include "script/metatables.h"

#include <iterator>
#include <utility>

#include "script/binding.h"

namespace calot {
namespace {

constexpr const char* metatables_key = "calot.metatables";
constexpr lua_Integer own_key = 1;  // where a hidden metatable keeps the script's

/// Pushes the metatable that the script gave; false, and nothing pushed, for a value without one or with one of
/// the simulator's.
bool push_own(lua_State* L, int index) {
  if (lua_type(L, index) != LUA_TTABLE || lua_getmetatable(L, index) == 0) return false;
  const bool found = lua_rawgeti(L, -1, own_key) == LUA_TTABLE;
  lua_remove(L, -2);
  if (!found) lua_pop(L, 1);
  return found;
}

bool push_handler(lua_State* L, int index, const char* event) {
  if (!push_own(L, index)) return false;
  lua_pushstring(L, event);
  const bool found = lua_rawget(L, -2) != LUA_TNIL;
  lua_remove(L, -2);
  if (!found) lua_pop(L, 1);
  return found;
}

int finish(lua_State* L, int, lua_KContext results) {
  if (results != LUA_MULTRET) return static_cast<int>(results);
  return lua_gettop(L);
}

/// Calls the handler on top of the stack with all that lies below it. Handlers may yield.
int call_with_all(lua_State* L, int results) {
  lua_insert(L, 1);
  lua_callk(L, lua_gettop(L) - 1, results, results, finish);
  return finish(L, LUA_OK, results);
}

/// Of the two operands' handlers the first that is there, as Lua seeks it.
bool push_either(lua_State* L, const char* event) {
  if (push_handler(L, 1, event)) return true;
  if (!push_own(L, 2)) return luaL_getmetafield(L, 2, event) != LUA_TNIL;
  lua_pop(L, 1);
  return push_handler(L, 2, event);
}

int index(lua_State* L) {
  if (!push_handler(L, 1, "__index")) {
    lua_pushnil(L);
    return 1;
  }
  if (lua_isfunction(L, -1)) return call_with_all(L, 1);
  lua_replace(L, 1);
  lua_gettable(L, 1);
  return 1;
}

int new_index(lua_State* L) {
  if (!push_handler(L, 1, "__newindex")) {
    lua_rawset(L, 1);
    return 0;
  }
  if (lua_isfunction(L, -1)) return call_with_all(L, 0);
  lua_replace(L, 1);
  lua_settable(L, 1);
  return 0;
}

int call(lua_State* L) {
  if (!push_handler(L, 1, "__call")) return luaL_error(L, "attempt to call a table value");
  return call_with_all(L, LUA_MULTRET);
}

int equal(lua_State* L) {
  if (push_either(L, "__eq")) return call_with_all(L, 1);
  lua_pushboolean(L, 0);  // Lua has found them different
  return 1;
}

int length(lua_State* L) {
  lua_settop(L, 1);
  if (push_handler(L, 1, "__len")) return call_with_all(L, 1);
  lua_pushinteger(L, static_cast<lua_Integer>(lua_rawlen(L, 1)));
  return 1;
}

struct Operator {
  const char* event;
  const char* what;  ///< "attempt to <what> a table value"
};
constexpr Operator operators[] = {{"__add", "perform arithmetic on"},
                                  {"__sub", "perform arithmetic on"},
                                  {"__mul", "perform arithmetic on"},
                                  {"__div", "perform arithmetic on"},
                                  {"__mod", "perform arithmetic on"},
                                  {"__pow", "perform arithmetic on"},
                                  {"__unm", "perform arithmetic on"},
                                  {"__idiv", "perform arithmetic on"},
                                  {"__band", "perform bitwise operation on"},
                                  {"__bor", "perform bitwise operation on"},
                                  {"__bxor", "perform bitwise operation on"},
                                  {"__shl", "perform bitwise operation on"},
                                  {"__shr", "perform bitwise operation on"},
                                  {"__bnot", "perform bitwise operation on"},
                                  {"__concat", "concatenate"},
                                  {"__lt", "compare"},
                                  {"__le", "compare"}};

template <int Number>
int operate(lua_State* L) {
  if (push_either(L, operators[Number].event)) return call_with_all(L, 1);
  return luaL_error(L, "attempt to %s a table value", operators[Number].what);
}

template <int... Numbers>
void set_operators(lua_State* L, std::integer_sequence<int, Numbers...>) {
  (..., (lua_pushcfunction(L, operate<Numbers>), lua_setfield(L, -2, operators[Numbers].event)));
}

/// Makes the hidden table for the script's metatable at `index` and leaves it on top.
void push_new_hidden(lua_State* L, int index) {
  constexpr int count = static_cast<int>(std::size(operators));
  lua_createtable(L, 1, count + 6);
  set_operators(L, std::make_integer_sequence<int, count>());
  const luaL_Reg others[] = {{"__index", calot::index}, {"__newindex", new_index}, {"__call", call},
                             {"__eq", equal},           {"__len", length},         {nullptr, nullptr}};
  luaL_setfuncs(L, others, 0);
  lua_pushvalue(L, index);
  lua_rawseti(L, -2, own_key);
}

/// One for each metatable: classes have many objects. The list lets go of those that nothing uses any more,
/// which no script can see.
void push_hidden(lua_State* L, int index) {
  if (luaL_newmetatable(L, metatables_key) != 0) {
    lua_createtable(L, 0, 1);
    lua_pushliteral(L, "k");
    lua_setfield(L, -2, "__mode");
    lua_setmetatable(L, -2);
  }
  lua_pushvalue(L, index);
  if (lua_rawget(L, -2) == LUA_TNIL) {
    lua_pop(L, 1);
    push_new_hidden(L, index);
    lua_pushvalue(L, index);
    lua_pushvalue(L, -2);
    lua_rawset(L, -4);
  }
  lua_remove(L, -2);
}

void refuse_collection(lua_State* L, int metatable) {
  for (const char* refused : {"__gc", "__close", "__mode"}) {
    lua_pushstring(L, refused);
    if (lua_rawget(L, metatable) != LUA_TNIL) luaL_error(L, "%s is not available in scenarios", refused);
    lua_pop(L, 1);
  }
}

}  // namespace

int get_metafield(lua_State* L, int index, const char* event) {
  if (!push_own(L, index)) return luaL_getmetafield(L, index, event);
  lua_pop(L, 1);
  return push_handler(L, index, event) ? lua_type(L, -1) : LUA_TNIL;
}

int set_metatable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_argexpected(L, lua_istable(L, 2) || lua_isnil(L, 2), 2, "nil or table");
  lua_settop(L, 2);
  if (get_metafield(L, 1, "__metatable") != LUA_TNIL)
    return luaL_error(L, "cannot change a protected metatable");
  if (lua_istable(L, 2)) {
    refuse_collection(L, 2);
    push_hidden(L, 2);
  }
  lua_setmetatable(L, 1);
  lua_settop(L, 1);
  return 1;
}

int get_metatable(lua_State* L) {
  luaL_checkany(L, 1);
  if (get_metafield(L, 1, "__metatable") != LUA_TNIL) return 1;
  if (!push_own(L, 1)) lua_pushnil(L);  // the simulator's own all have a __metatable
  return 1;
}

}  // namespace calot
