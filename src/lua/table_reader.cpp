#include "lua/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/suggest.h"

namespace calot {
namespace {

std::string wanted(const Key& key) {
  switch (key.kind) {
    case KeyKind::number:
      return key.quantity->unit.empty() ? "a number" : fmt::format("a number ({})", key.quantity->unit);
    case KeyKind::boolean:
      return "true or false";
    case KeyKind::text:
    case KeyKind::choice:
      return "a text";
    case KeyKind::point:
      return "a point { x, y, z }";
    case KeyKind::place:
      return "a point { x, y, z } or a landmark";
    case KeyKind::function:
      return "a function";
    case KeyKind::table:
    case KeyKind::map:
      return "a table { key = value }";
    case KeyKind::made_table:
      return "a table, or a function that returns it";
    case KeyKind::list:
      return "a list { a, b, c }";
    case KeyKind::any:
      break;
  }
  return "a value";
}

bool has_kind(const Key& key, const Value& value) {
  switch (key.kind) {
    case KeyKind::number:
      return value.is(Value::Kind::number);
    case KeyKind::boolean:
      return value.is(Value::Kind::boolean);
    case KeyKind::text:
    case KeyKind::choice:
      return value.is(Value::Kind::text);
    case KeyKind::function:
      return value.is(Value::Kind::function);
    case KeyKind::list:
      return value.is(Value::Kind::table) && value.fields.empty() && !value.has_other_keys;
    case KeyKind::map:
      return value.is(Value::Kind::table) && value.items.empty() && !value.has_other_keys;
    case KeyKind::place:
      return value.is(Value::Kind::table) || value.is(Value::Kind::text);
    case KeyKind::made_table:
      return value.is(Value::Kind::table) || value.is(Value::Kind::function);
    case KeyKind::point:
    case KeyKind::table:
      return value.is(Value::Kind::table);
    case KeyKind::any:
      break;
  }
  return true;
}

std::string example(const Key& key) {
  if (!key.fallback.empty()) return fmt::format("such as {} = {}", key.name, key.fallback);
  return key.doc;
}

}  // namespace

std::string indexed(const std::string& path, std::size_t index) {
  return fmt::format("{}[{}]", path, index + 1);
}

std::optional<Vec3> read_point(FieldCheck& check, const Value& value, const std::string& path) {
  bool good = value.is(Value::Kind::table) && value.items.size() == 3 && value.fields.empty();
  for (const Value& item : value.items)
    good = good && item.is(Value::Kind::number) && std::isfinite(item.number);
  if (!good) {
    check.problem(path, "this is no point",
                  "give three numbers { x, y, z } in m, such as { 0, 10 * mm, 25 * mm }");
    return std::nullopt;
  }
  return Vec3(value.items[0].number, value.items[1].number, value.items[2].number);
}

TableReader::TableReader(FieldCheck& check, const Value* value, std::string path, const KeyTable& api,
                         bool complete)
    : check_(check), path_(std::move(path)), api_(api) {
  if (value == nullptr) return;
  if (value->is(Value::Kind::table)) {
    check_keys(*value, complete);
  } else {
    check_.problem(path_, fmt::format("this must be a table, got {}", name_of(value->kind)), api_.doc);
  }
}

void TableReader::check_keys(const Value& value, bool complete) {
  for (const auto& [name, field] : value.fields) {
    const Key* key = api_.find(name);
    if (key == nullptr) {
      if (name != "kind") {  // set by the constructors of calot.score and calot.exercise
        check_.problem(path_of(name), fmt::format("unknown key \"{}\"", name),
                       suggestion(name, api_.key_names()));
      }
    } else if (check_value(*key, field)) {
      fit_.emplace_back(name, &field);
    }
  }
  if (api_.items.empty() && !value.items.empty()) {
    check_.problem(path_ + "[1]", "a value without a key",
                   fmt::format("known keys: {}", fmt::join(api_.key_names(), ", ")));
  }
  if (value.has_other_keys)
    check_.problem(path_, "keys must be names, or 1, 2, 3 ... without gaps", "look for a nil in the list");
  for (const Key& key : api_.keys) {
    if (complete && key.required && value.field(key.name) == nullptr) {
      check_.problem(path_, fmt::format("\"{}\" is missing", key.name),
                     fmt::format("add {} = ...: {}", key.name, key.doc));
    }
  }
}

bool TableReader::check_value(const Key& key, const Value& value) {
  const std::string path = path_of(key.name);
  if (!has_kind(key, value)) {
    check_.problem(path, fmt::format("{} must be {}, got {}", key.name, wanted(key), name_of(value.kind)),
                   example(key));
    return false;
  }
  if (key.kind == KeyKind::number) return check_number(key, value);
  if (key.kind == KeyKind::choice) return check_choice(key, value);
  if (key.kind != KeyKind::point) return true;
  const std::optional<Vec3> point = read_point(check_, value, path);
  if (!point) return false;
  return api_.checked_by_validate || check_vector(check_, path, *point, key);
}

bool TableReader::check_number(const Key& key, const Value& value) {
  if (api_.checked_by_validate) return true;
  if (!std::isfinite(value.number)) {
    check_.problem(path_of(key.name), fmt::format("{} = {:g} is no finite number", key.name, value.number),
                   example(key));
    return false;
  }
  if (value.number >= key.low && value.number <= key.high) return true;
  if (key.low == key.high) {
    check_.problem(path_of(key.name), fmt::format("{} = {:g} is not available", key.name, value.number),
                   fmt::format("write {} = {:g}", key.name, key.low));
    return false;
  }
  check_.in_range(path_of(key.name), value.number, *key.quantity, key.low, key.high, key.expected());
  return false;
}

bool TableReader::check_choice(const Key& key, const Value& value) {
  return check_.known(path_of(key.name), value.text, key.choices, key.name);
}

const Value* TableReader::take(const std::string& key) const {
  for (const auto& [name, value] : fit_)
    if (name == key) return value;
  return nullptr;
}

void TableReader::read_into(void* definition) const {
  for (const Key& key : api_.keys) {
    const Value* value = take(key.name);
    if (value == nullptr) continue;
    if (key.inner) {
      const TableReader inner(check_, value, path_of(key.name), api_table(key.of));
      inner.read_into(key.inner(definition, true));
    } else if (key.field) {
      assign(key, *value, key.field(definition));
    }
  }
}

void TableReader::assign(const Key& key, const Value& value, const KeyTarget& field) const {
  if (double* const* number = std::get_if<double*>(&field)) **number = value.number;
  if (std::optional<double>* const* number = std::get_if<std::optional<double>*>(&field))
    **number = value.number;
  if (int* const* number = std::get_if<int*>(&field)) take(key.name, **number);
  if (bool* const* flag = std::get_if<bool*>(&field)) **flag = value.boolean;
  if (std::string* const* text = std::get_if<std::string*>(&field)) **text = value.text;
  if (Vec3* const* point = std::get_if<Vec3*>(&field)) take(key.name, **point);
  if (const EnumField* choice = std::get_if<EnumField>(&field)) {
    const auto chosen = std::find(key.choices.begin(), key.choices.end(), value.text);
    choice->set(choice->place, static_cast<int>(chosen - key.choices.begin()));
  }
}

void TableReader::take(const std::string& key, double& target) const {
  if (const Value* value = take(key)) target = value->number;
}

void TableReader::take(const std::string& key, std::optional<double>& target) const {
  if (const Value* value = take(key)) target = value->number;
}

void TableReader::take(const std::string& key, bool& target) const {
  const Value* value = take(key);
  if (value != nullptr) target = value->boolean;
}

void TableReader::take(const std::string& key, int& target) const {
  const Value* value = take(key);
  if (value == nullptr) return;
  if (value->number == std::floor(value->number) && std::abs(value->number) < 1e9) {
    target = static_cast<int>(value->number);
  } else {
    check_.problem(path_of(key), fmt::format("{} = {:g} must be a whole number", key, value->number), "");
  }
}

void TableReader::take(const std::string& key, std::string& target) const {
  if (const Value* value = take(key)) target = value->text;
}

void TableReader::take(const std::string& key, Vec3& target) const {
  if (const Value* value = take(key))
    target = Vec3(value->items[0].number, value->items[1].number, value->items[2].number);
}

}  // namespace calot
