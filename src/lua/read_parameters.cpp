#include "lua/read_parameters.h"

#include <fmt/format.h>

#include <charconv>

#include "base/suggest.h"
#include "lua/mistakes.h"
#include "lua/table_reader.h"
#include "script/binding.h"
#include "script/lua_headers.h"

namespace calot {
namespace {

constexpr std::size_t longest_shown = 60;  // bytes of a user's text

using Parameter = ParameterDefinition;

std::string to_text(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  return std::get<std::string>(value);
}

std::string wanted(const Parameter& parameter) {
  if (parameter.type == "boolean") return "true or false";
  if (parameter.type == "choice") return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
  std::string text = "a number";
  if (parameter.low) text += fmt::format(", at least {:g}", *parameter.low);
  if (parameter.high) text += fmt::format(", at most {:g}", *parameter.high);
  return text;
}

bool within(const Parameter& parameter, double value) {
  return !(parameter.low && value < *parameter.low) && !(parameter.high && value > *parameter.high);
}

bool is_choice(const Parameter& parameter, const std::string& value) {
  return std::find(parameter.choices.begin(), parameter.choices.end(), value) != parameter.choices.end();
}

std::optional<ParameterValue> fit(const Parameter& parameter, const Value& value) {
  if (parameter.type == "boolean" && value.is(Value::Kind::boolean)) return value.boolean;
  if (parameter.type == "number" && value.is(Value::Kind::number) && within(parameter, value.number))
    return value.number;
  if (parameter.type == "choice" && value.is(Value::Kind::text) && is_choice(parameter, value.text))
    return value.text;
  return std::nullopt;
}

std::optional<ParameterValue> parse(const Parameter& parameter, const std::string& text) {
  if (parameter.type == "boolean" && (text == "true" || text == "false")) return text == "true";
  if (parameter.type == "choice" && is_choice(parameter, text)) return text;
  if (parameter.type == "number") {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size() && within(parameter, value)) return value;
  }
  return std::nullopt;
}

Parameter read_parameter(FieldCheck& check, const TableReader& reader) {
  Parameter parameter;
  reader.take("type", parameter.type);
  reader.take("title", parameter.title);
  reader.take("min", parameter.low);
  reader.take("max", parameter.high);
  if (const Value* choices = reader.take("choices")) {
    for (const Value& choice : choices->items)
      if (choice.is(Value::Kind::text)) parameter.choices.push_back(choice.text);
    if (parameter.choices.size() != choices->items.size()) {
      check.problem(reader.path_of("choices"), "choices must be texts",
                    "such as { \"standard\", \"hydrops\" }");
    }
  }
  if (parameter.type == "choice" && parameter.choices.empty() && !reader.has("choices"))
    check.problem(reader.path(), "a choice needs choices", "add choices = { \"one\", \"other\" }");
  return parameter;
}

}  // namespace

ReadParameters read_parameters(FieldCheck& check, const Value* params,
                               const std::map<std::string, std::string>& chosen) {
  ReadParameters result;
  std::vector<std::string> names;
  if (params != nullptr) {
    for (const auto& [name, value] : params->fields) {
      const std::string path = "params." + name;
      names.push_back(name);
      const TableReader reader(check, &value, path, api_table("param"));
      Parameter parameter = read_parameter(check, reader);
      parameter.name = name;
      const Value* fallback = reader.take("default");
      if (parameter.type.empty() || fallback == nullptr) continue;  // said already
      std::optional<ParameterValue> now = fit(parameter, *fallback);
      if (!now) {
        check.problem(path + ".default", "this default does not fit", "give " + wanted(parameter));
        continue;
      }
      parameter.fallback = to_text(*now);
      if (const auto given = chosen.find(name); given != chosen.end()) {
        if (const std::optional<ParameterValue> parsed = parse(parameter, given->second)) {
          now = parsed;
        } else {
          result.usage.push_back(
              {{},
               fmt::format("parameter {} cannot be \"{}\"", name, shortened(given->second, longest_shown)),
               "give " + wanted(parameter)});
        }
      }
      parameter.value = to_text(*now);
      result.values[name] = *now;
      result.definitions.push_back(std::move(parameter));
    }
  }
  for (const auto& [name, text] : chosen) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      result.usage.push_back(
          {{},
           fmt::format("the scenario has no parameter \"{}\"", shortened(name, longest_shown)),
           suggestion(name, names)});
    }
  }
  return result;
}

namespace {

int unknown_parameter(lua_State* L) {
  const std::vector<std::string> names = keys_of(L, 1);
  const std::string wanted = text_or_type(L, 2);
  raise_mistake(L, fmt::format("there is no parameter \"{}\"", wanted),
                names.empty() ? "declare it in params" : suggestion(wanted, names));
}

}  // namespace

void push_parameters(lua_State* L, const Parameters& parameters) {
  lua_newtable(L);
  for (const auto& [name, value] : parameters) {
    if (const auto* number = std::get_if<double>(&value)) lua_pushnumber(L, *number);
    if (const auto* boolean = std::get_if<bool>(&value)) lua_pushboolean(L, *boolean);
    if (const auto* text = std::get_if<std::string>(&value)) lua_pushlstring(L, text->data(), text->size());
    lua_setfield(L, -2, name.c_str());
  }
  lua_newtable(L);
  lua_pushcfunction(L, guarded<unknown_parameter>);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, -2);
}

}  // namespace calot
