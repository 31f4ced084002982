#pragma once
// Reads a definition's table against the API's declaration of it: unknown keys, wrong types, missing keys and
// values out of range become problems; what is fit can be taken.

#include <cstdlib>
#include <optional>
#include <string>

#include "anatomy/field_check.h"
#include "geometry/types.h"
#include "lua/api_table.h"
#include "script/value.h"

namespace calot {

/// The path of a list's entry, counted from 0: "path[1]" for the first.
std::string indexed(const std::string& path, std::size_t index);

/// The point {x, y, z}, or a problem at `path`.
std::optional<Vec3> read_point(FieldCheck& check, const Value& value, const std::string& path);

class TableReader {
 public:
  /// `value` may be null (an absent table): then there is nothing to take and no problem. `complete` false:
  /// what is required may be missing, for tables that override others.
  TableReader(FieldCheck& check, const Value* value, std::string path, const KeyTable& api,
              bool complete = true);

  // Each leaves the target alone unless the key is there and fit.
  void take(const std::string& key, double& target) const;
  void take(const std::string& key, std::optional<double>& target) const;
  void take(const std::string& key, int& target) const;
  void take(const std::string& key, bool& target) const;
  void take(const std::string& key, std::string& target) const;
  void take(const std::string& key, Vec3& target) const;
  /// Every bound key that is there and fit, into the definition that the table declares, with the tables within it.
  template <class T>
  void read(T& definition) const {
    if (api_.definition == nullptr || *api_.definition != typeid(T)) std::abort();  // a slip in our own code
    read_into(&definition);
  }
  /// A table's, list's, function's or other value; null unless there and of the right kind.
  const Value* take(const std::string& key) const;
  bool has(const std::string& key) const { return take(key) != nullptr; }

  const std::string& path() const { return path_; }
  std::string path_of(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

 private:
  void read_into(void* definition) const;
  void assign(const Key& key, const Value& value, const KeyTarget& field) const;
  void check_keys(const Value& value, bool complete);
  bool check_value(const Key& key, const Value& value);
  bool check_number(const Key& key, const Value& value);
  bool check_choice(const Key& key, const Value& value);

  FieldCheck& check_;
  std::string path_;
  const KeyTable& api_;
  std::vector<std::pair<std::string, const Value*>> fit_;
};

}  // namespace calot
