#include "session/recording.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "session/build_info.h"

namespace calot {
namespace {

using Json = nlohmann::json;

constexpr const char* schema = "calot.recording/1";

Failure unreadable(const std::string& path, int line, const std::string& message) {
  return fail(FailureKind::usage, message, "record the session anew with `calot run`", {path, line, {}});
}

std::uint64_t hash_of(const Json& text) {
  const std::string digits = text.get<std::string>();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw std::runtime_error("'" + digits + "' is not a state hash");
  }
  return value;
}

RecordingHeader parse_header(const Json& json) {
  if (!json.is_object() || json.value("schema", "") != schema) {
    throw std::runtime_error(fmt::format("this is not a recording of schema {}", schema));
  }
  RecordingHeader header;
  header.scenario = json.at("scenario");
  header.file = json.at("file");
  header.source_hash = hash_of(json.at("source_hash"));
  header.seed = json.at("seed");
  header.params = json.at("params").get<std::map<std::string, std::string>>();
  header.rate = json.at("rate_Hz");
  header.instruments = json.at("instruments").get<std::vector<std::string>>();
  header.toolchain = json.at("toolchain");
  header.instruction_set = json.at("instruction_set");
  header.state_hash = hash_of(json.at("state_hash"));
  return header;
}

RecordedStep parse_step(const Json& json, std::size_t instruments) {
  RecordedStep step;
  step.time = json.at("time_s");
  step.state_hash = hash_of(json.at("state_hash"));
  for (const Json& numbers : json.at("poses")) {
    const auto pose = numbers.get<std::vector<double>>();
    if (pose.size() != 5) throw std::runtime_error("a pose needs 5 numbers");
    step.input.instruments.push_back({pose[0], pose[1], pose[2], pose[3], pose[4]});
  }
  if (step.input.instruments.size() != instruments) {
    throw std::runtime_error(fmt::format("{} poses where the header names {} instruments",
                                         step.input.instruments.size(), instruments));
  }
  return step;
}

}  // namespace

RecordingHeader recording_header(const ExerciseDefinition& exercise, const World& world) {
  RecordingHeader header;
  header.scenario = exercise.id;
  header.file = exercise.file;
  header.source_hash = exercise.source_hash;
  header.seed = exercise.seed;
  header.params = exercise.params;
  header.rate = exercise.scene.solver.rate;
  for (const InstrumentDefinition& instrument : exercise.scene.instruments) {
    header.instruments.push_back(instrument.name);
  }
  header.toolchain = toolchain();
  header.instruction_set = instruction_set();
  header.state_hash = world.state_hash();
  return header;
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, const RecordingHeader& header) {
  RecordingWriter writer;
  writer.out_.open(path, std::ios::trunc);
  nlohmann::ordered_json json = {{"schema", schema},
                                 {"scenario", header.scenario},
                                 {"file", header.file},
                                 {"source_hash", hex(header.source_hash)},
                                 {"seed", header.seed},
                                 {"params", header.params},
                                 {"rate_Hz", header.rate},
                                 {"instruments", header.instruments},
                                 {"toolchain", header.toolchain},
                                 {"instruction_set", header.instruction_set},
                                 {"state_hash", hex(header.state_hash)}};
  writer.out_ << json.dump() << std::endl;
  if (!writer.out_) {
    return fail(FailureKind::usage, fmt::format("cannot write {}", path),
                "choose another folder with -o DIR");
  }
  return writer;
}

bool RecordingWriter::write(const RecordedStep& step) {
  // The library's digits read back as the same bits, the sign of a zero included.
  nlohmann::ordered_json json = {{"time_s", step.time}, {"poses", Json::array()}};
  for (const InstrumentPose& pose : step.input.instruments) {
    json["poses"].push_back({pose.pitch, pose.yaw, pose.insertion, pose.roll, pose.jaw});
  }
  json["state_hash"] = hex(step.state_hash);
  out_ << json.dump() << std::endl;
  ++steps_;
  return static_cast<bool>(out_);
}

bool RecordingWriter::finish(const std::string& end) {
  out_ << fmt::format("{{\"end\":\"{}\",\"steps\":{}}}", end, steps_) << std::endl;
  return static_cast<bool>(out_);
}

Result<Recording> read_recording(const std::string& path) {
  std::ifstream in(path);
  if (!in)
    return fail(FailureKind::usage, fmt::format("cannot read {}", path), "give the path of a recording");
  Recording recording;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const bool cut_short = in.eof();  // no line end: the writer was killed in the middle of this line
    try {
      const Json json = Json::parse(text);
      if (line == 1) {
        recording.header = parse_header(json);
      } else if (!recording.end.empty()) {
        return unreadable(path, line, "there is more after the recording's end");
      } else if (json.contains("end")) {
        recording.end = json.at("end");
        if (json.at("steps") != recording.steps.size()) {
          return unreadable(path, line,
                            fmt::format("{} steps were recorded, {} are here", json.at("steps").get<int>(),
                                        recording.steps.size()));
        }
      } else {
        recording.steps.push_back(parse_step(json, recording.header.instruments.size()));
      }
    } catch (const std::exception& error) {
      if (line > 1 && cut_short) break;
      return unreadable(path, line, error.what());
    }
  }
  if (recording.header.scenario.empty()) return unreadable(path, 1, "this is not a recording: it is empty");
  return recording;
}

Result<std::optional<StepInput>> ReplaySource::next(const World&, double) {
  if (step_ == recording_.steps.size()) return std::optional<StepInput>();
  return std::optional<StepInput>(recording_.steps[step_++].input);
}

}  // namespace calot
