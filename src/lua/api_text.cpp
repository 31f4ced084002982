#include "lua/api_text.h"

#include <fmt/format.h>

#include <cmath>

namespace calot {
namespace {

std::string named(const std::string& of) {
  if (of == "number") return "number";
  if (of == "text") return "string";
  return fmt::format("calot.{}", of);
}

std::string quoted(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += fmt::format("{}\"{}\"", all.empty() ? "" : "|", text);
  return all;
}

std::string limits(const Key& key) {
  const bool has_limits =
      key.kind == KeyKind::number && std::isfinite(key.low) && std::isfinite(key.high) && key.low < key.high;
  if (!has_limits) return {};
  const Quantity& quantity = *key.quantity;
  const UnitName unit =
      quantity.multipliers.empty() ? UnitName{quantity.unit, 1} : quantity.multipliers.front();
  return fmt::format("{:g} to {:g}{}{}", key.low / unit.factor, key.high / unit.factor,
                     unit.name.empty() ? "" : " ", unit.name);
}

}  // namespace

std::string type_text(const Key& key) {
  switch (key.kind) {
    case KeyKind::number:
      return "number";
    case KeyKind::boolean:
      return "boolean";
    case KeyKind::text:
      return "string";
    case KeyKind::choice:
      return quoted(key.choices);
    case KeyKind::point:
      return "calot.point";
    case KeyKind::place:
      return "calot.point|string";
    case KeyKind::function:
      return key.signature;
    case KeyKind::table:
      return named(key.of);
    case KeyKind::made_table:
      return fmt::format("{0}|fun(p: table<string, any>): {0}", named(key.of));
    case KeyKind::list:
      return named(key.of) + "[]";
    case KeyKind::map:
      return fmt::format("table<string, {}>", named(key.of));
    case KeyKind::any:
      break;
  }
  return "any";
}

std::string doc_text(const Key& key) {
  std::string text = key.doc;
  if (key.owner == KeyOwner::jaws) text += "; jaws only";
  if (key.owner == KeyOwner::clips) text += "; clip_applier only";
  if (key.owner == KeyOwner::needle) text += "; aspiration_needle only";
  if (key.owner == KeyOwner::current) text += "; only what can be activated";
  if (!key.fallback.empty()) text += fmt::format("; default {}", key.fallback);
  const std::string range = limits(key);
  if (!range.empty()) text += fmt::format("; {}", range);
  return text;
}

std::string items_text(const KeyTable& table) {
  std::string all;
  for (std::size_t start = 0; start < table.items.size();) {
    const std::size_t end = std::min(table.items.find('|', start), table.items.size());
    all += fmt::format("{}calot.{}", all.empty() ? "" : "|", table.items.substr(start, end - start));
    start = end + 1;
  }
  return all;
}

}  // namespace calot
