#pragma once
// The mark that some editors write at the beginning of a text in UTF-8.

#include <string_view>

namespace calot {

/// A text, or its first line, without the mark.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

}  // namespace calot
