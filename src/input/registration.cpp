#include "input/registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/suggest.h"
#include "geometry/decompose.h"
#include "input/registered_tool.h"
#include "session/runner.h"
#include "tools/tool.h"

namespace calot {
namespace {

constexpr double waiting_insertion = 30e-3;  // m: of a tool that is in its trocar and no further
constexpr double least_spread = 1e-4;        // smallest eigenvalue of a bundle of shafts, of its number

struct TimedPose {
  double time = 0;  ///< s
  int row = 0;
  InstrumentPose pose;
};

std::vector<std::string> names_of(const std::vector<InstrumentDefinition>& instruments) {
  std::vector<std::string> names;
  for (const InstrumentDefinition& instrument : instruments) names.push_back(instrument.name);
  return names;
}

/// What of it does not name an exercise and its instruments, each once.
std::vector<Problem> misnamed(const Registration& registration, const ExerciseDefinition& exercise,
                              const std::vector<std::string>& names) {
  if (registration.exercise != exercise.id)
    return {{registration.place,
             fmt::format("this registers for {}, not for {}", registration.exercise, exercise.id),
             "play that exercise, or name another table"}};
  std::vector<Problem> problems;
  std::vector<std::string> given;
  for (const ForeignInstrument& instrument : registration.instruments) {
    if (std::find(names.begin(), names.end(), instrument.name) == names.end())
      problems.push_back({instrument.place,
                          fmt::format("the exercise has no instrument \"{}\"", instrument.name),
                          suggestion(instrument.name, names)});
    if (std::find(given.begin(), given.end(), instrument.name) != given.end())
      problems.push_back(
          {instrument.place, fmt::format("\"{}\" is there twice", instrument.name), "name each once"});
    given.push_back(instrument.name);
  }
  return problems;
}

/// One file's motion on its way into one exercise.
class Importer {
 public:
  Importer(const ForeignMotion& motion, const Registration& registration, const ExerciseDefinition& exercise)
      : motion_(motion), registration_(registration), exercise_(exercise), rate_(exercise.scene.solver.rate) {
    result_.notes = motion.notes;
  }

  Result<ImportedRecording> run() {
    const std::vector<std::string> names = names_of(exercise_.scene.instruments);
    const std::vector<LiveInstrument> instruments = live_instruments(exercise_.scene);
    std::vector<std::vector<TimedPose>> tracks(names.size());
    for (std::size_t i = 0; i < registration_.instruments.size(); ++i) {
      const auto at =
          std::find(names.begin(), names.end(), registration_.instruments[i].name) - names.begin();
      tracks[static_cast<std::size_t>(at)] = poses(i, instruments[static_cast<std::size_t>(at)]);
    }
    keep_first(problems_);
    if (!problems_.empty()) return Failure{FailureKind::usage, std::move(problems_)};
    write_header(names);
    resample(tracks);
    if (!problems_.empty()) return Failure{FailureKind::usage, std::move(problems_)};
    return std::move(result_);
  }

 private:
  void problem(int row, const std::string& message, const std::string& hint) {
    if (motion_.framed)
      problems_.push_back({{motion_.file, 0, {}}, fmt::format("frame {}: {}", row, message), hint});
    else
      problems_.push_back({{motion_.file, row, {}}, message, hint});
  }

  void note(const std::string& who, const std::string& what) { result_.notes.push_back(who + ": " + what); }

  std::vector<TimedPose> poses(std::size_t track, const LiveInstrument& instrument) {
    const std::vector<ForeignSample>& samples = motion_.tracks[track];
    const ForeignInstrument& tool = registration_.instruments[track];
    std::vector<TimedPose> result;
    if (samples.size() < 2) {
      problems_.push_back(
          {{motion_.file, 0, {}},
           fmt::format("{} rows of \"{}\", which is {}", samples.size(), tool.source, tool.name),
           "name the tool as the file does: the registration's source"});
      return result;
    }
    const std::optional<Vec3> port = samples.front().pivot ? Vec3(Vec3::Zero()) : port_of(tool, samples);
    if (!port) return result;
    RegisteredTool registered(registration_, tool, *port, instrument);
    for (const ForeignSample& sample : samples) {
      TimedPose pose{sample.time * registration_.time_unit, sample.row, registered.pose(sample)};
      check_time(result, pose);
      check_depth(tool, pose.pose, instrument.geometry.max_insertion, sample.row);
      result.push_back(pose);
    }
    if (registered.held_jaws() > 0)
      note(tool.name,
           fmt::format("the jaws were beyond closed or fully open in {} of {} rows, and are taken as that",
                       registered.held_jaws(), samples.size()));
    return result;
  }

