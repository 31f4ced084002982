#pragma once
// An exercise as plain data, and the two questions the runner asks its script. The Lua room implements the
// script; the runner (session/runner.h) never knows Lua.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/definitions.h"
#include "base/status.h"
#include "session/progress.h"
#include "sim/world.h"

namespace calot {

enum class ScorePartKind { benchmark, penalty };

/// benchmark: clamp((novice - measured) / (novice - expert), 0, 1), so expert < novice where lower is better.
/// penalty: 1 - each * (number of events), not below 0.
struct ScorePart {
  std::string name;  ///< the metric or the event unless the author names it
  ScorePartKind kind = ScorePartKind::benchmark;
  std::string metric;  ///< benchmark
  double novice = 0, expert = 1;
  EventKind event = EventKind::contact;  ///< penalty
  double each = 0.25;
  double weight = 1;
  std::string calibration = "uncalibrated";  ///< where its figures come from
  Place place;                               ///< where the author wrote it
};

struct ScoreDefinition {
  std::vector<ScorePart> parts;     ///< weights sum to 1
  std::vector<EventKind> critical;  ///< events that cap the total at `cap` and fail the exercise
  double cap = 40, pass = 80;       ///< points of 100
};

struct GoldenDefinition {
  static constexpr std::size_t most_times =
      100;                 ///< a picture costs a quarter of a second and some 1.5 MB on disk
  std::vector<double> at;  ///< s
};

/// Something that can be chosen when the exercise is started. Values as the user writes them.
struct ParameterDefinition {
  std::string name, title;
  std::string type;  ///< "choice", "number" or "boolean"
  std::vector<std::string> choices;
  std::optional<double> low, high;
  std::string fallback, value;  ///< when nothing is chosen; now
};

struct ExerciseDefinition {
  int api = 1;
  std::string id, title;
  double time_limit = 120;  ///< s
  std::uint64_t seed = 1;
  SceneDefinition scene;
  ScoreDefinition score;
  GoldenDefinition golden;
  /// Steps, holds and noted numbers of the script, found by running it dry: metrics are named after them.
  std::vector<std::string> step_names, hold_names, note_names;  ///< hold_names are "step.hold"
  /// What the script may bring into the field, pieces of divided ducts too, likewise.
  std::vector<OrganDefinition> later_organs;
  std::string file;                             ///< the scenario's path
  std::uint64_t source_hash = 0;                ///< of the scenario's text and the modules it required
  std::map<std::string, std::string> params;    ///< every parameter's value as text, defaults included
  std::vector<ParameterDefinition> parameters;  ///< ordered by name
};

/// Where inputs come from: a scenario's demo, a recording, live devices (session/live.h).
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// Targets at world.report().time + dt. No value: the source has ended (the runner then holds the last
  /// input). A failure as interrupted ends the session as that.
  virtual Result<std::optional<StepInput>> next(const World& world, double dt) = 0;
  /// What report and recording should say of it, once the session has ended.
  virtual std::vector<std::string> notes() const { return {}; }
};

class ExerciseScript {
 public:
  virtual ~ExerciseScript() = default;
  virtual const ExerciseDefinition& definition() const = 0;
  /// The demo as an input source; lives no longer than the script.
  virtual InputSource& demo() = 0;
  /// Resumes the steps coroutine after a world step of length dt. True when the steps have ended. Marks
  /// steps, holds and their metrics in `progress`. The first call begins at the time before that step. What steps change
  /// of who is in the world is no input and not recorded: a replay runs the same steps.
  virtual Result<bool> advance(World& world, Progress& progress, double dt) = 0;
  /// Called from another thread just before the process ends with the resource-limit exit code because a
  /// single call into the script hangs: write out what was recorded. The simulating thread is in the script.
  virtual void set_emergency_flush(const std::function<void()>& /*flush*/) {}
  /// The failure, its problems with fields of the definition (place.path) at the author's file and line.
  virtual Failure located(Failure failure) const { return failure; }
  /// What the demo, run dry from a world at rest, asks for and cannot have, such as places out of reach. The
  /// script cannot be played after that.
  virtual std::vector<Problem> rehearse(const World& /*world*/) { return {}; }
};

}  // namespace calot
