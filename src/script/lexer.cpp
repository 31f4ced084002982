#include "script/lexer.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace calot {
namespace {

constexpr std::array keywords = {"and",      "break",  "do",   "else", "elseif", "end",  "false", "for",
                                 "function", "goto",   "if",   "in",   "local",  "nil",  "not",   "or",
                                 "repeat",   "return", "then", "true", "until",  "while"};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class Lexer {
 public:
  explicit Lexer(std::string_view source) : source_(source) {}

  std::vector<Token> run() {
    while (at_ < source_.size()) next();
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
  }

  void advance(std::size_t count) {
    for (; count > 0 && at_ < source_.size(); --count) line_ += source_[at_++] == '\n' ? 1 : 0;
  }

  void add(Token::Kind kind, std::size_t length) {
    tokens_.push_back({kind, std::string(source_.substr(at_, length)), line_});
    advance(length);
  }

  /// "[[", "[=[" ...: the number of characters to the second bracket, or 0 when none opens here.
  std::size_t long_bracket() const {
    if (peek() != '[') return 0;
    std::size_t length = 1;
    while (peek(length) == '=') ++length;
    return peek(length) == '[' ? length + 1 : 0;
  }

  /// Skips a long bracket and gives what is inside.
  std::string_view long_text() {
    const std::size_t opening = long_bracket();
    std::string closing(opening, '=');
    closing.front() = closing.back() = ']';
    const std::size_t start = at_ + opening;
    const std::size_t end = std::min(source_.find(closing, start), source_.size());
    advance(std::min(end + closing.size(), source_.size()) - at_);
    return source_.substr(std::min(start, source_.size()), end - std::min(start, end));
  }

  void quoted(char quote) {
    const int line = line_;
    std::size_t length = 1;
    while (at_ + length < source_.size() && peek(length) != quote && peek(length) != '\n')
      length += peek(length) == '\\' ? 2 : 1;
    const std::string_view inside = source_.substr(at_ + 1, std::min(length, source_.size() - at_) - 1);
    tokens_.push_back({Token::Kind::text, std::string(inside), line});
    advance(length + 1);
  }

  void name() {
    std::size_t length = 1;
    while (is_letter(peek(length)) || is_digit(peek(length))) ++length;
    const std::string_view word = source_.substr(at_, length);
    const bool reserved = std::find(keywords.begin(), keywords.end(), word) != keywords.end();
    add(reserved ? Token::Kind::keyword : Token::Kind::name, length);
  }

  void number() {
    std::size_t length = 1;
    const auto exponent_sign = [&](char c) {
      return (c == '+' || c == '-') &&
             std::string_view("eEpP").find(peek(length - 1)) != std::string_view::npos;
    };
    while (is_letter(peek(length)) || is_digit(peek(length)) || peek(length) == '.' ||
           exponent_sign(peek(length)))
      ++length;
    add(Token::Kind::number, length);
  }

  void symbol() {
    for (const std::string_view candidate : {"...", "..", "==", "~=", "<=", ">=", "//", "::", "<<", ">>"})
      if (source_.substr(at_).starts_with(candidate)) return add(Token::Kind::symbol, candidate.size());
    add(Token::Kind::symbol, 1);
  }

  void next() {
    const char c = peek();
    if (std::isspace(static_cast<unsigned char>(c)) != 0) return advance(1);
    if (c == '-' && peek(1) == '-') {
      advance(2);
      if (long_bracket() > 0) {
        long_text();
      } else {
        advance(std::min(source_.find('\n', at_), source_.size()) - at_);
      }
      return;
    }
    if (long_bracket() > 0) {
      const int line = line_;
      const std::string text(long_text());
      tokens_.push_back({Token::Kind::text, text, line});
      return;
    }
    if (c == '"' || c == '\'') return quoted(c);
    if (is_letter(c)) return name();
    if (is_digit(c) || (c == '.' && is_digit(peek(1)))) return number();
    symbol();
  }

  std::string_view source_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view source) { return Lexer(source).run(); }

}  // namespace calot
