#include "session/scoring.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

double count_of(const Progress& progress, const std::vector<EventKind>& kinds, std::vector<double>& times,
                std::string& counted) {
  double sum = 0;
  for (const EventKind kind : kinds) {
    const std::vector<double> of_kind = times_of(progress, kind);
    if (of_kind.empty()) continue;
    sum += static_cast<double>(of_kind.size());
    times.insert(times.end(), of_kind.begin(), of_kind.end());
    counted += fmt::format("{}{} x {}", counted.empty() ? "" : ", ", of_kind.size(), to_text(kind));
  }
  std::sort(times.begin(), times.end());
  return sum;
}

const StepRecord* record_of(const Progress& progress, const std::string& step) {
  const auto found = std::find_if(progress.steps().begin(), progress.steps().end(),
                                  [&](const StepRecord& one) { return one.name == step; });
  return found != progress.steps().end() ? &*found : nullptr;
}

bool is_done(const Progress& progress, const std::string& step) {
  const StepRecord* record = record_of(progress, step);
  return record != nullptr && record->outcome == "done";
}

/// Whether a bail-out took the step's place: it ended it, or came before it.
bool is_left(const Progress& progress, const std::string& step) {
  const StepRecord* record = record_of(progress, step);
  return record == nullptr || record->outcome == "bail_out";
}

/// Of the steps that a part judges.
struct StepCount {
  std::size_t counted = 0, done = 0;
  std::vector<std::string> missing;

  /// Done of those counted. Where there are none, a right bail-out left them all out, or nobody asked for anything.
  double share(bool steps_were_left) const {
    return counted == 0 ? (steps_were_left ? 1 : 0)
                        : static_cast<double>(done) / static_cast<double>(counted);
  }
  std::string text() const {
    return fmt::format("{} of {} steps done{}", done, counted,
                       missing.empty() ? "" : fmt::format(" (not {})", fmt::join(missing, ", ")));
  }
};

/// Those that a right bail-out left out do not count.
StepCount count_steps(const ScorePart& part, const std::vector<std::string>& all_steps,
                      const Progress& progress, bool right_bail_out) {
  StepCount count;
  for (const std::string& step : part.steps.empty() ? all_steps : part.steps) {
    if (right_bail_out && is_left(progress, step)) continue;
    ++count.counted;
    if (is_done(progress, step))
      ++count.done;
    else
      count.missing.push_back(step);
  }
  return count;
}

ScoredPart score_procedure(const ScorePart& part, const StepCount& steps, bool steps_were_left,
                           const Progress& progress) {
  ScoredPart scored;
  scored.definition = part;
  std::string minor, major;
  const double costs = part.minor_costs * count_of(progress, part.minor, scored.times, minor) +
                       part.major_costs * count_of(progress, part.major, scored.times, major);
  scored.fraction = std::max(0.0, steps.share(steps_were_left) - costs / 100);
  scored.measured = 100 * scored.fraction;
  scored.explanation = steps.text();
  scored.explanation +=
      minor.empty() && major.empty() ? ", no errors" : fmt::format(", less {:.4g} points", costs);
  if (!minor.empty()) scored.explanation += fmt::format("; minor, {:.4g} each: {}", part.minor_costs, minor);
  if (!major.empty()) scored.explanation += fmt::format("; major, {:.4g} each: {}", part.major_costs, major);
  return scored;
}

ScoredPart score_time(const ScorePart& part, const std::map<std::string, double>& metrics,
                      const Progress& progress) {
  ScoredPart scored;
  scored.definition = part;
  const auto found = metrics.find("total.time_s");
  if (found == metrics.end()) {
    scored.explanation = "total.time_s was never measured in this session";
    return scored;
  }
  std::string errors;
  const double penalty = part.each_s * count_of(progress, part.errors, scored.times, errors);
  scored.measured = found->second + penalty;
  scored.fraction =
      std::clamp((part.limit - *scored.measured) / (part.limit - part.reference), 0.0, 1.0) + 0.0;
  scored.explanation = fmt::format(
      "{:.4g} s{}, between {:.4g} s (all points) and {:.4g} s (no points)", found->second,
      errors.empty() ? "" : fmt::format(" and {:.4g} s for {}", penalty, errors), part.reference, part.limit);
  return scored;
}

ScoredPart score_critical_view(const ScorePart& part, const std::map<std::string, double>& metrics,
                               const Progress& progress) {
  ScoredPart scored;
  scored.definition = part;
  for (const Note& note : progress.notes())
    if ("note." + note.name == part.metric) scored.times.push_back(note.time);
  const auto found = metrics.find(part.metric);
  if (found == metrics.end()) {
    scored.explanation = why_not_measured(progress, part.metric);
    return scored;
  }
  scored.measured = found->second;
  scored.fraction = std::clamp(found->second / part.full, 0.0, 1.0) + 0.0;
  const bool enough = found->second >= part.satisfactory;
  scored.explanation =
      fmt::format("the critical view has {:.4g} of {:.4g} points: {} is satisfactory, this {}", found->second,
                  part.full, part.satisfactory, enough ? "is" : "is not");
  return scored;
}