  void check_time(const std::vector<TimedPose>& before, const TimedPose& pose) {
    if (before.empty()) return;
    const double gap = pose.time - before.back().time;
    if (!(gap > 0))
      problem(pose.row,
              fmt::format("its time, {:.6g} s, is not after that of the row before, {:.6g} s", pose.time,
                          before.back().time),
              "mend or remove the row");
    else if (gap > registration_.longest_gap + 1e-9)
      problem(pose.row, fmt::format("nothing is known of the {:.3g} s before it", gap),
              fmt::format("cut the file there, or allow more than longest_gap = {:g} s",
                          registration_.longest_gap));
  }

  /// Their trocar, in their frame and unit.
  std::optional<Vec3> port_of(const ForeignInstrument& tool, const std::vector<ForeignSample>& samples) {
    if (tool.port) return tool.port;
    // The point nearest to all shafts: the sum of squared distances to their lines is least there.
    Mat3 sum = Mat3::Zero();
    Vec3 moment = Vec3::Zero();
    int lines = 0;
    for (const ForeignSample& sample : samples) {
      if (!sample.along) continue;
      const Mat3 across = Mat3::Identity() - *sample.along * sample.along->transpose();
      sum += across;
      moment += across * sample.tip;
      ++lines;
    }
    const Principal spread = principal(sum);
    if (lines < 2 || spread.values[0] < least_spread * lines) {
      problems_.push_back(
          {tool.place,
           fmt::format("{}: the place of its trocar cannot be found from {}", tool.name,
                       lines < 2 ? "a file without shaft directions" : "shafts that hardly turn"),
           "give port = { x, y, z } in the file's frame and unit"});
      return std::nullopt;
    }
    const Vec3 port = spread.vectors * (spread.vectors.transpose() * moment).cwiseQuotient(spread.values);
    double squares = 0;
    for (const ForeignSample& sample : samples)
      if (sample.along) squares += sample.along->cross(sample.tip - port).squaredNorm();
    note(tool.name,
         fmt::format(
             "its trocar was found at {{ {:.4g}, {:.4g}, {:.4g} }} of the file's frame; the shafts pass "
             "it at {:.2f} mm (root mean square)",
             port.x(), port.y(), port.z(), std::sqrt(squares / lines) * registration_.unit / 1e-3));
    return port;
  }

  void check_depth(const ForeignInstrument& tool, const InstrumentPose& pose, double deepest, int row) {
    if (pose.insertion >= 0 && pose.insertion <= deepest) return;
    problem(row,
            fmt::format("{} would be {:.1f} mm deep in its trocar: it reaches {:g} mm", tool.name,
                        pose.insertion / 1e-3, deepest / 1e-3),
            "are the registration's unit, port and axes right?");
  }

  void write_header(const std::vector<std::string>& names) {
    RecordingHeader& header = result_.recording.header;
    header.scenario = exercise_.id;
    header.attempt.source = "import";
    header.rate = rate_;
    header.instruments = names;
    result_.recording.end = to_text(SessionEnd::source_ended);
  }

  static InstrumentPose at(const std::vector<TimedPose>& track, double time) {
    const auto after = std::upper_bound(track.begin(), track.end(), time,
                                        [](double t, const TimedPose& pose) { return t < pose.time; });
    if (after == track.begin()) return track.front().pose;
    if (after == track.end()) return track.back().pose;
    const TimedPose& from = *(after - 1);
    return interpolate(from.pose, after->pose, (time - from.time) / (after->time - from.time));
  }

