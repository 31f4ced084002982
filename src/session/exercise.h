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
#include "world/world.h"

namespace calot {

/// Version of what an exercise may say and how it is scored. 1: parts earn whether steps were done or not, and every
/// bail-out completes where the score has bail_out_completes.
inline constexpr int newest_api = 2;

enum class ScorePartKind { benchmark, penalty, procedure, time, critical_view, rule };
/// "benchmark", "penalty", ...: what the function of calot.score is called that makes it.
const std::vector<std::string>& score_part_kinds();

/// The share of their weight that parts earn, 0 to 1, with n events of a kind; from api 2 on times the share of their
/// steps that were done (but for procedure, which counts them itself):
/// benchmark: clamp((novice - measured) / (novice - expert), 0, 1), so expert < novice where lower is better.
/// penalty: 1 - each n, not below 0.
/// procedure: steps done / steps - (minor_costs n of minor + major_costs n of major) / 100, not below 0.
/// time: clamp((limit - time - each_s n of errors) / (limit - reference), 0, 1), with the time of the whole session.
/// critical_view: clamp(measured / full, 0, 1).
/// rule: what the author's own function says.
struct ScorePart {
  std::string name;  ///< the metric or the event unless the author names it
  ScorePartKind kind = ScorePartKind::benchmark;
  std::string metric;  ///< benchmark
  double novice = 0, expert = 1;
  EventKind event = EventKind::contact;  ///< penalty
  double each = 0.25;
  std::vector<std::string> steps;            ///< that it judges; empty: all
  std::vector<EventKind> minor, major;       ///< procedure
  double minor_costs = 2, major_costs = 10;  ///< points of 100
  double reference = 60, limit = 300;        ///< s: time
  std::vector<EventKind> errors;             ///< time
  double each_s = 5;                         ///< s
  double satisfactory = 5, full = 6;         ///< points: critical_view
  int rule = 0;                              ///< rule: its function, in the Lua state that it was read in
  double weight = 1;
  std::string calibration = "uncalibrated";  ///< where its figures come from
  Place place;                               ///< where the author wrote it
};

/// Caps the total, and fails the exercise, where all of its conditions hold: an event (before another one that should
/// have come first), a metric beyond a value. A metric that was never measured is beyond.
struct GateDefinition {
  std::string reason;                   ///< one sentence for the trainee
  std::string event, organ;             ///< a kind of event, on this organ or a piece of it; may be empty
  std::string only_after, after_organ;  ///< what must have happened before that event; may be empty
  std::string metric;                   ///< may be empty
  std::optional<double> below, above;   ///< of the metric; one of them
  std::string unless;                   ///< an event that excuses it; may be empty
  std::optional<double> cap;            ///< points; none: the score's
  bool fails = true;                    ///< false: it caps the total, and no more
  Place place;                          ///< where the author wrote it
};

class ScoreRules;

struct ScoreDefinition {
  std::vector<ScorePart> parts;     ///< weights sum to 1
  std::vector<EventKind> critical;  ///< each a gate: it caps the total at `cap` and fails the exercise
  std::vector<GateDefinition> gates;
  double cap = 40, pass = 80;       ///< points of 100
  bool bail_out_completes = false;  ///< api 1: who bails out need not have done the steps that are left
  int bail_out = 0;  ///< api 2: the rule that says whether that was right, as ScorePart::rule; 0: never
  std::shared_ptr<const ScoreRules> rules;  ///< where a part is a rule, or bail_out
};

/// A picture of something that happens, whenever the session comes to it.
struct GoldenMoment {
  std::string name;          ///< the picture's
  std::string step;          ///< this step's beginning, or in it the event below; may be empty
  std::string event, organ;  ///< a kind of event, on this organ or a piece of it; may be empty
  int count = 1;             ///< the first of these events, the second, ...
  double delay = 0;          ///< s after that
  Place place;               ///< where the author wrote it
};

struct GoldenDefinition {
  static constexpr std::size_t most_pictures =
      100;                 ///< one costs a quarter of a second and some 1.5 MB on disk
  std::vector<double> at;  ///< s
  std::vector<GoldenMoment> moments;
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
  int api = newest_api;
  std::string id, title;
  double time_limit = 120;  ///< s
  std::uint64_t seed = 1;
  SceneDefinition scene;
  ScoreDefinition score;
  GoldenDefinition golden;
  /// Steps, holds and noted numbers of the script, found by running it dry: metrics are named after them.
  std::vector<std::string> step_names, hold_names, note_names;  ///< hold_names are "step.hold"
  std::vector<std::string> waited_steps;                        ///< steps that nothing but time ends
  /// What the script may bring into the field, pieces of divided ducts too, likewise.
  std::vector<OrganDefinition> later_organs;
  std::vector<TissueDefinition> later_tissues;
  std::string file;                             ///< the scenario's path
  std::uint64_t source_hash = 0;                ///< of the scenario's text and the modules it required
  std::map<std::string, std::string> params;    ///< every parameter's value as text, defaults included
  std::vector<ParameterDefinition> parameters;  ///< ordered by name
};

/// What an author's rule says of a session.
struct RuleAnswer {
  double share = 0;  ///< of the part, 0 to 1
  std::string reason;
  std::vector<double> times;  ///< s, behind it, ascending
};

struct RuleAnswers {
  std::vector<RuleAnswer> parts;  ///< one for each part that is a rule, in their order
  std::optional<RuleAnswer>
      bail_out;  ///< share 1: it was right, 0: it was not; where there is a rule of it, and one
};

/// The author's own rules: they see what was measured, and no world.
class ScoreRules {
 public:
  virtual ~ScoreRules() = default;
  /// The same however often it is asked, by the exercise as it was read. Fails (scenario, at the author's line; resource)
  /// where an answer cannot be had.
  virtual Result<RuleAnswers> judge(const ExerciseDefinition& exercise,
                                    const std::map<std::string, double>& metrics,
                                    const Progress& progress) const = 0;
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
