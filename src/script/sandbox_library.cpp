#include "script/sandbox_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/suggest.h"
#include "script/binding.h"
#include "script/coroutines.h"
#include "script/metatables.h"
#include "script/module_loader.h"
#include "script/ordered_pairs.h"
#include "script/sandbox.h"

namespace calot {
namespace {

constexpr lua_Unsigned bytes_per_instruction = 16;  // of texts that library functions run through
constexpr std::size_t longest_printed_line = 4000;  // bytes
constexpr std::size_t longest_name = 100;           // bytes, in messages

// What is easier to say in Lua: a stable sort (Lua's own looks at the clock), and xpcall built on pcall,
// because a handler that loops inside Lua's own xpcall escapes the budget.
constexpr const char* prelude_text = R"lua(
local pcall, error, type, less = ...

local function finish(handler, ok, ...)
  if ok then return true, ... end
  return false, select(2, pcall(handler, ...))
end

local function xpcall(f, handler, ...)
  if type(handler) ~= "function" then error("xpcall needs a function as its second argument", 2) end
  return finish(handler, pcall(f, ...))
end

local function sort(list, before)
  if type(list) ~= "table" then error("table.sort needs a table, got a " .. type(list), 2) end
  before = before or less
  local n, from, to = #list, {}, {}
  for i = 1, n do from[i] = list[i] end
  local width = 1
  while width < n do
    for low = 1, n, 2 * width do
      local middle, high = low + width, low + 2 * width
      if middle > n + 1 then middle = n + 1 end
      if high > n + 1 then high = n + 1 end
      local a, b = low, middle
      for k = low, high - 1 do
        if a < middle and (b >= high or not before(from[b], from[a])) then
          to[k] = from[a]
          a = a + 1
        else
          to[k] = from[b]
          b = b + 1
        end
      end
    end
    from, to = to, from
    width = 2 * width
  end
  for i = 1, n do list[i] = from[i] end
end

return xpcall, sort
)lua";

/// Pushes a text for any value, without addresses; may call __tostring. A text is pushed as it is, not copied.
void push_text(lua_State* L, int index) {
  index = lua_absindex(L, index);
  luaL_checkstack(L, 4, "too many values");
  if (get_metafield(L, index, "__tostring") != LUA_TNIL) {
    lua_pushvalue(L, index);
    lua_call(L, 1, 1);
    if (lua_type(L, -1) != LUA_TSTRING) luaL_error(L, "'__tostring' must return a string");
    return;
  }
  const int of = lua_type(L, index);
  if (of == LUA_TNIL || of == LUA_TBOOLEAN || of == LUA_TNUMBER || of == LUA_TSTRING) {
    luaL_tolstring(L, index, nullptr);
  } else {
    lua_pushstring(L, lua_typename(L, of));
  }
}

/// A name as an author wrote it, no longer than a message can carry.
std::string name_at(lua_State* L, int index) {
  push_text(L, index);
  std::size_t length = 0;
  const char* text = lua_tolstring(L, -1, &length);
  std::string name = shortened({text, length}, longest_name);
  lua_pop(L, 1);
  return name;
}

int to_string(lua_State* L) {
  luaL_checkany(L, 1);
  push_text(L, 1);
  return 1;
}

/// What is beyond the longest line is dropped before it is copied.
int print(lua_State* L) {
  std::string line;
  const int count = lua_gettop(L);
  for (int i = 1; i <= count; ++i) {
    if (i > 1) line += '\t';
    push_text(L, i);
    std::size_t length = 0;
    const char* text = lua_tolstring(L, -1, &length);
    const std::size_t room = longest_printed_line + 1 - std::min(longest_printed_line + 1, line.size());
    line.append(text, std::min(length, room));
    lua_pop(L, 1);
  }
  Sandbox::of(L).print(shortened(line, longest_printed_line));
  return 0;
}

/// string.format without %p, and with %s that shows no address. Upvalue 1: Lua's own.
int format(lua_State* L) {
  std::size_t length = 0;
  const char* pattern = luaL_checklstring(L, 1, &length);
  int argument = 1;
  for (std::size_t i = 0; i < length; ++i) {
    if (pattern[i] != '%') continue;
    while (++i < length && std::string_view("-+ #0123456789.").find(pattern[i]) != std::string_view::npos) {
    }
    if (i >= length || pattern[i] == '%') continue;
    ++argument;
    if (pattern[i] == 'p')
      return luaL_error(L, "string.format: %%p is not available (addresses differ per run)");
    if (pattern[i] != 's' || argument > lua_gettop(L)) continue;
    push_text(L, argument);
    lua_replace(L, argument);
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, 1);
  return 1;
}

/// error, noted as the script's own: a dry run must not take an author's checks of its stand-in values for
/// mistakes.
int raise(lua_State* L) {
  const int level = static_cast<int>(luaL_optinteger(L, 2, 1));
  lua_settop(L, 1);
  if (lua_type(L, 1) == LUA_TSTRING && level > 0) {
    luaL_where(L, level);
    lua_insert(L, 1);
    lua_concat(L, 2);
  }
  Sandbox::of(L).note_raise();
  return lua_error(L);
}

int assert_true(lua_State* L) {
  if (lua_toboolean(L, 1) != 0) return lua_gettop(L);
  luaL_checkany(L, 1);
  lua_remove(L, 1);
  lua_pushliteral(L, "assertion failed!");
  lua_settop(L, 1);
  Sandbox::of(L).note_raise();
  return lua_error(L);
}

lua_Unsigned rounds_of(lua_Integer first, lua_Integer last) {
  return first > last ? 0 : static_cast<lua_Unsigned>(last) - static_cast<lua_Unsigned>(first) + 1;
}

/// Of a table's places from an argument to its end; a table may say of itself how long it is.
lua_Unsigned places_from(lua_State* L, int argument) {
  return lua_istable(L, 1) ? rounds_of(lua_tointeger(L, argument), luaL_len(L, 1)) : 0;
}

/// Functions of Lua's library that loop as often as they are told, and how many rounds.
struct Loop {
  std::string_view name;
  lua_Unsigned (*rounds)(lua_State* L);
};
constexpr std::array loops{
    Loop{"rep", [](lua_State* L) { return rounds_of(1, lua_tointeger(L, 2)) / bytes_per_instruction; }},
    Loop{"move", [](lua_State* L) { return rounds_of(lua_tointeger(L, 2), lua_tointeger(L, 3)); }},
    Loop{"insert", [](lua_State* L) { return lua_gettop(L) < 3 ? lua_Unsigned{0} : places_from(L, 2); }},
    Loop{"remove", [](lua_State* L) { return lua_gettop(L) < 2 ? lua_Unsigned{0} : places_from(L, 2); }},
};

/// A function of Lua's library (upvalue 1) whose time grows with the texts it is given and gives, or with the rounds of
/// its loop (upvalue 2: which of `loops`, or none).
int charged(lua_State* L) {
  Sandbox& sandbox = Sandbox::of(L);
  const auto texts = [L](int first) {
    lua_Unsigned bytes = 0;
    for (int i = first; i <= lua_gettop(L); ++i)
      if (lua_type(L, i) == LUA_TSTRING) bytes += lua_rawlen(L, i);
    return static_cast<std::int64_t>(bytes / bytes_per_instruction);
  };
  sandbox.note_place(L);
  sandbox.charge(L, texts(1));
  const auto loop = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(2)));
  constexpr lua_Unsigned most = 1'000'000'000'000;  // more than any script may use
  if (loop < loops.size())
    sandbox.charge(L, static_cast<std::int64_t>(std::min(loops[loop].rounds(L), most)));
  const int results = lua_tocfunction(L, lua_upvalueindex(1))(L);
  sandbox.charge(L, texts(lua_gettop(L) - results + 1));
  return results;
}

