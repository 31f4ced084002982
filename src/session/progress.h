#pragma once
// What has happened so far in a session: steps, events and the metrics named by the script.

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "world/world.h"

namespace calot {

/// A force that is asked for, so that a plot can show it.
struct ForceBand {
  std::string instrument;      ///< on whose jaws
  double least = 0, most = 0;  ///< N
};

/// What the author says of a step besides its name and title.
struct StepOptions {
  double limit = 0;                    ///< s, 0: none
  std::string hint = {};               ///< how it is done, for who practises; in no report
  std::optional<ForceBand> band = {};  ///< in no report
};

struct StepRecord {
  std::string name, title;
  std::string hint;                 ///< StepOptions
  double limit = 0;                 ///< s, 0: none
  std::optional<ForceBand> band;    ///< StepOptions
  double started = 0, ended = -1;   ///< s; ended < 0 while it runs
  std::string outcome = "running";  ///< running, done, timeout, missed, bail_out, aborted
};

/// A world event, or step_done / step_timeout / step_missed (value: the step's duration, s), with the step it fell into.
struct SessionEvent : WorldEvent {
  std::string step;  ///< empty before the first step
};

/// Whether it is of that kind, and happened to that organ or a piece of it; of an empty name, to any or none.
bool is_event(const WorldEvent& event, const std::string& kind, const std::string& organ);

/// A value that the script puts into the report.
struct Note {
  double time = 0;   ///< s
  std::string step;  ///< empty before the first step
  std::string name;
  std::variant<double, bool, std::string> value;
  std::string unit;  ///< may be empty
};

/// Everything the report and the score are made from.
class Progress {
 public:
  Progress() = default;
  /// Of a session that was played before.
  Progress(std::vector<StepRecord> steps, std::vector<SessionEvent> events, std::vector<Note> notes)
      : steps_(std::move(steps)), events_(std::move(events)), notes_(std::move(notes)) {}
  /// Ends the running step as done, if any, and starts the next.
  void begin_step(double time, const std::string& name, const std::string& title,
                  const StepOptions& options = {});
  /// Ends the running step, if any, and raises step_done, step_timeout or step_missed (with `why`) where the outcome is
  /// that.
  void end_step(double time, const std::string& outcome, const std::string& why = {});
  /// The running step, or null.
  const StepRecord* running() const;
  void add_event(const WorldEvent& event);
  void set_metric(const std::string& name, double value);
  /// A number is the metric note.<name> too.
  void add_note(Note note);
  const std::vector<StepRecord>& steps() const { return steps_; }
  const std::vector<SessionEvent>& events() const { return events_; }
  /// Whether who operated ended the operation otherwise than planned.
  bool bailed_out() const;
  const std::map<std::string, double>& metrics() const { return metrics_; }
  const std::vector<Note>& notes() const { return notes_; }

 private:
  std::vector<StepRecord> steps_;
  std::vector<SessionEvent> events_;
  std::map<std::string, double> metrics_;
  std::vector<Note> notes_;
};

}  // namespace calot
