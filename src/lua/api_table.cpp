#include "lua/api_table.h"

#include <cstdlib>

#include "base/units.h"
#include "lua/api_parts.h"

namespace calot {

namespace quantity {
const Quantity speed{"m/s", {{"mm / s", units::mm}, {"cm / s", units::cm}}};
const Quantity points{"points", {}};
}  // namespace quantity

std::string ApiFunction::full_name() const {
  if (owner == "calot") return "calot." + name;
  if (owner == "score") return "calot.score." + name;
  if (owner == "Run") return "run:" + name;
  if (owner == "Laparoscope" || owner == "DemoLaparoscope") return "t.laparoscope:" + name;
  return (owner == "Instrument" || owner == "DemoInstrument" ? "t.<instrument>:" : "t:") + name;
}

const std::vector<KeyTable>& api_tables() {
  static const std::vector<KeyTable> tables = [] {
    std::vector<KeyTable> all = exercise_tables();
    for (const KeyTable& table : scene_key_tables()) all.push_back(table);
    return all;
  }();
  return tables;
}

const KeyTable& api_table(const std::string& name) {
  for (const KeyTable& table : api_tables())
    if (table.name == name) return table;
  std::abort();  // a name in our own code
}

const std::vector<ApiFunction>& api_functions() {
  static const std::vector<ApiFunction> functions = all_functions();
  return functions;
}

const ApiFunction& api_function(const std::string& owner, const std::string& name) {
  for (const ApiFunction& function : api_functions())
    if (function.owner == owner && function.name == name) return function;
  std::abort();  // a name in our own code
}

const std::vector<ApiClass>& api_classes() {
  static const std::vector<ApiClass> classes = {
      {"Session", "",
       "What steps and demo have in common. Instruments are its fields: t.left, t.right, ...; and "
       "t.laparoscope."},
      {"Steps", "Session",
       "The t of steps = function(t, p): the operation's steps, what to wait for, what to measure."},
      {"Demo", "Session", "The t of demo = function(t, p): moves the instruments."},
      {"Instrument", "", "An instrument as steps see it: what it touches, holds and feels."},
      {"DemoInstrument", "Instrument",
       "An instrument as the demo moves it. Motions return when they have ended."},
      {"Laparoscope", "",
       "The laparoscope, t.laparoscope. With an angled optic it looks down from its shaft (posteriorly) "
       "where it "
       "starts, at roll 0; roll turns the way it looks about the shaft."},
      {"DemoLaparoscope", "Laparoscope", "The laparoscope as the demo moves it."},
      {"Run", "",
       "A session that has ended, as a rule of the score sees it. metrics holds those that were measured by "
       "their "
       "names, "
       "notes what t:note gave last, params what was chosen, events and steps lists in the order of time."}};
  return classes;
}

std::vector<std::string> method_names(const std::string& class_name) {
  std::vector<std::string> names;
  for (const ApiFunction& function : api_functions())
    if (function.owner == class_name) names.push_back(function.name);
  for (const ApiClass& candidate : api_classes()) {
    if (candidate.name != class_name || candidate.parent.empty()) continue;
    for (std::string& name : method_names(candidate.parent)) names.push_back(std::move(name));
  }
  return names;
}

const std::vector<ApiUnit>& api_units() {
  static const std::vector<ApiUnit> table = {{"mm", units::mm, "millimetre"},
                                             {"cm", units::cm, "centimetre"},
                                             {"m", units::m, "metre"},
                                             {"mL", units::mL, "millilitre"},
                                             {"L", units::L, "litre"},
                                             {"N", units::N, "newton"},
                                             {"mN", units::mN, "millinewton"},
                                             {"Pa", units::Pa, "pascal"},
                                             {"kPa", units::kPa, "kilopascal"},
                                             {"MPa", units::MPa, "megapascal"},
                                             {"mmHg", units::mmHg, "millimetre of mercury"},
                                             {"s", units::s, "second"},
                                             {"ms", units::ms, "millisecond"},
                                             {"deg", units::deg, "degree"},
                                             {"rad", units::rad, "radian"},
                                             {"kg", units::kg, "kilogram"},
                                             {"g", units::g, "gram"}};
  return table;
}

}  // namespace calot
