#pragma once
// What scripts can say, declared once: the keys of the definitions (those of the scene in anatomy/scene_keys.cpp),
// every function and unit, with types, units, limits, defaults and documentation. Readers and bindings check against it; the annotations
// for editors, the luacheck configuration and the reference are generated from it (api_generate.h).

#include <string>
#include <vector>

#include "anatomy/key_table.h"

namespace calot {

struct ApiFunction {
  std::string owner;  ///< "calot", "score", or a class: see api_classes()
  std::string name, doc;
  std::vector<Key> parameters;  ///< `required` false: may be left out
  std::string returns;          ///< the editor's type; empty: nothing

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
extern const Quantity speed, points;
}

const std::vector<KeyTable>& api_tables();
const KeyTable& api_table(const std::string& name);
const std::vector<ApiClass>& api_classes();
const std::vector<ApiFunction>& api_functions();
const ApiFunction& api_function(const std::string& owner, const std::string& name);
/// Of the class and its parents.
std::vector<std::string> method_names(const std::string& class_name);
const std::vector<ApiUnit>& api_units();

}  // namespace calot