  /// For as long as all instruments are known, after they have come in.
  void resample(const std::vector<std::vector<TimedPose>>& tracks) {
    double start = tracks.front().front().time, end = tracks.front().back().time, depth = 0;
    for (const std::vector<TimedPose>& track : tracks) {
      start = std::max(start, track.front().time);
      end = std::min(end, track.back().time);
    }
    if (end <= start) {
      problems_.push_back({{motion_.file, 0, {}},
                           "the instruments' times have nothing in common",
                           "check time_unit and sources"});
      return;
    }
    for (const std::vector<TimedPose>& track : tracks)
      depth = std::max(depth, at(track, start).insertion - waiting_insertion);
    const int lead = static_cast<int>(std::ceil(depth / lead_in_speed * rate_ - 1e-6));
    const int steps = static_cast<int>(std::floor((end - start) * rate_ + 1e-6));
    for (int k = 0; k < lead; ++k) {
      const double left = (lead - k) / rate_ * lead_in_speed;
      add_step(tracks, start, [&](InstrumentPose& pose) {
        pose.insertion = std::max(std::min(pose.insertion, waiting_insertion), pose.insertion - left);
      });
    }
    for (int k = 0; k <= steps; ++k) add_step(tracks, start + k / rate_, [](InstrumentPose&) {});
    if (lead > 0)
      result_.notes.push_back(
          fmt::format("the instruments first go in from their trocars, for {:.2f} s", lead / rate_));
  }

  template <class Change>
  void add_step(const std::vector<std::vector<TimedPose>>& tracks, double time, const Change& change) {
    RecordedStep step;
    for (const std::vector<TimedPose>& track : tracks) {
      step.input.instruments.push_back(at(track, time));
      change(step.input.instruments.back());
    }
    step.time = static_cast<double>(result_.recording.steps.size() + 1) / rate_;
    result_.recording.steps.push_back(std::move(step));
  }

  const ForeignMotion& motion_;
  const Registration& registration_;
  const ExerciseDefinition& exercise_;
  double rate_;
  std::vector<Problem> problems_;
  ImportedRecording result_;
};

}  // namespace

std::vector<Problem> problems_with(const Registration& registration, const ExerciseDefinition& exercise) {
  const std::vector<std::string> names = names_of(exercise.scene.instruments);
  std::vector<Problem> problems = misnamed(registration, exercise, names);
  if (registration.exercise != exercise.id) return problems;
  for (const std::string& name : names)
    if (std::none_of(registration.instruments.begin(), registration.instruments.end(),
                     [&](const ForeignInstrument& tool) { return tool.name == name; }))
      problems.push_back({registration.place,
                          fmt::format("the exercise's instrument \"{}\" is missing", name),
                          "add { name = \"" + name + "\", source = ... } to instruments"});
  return problems;
}

std::vector<Problem> live_problems_with(const Registration& registration,
                                        const ExerciseDefinition& exercise) {
  std::vector<std::string> names = names_of(exercise.scene.instruments);
  names.emplace_back(laparoscope_name);
  std::vector<Problem> problems = misnamed(registration, exercise, names);
  for (const ForeignInstrument& tool : registration.instruments)
    if (!tool.port)
      problems.push_back({tool.place,
                          fmt::format("{}: while it moves, its trocar's place cannot be found", tool.name),
                          "give port = { x, y, z } in their frame and unit"});
  return problems;
}

Registration direct_registration(const std::string& exercise,
                                 const std::vector<LiveInstrument>& instruments) {
  Registration registration;
  registration.exercise = exercise;
  registration.unit = 1e-3;
  for (const LiveInstrument& instrument : instruments) {
    ForeignInstrument tool;
    tool.name = tool.source = instrument.definition.name;
    tool.port = instrument.trocar / registration.unit;
    registration.instruments.push_back(std::move(tool));
  }
  return registration;
}

Result<ImportedRecording> to_recording(const ForeignMotion& motion, const Registration& registration,
                                       const ExerciseDefinition& exercise) {
  return Importer(motion, registration, exercise).run();
}

std::optional<Failure> write_recording(const std::string& path, const Recording& recording) {
  Result<RecordingWriter> writer = RecordingWriter::create(path, recording.header);
  if (!writer) return writer.failure();
  bool written = true;
  for (const RecordedStep& step : recording.steps) written = written && writer->write(step);
  if (written && writer->finish(recording.end)) return std::nullopt;
  return fail(FailureKind::usage, fmt::format("cannot write {}", path), "is the disk full?");
}

}  // namespace calot
