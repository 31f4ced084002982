#include "session/scoring.h"

#include <fmt/format.h>

#include <algorithm>

#include "session/metrics.h"

namespace calot {
namespace {

constexpr double rounding = 1e-9;  // of a part's full marks

std::vector<double> times_of(const Progress& progress, EventKind kind) {
  std::vector<double> times;
  for (const SessionEvent& event : progress.events()) {
    if (event.kind == kind) times.push_back(event.time);
  }
  return times;
}

/// The events that change or mark a metric, so that an instructor can look them up in the recording.
std::vector<double> times_behind(const Progress& progress, const std::string& metric) {
  const std::size_t dot = metric.find('.'), last = metric.rfind('.');
  const std::string owner = metric.substr(0, dot), what = metric.substr(last + 1);
  const std::string full_owner = metric.substr(0, last);  // a piece of an organ has a dot in its name
  const std::optional<EventKind> kind = event_behind(what);
  std::vector<double> times;
  for (const SessionEvent& event : progress.events()) {
    const bool owned = event.kind == kind && (event.instrument == owner || event.organ == full_owner);
    const bool ends_step = ends_a_step(event.kind) && event.step == owner;
    if (owned || ends_step) times.push_back(event.time);
  }
  return times;
}

std::string why_not_measured(const Progress& progress, const std::string& metric) {
  const std::string owner = metric.substr(0, metric.find('.'));
  for (const StepRecord& step : progress.steps()) {
    if (step.name != owner) continue;
    return fmt::format("{} was never measured: step {} ended ({}) before it could be", metric, owner,
                       step.outcome);
  }
  return fmt::format("{} was never measured in this session", metric);
}

/// With as many digits, 4 and more, as tell a value from both benchmarks: what is not full marks must not look so.
std::string told_apart(double value, const ScorePart& part) {
  for (int digits = 4; digits < 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    if (text != fmt::format("{:.{}g}", part.novice, digits) &&
        text != fmt::format("{:.{}g}", part.expert, digits))
      return text;
  }
  return fmt::format("{}", value);
}

ScoredPart score_benchmark(const ScorePart& part, const std::map<std::string, double>& metrics,
                           const Progress& progress) {
  ScoredPart scored;
  scored.definition = part;
  scored.times = times_behind(progress, part.metric);
  const auto found = metrics.find(part.metric);
  if (found == metrics.end()) {
    scored.explanation = why_not_measured(progress, part.metric);
    return scored;
  }
  scored.measured = found->second;
  // + 0.0: a novice's very value gives minus zero, which would be printed as such.
  scored.fraction = std::clamp((part.novice - found->second) / (part.novice - part.expert), 0.0, 1.0) + 0.0;
  scored.explanation =
      fmt::format("{} = {}, between novice {:.4g} (no points) and expert {:.4g} (all points)", part.metric,
                  told_apart(found->second, part), part.novice, part.expert);
  if (scored.fraction < rounding) {
    scored.explanation =
        fmt::format("{} = {:.4g}, no better than novice {:.4g}", part.metric, found->second, part.novice);
  } else if (scored.fraction > 1 - rounding) {
    scored.explanation =
        fmt::format("{} = {:.4g}, as good as expert {:.4g}", part.metric, found->second, part.expert);
  }
  return scored;
}

ScoredPart score_penalty(const ScorePart& part, const Progress& progress) {
  ScoredPart scored;
  scored.definition = part;
  scored.times = times_of(progress, part.event);
  const double count = static_cast<double>(scored.times.size());
  scored.measured = count;
  scored.fraction = std::max(0.0, 1 - part.each * count);
  scored.explanation =
      count == 0 ? fmt::format("no {}", to_text(part.event))
                 : fmt::format("{:.0f} x {}, {:.4g} of the part each", count, to_text(part.event), part.each);
  return scored;
}

bool all_steps_done(const ExerciseDefinition& exercise, const Progress& progress) {
  for (const StepRecord& step : progress.steps()) {
    if (step.outcome != "done") return false;
  }
  for (const std::string& name : exercise.step_names) {
    const auto reached = [&](const StepRecord& step) { return step.name == name; };
    if (std::none_of(progress.steps().begin(), progress.steps().end(), reached)) return false;
  }
  return true;
}

}  // namespace

Score score(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
            const Progress& progress) {
  Score result;
  for (const ScorePart& part : exercise.score.parts) {
    ScoredPart scored = part.kind == ScorePartKind::benchmark ? score_benchmark(part, metrics, progress)
                                                              : score_penalty(part, progress);
    scored.points = 100 * part.weight * scored.fraction;
    result.uncapped += scored.points;
    result.parts.push_back(std::move(scored));
  }
  for (const EventKind kind : exercise.score.critical) {
    std::vector<double> times = times_of(progress, kind);
    if (!times.empty()) result.critical.push_back({kind, std::move(times)});
  }
  result.total = result.critical.empty() ? result.uncapped : std::min(result.uncapped, exercise.score.cap);
  result.completed = all_steps_done(exercise, progress);
  // A total that misses the pass mark by rounding alone has reached it.
  result.passed =
      result.completed && result.critical.empty() && result.total >= exercise.score.pass - 100 * rounding;
  return result;
}

}  // namespace calot