ScoredPart score_rule(const ScorePart& part, const RuleAnswer& answer) {
  ScoredPart scored;
  scored.definition = part;
  scored.measured = scored.fraction = answer.share;
  scored.times = answer.times;
  scored.explanation = answer.reason;
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

/// The times at which its event came too soon, or at all; nothing where it has no event.
std::vector<double> times_tripped(const GateDefinition& gate, const Progress& progress) {
  std::vector<double> times;
  bool prepared = gate.only_after.empty();
  for (const SessionEvent& event : progress.events()) {
    if (is_event(event, gate.event, gate.organ) && (gate.only_after.empty() || !prepared))
      times.push_back(event.time);
    prepared = prepared || is_event(event, gate.only_after, gate.after_organ);
  }
  return times;
}

/// Whether the metric is beyond the gate's value, and what was found.
bool is_beyond(const GateDefinition& gate, const std::map<std::string, double>& metrics, std::string& found) {
  const auto metric = metrics.find(gate.metric);
  if (metric == metrics.end()) {
    found = gate.metric + " was never measured";
    return true;
  }
  const double limit = gate.below.value_or(gate.above.value_or(0));
  found = fmt::format("{} = {:.6g}, {} {:.6g}", gate.metric, metric->second, gate.below ? "below" : "above",
                      limit);
  return gate.below ? metric->second < limit : metric->second > limit;
}

std::optional<TrippedGate> tripped(const GateDefinition& gate, double cap,
                                   const std::map<std::string, double>& metrics, const Progress& progress) {
  TrippedGate result{gate.reason, std::nullopt, gate.event, gate.cap.value_or(cap), gate.fails, {}, {}};
  if (std::any_of(progress.events().begin(), progress.events().end(),
                  [&](const WorldEvent& event) { return is_event(event, gate.unless, {}); }))
    return std::nullopt;
  if (!gate.event.empty()) {
    result.times = times_tripped(gate, progress);
    if (result.times.empty()) return std::nullopt;
    const std::string on = gate.organ.empty() ? "" : " of " + gate.organ;
    result.explanation = fmt::format("{} x {}{}", result.times.size(), gate.event, on);
    if (!gate.only_after.empty())
      result.explanation += fmt::format(", and no {}{} before", gate.only_after,
                                        gate.after_organ.empty() ? "" : " of " + gate.after_organ);
  }
  if (!gate.metric.empty()) {
    std::string found;
    if (!is_beyond(gate, metrics, found)) return std::nullopt;
    result.explanation += (result.explanation.empty() ? "" : "; ") + found;
  }
  return result;
}

std::vector<TrippedGate> tripped_gates(const ScoreDefinition& score,
                                       const std::map<std::string, double>& metrics,
                                       const Progress& progress) {
  std::vector<TrippedGate> gates;
  for (const EventKind kind : score.critical) {
    std::vector<double> times = times_of(progress, kind);
    if (times.empty()) continue;
    const std::string counted = fmt::format("{} x {}", times.size(), to_text(kind));
    gates.push_back(
        {to_text(kind) + " is critical", kind, to_text(kind), score.cap, true, std::move(times), counted});
  }
  for (const GateDefinition& gate : score.gates)
    if (std::optional<TrippedGate> found = tripped(gate, score.cap, metrics, progress))
      gates.push_back(std::move(*found));
  std::stable_partition(gates.begin(), gates.end(), [](const TrippedGate& gate) { return gate.fails; });
  return gates;
}

/// Those that the exercise is known to have, and those that a session reached besides.
std::vector<std::string> all_steps(const ExerciseDefinition& exercise, const Progress& progress) {
  std::vector<std::string> names = exercise.step_names;
  for (const StepRecord& step : progress.steps())
    if (std::find(names.begin(), names.end(), step.name) == names.end()) names.push_back(step.name);
  return names;
}

/// Whether the steps that a bail-out left may be missing.
bool bail_out_is_right(const ExerciseDefinition& exercise, const Score& score, const Progress& progress) {
  if (!progress.bailed_out()) return false;
  return exercise.api == 1 ? exercise.score.bail_out_completes : score.bail_out && score.bail_out->share > 0;
}

AttemptOutcome outcome_of(const ExerciseDefinition& exercise, const Score& score, bool right_bail_out) {
  if (exercise.score.parts.empty()) return AttemptOutcome::not_judged;
  if (failing_gate(score) != nullptr) return AttemptOutcome::unsafe;
  if (!score.completed) return AttemptOutcome::unfinished;
  // A total that misses the pass mark by rounding alone has reached it.
  if (score.total < exercise.score.pass - 100 * rounding) return AttemptOutcome::below_mark;
  return right_bail_out ? AttemptOutcome::right_bail_out : AttemptOutcome::passed;
}

/// What it earns of what was done; a procedure looks at `steps`, its own.
ScoredPart score_part(const ScorePart& part, const std::map<std::string, double>& metrics,
                      const Progress& progress, const StepCount& steps, bool steps_were_left,
                      const RuleAnswer* answer) {
  switch (part.kind) {
    case ScorePartKind::benchmark:
      return score_benchmark(part, metrics, progress);
    case ScorePartKind::penalty:
      return score_penalty(part, progress);
    case ScorePartKind::procedure:
      return score_procedure(part, steps, steps_were_left, progress);
    case ScorePartKind::time:
      return score_time(part, metrics, progress);
    case ScorePartKind::critical_view:
      return score_critical_view(part, metrics, progress);
    case ScorePartKind::rule:
      return score_rule(part, *answer);
  }
  return {};
}

}  // namespace

