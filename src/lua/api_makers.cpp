#include <fmt/format.h>

#include "lua/api_parts.h"

namespace calot {

ApiKey number(std::string name, const Quantity& quantity, double low, double high, std::string fallback,
              std::string doc) {
  ApiKey key{std::move(name), ApiKind::number, std::move(doc)};
  key.quantity = &quantity;
  key.low = low;
  key.high = high;
  key.fallback = std::move(fallback);
  return key;
}

ApiKey point(std::string name, const Quantity& quantity, double reach, std::string fallback,
             std::string doc) {
  ApiKey key{std::move(name), ApiKind::point, std::move(doc)};
  key.quantity = &quantity;
  key.low = -reach;
  key.high = reach;
  key.fallback = std::move(fallback);
  return key;
}

ApiKey text(std::string name, std::string fallback, std::string doc) {
  ApiKey key{std::move(name), ApiKind::text, std::move(doc)};
  key.fallback = std::move(fallback);
  return key;
}

ApiKey flag(std::string name, std::string fallback, std::string doc) {
  ApiKey key{std::move(name), ApiKind::boolean, std::move(doc)};
  key.fallback = std::move(fallback);
  return key;
}

ApiKey choice(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc) {
  ApiKey key{std::move(name), ApiKind::choice, std::move(doc)};
  key.choices = std::move(choices);
  key.fallback = std::move(fallback);
  return key;
}

namespace {
ApiKey compound(ApiKind kind, std::string name, std::string of, std::string doc) {
  ApiKey key{std::move(name), kind, std::move(doc)};
  key.of = std::move(of);
  return key;
}
}  // namespace

ApiKey table(std::string name, std::string of, std::string doc) {
  return compound(ApiKind::table, std::move(name), std::move(of), std::move(doc));
}
ApiKey list(std::string name, std::string of, std::string doc) {
  return compound(ApiKind::list, std::move(name), std::move(of), std::move(doc));
}
ApiKey map(std::string name, std::string of, std::string doc) {
  return compound(ApiKind::map, std::move(name), std::move(of), std::move(doc));
}

ApiKey function(std::string name, std::string signature, std::string doc) {
  ApiKey key{std::move(name), ApiKind::function, std::move(doc)};
  key.signature = std::move(signature);
  return key;
}

ApiKey required(ApiKey key) {
  key.required = true;
  return key;
}

std::string written(double value, const Quantity& quantity) {
  if (quantity.multipliers.empty()) return fmt::format("{:g}", value);
  const UnitName& unit = quantity.multipliers.front();
  return fmt::format("{:g} * {}", value / unit.factor, unit.name);
}

}  // namespace calot
