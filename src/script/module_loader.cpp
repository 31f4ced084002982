#include "script/module_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/status.h"
#include "script/lua_headers.h"
#include "script/safe_path.h"
#include "script/sandbox.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

constexpr const char* modules_key = "calot.modules";

bool is_name_part(const std::string& part) {
  return !part.empty() && std::all_of(part.begin(), part.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// "grips.fold" -> grips/fold.lua. Only letters, digits, _ and -, so nothing can point upward.
fs::path file_of_module(const std::string& name) {
  fs::path path;
  for (std::size_t start = 0; start <= name.size();) {
    const std::size_t dot = std::min(name.find('.', start), name.size());
    const std::string part = name.substr(start, dot - start);
    if (!is_name_part(part)) {
      throw std::runtime_error(fmt::format(
          "require: \"{}\" is no module's name (use letters, digits, _ and -, with dots for folders)", name));
    }
    path /= part;
    start = dot + 1;
  }
  path += ".lua";
  return path;
}

fs::path find_module(const SandboxOptions& options, const std::string& name) {
  const fs::path file = file_of_module(name);
  const std::array<fs::path, 2> folders{options.script.parent_path(), options.modules};
  for (const fs::path& folder : folders)
    if (options.texts.contains(folder / file)) return folder / file;
  std::string sought;
  for (const fs::path& folder : folders) {
    if (folder.empty() && folder != options.script.parent_path()) continue;
    const fs::path base = folder.empty() ? fs::path(".") : folder;
    if (fs::is_regular_file(base / file)) {
      if (!is_inside(base / file, base)) {
        throw std::runtime_error(
            fmt::format("require: {} is a link out of {}", (base / file).string(), base.string()));
      }
      return folder / file;
    }
    sought += (sought.empty() ? "" : ", ") + (base / file).string();
  }
  throw std::runtime_error(fmt::format("require: there is no module \"{}\" (looked for {})", name, sought));
}

}  // namespace

void add_builtin_module(lua_State* L, const char* name) {
  luaL_getsubtable(L, LUA_REGISTRYINDEX, modules_key);
  lua_insert(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

int require_module(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1);
  luaL_getsubtable(L, LUA_REGISTRYINDEX, modules_key);
  const int modules = lua_gettop(L);
  if (lua_getfield(L, modules, name.c_str()) != LUA_TNIL) {
    if (lua_islightuserdata(L, -1))
      return luaL_error(L, "require: \"%s\" requires itself, directly or through others", name.c_str());
    return 1;
  }
  Sandbox& sandbox = Sandbox::of(L);
  const fs::path path = find_module(sandbox.options(), name);
  lua_pushlightuserdata(L, &sandbox);  // marks a module that is being loaded
  lua_setfield(L, modules, name.c_str());
  sandbox.push_chunk(L, path);
  lua_call(L, 0, 1);
  if (lua_isnil(L, -1)) {
    lua_pop(L, 1);
    lua_pushboolean(L, 1);
  }
  lua_pushvalue(L, -1);
  lua_setfield(L, modules, name.c_str());
  return 1;
}

}  // namespace calot
