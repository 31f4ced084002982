#pragma once
// What is made from the API's table and kept in the repository; the tests hold the files to it.

#include <string>

namespace calot {

/// For LuaLS and editors that use it: scripts/lua/calot.meta.lua.
std::string generate_annotations();
/// luacheck's configuration, with the sandbox's globals: .luacheckrc.
std::string generate_luacheckrc();
/// For people: scripts/lua/README.md.
std::string generate_reference();

}  // namespace calot