/// Replaces the functions of the library table on top by charged ones.
void charge_all(lua_State* L) {
  std::vector<std::string> names;
  for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1))
    if (lua_iscfunction(L, -1) != 0) names.emplace_back(lua_tostring(L, -2));
  for (const std::string& name : names) {
    lua_getfield(L, -1, name.c_str());
    const auto loop = std::find_if(loops.begin(), loops.end(), [&](const Loop& l) { return l.name == name; });
    lua_pushinteger(L, loop - loops.begin());
    lua_pushcclosure(L, charged, 2);
    lua_setfield(L, -2, name.c_str());
  }
}

int finish_pcall(lua_State* L, int status, lua_KContext) {
  if (status == LUA_OK || status == LUA_YIELD) return lua_gettop(L);
  Sandbox::of(L).survive_error(L, status);
  lua_pushboolean(L, 0);
  lua_insert(L, -2);
  return 2;
}

int protected_call(lua_State* L) {
  luaL_checkany(L, 1);
  lua_pushboolean(L, 1);
  lua_insert(L, 1);
  return finish_pcall(L, lua_pcallk(L, lua_gettop(L) - 2, LUA_MULTRET, 0, 0, finish_pcall), 0);
}

int less(lua_State* L) {
  lua_pushboolean(L, lua_compare(L, 1, 2, LUA_OPLT));
  return 1;
}

const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names = {"mm",  "cm",   "m", "mL", "L",   "N",   "mN", "Pa", "kPa",
                                                 "MPa", "mmHg", "s", "ms", "deg", "rad", "kg", "g"};
  return names;
}

std::vector<std::string> top_level_names() {
  std::vector<std::string> names;
  for (const std::string& name : library_names())
    if (name.find('.') == std::string::npos) names.push_back(name);
  return names;
}

