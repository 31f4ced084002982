#pragma once
// What a script finds in its global environment: Lua's own library without files, clocks, addresses, code
// loading and finalisers, with a fixed order of traversal, and with calls that no budget error is lost in.

#include <cstdint>
#include <string>
#include <vector>

struct lua_State;

namespace calot {

/// Chunk name of the library's own Lua code; kept out of traces.
inline constexpr const char* prelude_name = "[calot]";

/// Makes the environment of L, the main thread of a Sandbox. Call it protected.
void open_library(lua_State* L, std::uint64_t seed);

/// The names of the environment, sorted; the members of a library table as "string.rep". For annotations and
/// tests.
const std::vector<std::string>& library_names();

}  // namespace calot
