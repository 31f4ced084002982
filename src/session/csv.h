#pragma once
// Rows of comma-separated values, RFC 4180.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace calot {

/// In quotes where it has to be.
std::string csv_field(const std::string& text);
/// Of fields that are quoted where they have to be, with its line end.
std::string csv_row(const std::vector<std::string>& fields);
/// Fields of a row on one line, without its line end and without blanks at their ends; none where a quotation does not end.
std::optional<std::vector<std::string>> csv_fields(std::string_view line, char separator = ',');

}  // namespace calot
