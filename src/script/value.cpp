#include "script/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "script/lua_headers.h"

namespace calot {
namespace {

constexpr int deepest = 32;
constexpr std::size_t longest_text = 4000;                 // bytes
constexpr std::size_t most_bytes = std::size_t{16} << 20;  // of one definition's copy

class ValueReader {
 public:
  explicit ValueReader(lua_State* L) : L_(L) {}

  /// Complains once; what is read after that is to be thrown away.
  Value read(int index, const std::string& path, int depth) {
    Value value;
    if (depth > deepest) {
      complain(path, fmt::format("tables are nested deeper than {}", deepest), "does one contain itself?");
      return value;
    }
    if (!take(sizeof(ValueField) + path.size(), path)) return value;
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
        value.text = text_at(index, path);
        break;
      case LUA_TFUNCTION:
        value.kind = Value::Kind::function;
        lua_pushvalue(L_, index);
        value.function = luaL_ref(L_, LUA_REGISTRYINDEX);
        break;
      case LUA_TTABLE:
        read_table(value, lua_absindex(L_, index), path, depth);
        break;
      default:
        value.kind = Value::Kind::other;
        value.text = lua_typename(L_, lua_type(L_, index));
    }
    return value;
  }

  std::optional<Failure> failure;

 private:
  void complain(const std::string& path, std::string message, std::string hint) {
    if (!failure) failure = fail(FailureKind::scenario, std::move(message), std::move(hint), {"", 0, path});
  }

  bool take(std::size_t bytes, const std::string& path) {
    bytes_ += bytes;
    if (bytes_ > most_bytes)
      complain(path, fmt::format("the definition is larger than {} MiB up to here", most_bytes >> 20),
               "keep less data in it");
    return !failure;
  }

  std::string text_at(int index, const std::string& path) {
    std::size_t length = 0;
    const char* text = lua_tolstring(L_, index, &length);
    if (length <= longest_text) return take(length, path) ? std::string(text, length) : std::string();
    complain(path, fmt::format("a text of {} bytes", length),
             fmt::format("a definition's texts have at most {}", longest_text));
    return {};
  }

  void read_table(Value& value, int index, const std::string& path, int depth) {
    luaL_checkstack(L_, 4, "a definition is nested too deep");
    value.kind = Value::Kind::table;
    const lua_Unsigned count = lua_rawlen(L_, index);
    for (lua_Unsigned i = 1; i <= count && !failure; ++i) {
      lua_rawgeti(L_, index, static_cast<lua_Integer>(i));
      value.items.push_back(read(-1, fmt::format("{}[{}]", path, i), depth + 1));
      lua_pop(L_, 1);
    }
    // In the order of names, not of Lua's table, which differs from one process to the next.
    std::vector<std::string> names;
    for (lua_pushnil(L_); lua_next(L_, index) != 0; lua_pop(L_, 1)) {
      if (lua_type(L_, -2) == LUA_TSTRING && !failure) {
        names.push_back(text_at(-2, path));
      } else if (!is_item(count)) {
        value.has_other_keys = true;
      }
    }
    std::sort(names.begin(), names.end());
    for (std::size_t i = 0; i < names.size() && !failure; ++i) {
      lua_pushlstring(L_, names[i].data(), names[i].size());
      lua_rawget(L_, index);
      value.fields.push_back(
          {names[i], read(-1, path.empty() ? names[i] : path + "." + names[i], depth + 1)});
      lua_pop(L_, 1);
    }
  }

  /// Whether the key below the top is one of 1 to count.
  bool is_item(lua_Unsigned count) const {
    if (lua_isinteger(L_, -2) == 0) return false;
    const lua_Integer key = lua_tointeger(L_, -2);
    return key >= 1 && static_cast<lua_Unsigned>(key) <= count;
  }

  lua_State* L_;
  std::size_t bytes_ = 0;
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

Result<Value> read_value(lua_State* L, int index, const std::string& path) {
  const int top = lua_gettop(L);
  ValueReader reader(L);
  Value value = reader.read(index, path, 0);
  lua_settop(L, top);
  if (reader.failure) return *reader.failure;
  return value;
}

}  // namespace calot
