#include "session/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/suggest.h"
#include "session/acts.h"
#include "session/json_fields.h"
#include "session/metrics.h"
#include "session/runner.h"
#include "session/scoring.h"

namespace calot {
namespace {

constexpr std::array schemas = {"calot.recording/1", "calot.recording/2", "calot.recording/3"};
constexpr int newest = 3, with_actions = 2, with_versions = 3;
constexpr std::size_t longest_line = 1 << 20;                 // bytes
constexpr std::size_t longest_file = std::size_t{128} << 20;  // bytes: an hour of two instruments at 200 Hz
constexpr double highest_rate = 1e6;                          // Hz
constexpr double time_slack = 1e-6;                           // s

Make parse_make(JsonFields& fields) {
  Make make;
  if (fields.has("toolchain")) make.toolchain = fields.text("toolchain");
  if (fields.has("instruction_set")) make.instruction_set = fields.text("instruction_set");
  if (fields.has("mathematics")) make.mathematics = fields.text("mathematics");
  return make;
}

/// By which rules; none before calot.recording/3.
void parse_versions(JsonFields& fields, RecordingHeader& header) {
  constexpr int most = 1'000'000;
  if (fields.has("exercise_hash")) header.exercise_hash = fields.hash("exercise_hash");
  if (fields.has("measures")) header.measures = fields.integer("measures", 1, most);
  if (fields.has("scoring")) header.scoring = fields.integer("scoring", 1, most);
}

RecordingHeader parse_header(const Json& json, std::vector<std::string>& problems) {
  JsonFields fields(json, problems);
  RecordingHeader header;
  const std::string given = fields.text("schema");
  const auto known = std::find(schemas.begin(), schemas.end(), given);
  if (known == schemas.end()) {
    problems = {fmt::format("this is not a recording of schema {}", fmt::join(schemas, ", "))};
    return header;
  }
  header.version = static_cast<int>(known - schemas.begin()) + 1;
  header.scenario = fields.text("scenario");
  if (fields.has("file")) header.file = fields.text("file");
  if (fields.has("source_hash")) header.source_hash = fields.hash("source_hash");
  if (fields.has("seed")) header.seed = fields.count("seed");
  if (fields.has("params")) header.params = fields.text_map("params");
  header.rate = fields.number("rate_Hz", 1 / highest_rate, highest_rate);
  header.instruments = fields.texts("instruments");
  if (header.version >= with_versions) {
    parse_versions(fields, header);
    header.attempt = read_attempt(fields);
  } else {
    header.measures = header.scoring = 1;
    header.attempt.mode = read_mode(fields);
  }
  header.make = parse_make(fields);
  if (fields.has("state_hash")) header.state_hash = fields.hash("state_hash");
  fields.expect_no_others();
  return header;
}

bool is_pose(const Json& json, std::size_t numbers) {
  return json.is_array() && json.size() == numbers &&
         std::all_of(json.begin(), json.end(), [](const Json& number) { return number.is_number(); });
}

std::vector<InstrumentPose> parse_poses(const Json& poses, std::vector<std::string>& problems) {
  std::vector<InstrumentPose> result;
  if (!poses.is_array()) problems.emplace_back("poses must be a list, one for each instrument");
  for (std::size_t i = 0; poses.is_array() && i < poses.size(); ++i) {
    if (!is_pose(poses[i], 5))
      problems.push_back(
          fmt::format("poses[{}] needs 5 numbers: pitch, yaw, insertion, roll, jaw (rad, m)", i));
    else
      result.push_back({poses[i][0], poses[i][1], poses[i][2], poses[i][3], poses[i][4]});
  }
  return result;
}

InstrumentPose parse_laparoscope(const Json& json, std::vector<std::string>& problems) {
  if (is_pose(json, 4)) return {json[0], json[1], json[2], json[3], 0};
  problems.emplace_back("laparoscope needs 4 numbers: pitch, yaw, insertion, roll (rad, m)");
  return {};
}

std::vector<InstrumentAction> parse_actions(const std::vector<std::string>& names,
                                            std::vector<std::string>& problems) {
  std::vector<InstrumentAction> result;
  for (const std::string& name : names) {
    const std::optional<InstrumentAction> action = instrument_action_called(name);
    if (!action)
      problems.push_back(fmt::format("\"{}\" is no action; {}", shortened(name, 40),
                                     suggestion(name, instrument_action_names())));
    else
      result.push_back(*action);
  }
  return result;
}

std::vector<SessionAct> parse_acts(const Json& json, std::vector<std::string>& problems) {
  std::vector<SessionAct> result;
  if (!json.is_array()) problems.emplace_back("acts must be a list");
  for (std::size_t i = 0; json.is_array() && i < json.size(); ++i) {
    JsonFields fields(json[i], problems, fmt::format("acts[{}].", i));
    const std::string name = fields.text("act");
    const std::string text = fields.has("text") ? fields.text("text") : std::string();
    fields.expect_no_others();
    Result<SessionAct> act = read_session_act(name, text);
    if (act)
      result.push_back(std::move(act).value());
    else
      problems.push_back(
          fmt::format("{} ({})", act.failure().problems[0].message, act.failure().problems[0].hint));
  }
  return result;
}

/// `time` is that of a whole number of steps.
RecordedStep parse_step(const Json& json, const RecordingHeader& header, double time,
                        std::vector<std::string>& problems) {
  JsonFields fields(json, problems);
  RecordedStep step;
  step.time = fields.number("time_s");
  step.input.instruments = parse_poses(fields.any("poses"), problems);
  if (header.version >= with_actions && fields.has("actions"))
    step.input.actions = parse_actions(fields.texts("actions"), problems);
  if (fields.has("laparoscope"))
    step.input.laparoscope = parse_laparoscope(fields.any("laparoscope"), problems);
  if (fields.has("acts")) step.input.acts = parse_acts(fields.any("acts"), problems);
  if (header.state_hash) step.state_hash = fields.hash("state_hash");
  fields.expect_no_others();
  const std::size_t poses = step.input.instruments.size();
  if (problems.empty() && poses != header.instruments.size())
    problems.push_back(
        fmt::format("{} poses where the header names {} instruments", poses, header.instruments.size()));
  if (problems.empty() && !step.input.actions.empty() && step.input.actions.size() != poses)
    problems.push_back(fmt::format("{} actions for {} instruments", step.input.actions.size(), poses));
  if (problems.empty() && std::abs(step.time - time) > time_slack)
    problems.push_back(fmt::format("time_s is {}, not {:.6g}: there is one line for each step at {:g} Hz",
                                   step.time, time, header.rate));
  return step;
}

/// Before calot.recording/3 the exercise's hash stands here.
Measured parse_measured(const Json& json, RecordingHeader& header, std::vector<std::string>& problems) {
  JsonFields fields(json, problems);
  JsonFields inner(fields.any("measured"), problems);
  if (header.version < with_versions)
    header.exercise_hash = inner.hash("exercise_hash");
  else if (!header.exercise_hash || header.measures == 0)
    problems.emplace_back("what was measured needs exercise_hash and measures in the first line");
  Measured measured = read_measured(inner, problems);
  fields.expect_no_others();
  return measured;
}

/// What was measured later than the steps last, or of another time than they take.
std::vector<std::string> disagreements(const Recording& recording) {
  const double last = recording.steps.empty() ? 0 : recording.steps.back().time;
  const double slack =
      1 / recording.header.rate + time_slack;  // a step that could not be followed is not measured
  std::vector<std::string> found;
  const auto expect_within = [&](const std::string& what, double time) {
    if (found.empty() && !(time <= last + time_slack))
      found.push_back(fmt::format("{} is of {:.6g} s, and the steps end at {:.6g} s", what, time, last));
  };
  const Measured& measured = *recording.measured;
  const auto total = measured.metrics.find("total.time_s");
  if (total != measured.metrics.end() && !(std::abs(total->second - last) <= slack))
    found.push_back(
        fmt::format("total.time_s is {:.6g}, and the steps end at {:.6g} s", total->second, last));
  for (const StepRecord& step : measured.progress.steps()) expect_within("step " + step.name, step.ended);
  for (const SessionEvent& event : measured.progress.events()) expect_within(to_text(event.kind), event.time);
  for (const Note& note : measured.progress.notes()) expect_within("note " + note.name, note.time);
  for (std::string& text : found) text.insert(0, "what was measured is not of these steps: ");
  return found;
}

std::string parse_end(const Json& json, std::size_t steps, const Hash& before,
                      std::vector<std::string>& problems) {
  JsonFields fields(json, problems);
  std::string end = fields.text("end");
  const std::uint64_t declared = fields.count("steps");
  if (problems.empty() && declared != steps)
    problems.push_back(fmt::format("{} steps were recorded, {} are here", declared, steps));
  if (fields.has("checksum") && fields.hash("checksum") != before.value() && problems.empty())
    problems.emplace_back(
        "the lines before this one are not those that were recorded: their checksum is another");
  fields.expect_no_others();
  const SessionEnd ends[] = {SessionEnd::steps_done,  SessionEnd::time_limit, SessionEnd::source_ended,
                             SessionEnd::interrupted, SessionEnd::failed,     SessionEnd::bailed_out};
  if (end != cut_end &&
      std::none_of(std::begin(ends), std::end(ends), [&](SessionEnd known) { return to_text(known) == end; }))
    problems.push_back(fmt::format("a session does not end as \"{}\"", end));
  return end;
}

/// Reads line by line what a writer may have left unfinished.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), in_(path, std::ios::binary) {}

