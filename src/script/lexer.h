#pragma once
// Lua's tokens with their lines; enough to find where a table's key was written.

#include <string>
#include <string_view>
#include <vector>

namespace calot {

struct Token {
  enum class Kind { name, keyword, text, number, symbol };
  Kind kind = Kind::symbol;
  std::string text;  ///< a text without its quotes, escapes as written
  int line = 0;
};

/// Comments and blanks are left out. Text that Lua would refuse gives some tokens too, never an error.
std::vector<Token> tokens_of(std::string_view source);

}  // namespace calot
