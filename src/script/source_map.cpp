#include "script/source_map.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "script/lexer.h"

namespace calot {
namespace {

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : fmt::format("{}.{}", path, key);
}

/// Longer paths than definitions have are not followed: their sum would grow with the square of the text.
constexpr std::size_t longest_path = 300;  // bytes
constexpr std::size_t most_lines = 100'000;

/// The path of what is no value of the exercise.
const std::string nowhere(1, '?');
/// The same, of an entry that has begun.
const std::string hidden = "??";

std::string variable(const std::string& name) { return fmt::format("${}", name); }

/// The path without its last segment; nothing for the empty path.
std::optional<std::string> parent_of(const std::string& path) {
  if (path.empty()) return std::nullopt;
  const std::size_t cut = path.find_last_of(".[");
  return cut == std::string::npos ? std::string() : path.substr(0, cut);
}

}  // namespace

/// Walks the tokens with a stack of what is open. Every scope knows the path of the value being written in
/// it.
class SourceMap::Builder {
 public:
  Builder(SourceMap& map, std::vector<Token> tokens) : map_(map), tokens_(std::move(tokens)) {}

  void run() {
    open(Scope::block, std::string(), nowhere);
    while (at_ < tokens_.size()) {
      if (scopes_.empty()) return;  // more closed than opened: Lua will say so
      step();
    }
  }

 private:
  struct Scope {
    enum Kind { block, table, group } kind;
    std::string own;    ///< of the table, or what the function's `return` gives
    std::string value;  ///< of the value being written
    int items;          ///< positional entries so far
  };

  const Token& token(std::size_t ahead = 0) const {
    static const Token none;
    return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead] : none;
  }
  bool is(const char* text, std::size_t ahead = 0) const {
    const Token& t = token(ahead);
    return (t.kind == Token::Kind::symbol || t.kind == Token::Kind::keyword) && t.text == text;
  }

  void record(const std::string& path, int line) {
    if (!path.starts_with(nowhere) && map_.lines_.size() < most_lines) map_.lines_.emplace(path, line);
  }

  /// At the start of an entry of a table: its key, or its place in the list.
  void begin_entry(Scope& scope) {
    const int line = token().line;
    if (token().kind == Token::Kind::name && is("=", 1)) {
      scope.value = joined(scope.own, token().text);
      at_ += 2;
    } else if (is("[") && token(1).kind == Token::Kind::text && is("]", 2) && is("=", 3)) {
      scope.value = joined(scope.own, token(1).text);
      at_ += 4;
    } else {
      scope.value = fmt::format("{}[{}]", scope.own, ++scope.items);
    }
    if (scope.value.size() > longest_path) scope.value = hidden;
    record(scope.value, line);
    note_alias(scope.value);
  }

  /// A value that is a lone name, or starts as the call of one.
  void note_alias(const std::string& path) {
    if (token().kind != Token::Kind::name) return;
    bool alone = at_ + 1 >= tokens_.size();
    for (const char* after : {",", ";", "}", "(", "end"}) alone = alone || is(after, 1);
    if (alone && !path.starts_with(nowhere) && token().text.size() <= longest_path &&
        map_.aliases_.size() < most_lines)
      map_.aliases_.emplace(path, variable(token().text));
  }

  bool ends_value(const Token& t) const {
    if (t.kind == Token::Kind::name || t.kind == Token::Kind::text || t.kind == Token::Kind::number)
      return true;
    return t.text == ")" || t.text == "}" || t.text == "]" || t.text == "end" || t.text == "nil" ||
           t.text == "true" || t.text == "false";
  }

  /// In a block: which value the coming tokens write.
  void begin_statement(Scope& scope) {
    if (is("return")) {
      scope.value = scope.own;
      record(scope.own, token().line);  // what is nowhere else is looked for there
      ++at_;
      return note_alias(scope.own);
    }
    if (is("local") && is("function", 1)) return;  // step() names the function
    if (is("local")) ++at_;
    const bool fresh = at_ == 0 || ends_value(tokens_[at_ - 1]) || token(0).kind == Token::Kind::keyword;
    if (token().kind == Token::Kind::name && is("=", 1)) {
      scope.value = token().text.size() <= longest_path ? variable(token().text) : nowhere;
      at_ += 2;
    } else if (fresh && token().kind == Token::Kind::name) {
      scope.value = nowhere;
      ++at_;
    }
  }

  void open(Scope::Kind kind, const std::string& own, const std::string& value) {
    scopes_.push_back({kind, own, value, 0});
  }

  void open_function() {
    const int line = token().line;
    ++at_;
    std::string path = scopes_.back().value;
    if (token().kind == Token::Kind::name) {  // function name(...)
      path = token().text.size() <= longest_path ? variable(token().text) : nowhere;
      record(path, line);
      while (at_ < tokens_.size() && !is("(")) ++at_;
    }
    while (at_ < tokens_.size() && !is(")")) ++at_;  // its parameters
    ++at_;
    open(Scope::block, path, nowhere);
  }

  void step() {
    Scope& scope = scopes_.back();
    if (scope.kind == Scope::table && scope.value == nowhere && !is("}") && !is(",") && !is(";"))
      return begin_entry(scope);
    if (scope.kind == Scope::block && begins_statement()) {
      const std::size_t before = at_;
      begin_statement(scope);
      if (at_ != before) return;
    }
    if (is("function")) return open_function();
    if (is("{")) {
      open(Scope::table, scope.value, nowhere);
    } else if (is("(") || is("[")) {
      open(Scope::group, scope.value, scope.value);
    } else if (is("do") || is("if") || is("repeat")) {
      open(Scope::block, scope.own, nowhere);
    } else if (is("}") || is(")") || is("]") || is("end") || is("until")) {
      scopes_.pop_back();
    } else if (scope.kind == Scope::table && (is(",") || is(";"))) {
      scope.value = nowhere;
    }
    ++at_;
  }

  bool begins_statement() const {
    if (is("return") || is("local")) return true;
    return token().kind == Token::Kind::name &&
           (at_ == 0 || ends_value(tokens_[at_ - 1]) || tokens_[at_ - 1].kind == Token::Kind::keyword ||
            is_symbol(tokens_[at_ - 1], ";"));
  }
  static bool is_symbol(const Token& t, const char* text) {
    return t.kind == Token::Kind::symbol && t.text == text;
  }

  SourceMap& map_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<Scope> scopes_;
};

SourceMap::SourceMap(std::string_view source) { Builder(*this, tokens_of(source)).run(); }

int SourceMap::exact_line(const std::string& path, int depth) const {
  const auto found = lines_.find(path);
  if (found != lines_.end()) return found->second;
  if (depth > 8) return 0;  // names that stand for each other
  for (std::optional<std::string> prefix = parent_of(path); prefix; prefix = parent_of(*prefix)) {
    const auto alias = aliases_.find(*prefix);
    if (alias == aliases_.end()) continue;
    const std::string rest = prefix->empty() ? fmt::format(".{}", path) : path.substr(prefix->size());
    const int line = exact_line(alias->second + rest, depth + 1);
    if (line > 0) return line;
  }
  return 0;
}

int SourceMap::line_of(const std::string& path) const {
  for (std::optional<std::string> place = path; place; place = parent_of(*place)) {
    const int line = exact_line(*place, 0);
    if (line > 0) return line;
  }
  return 0;
}

}  // namespace calot