const std::vector<std::string>& score_part_kinds() {
  static const std::vector<std::string> names = {"benchmark", "penalty",       "procedure",
                                                 "time",      "critical_view", "rule"};
  return names;
}

std::string part_title(const ScorePart& part) {
  switch (part.kind) {
    case ScorePartKind::benchmark:
    case ScorePartKind::critical_view:
      return metric_title(part.metric);
    case ScorePartKind::penalty:
      return to_text(part.event) + " events";
    case ScorePartKind::procedure:
      return "steps done, less its errors";
    case ScorePartKind::time:
      return "time of the session with its errors' costs, s";
    case ScorePartKind::rule:
      return "a rule of the exercise's author";
  }
  return {};
}

const TrippedGate* failing_gate(const Score& score) {
  return !score.gates.empty() && score.gates.front().fails ? &score.gates.front() : nullptr;
}

const std::vector<OutcomeRow>& outcome_rows() {
  using enum AttemptOutcome;
  static const std::vector<OutcomeRow> rows = {
      {passed, "passed", "passed"},
      {right_bail_out, "right_bail_out", "right bail-out"},
      {below_mark, "below_mark", "below the mark"},
      {unfinished, "unfinished", "unfinished"},
      {unsafe, "unsafe", "unsafe"},
      {not_judged, "not_judged", "not judged"},
  };
  return rows;
}

std::string to_text(AttemptOutcome outcome) { return outcome_rows()[static_cast<std::size_t>(outcome)].name; }

std::string verdict(const Score& score) {
  const std::string text = outcome_rows()[static_cast<std::size_t>(score.outcome)].words;
  if (score.outcome == AttemptOutcome::unsafe) {
    const TrippedGate& gate = *failing_gate(score);
    return text + ": " + (gate.critical ? "critical event " + to_text(*gate.critical) : gate.reason);
  }
  if (score.outcome != AttemptOutcome::unfinished) return text;
  if (score.bail_out && score.bail_out->share == 0)
    return text + ": bailing out was not right: " + score.bail_out->reason;
  return score.missing.empty() ? text : fmt::format("{}: not {}", text, fmt::join(score.missing, ", "));
}

void cut_short(Score& score, bool simulation_failed) {
  score.completed = false;
  if (score.outcome == AttemptOutcome::not_judged) return;
  score.outcome = simulation_failed                ? AttemptOutcome::not_judged
                  : failing_gate(score) != nullptr ? AttemptOutcome::unsafe
                                                   : AttemptOutcome::unfinished;
}

Result<Score> score(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
                    const Progress& progress) {
  Score result;
  RuleAnswers answers;
  if (exercise.score.rules) {
    Result<RuleAnswers> judged = exercise.score.rules->judge(exercise, metrics, progress);
    if (!judged) return judged.failure();
    answers = std::move(judged).value();
    result.bail_out = answers.bail_out;
  }
  const bool right_bail_out = bail_out_is_right(exercise, result, progress), bound = exercise.api > 1;
  const std::vector<std::string> all = all_steps(exercise, progress);
  std::size_t rules = 0;
  for (const ScorePart& part : exercise.score.parts) {
    const bool steps_were_left = bound && right_bail_out;
    const StepCount steps = count_steps(part, all, progress, steps_were_left);
    const RuleAnswer* answer = part.kind == ScorePartKind::rule ? &answers.parts.at(rules++) : nullptr;
    ScoredPart scored = score_part(part, metrics, progress, steps, steps_were_left, answer);
    if (bound && part.kind != ScorePartKind::procedure) {
      scored.done = steps.share(steps_were_left);
      if (!steps.missing.empty()) scored.explanation += "; " + steps.text();
    }
    scored.points = 100 * part.weight * scored.fraction * scored.done;
    result.uncapped += scored.points;
    result.parts.push_back(std::move(scored));
  }
  result.total = result.uncapped;
  result.gates = tripped_gates(exercise.score, metrics, progress);
  for (const TrippedGate& gate : result.gates) result.total = std::min(result.total, gate.cap);
  const StepCount steps = count_steps({}, all, progress, right_bail_out);
  result.steps = all.size();
  result.steps_done = steps.done;
  result.missing = steps.missing;
  result.completed = steps.missing.empty() || right_bail_out;
  result.outcome = outcome_of(exercise, result, right_bail_out);
  return result;
}

}  // namespace calot
