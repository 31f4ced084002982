#pragma once
// A Lua file that returns one table of plain data: benchmarks, a registration.

#include <filesystem>
#include <string>

#include "script/source_map.h"
#include "script/value.h"

namespace calot {

struct TableFile {
  std::string file;
  Value root;  ///< a table
  SourceMap map;
  std::uint64_t source_hash = 0;  ///< of its text and the modules it required
};

/// Runs the file in a sandbox with `calot` (units) and the project's modules. Fails (usage: it cannot be read; scenario:
/// Lua's own errors, or it returns no table, of which `what` says what it is to be; resource).
Result<TableFile> read_table_file(const std::filesystem::path& path, const std::filesystem::path& modules,
                                  const std::string& what);

/// Gives a problem with one of the file's fields the line that the field is written on.
void locate(Problem& problem, const SourceMap& map, const std::string& file);

}  // namespace calot
