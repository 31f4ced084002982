#include "script/ordered_pairs.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "script/lua_headers.h"
#include "script/metatables.h"
#include "script/sandbox.h"

namespace calot {
namespace {

struct Key {
  int type = LUA_TNIL;
  bool is_integer = false, boolean = false;
  lua_Integer integer = 0;
  lua_Number number = 0;
  std::string_view text;  ///< the table keeps the string alive

  int rank() const { return type == LUA_TNUMBER ? 0 : type == LUA_TSTRING ? 1 : 2; }
  /// The 80-bit format holds every integer and every double exactly.
  long double value() const {
    return is_integer ? static_cast<long double>(integer) : static_cast<long double>(number);
  }
};

bool before(const Key& a, const Key& b) {
  if (a.rank() != b.rank()) return a.rank() < b.rank();
  if (a.type == LUA_TNUMBER) return a.value() < b.value();
  if (a.type == LUA_TSTRING) return a.text < b.text;
  return !a.boolean && b.boolean;
}

/// The key at the top of the stack, not converted in place (that would confuse lua_next).
Key key_at_top(lua_State* L) {
  Key key;
  key.type = lua_type(L, -1);
  if (key.type == LUA_TNUMBER) {
    key.is_integer = lua_isinteger(L, -1) != 0;
    key.integer = key.is_integer ? lua_tointeger(L, -1) : 0;
    key.number = lua_tonumber(L, -1);
  } else if (key.type == LUA_TSTRING) {
    std::size_t length = 0;
    const char* text = lua_tolstring(L, -1, &length);
    key.text = {text, length};
  } else if (key.type == LUA_TBOOLEAN) {
    key.boolean = lua_toboolean(L, -1) != 0;
  } else {
    luaL_error(L, "pairs: a key is a %s, which has no fixed order (use numbers, strings or booleans as keys)",
               lua_typename(L, key.type));
  }
  return key;
}

void push_key(lua_State* L, const Key& key) {
  if (key.type == LUA_TSTRING) {
    lua_pushlstring(L, key.text.data(), key.text.size());
  } else if (key.type == LUA_TBOOLEAN) {
    lua_pushboolean(L, key.boolean);
  } else if (key.is_integer) {
    lua_pushinteger(L, key.integer);
  } else {
    lua_pushnumber(L, key.number);
  }
}

/// Upvalues: the sorted keys, the index of the last one given.
int next_pair(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_Integer index = lua_tointeger(L, lua_upvalueindex(2));
  while (lua_rawgeti(L, lua_upvalueindex(1), ++index) != LUA_TNIL) {
    lua_pushvalue(L, -1);
    if (lua_rawget(L, 1) != LUA_TNIL) {
      lua_pushinteger(L, index);
      lua_replace(L, lua_upvalueindex(2));
      return 2;
    }
    lua_pop(L, 2);
  }
  return 1;  // the nil found past the last key
}

std::size_t count_entries(lua_State* L) {
  std::size_t count = 0;
  for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) ++count;
  return count;
}

}  // namespace

int ordered_pairs(lua_State* L) {
  luaL_checkany(L, 1);
  if (get_metafield(L, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 3);
    return 3;
  }
  luaL_checktype(L, 1, LUA_TTABLE);
  Sandbox& sandbox = Sandbox::of(L);
  const std::size_t count = count_entries(L);
  sandbox.charge(L, static_cast<std::int64_t>(count));
  sandbox.need_memory(L, count * sizeof(Key));
  std::vector<Key> keys;
  keys.reserve(count);
  for (lua_pushnil(L); lua_next(L, 1) != 0;) {
    lua_pop(L, 1);
    keys.push_back(key_at_top(L));
  }
  std::sort(keys.begin(), keys.end(), before);
  lua_createtable(L, static_cast<int>(keys.size()), 0);
  lua_Integer index = 0;
  for (const Key& key : keys) {
    push_key(L, key);
    lua_rawseti(L, -2, ++index);
  }
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, next_pair, 2);
  lua_pushvalue(L, 1);
  lua_pushnil(L);
  return 3;
}

}  // namespace calot
