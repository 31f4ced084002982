#pragma once
// How the generated files write the API's types and limits.

#include "lua/api_table.h"

namespace calot {

/// As the editor writes it: "number", "calot.wall", "table<string, calot.point>".
std::string type_text(const Key& key);
/// The documentation with default and limits: "2 to 3 mm is usual; default 2 * mm; 0.1 to 10 mm".
std::string doc_text(const Key& key);
/// The types of a table's positional entries: "calot.benchmark|calot.penalty"; empty: there are none.
std::string items_text(const KeyTable& table);

}  // namespace calot
