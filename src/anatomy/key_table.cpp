#include "anatomy/key_table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace calot {
namespace {

const KeyTable* find_table(const std::string& name) {
  for (const KeyTable& table : scene_key_tables())
    if (table.name == name) return &table;
  return nullptr;
}

Key compound(KeyKind kind, std::string name, std::string of, std::string doc) {
  Key key{std::move(name), kind, std::move(doc)};
  key.of = std::move(of);
  return key;
}

}  // namespace

const Key* KeyTable::find(const std::string& key) const {
  for (const Key& candidate : keys)
    if (candidate.name == key) return &candidate;
  return nullptr;
}

std::vector<std::string> KeyTable::key_names() const {
  std::vector<std::string> names;
  for (const Key& key : keys) names.push_back(key.name);
  return names;
}

const KeyTable& scene_key_table(const std::string& name, const std::type_info& definition) {
  const KeyTable* table = find_table(name);
  if (table == nullptr || table->definition == nullptr || *table->definition != definition) std::abort();
  return *table;
}

void check_limits(FieldCheck& check, const std::string& path, const KeyTable& table, const void* definition,
                  const std::string& leave_out) {
  void* const looked_at =
      const_cast<void*>(definition);  // the accessors serve reading too; nothing is written here
  for (const Key& key : table.keys) {
    if (key.name == leave_out) continue;
    const std::string at = fmt::format("{}.{}", path, key.name);
    if (key.inner) {
      if (const void* inner = key.inner(looked_at, false))
        check_limits(check, at, *find_table(key.of), inner);
      continue;
    }
    if (!key.field) continue;
    const KeyTarget field = key.field(looked_at);
    std::optional<double> value;
    if (double* const* number = std::get_if<double*>(&field)) value = **number;
    if (std::optional<double>* const* number = std::get_if<std::optional<double>*>(&field)) value = **number;
    if (int* const* number = std::get_if<int*>(&field)) value = **number;
    if (value) check.in_range(at, *value, *key.quantity, key.low, key.high, key.expected());
    Vec3* const* place = std::get_if<Vec3*>(&field);
    if (place != nullptr && std::isfinite(key.high)) check_vector(check, at, **place, key);
  }
}

bool check_vector(FieldCheck& check, const std::string& path, const Vec3& value, const Key& key) {
  return key.quantity == &quantity::angle ? check.turn_within(path, value, key.high, key.expected())
                                          : check.place_within(path, value, key.high, key.expected());
}

Key number(std::string name, const Quantity& quantity, double low, double high, std::string fallback,
           std::string doc) {
  Key key{std::move(name), KeyKind::number, std::move(doc)};
  key.quantity = &quantity;
  key.low = low;
  key.high = high;
  key.fallback = std::move(fallback);
  return key;
}

Key point(std::string name, const Quantity& quantity, double reach, std::string fallback, std::string doc) {
  Key key{std::move(name), KeyKind::point, std::move(doc)};
  key.quantity = &quantity;
  key.low = -reach;
  key.high = reach;
  key.fallback = std::move(fallback);
  return key;
}

Key text(std::string name, std::string fallback, std::string doc) {
  Key key{std::move(name), KeyKind::text, std::move(doc)};
  key.fallback = std::move(fallback);
  return key;
}

Key flag(std::string name, std::string fallback, std::string doc) {
  Key key{std::move(name), KeyKind::boolean, std::move(doc)};
  key.fallback = std::move(fallback);
  return key;
}

Key choice(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc) {
  Key key{std::move(name), KeyKind::choice, std::move(doc)};
  key.choices = std::move(choices);
  key.fallback = std::move(fallback);
  return key;
}

Key table(std::string name, std::string of, std::string doc) {
  return compound(KeyKind::table, std::move(name), std::move(of), std::move(doc));
}
Key made_table(std::string name, std::string of, std::string doc) {
  return compound(KeyKind::made_table, std::move(name), std::move(of), std::move(doc));
}
Key list(std::string name, std::string of, std::string doc) {
  return compound(KeyKind::list, std::move(name), std::move(of), std::move(doc));
}
Key map(std::string name, std::string of, std::string doc) {
  return compound(KeyKind::map, std::move(name), std::move(of), std::move(doc));
}

Key function(std::string name, std::string signature, std::string doc) {
  Key key{std::move(name), KeyKind::function, std::move(doc)};
  key.signature = std::move(signature);
  return key;
}

Key required(Key key) {
  key.required = true;
  key.fallback.clear();
  return key;
}

Key only_of(KeyOwner owner, Key key) {
  key.owner = owner;
  return key;
}

std::string written(double value, const Quantity& quantity) {
  if (quantity.multipliers.empty()) return fmt::format("{:g}", value);
  const UnitName& unit = quantity.multipliers.front();
  return fmt::format("{:g} * {}", value / unit.factor, unit.name);
}

std::string written(const Vec3& value, const Quantity& quantity) {
  std::string text;
  for (const double x : value)
    text += fmt::format("{}{}", text.empty() ? "{ " : ", ", x == 0 ? "0" : written(x, quantity));
  return text + " }";
}

}  // namespace calot
