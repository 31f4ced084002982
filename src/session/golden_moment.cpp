#include "session/golden_moment.h"

namespace calot {
namespace {

std::optional<double> step_begins(const std::string& name, const Progress& progress) {
  for (const StepRecord& step : progress.steps())
    if (step.name == name) return step.started;
  return std::nullopt;
}

std::optional<double> event_happens(const GoldenMoment& moment, const Progress& progress) {
  int awaited = moment.count;
  for (const SessionEvent& event : progress.events()) {
    if (!is_event(event, moment.event, moment.organ)) continue;
    if (!moment.step.empty() && event.step != moment.step) continue;
    if (--awaited == 0) return event.time;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> due_time(const GoldenMoment& moment, const Progress& progress) {
  const std::optional<double> happens =
      moment.event.empty() ? step_begins(moment.step, progress) : event_happens(moment, progress);
  if (!happens) return std::nullopt;
  return *happens + moment.delay;
}

}  // namespace calot