  Result<Recording> read() {
    if (!in_)
      return fail(FailureKind::usage, fmt::format("cannot read {}", path_),
                  "give the path of a recording, or of a folder that holds some");
    std::string buffer(longest_line, '\0');
    while (problems_.empty() && next_line(buffer)) {
      std::vector<std::string> problems;
      parse(text_, problems);
      if (!problems.empty() && line_ > 1 && cut_short_) break;
      for (std::string& problem : problems) add_problem(std::move(problem));
      text_hash_.add(text_);
      text_hash_.add('\n');
    }
    if (problems_.empty() && line_ == 0) add_problem("this is not a recording: it is empty");
    keep_first(problems_);
    if (recording_.end.empty()) recording_.measured.reset();  // no checksum vouches for it
    if (problems_.empty() && recording_.measured)
      for (std::string& problem : disagreements(recording_)) add_problem(std::move(problem));
    if (!problems_.empty()) return Failure{FailureKind::usage, std::move(problems_)};
    recording_.text_hash = text_hash_.value();
    return std::move(recording_);
  }

 private:
  bool next_line(std::string& buffer) {
    if (in_.eof() || in_.peek() == std::ifstream::traits_type::eof()) {
      if (in_.bad()) add_problem("this cannot be read");
      return false;
    }
    ++line_;
    in_.getline(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    cut_short_ = in_.eof();  // no line end: the writer was killed in the middle of this line
    const auto size = static_cast<std::size_t>(in_.gcount()) - (in_ && !cut_short_ ? 1U : 0U);
    if (in_.fail()) add_problem(fmt::format("this line has more than {} bytes", longest_line - 1));
    bytes_ += size;
    if (bytes_ > longest_file)
      add_problem(fmt::format("the recording has more than {} MiB up to here", longest_file >> 20));
    text_ = std::string_view(buffer).substr(0, size);
    return problems_.empty();
  }

  void parse(std::string_view text, std::vector<std::string>& problems) {
    std::string broken;
    const Json json = parse_json(text, broken);
    if (!broken.empty())
      problems.push_back(std::move(broken));
    else if (line_ == 1)
      recording_.header = parse_header(json, problems);
    else if (!recording_.end.empty())
      problems.emplace_back("there is more after the recording's end");
    else if (json.is_object() && json.contains("end"))
      recording_.end = parse_end(json, recording_.steps.size(), text_hash_, problems);
    else if (recording_.measured)
      problems.emplace_back("there is more between what was measured and the recording's end");
    else if (json.is_object() && json.contains("measured"))
      recording_.measured = parse_measured(json, recording_.header, problems);
    else
      add_step(parse_step(json, recording_.header, static_cast<double>(line_ - 1) / recording_.header.rate,
                          problems),
               problems);
  }

  void add_step(RecordedStep step, const std::vector<std::string>& problems) {
    if (problems.empty()) recording_.steps.push_back(std::move(step));
  }

  void add_problem(std::string message) {
    problems_.push_back({{path_, std::max(1, line_), {}},
                         std::move(message),
                         "restore the file, or record the session anew with `calot run`"});
  }

  const std::string& path_;
  std::ifstream in_;
  std::string_view text_;
  bool cut_short_ = false;
  int line_ = 0;
  std::size_t bytes_ = 0;
  Hash text_hash_;
  Recording recording_;
  std::vector<Problem> problems_;
};

}  // namespace

std::string session_of(const Recording& recording) {
  const std::string& own = recording.header.attempt.session;
  return own.empty() ? hex(recording.text_hash) + hex(0) : own;
}

bool came_to_its_end(const std::string& end) {
  return !end.empty() && end != cut_end && end != to_text(SessionEnd::interrupted) &&
         end != to_text(SessionEnd::failed);
}

std::optional<std::string> cut_note(const Recording& recording) {
  if (!recording.end.empty() && recording.end != cut_end) return std::nullopt;
  return fmt::format("the recording {}: it was cut, and stops at step {} ({:.3f} s)",
                     recording.end.empty() ? "has no end" : "is played from one without an end",
                     recording.steps.size(), recording.steps.empty() ? 0.0 : recording.steps.back().time);
}

RecordingHeader recording_header(const ExerciseDefinition& exercise, const World& world,
                                 const std::string& file, const Attempt& attempt) {
  RecordingHeader header;
  header.scenario = exercise.id;
  header.file = file;
  header.source_hash = exercise.source_hash;
  header.exercise_hash = exercise_hash(exercise);
  header.measures = measures_version;
  header.scoring = scoring_version;
  header.attempt = attempt;
  header.seed = exercise.seed;
  header.params = exercise.params;
  header.rate = exercise.scene.solver.rate;
  for (const InstrumentDefinition& instrument : exercise.scene.instruments) {
    header.instruments.push_back(instrument.name);
  }
  header.make = this_make();
  header.state_hash = world.state_hash();
  return header;
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, const RecordingHeader& header) {
  RecordingWriter writer;
  writer.out_.open(path, std::ios::trunc);
  OrderedJson json = {{"schema", schemas[newest - 1]}, {"scenario", header.scenario}, {"file", header.file}};
  if (header.source_hash) json["source_hash"] = hex(*header.source_hash);
  if (header.exercise_hash) json["exercise_hash"] = hex(*header.exercise_hash);
  if (header.measures > 0) json["measures"] = header.measures;
  if (header.scoring > 0) json["scoring"] = header.scoring;
  json["seed"] = header.seed;
  json["params"] = header.params;
  json["rate_Hz"] = header.rate;
  json["instruments"] = header.instruments;
  write_attempt(header.attempt, json);
  json["toolchain"] = header.make.toolchain;
  json["instruction_set"] = header.make.instruction_set;
  json["mathematics"] = header.make.mathematics;
  if (header.state_hash) json["state_hash"] = hex(*header.state_hash);
  // A file's name may hold any bytes: what is not UTF-8 is replaced.
  if (!writer.add_line(json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace))) {
    return fail(FailureKind::usage, fmt::format("cannot write {}", path),
                "choose another folder with -o DIR");
  }
  return writer;
}

