#pragma once
// Pieces of HTML.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace calot {

/// Text as an element's content or an attribute's value in double quotes; bytes that HTML cannot hold are dropped.
std::string escaped(std::string_view text);
/// The same, which may go on in the next line between words that a dot or an underline joins.
std::string breakable(std::string_view name);
std::string base64(std::string_view bytes);
/// "data:image/jpeg;base64,..."
std::string data_uri(const std::string& media_type, std::string_view bytes);

/// A table with its caption, which scrolls by itself where it is wider than the screen. Cells are HTML; the first of a
/// row is its heading.
struct HtmlTable {
  struct Row {
    std::string attributes;  ///< " id=\"event-3\""
    std::vector<std::string> cells;
  };
  std::string caption;             ///< text
  std::vector<std::string> heads;  ///< text
  std::string numbers;             ///< 'r' for a column of numbers, else 'l'
  std::vector<Row> rows;
  bool labelled = false;  ///< cells name their column, for screens on which a row is a card
};
std::string html(const HtmlTable& table);

/// "6.32 s"
std::string seconds(double time);
/// With four digits.
std::string figure_text(double value);

}  // namespace calot
