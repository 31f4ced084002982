#pragma once
// Rows of comma-separated values, RFC 4180.

#include <string>
#include <vector>

namespace calot {

/// In quotes where it has to be.
std::string csv_field(const std::string& text);
/// Of fields that are quoted where they have to be, with its line end.
std::string csv_row(const std::vector<std::string>& fields);

}  // namespace calot
