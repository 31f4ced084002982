#pragma once
// What scripts can say, declared once: every key of every definition table, every function and unit, with
// types, units, limits, defaults and documentation. Readers and bindings check against it; the annotations
// for editors, the luacheck configuration and the reference are generated from it (api_generate.h).

#include <limits>
#include <string>
#include <vector>

#include "anatomy/field_check.h"

namespace calot {

enum class ApiKind {
  number,
  boolean,
  text,
  choice,  ///< a text out of `choices`
  point,   ///< {x, y, z}
  place,   ///< {x, y, z} or a landmark "organ.landmark"
  function,
  table,  ///< of the keys of table `of`
  list,   ///< items of table `of`, or of numbers or texts ("number", "text")
  map,    ///< author's names to tables `of`, or to points ("point")
  any
};

struct ApiKey {
  std::string name;
  ApiKind kind = ApiKind::number;
  std::string doc;
  bool required = false;
  const Quantity* quantity = &quantity::number;  ///< of numbers and points
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string fallback{};              ///< the default as an author would write it; may be empty
  std::string of{};                    ///< for tables, lists and maps
  std::vector<std::string> choices{};  ///< for choices
  std::string signature{};             ///< for functions, as the editor's type
};

struct ApiTable {
  std::string name, doc;
  std::vector<ApiKey> keys;
  std::string items{};  ///< tables of the positional entries ("a|b"); empty: there are none
  /// Its limits are checked by anatomy's validate(), which the tests hold against this table.
  bool validated_elsewhere = false;

  const ApiKey* find(const std::string& key) const;
  std::vector<std::string> key_names() const;
};

struct ApiFunction {
  std::string owner;  ///< "calot", "score", or a class: see api_classes()
  std::string name, doc;
  std::vector<ApiKey> parameters;  ///< `required` false: may be left out
  std::string returns;             ///< the editor's type; empty: nothing

  std::string full_name() const;  ///< "t:hold", "t.<instrument>:force", "calot.anatomy": for messages
};

/// A handle's class and the class whose methods it has too.
struct ApiClass {
  std::string name, parent, doc;
};

struct ApiUnit {
  std::string name;
  double factor = 1;
  std::string doc;
};

namespace quantity {
extern const Quantity time, speed, points;
}

const std::vector<ApiTable>& api_tables();
const ApiTable& api_table(const std::string& name);
const std::vector<ApiClass>& api_classes();
const std::vector<ApiFunction>& api_functions();
const ApiFunction& api_function(const std::string& owner, const std::string& name);
/// Of the class and its parents.
std::vector<std::string> method_names(const std::string& class_name);
const std::vector<ApiUnit>& api_units();

}  // namespace calot
