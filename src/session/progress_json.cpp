#include "session/progress_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "session/json_fields.h"

namespace calot {
namespace {

/// {x, y, z}; none, and a problem, where it is not that.
std::optional<Vec3> read_place(JsonFields& fields, const std::string& key) {
  const Json& place = fields.any(key);
  const auto is_number = [](const Json& one) { return one.is_number(); };
  if (place.is_array() && place.size() == 3 && std::all_of(place.begin(), place.end(), is_number))
    return Vec3(place[0].get<double>(), place[1].get<double>(), place[2].get<double>());
  fields.wrong(key, "must be three numbers");
  return std::nullopt;
}

/// An entry's number, or what stands for one that is missing where it is null.
double number_or(JsonFields& fields, const std::string& key, double missing) {
  return fields.any(key).is_null() ? missing : fields.number(key);
}

StepRecord read_step(JsonFields& fields) {
  StepRecord step;
  step.name = fields.text("name");
  step.title = fields.text("title");
  step.outcome = fields.text("outcome");
  step.started = fields.number("started_s");
  step.ended = number_or(fields, "ended_s", -1);
  step.limit = number_or(fields, "limit_s", 0);
  return step;
}

SessionEvent read_event(JsonFields& fields) {
  SessionEvent event;
  const std::string name = fields.text("event");
  event.time = fields.number("time_s");
  event.step = fields.text("step");
  if (fields.has("instrument")) event.instrument = fields.text("instrument");
  if (fields.has("organ")) event.organ = fields.text("organ");
  if (fields.has("place_m")) event.place = read_place(fields, "place_m");
  if (fields.has("cause")) {
    const std::optional<EventCause> cause = event_cause_called(fields.text("cause"));
    if (!cause) fields.wrong("cause", "is none that is known");
    event.cause = cause.value_or(EventCause::none);
  }
  if (fields.has("text")) event.text = fields.text("text");
  const std::optional<EventKind> kind = event_called(name);
  if (!kind) {
    fields.wrong("event", "is of no kind that is known");
    return event;
  }
  event.kind = *kind;
  if (const char* key = event_row(event.kind).value; *key != 0) event.value = fields.number(key);
  return event;
}

Note read_note(JsonFields& fields) {
  Note note;
  note.name = fields.text("name");
  note.unit = fields.text("unit");
  note.time = fields.number("time_s");
  note.step = fields.text("step");
  const Json& value = fields.any("value");
  if (value.is_number())
    note.value = value.get<double>();
  else if (value.is_boolean())
    note.value = value.get<bool>();
  else if (value.is_string())
    note.value = value.get<std::string>();
  else
    fields.wrong("value", "must be a number, a text, true or false");
  return note;
}

template <class Read>
auto read_list(const Json& list, const char* name, Read read, std::vector<std::string>& problems) {
  std::vector<decltype(read(std::declval<JsonFields&>()))> result;
  if (!list.is_array()) problems.push_back(fmt::format("{} must be a list", name));
  for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
    JsonFields fields(list[i], problems, fmt::format("{}[{}].", name, i));
    result.push_back(read(fields));
    fields.expect_no_others();
  }
  return result;
}

}  // namespace

OrderedJson steps_json(const Progress& progress) {
  OrderedJson list = OrderedJson::array();
  for (const StepRecord& step : progress.steps()) {
    OrderedJson json = {
        {"name", step.name}, {"title", step.title}, {"outcome", step.outcome}, {"started_s", step.started}};
    json["ended_s"] = step.ended >= 0 ? OrderedJson(step.ended) : OrderedJson();
    json["limit_s"] = step.limit > 0 ? OrderedJson(step.limit) : OrderedJson();
    list.push_back(std::move(json));
  }
  return list;
}

OrderedJson events_json(const Progress& progress) {
  OrderedJson list = OrderedJson::array();
  for (const SessionEvent& event : progress.events()) {
    OrderedJson json = {{"event", to_text(event.kind)}, {"time_s", event.time}, {"step", event.step}};
    if (!event.instrument.empty()) json["instrument"] = event.instrument;
    if (!event.organ.empty()) json["organ"] = event.organ;
    if (const char* key = event_row(event.kind).value; *key != 0) json[key] = event.value;
    if (event.place) json["place_m"] = {event.place->x(), event.place->y(), event.place->z()};
    if (event.cause != EventCause::none) json["cause"] = to_text(event.cause);
    if (!event.text.empty()) json["text"] = event.text;
    list.push_back(std::move(json));
  }
  return list;
}

OrderedJson notes_json(const Progress& progress) {
  OrderedJson list = OrderedJson::array();
  for (const Note& note : progress.notes()) {
    OrderedJson json = {{"name", note.name}};
    std::visit([&](const auto& value) { json["value"] = value; }, note.value);
    json["unit"] = note.unit;
    json["time_s"] = note.time;
    json["step"] = note.step;
    list.push_back(std::move(json));
  }
  return list;
}

Progress read_progress(const Json& steps, const Json& events, const Json& notes,
                       std::vector<std::string>& problems) {
  std::vector<StepRecord> read_steps = read_list(steps, "steps", read_step, problems);
  std::vector<SessionEvent> read_events = read_list(events, "events", read_event, problems);
  std::vector<Note> read_notes = read_list(notes, "noted", read_note, problems);
  return {std::move(read_steps), std::move(read_events), std::move(read_notes)};
}

}  // namespace calot
