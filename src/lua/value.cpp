#include "lua/value.h"

#include <algorithm>

#include "lua/lua_headers.h"

namespace calot {
namespace {

constexpr int deepest = 32;
constexpr int most_entries = 100'000;

std::string text_at(lua_State* L, int index) {
  std::size_t length = 0;
  const char* text = lua_tolstring(L, index, &length);
  return {text, length};
}

class ValueReader {
 public:
  explicit ValueReader(lua_State* L) : L_(L) {}

  Value read(int index, int depth) {
    if (depth > deepest || ++entries_ > most_entries)
      luaL_error(L_, "a definition's tables are nested too deep or too large (does one contain itself?)");
    Value value;
    switch (lua_type(L_, index)) {
      case LUA_TNIL:
        break;
      case LUA_TBOOLEAN:
        value.kind = Value::Kind::boolean;
        value.boolean = lua_toboolean(L_, index) != 0;
        break;
      case LUA_TNUMBER:
        value.kind = Value::Kind::number;
        value.number = lua_tonumber(L_, index);
        break;
      case LUA_TSTRING:
        value.kind = Value::Kind::text;
        value.text = text_at(L_, index);
        break;
      case LUA_TFUNCTION:
        value.kind = Value::Kind::function;
        lua_pushvalue(L_, index);
        value.function = luaL_ref(L_, LUA_REGISTRYINDEX);
        break;
      case LUA_TTABLE:
        read_table(value, lua_absindex(L_, index), depth);
        break;
      default:
        value.kind = Value::Kind::other;
        value.text = lua_typename(L_, lua_type(L_, index));
    }
    return value;
  }

 private:
  void read_table(Value& value, int index, int depth) {
    luaL_checkstack(L_, 4, "a definition is nested too deep");
    value.kind = Value::Kind::table;
    const lua_Unsigned count = lua_rawlen(L_, index);
    for (lua_Unsigned i = 1; i <= count; ++i) {
      lua_rawgeti(L_, index, static_cast<lua_Integer>(i));
      value.items.push_back(read(-1, depth + 1));
      lua_pop(L_, 1);
    }
    for (lua_pushnil(L_); lua_next(L_, index) != 0; lua_pop(L_, 1)) {
      if (lua_type(L_, -2) == LUA_TSTRING) {
        value.fields.push_back({text_at(L_, -2), read(-1, depth + 1)});
      } else if (!is_item(count)) {
        value.has_other_keys = true;
      }
    }
    std::sort(value.fields.begin(), value.fields.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
  }

  /// Whether the key below the top is one of 1 to count.
  bool is_item(lua_Unsigned count) const {
    if (lua_isinteger(L_, -2) == 0) return false;
    const lua_Integer key = lua_tointeger(L_, -2);
    return key >= 1 && static_cast<lua_Unsigned>(key) <= count;
  }

  lua_State* L_;
  int entries_ = 0;
};

}  // namespace

const Value* Value::field(const std::string& name) const {
  for (const auto& [key, value] : fields)
    if (key == name) return &value;
  return nullptr;
}

std::string name_of(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::nil:
      return "nil";
    case Value::Kind::boolean:
      return "a boolean";
    case Value::Kind::number:
      return "a number";
    case Value::Kind::text:
      return "a text";
    case Value::Kind::table:
      return "a table";
    case Value::Kind::function:
      return "a function";
    case Value::Kind::other:
      return "an object";
  }
  return "a value";
}

Value read_value(lua_State* L, int index) { return ValueReader(L).read(index, 0); }

}  // namespace calot
