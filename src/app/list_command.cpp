#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "base/units.h"
#include "play/play.h"
#include "process/terminal.h"
#include "session/json.h"
#include "session/metrics.h"

namespace calot {
namespace {

/// One list: its rows to print, and the same for programs.
struct Listing {
  std::string key, title;
  std::vector<std::vector<std::string>> rows;
  OrderedJson json = OrderedJson::array();
};

Listing ports(const std::vector<PortDefinition>& list) {
  Listing listing{"ports", "Ports", {}};
  for (const PortDefinition& port : list) {
    const Vec3& at = port.position;
    listing.rows.push_back(
        {port.name, fmt::format("{{ {:g} * mm, {:g} * mm, {:g} * mm }}", at.x() / units::mm,
                                at.y() / units::mm, at.z() / units::mm)});
    listing.json.push_back({{"name", port.name}, {"position_m", {at.x(), at.y(), at.z()}}});
  }
  return listing;
}

void add_landmark(Listing& listing, const std::string& name, const Landmark& landmark) {
  listing.rows.push_back({name, landmark.doc});
  listing.json.push_back({{"name", name}, {"doc", landmark.doc}});
}

/// Those that an organ of its shape has.
void add_landmarks(Listing& listing, const OrganDefinition& organ) {
  const std::vector<std::string> own = landmarks_of(organ.shape);
  for (const Landmark& landmark : landmark_rows())
    if (std::find(own.begin(), own.end(), landmark.name) != own.end())
      add_landmark(listing, organ.name + "." + landmark.name, landmark);
}

Listing events() {
  Listing listing{"events", "Events", {}};
  for (const EventRow& event : event_rows()) {
    listing.rows.push_back({event.name, event.doc});
    listing.json.push_back({{"name", event.name},
                            {"doc", event.doc},
                            {"value", event.value},
                            {"of_instrument", event.of_instrument},
                            {"of_organ", event.of_organ}});
  }
  return listing;
}

Listing names(const std::string& key, const std::string& title, const std::vector<std::string>& list) {
  Listing listing{key, title, {}};
  for (const std::string& name : list) {
    listing.rows.push_back({name});
    listing.json.push_back({{"name", name}});
  }
  return listing;
}

std::vector<Listing> of_every_scenario() {
  Listing landmarks{"landmarks", "Landmarks, each of organs of its kind", {}},
      metrics{"metrics", "Metrics", {}};
  for (const Landmark& landmark : landmark_rows()) add_landmark(landmarks, landmark.name, landmark);
  for (const MetricRow& row : metric_rows()) {
    metrics.rows.push_back({pattern(row), row.doc});
    metrics.json.push_back({{"name", pattern(row)}, {"doc", row.doc}});
  }
  return {names("anatomies", "Anatomies", anatomy_names()),
          ports(default_ports()),
          names("instrument_types", "Instruments", instrument_type_names()),
          landmarks,
          events(),
          metrics};
}

Listing instruments(const SceneDefinition& scene) {
  Listing listing{"instruments", "Instruments", {}};
  for (const InstrumentDefinition& instrument : scene.instruments) {
    const std::string type = to_text(instrument.type);
    listing.rows.push_back({instrument.name, type, instrument.port});
    listing.json.push_back({{"name", instrument.name}, {"type", type}, {"port", instrument.port}});
  }
  return listing;
}

Listing parameters(const ExerciseDefinition& exercise) {
  Listing listing{"parameters", "Parameters", {}};
  for (const ParameterDefinition& parameter : exercise.parameters) {
    std::string range = parameter.type;
    if (!parameter.choices.empty()) range = fmt::format("{}", fmt::join(parameter.choices, ", "));
    if (parameter.low) range += fmt::format(", at least {:g}", *parameter.low);
    if (parameter.high) range += fmt::format(", at most {:g}", *parameter.high);
    listing.rows.push_back({parameter.name, "default " + parameter.fallback, range, parameter.title});
    OrderedJson json = {{"name", parameter.name},
                        {"type", parameter.type},
                        {"default", parameter.fallback},
                        {"choices", parameter.choices},
                        {"title", parameter.title}};
    json["min"] = parameter.low ? OrderedJson(*parameter.low) : OrderedJson();
    json["max"] = parameter.high ? OrderedJson(*parameter.high) : OrderedJson();
    listing.json.push_back(std::move(json));
  }
  return listing;
}

std::vector<Listing> of_scenario(const ExerciseDefinition& exercise) {
  const SceneDefinition& scene = exercise.scene;
  Listing landmarks{"landmarks", "Landmarks", {}};
  for (const auto* organs : {&scene.anatomy.organs, &exercise.later_organs})
    for (const OrganDefinition& organ : *organs) add_landmarks(landmarks, organ);
  return {parameters(exercise),
          ports(scene.ports.empty() ? default_ports() : scene.ports),
          instruments(scene),
          landmarks,
          names("steps", "Steps", exercise.step_names),
          events(),
          names("metrics", "Metrics", metric_names(exercise))};
}

/// A table of as many columns as its widest row; nothing for a list without entries.
std::string listed(const Listing& listing) {
  if (listing.rows.empty()) return {};
  return fmt::format("{}\n{}", bold(listing.title),
                     table(listing.rows, std::string(listing.rows.front().size(), 'l')));
}

}  // namespace

ExitCode list_command(const ListCommand& command) {
  std::vector<Listing> listings;
  OrderedJson json = {{"schema", "calot.list/1"}};
  if (command.scenario.empty()) {
    listings = of_every_scenario();
  } else {
    const Result<ExerciseDefinition> exercise = load_definition(command.scenario);
    if (!exercise)
      return print_failure(exercise.failure(), "calot check " + shell_word(command.scenario), command.json);
    json["scenario"] = exercise->id;
    listings = of_scenario(exercise.value());
  }
  if (command.dry_run) return ExitCode::ok;
  std::string text;
  for (const Listing& listing : listings) {
    json[listing.key] = listing.json;
    const std::string part = listed(listing);
    if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  }
  if (command.json) text = json_text(json) + "\n";
  std::fputs(text.c_str(), stdout);
  return ExitCode::ok;
}

}  // namespace calot
