#include "lua/api_generate.h"

#include <fmt/format.h>

#include "anatomy/definitions.h"
#include "base/units.h"
#include "lua/api_text.h"
#include "script/sandbox_library.h"
#include "session/metrics.h"

namespace calot {
namespace {

constexpr const char* origin =
    "Generated from the API's table (src/lua/api_*.cpp, src/anatomy/scene_keys.cpp); the tests hold it to "
    "that. Do not edit.";

std::string shape_types() {
  std::string types;
  for (const KeyTable& table : api_tables()) {
    if (table.name.starts_with("shape_"))
      types += fmt::format("{}calot.{}", types.empty() ? "" : "|", table.name);
  }
  return types;
}

std::string annotate_table(const KeyTable& table) {
  std::string text = fmt::format("\n---{}\n---@class calot.{}\n", table.doc, table.name);
  for (const Key& key : table.keys) {
    text += fmt::format("---@field {}{} {} {}\n", key.name, key.required ? "" : "?", type_text(key),
                        doc_text(key));
  }
  if (!table.items.empty()) text += fmt::format("---@field [integer] {}\n", items_text(table));
  return text;
}

std::string annotate_function(const ApiFunction& function, const std::string& prefix) {
  std::string text = fmt::format("\n---{}\n", function.doc), names;
  for (const Key& parameter : function.parameters) {
    text += fmt::format("---@param {}{} {} {}\n", parameter.name, parameter.required ? "" : "?",
                        type_text(parameter), doc_text(parameter));
    names += fmt::format("{}{}", names.empty() ? "" : ", ", parameter.name);
  }
  if (!function.returns.empty()) text += fmt::format("---@return {}\n", function.returns);
  return text + fmt::format("function {}{}({}) end\n", prefix, function.name, names);
}

std::string annotate_functions(const std::string& owner, const std::string& prefix) {
  std::string text;
  for (const ApiFunction& function : api_functions())
    if (function.owner == owner) text += annotate_function(function, prefix);
  return text;
}

std::string annotate_class(const ApiClass& handle) {
  const std::string parent = handle.parent.empty() ? "" : fmt::format(": calot.{}", handle.parent);
  std::string text = fmt::format("\n---{}\n---@class calot.{}{}\n", handle.doc, handle.name, parent);
  if (handle.name == "Steps")
    text += "---@field [string] calot.Instrument\n---@field laparoscope calot.Laparoscope\n";
  if (handle.name == "Demo")
    text += "---@field [string] calot.DemoInstrument\n---@field laparoscope calot.DemoLaparoscope\n";
  if (handle.name == "Run")
    text +=
        "---@field events calot.event[]\n---@field steps calot.step[]\n---@field metrics table<string, "
        "number>\n"
        "---@field notes table<string, number|string|boolean>\n---@field params table<string, any>\n";
  return text + fmt::format("local {} = {{}}\n", handle.name) +
         annotate_functions(handle.name, fmt::format("{}:", handle.name));
}

/// "string" of "string.rep"; empty for a plain name.
std::string library_of(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? std::string() : name.substr(0, dot);
}

std::string signature(const ApiFunction& function) {
  std::string names;
  for (const Key& parameter : function.parameters) {
    names += fmt::format("{}{}{}{}", parameter.required ? "" : "[", names.empty() ? "" : ", ", parameter.name,
                         parameter.required ? "" : "]");
  }
  return fmt::format("{}({})", function.full_name(), names);
}

std::string describe_table(const KeyTable& table) {
  std::string text =
      fmt::format("\n### {}\n\n{}\n\n| key | type | |\n|---|---|---|\n", table.name, table.doc);
  for (const Key& key : table.keys) {
    std::string type = type_text(key);
    for (std::size_t bar = 0; (bar = type.find('|', bar)) != std::string::npos; bar += 2)
      type.insert(bar, 1, '\\');
    text += fmt::format("| `{}`{} | `{}` | {} |\n", key.name, key.required ? " (needed)" : "", type,
                        doc_text(key));
  }
  return text;
}

std::string describe_function(const ApiFunction& function) {
  std::string text =
      fmt::format("\n**`{}`**{} {}\n", signature(function),
                  function.returns.empty() ? "" : fmt::format(" → `{}`", function.returns), function.doc);
  for (const Key& parameter : function.parameters)
    text += fmt::format("- `{}`: {}\n", parameter.name, doc_text(parameter));
  return text;
}

/// What t.left:contact() returns.
KeyTable contact_table() {
  return {"contact",
          "Where an instrument touches, as contact returns it.",
          {required(choice("part", tool_part_names(), "", "the part that touches")),
           required(text("organ", "", "the organ that it touches")),
           required(point("place", quantity::length, 0, "", "the point that is pressed hardest, m")),
           required(text("landmark", "", "the landmark nearest to it, such as \"gallbladder.fundus\"")),
           required(number("force", quantity::force, 0, 0, "", "of the tissue on the whole part, N"))}};
}

/// Of what a rule's run.events has each.
KeyTable event_table() {
  return {"event",
          "An event of a session, as a rule sees it.",
          {required(choice("event", event_names(), "", "its kind")),
           required(number("time", quantity::time, 0, 0, "", "when, s")),
           required(text("step", "", "the step that ran")), text("instrument", "", "whose it is"),
           text("organ", "", "or tissue, that it happened to"),
           number("value", quantity::number, 0, 0, "", "as the kind says, in the unit that it says"),
           point("place", quantity::length, 0, "", "where, m"),
           choice("cause", event_cause_names(), "", "what did it"),
           text("text", "", "an injury's class; what was said at a time-out or a bail-out")}};
}

/// Of its run.steps.
KeyTable step_table() {
  return {
      "step",
      "A step of a session, as a rule sees it.",
      {required(text("name", "", "its name")),
       required(choice("outcome", {"done", "timeout", "missed", "bail_out", "aborted"}, "", "how it ended")),
       required(number("started", quantity::time, 0, 0, "", "when it began, s")),
       required(number("ended", quantity::time, 0, 0, "", "when it ended, s"))}};
}

/// Of what t:clips() returns each.
KeyTable clip_table() {
  return {"clip",
          "A clip on a tube, as clips returns it.",
          {required(number("place", quantity::number, 0, 1, "", "share of the tube's length from its start")),
           required(number("opening", quantity::number, 0, 1, "",
                           "share of the tube's width that it does not hold; 0: it is shut")),
           required(choice("size", clip_names(), "", "the clip's size"))}};
}

Key share_key(const char* name, const char* doc) {
  return required(number(name, quantity::number, 0, 1, "", doc));
}

Key points_key(double most) { return required(number("points", quantity::number, 0, most, "", "earned")); }

/// What t:critical_view() returns, with its parts.
std::vector<KeyTable> critical_view_tables() {
  const auto part = [](const char* name, const char* doc) {
    return required(table(name, fmt::format("critical_view_{}", name), doc));
  };
  return {
      {"critical_view_triangle",
       "The hepatocystic triangle, by rays through it.",
       {share_key("front", "cleared of tissue, of what organs and instruments leave open to the laparoscope"),
        share_key("behind", "the same from behind"),
        share_key("front_open",
                  "left open by organs and instruments to the laparoscope; below 0.1 nothing "
                  "counts as cleared"),
        share_key("behind_open", "the same from behind"), points_key(2)}},
      {"critical_view_plate",
       "The cystic plate on the gallbladder's lower part.",
       {share_key("share", "of its strands there that are torn; 1 where there are none"), points_key(2)}},
      {"critical_view_structures",
       "What enters the gallbladder.",
       {required(number("count", quantity::number, 0, 100, "", "tubes joined to it that are not divided")),
        required(number("free", quantity::number, 0, 100, "", "of those what is seen and free around")),
        points_key(2)}},
      {"critical_view",
       "The critical view of safety, as critical_view returns it.",
       {part("triangle", "the hepatocystic triangle"), part("plate", "the cystic plate"),
        part("structures", "what enters the gallbladder"), points_key(6)}}};
}

/// Of what t:strands() returns each.
KeyTable strand_table() {
  const auto place = [](const char* name, const char* doc) {
    return required(point(name, quantity::length, 0, "", doc));
  };
  return {"strand",
          "A strand of a tissue, as strands returns it.",
          {place("from", "its end on the tissue's first organ"), place("middle", "its own middle"),
           place("to", "its end on the other organ"),
           required(number("share", quantity::number, 0, 1, "",
                           "of the first organ's way, where it begins: a tube's length, else from neck to "
                           "fundus")),
           required(number("tension", quantity::force, 0, 1e6, "", "N; 0 while it is slack"))}};
}

std::string in_mm(const Vec3& place) {
  return fmt::format("{{ {:g} * mm, {:g} * mm, {:g} * mm }}", place.x() / units::mm, place.y() / units::mm,
                     place.z() / units::mm);
}

/// What a scenario names: ports, landmarks, events, metrics. `calot list` prints the same.
std::string describe_names() {
  std::string text = "\n## Ports\n\n| port | place |\n|---|---|\n";
  for (const PortDefinition& port : default_ports())
    text += fmt::format("| `{}` | `{}` |\n", port.name, in_mm(port.position));
  text +=
      "\n## Landmarks\n\nEach of organs of its kind; `calot list FILE` says which: "
      "`gallbladder.fundus`.\n\n| landmark | |\n|---|---|\n";
  for (const Landmark& landmark : landmark_rows())
    text += fmt::format("| `{}` | {} |\n", landmark.name, landmark.doc);
  text += "\n## Events\n\n| event | raised when | value |\n|---|---|---|\n";
  for (const EventRow& event : event_rows())
    text += fmt::format("| `{}` | {} | {} |\n", event.name, event.doc, event.value);
  text += "\n## Metrics\n\np: tip, u: direction of the shaft, d: depth, psi: turn about the shaft.\n";
  text += "\n| metric | |\n|---|---|\n";
  for (const MetricRow& metric : metric_rows())
    text += fmt::format("| `{}` | {} |\n", pattern(metric), metric.doc);
  return text;
}

}  // namespace

std::string generate_annotations() {
  std::string text = fmt::format("---@meta calot\n-- {}\n", origin);
  text +=
      "\n---A place or a vector {x, y, z} in m, in the patient's frame: x to the patient's left, y towards "
      "the head,\n";
  text += "---z out of the abdomen, from the navel.\n---@alias calot.point number[]\n";
  text += fmt::format("---@alias calot.shape {}\n", shape_types());
  for (const KeyTable& table : api_tables()) text += annotate_table(table);
  text += annotate_table(contact_table());
  text += annotate_table(clip_table());
  text += annotate_table(event_table());
  text += annotate_table(step_table());
  for (const KeyTable& table : critical_view_tables()) text += annotate_table(table);
  text += annotate_table(strand_table());
  for (const ApiClass& handle : api_classes()) text += annotate_class(handle);
  text +=
      "\n---Multipliers to write figures with: 70 * mm, 12 * mmHg. Everything is in SI.\n---@class "
      "calot.units\n";
  for (const ApiUnit& unit : api_units())
    text += fmt::format("---@field {} number {}\n", unit.name, unit.doc);
  text += "\n---@class calot.score\nlocal score = {}\n" + annotate_functions("score", "score.");
  text += "\n---@class calot\n---@field units calot.units\n---@field score calot.score\nlocal calot = {}\n";
  return text + annotate_functions("calot", "calot.") + "\nreturn calot\n";
}

std::string generate_luacheckrc() {
  std::string text = fmt::format("-- {}\nstd = \"calot\"\nmax_line_length = 120\n", origin);
  text += "exclude_files = { \"scripts/lua/calot.meta.lua\" }\nstds.calot = {\n  read_globals = {\n";
  const std::vector<std::string>& names = library_names();
  for (const std::string& name : names) {
    if (!library_of(name).empty()) continue;
    std::string fields;
    for (const std::string& member : names) {
      if (library_of(member) == name) {
        fields +=
            fmt::format("{}[\"{}\"] = {{}}", fields.empty() ? "" : ", ", member.substr(name.size() + 1));
      }
    }
    text += fields.empty() ? fmt::format("    \"{}\",\n", name)
                           : fmt::format("    {} = {{ fields = {{ {} }} }},\n", name, fields);
  }
  return text + "  },\n}\n";
}

std::string generate_reference() {
  std::string text = fmt::format("<!-- {} -->\n# What a scenario can say\n\n", origin);
  text +=
      "A scenario is a Lua file that returns `calot.exercise { ... }`; `scenarios/` has examples, and\n"
      "`calot check` says what is wrong with one. Figures carry their unit (`70 * mm`); everything is in "
      "SI.\n"
      "Places are `{ x, y, z }` in the patient's frame: x to the patient's left, y towards the head, z out "
      "of\n"
      "the abdomen, from the navel. `require` finds modules beside the scenario and in this folder.\n";
  text += "\n## Functions\n";
  for (const char* owner : {"calot", "score"}) {
    for (const ApiFunction& function : api_functions())
      if (function.owner == owner) text += describe_function(function);
  }
  for (const ApiClass& handle : api_classes()) {
    text += fmt::format("\n## {}\n\n{}\n", handle.name, handle.doc);
    if (!handle.parent.empty()) text += fmt::format("It has the functions of {} too.\n", handle.parent);
    for (const ApiFunction& function : api_functions())
      if (function.owner == handle.name) text += describe_function(function);
  }
  text += "\n## Tables\n";
  for (const KeyTable& table : api_tables()) text += describe_table(table);
  text += describe_table(contact_table());
  text += describe_table(clip_table());
  text += describe_table(event_table());
  text += describe_table(step_table());
  for (const KeyTable& table : critical_view_tables()) text += describe_table(table);
  text += describe_table(strand_table());
  text += describe_names();
  text += "\n## Units\n\n";
  for (const ApiUnit& unit : api_units())
    text += fmt::format("- `calot.units.{}`: {}\n", unit.name, unit.doc);
  return text;
}

}  // namespace calot