int unknown_global(lua_State* L) {
  const std::string name = name_at(L, 2);
  for (const char* absent : {"os", "io", "debug", "package", "load", "loadstring", "loadfile", "dofile",
                             "collectgarbage", "next", "_G"}) {
    if (name == absent) {
      return luaL_error(
          L, "'%s' is not available: scenarios reach no files, clocks, code loading or raw tables%s", absent,
          name == "next" ? " (use pairs)" : "");
    }
  }
  const std::vector<std::string>& units = unit_names();
  if (std::find(units.begin(), units.end(), name) != units.end()) {
    return luaL_error(L, "unknown name '%s' (write: local %s = calot.units.%s)", name.c_str(), name.c_str(),
                      name.c_str());
  }
  const std::string near = closest_name(name, top_level_names());
  const std::string hint = near.empty() ? std::string() : fmt::format(" or did you mean '{}'?", near);
  return luaL_error(L, "unknown name '%s' (is a local missing?%s)", name.c_str(), hint.c_str());
}

int new_global(lua_State* L) {
  const std::string name = name_at(L, 2);
  return luaL_error(L, "'%s' would be a global variable (write: local %s = ...)", name.c_str(), name.c_str());
}

/// Copies `names` from the table at the top into the table below it.
void keep(lua_State* L, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_getfield(L, -1, name);
    lua_setfield(L, -3, name);
  }
}

void set(lua_State* L, const char* name, lua_CFunction function) {
  lua_pushcfunction(L, function);
  lua_setfield(L, -2, name);
}

void remove(lua_State* L, const char* name) {
  lua_pushnil(L);
  lua_setfield(L, -2, name);
}

void open(lua_State* L, lua_CFunction opener) {
  lua_pushcfunction(L, opener);
  lua_call(L, 0, 1);
}

void open_base(lua_State* L) {
  open(L, luaopen_base);
  keep(L, {"ipairs", "rawequal", "rawget", "rawlen", "rawset", "select", "tonumber", "type", "_VERSION"});
  lua_pop(L, 1);
  set(L, "assert", assert_true);
  set(L, "error", raise);
  set(L, "getmetatable", get_metatable);
  set(L, "pairs", guarded<ordered_pairs>);
  set(L, "pcall", protected_call);
  set(L, "print", guarded<print>);
  set(L, "require", guarded<require_module>);
  set(L, "setmetatable", set_metatable);
  set(L, "tostring", guarded<to_string>);
}

void open_string(lua_State* L) {
  open(L, luaopen_string);  // this very table is the index of all strings: change it in place
  remove(L, "dump");
  charge_all(L);
  lua_getfield(L, -1, "format");
  lua_pushcclosure(L, guarded<format>, 1);
  lua_setfield(L, -2, "format");
  lua_setfield(L, -2, "string");
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 2);
}

void open_math(lua_State* L, std::uint64_t seed) {
  open(L, luaopen_math);
  lua_getfield(L, -1, "randomseed");
  lua_pushinteger(L, static_cast<lua_Integer>(seed));
  lua_call(L, 1, 0);
  // All but the first are Lua 5.2's, kept by Debian's build.
  for (const char* name : {"randomseed", "atan2", "cosh", "frexp", "ldexp", "log10", "pow", "sinh", "tanh"})
    remove(L, name);
  lua_setfield(L, -2, "math");
}

void open_prelude(lua_State* L) {
  const std::string name = fmt::format("={}", prelude_name);
  if (luaL_loadbufferx(L, prelude_text, std::char_traits<char>::length(prelude_text), name.c_str(), "t") !=
      LUA_OK)
    lua_error(L);
  lua_pushcfunction(L, protected_call);
  lua_getfield(L, -3, "error");
  lua_getfield(L, -4, "type");
  lua_pushcfunction(L, less);
  lua_call(L, 4, 2);
  lua_getfield(L, -3, "table");
  lua_insert(L, -2);
  lua_setfield(L, -2, "sort");
  lua_pop(L, 1);
  lua_setfield(L, -2, "xpcall");
}

/// Reading or writing an unknown global is an error that says what to write instead.
void guard_globals(lua_State* L) {
  lua_newtable(L);
  set(L, "__index", guarded<unknown_global>);
  set(L, "__newindex", guarded<new_global>);
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
}

}  // namespace

void open_library(lua_State* L, std::uint64_t seed) {
  lua_newtable(L);
  open_base(L);  // fills the state's own globals, of which only some are kept
  lua_pushvalue(L, -1);
  lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
  open_string(L);
  open_math(L, seed);
  open(L, luaopen_table);
  charge_all(L);
  lua_setfield(L, -2, "table");
  open(L, luaopen_utf8);
  charge_all(L);
  lua_setfield(L, -2, "utf8");
  push_coroutine_library(L);
  lua_setfield(L, -2, "coroutine");
  open_prelude(L);
  guard_globals(L);
}

}  // namespace calot