bool RecordingWriter::add_line(const std::string& line) {
  written_.add(std::string_view(line));
  written_.add('\n');
  out_ << line << std::endl;
  return static_cast<bool>(out_);
}

bool RecordingWriter::write(const RecordedStep& step) {
  // The library's digits read back as the same bits, the sign of a zero included.
  OrderedJson json = {{"time_s", step.time}, {"poses", OrderedJson::array()}};
  for (const InstrumentPose& pose : step.input.instruments) {
    json["poses"].push_back({pose.pitch, pose.yaw, pose.insertion, pose.roll, pose.jaw});
  }
  const auto acts = [](InstrumentAction action) { return action != InstrumentAction::none; };
  if (std::any_of(step.input.actions.begin(), step.input.actions.end(), acts)) {
    json["actions"] = OrderedJson::array();
    for (InstrumentAction action : step.input.actions) json["actions"].push_back(to_text(action));
  }
  if (const std::optional<InstrumentPose>& scope = step.input.laparoscope)
    json["laparoscope"] = {scope->pitch, scope->yaw, scope->insertion, scope->roll};
  for (const SessionAct& act : step.input.acts) {
    OrderedJson entry = {{"act", to_text(act.kind)}};
    if (!act.text.empty()) entry["text"] = act.text;
    json["acts"].push_back(std::move(entry));
  }
  if (step.state_hash) json["state_hash"] = hex(*step.state_hash);
  ++steps_;
  return add_line(json.dump());
}

bool RecordingWriter::write(const Measured& measured) {
  const OrderedJson json = {{"measured", measured_json(measured)}};
  // An author's texts may hold any bytes.
  const std::string line = json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  return line.size() >= longest_line || add_line(line);
}

bool RecordingWriter::finish(const std::string& end) {
  return add_line(
      fmt::format(R"({{"end":"{}","steps":{},"checksum":"{}"}})", end, steps_, hex(written_.value())));
}

Result<Recording> read_recording(const std::string& path) { return Reader(path).read(); }

Result<std::optional<StepInput>> ReplaySource::next(const World&, double) {
  if (step_ == recording_.steps.size()) return std::optional<StepInput>();
  return std::optional<StepInput>(recording_.steps[step_++].input);
}

}  // namespace calot
