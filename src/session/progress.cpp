#include "session/progress.h"

#include <algorithm>

namespace calot {

bool is_event(const WorldEvent& event, const std::string& kind, const std::string& organ) {
  return to_text(event.kind) == kind &&
         (organ.empty() || event.organ == organ || event.organ.starts_with(organ + "."));
}

void Progress::begin_step(double time, const std::string& name, const std::string& title,
                          const StepOptions& options) {
  end_step(time, "done");
  StepRecord step;
  step.name = name;
  step.title = title;
  step.hint = options.hint;
  step.limit = options.limit;
  step.band = options.band;
  step.started = time;
  steps_.push_back(std::move(step));
}

void Progress::end_step(double time, const std::string& outcome, const std::string& why) {
  if (running() == nullptr) return;
  StepRecord& step = steps_.back();
  if (const std::optional<EventKind> kind = event_called("step_" + outcome)) {
    WorldEvent event;
    event.kind = *kind;
    event.text = why;
    event.time = time;
    event.value = time - step.started;
    add_event(event);  // while the step still runs, so that the event carries its name
  }
  step.ended = time;
  step.outcome = outcome;
}

const StepRecord* Progress::running() const {
  return steps_.empty() || steps_.back().ended >= 0 ? nullptr : &steps_.back();
}

void Progress::add_event(const WorldEvent& event) {
  const StepRecord* step = running();
  events_.push_back({event, step != nullptr ? step->name : std::string()});
}

bool Progress::bailed_out() const {
  return std::any_of(events_.begin(), events_.end(),
                     [](const SessionEvent& event) { return event.kind == EventKind::bail_out; });
}

void Progress::add_note(Note note) {
  if (const StepRecord* step = running()) note.step = step->name;
  if (const double* number = std::get_if<double>(&note.value)) set_metric("note." + note.name, *number);
  notes_.push_back(std::move(note));
}

void Progress::set_metric(const std::string& name, double value) { metrics_[name] = value; }

}  // namespace calot
