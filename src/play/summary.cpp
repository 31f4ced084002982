#include "play/summary.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "base/units.h"
#include "process/terminal.h"

namespace calot {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// The first times, and how many there are.
std::string times_text(const std::vector<double>& times) {
  std::string text;
  for (std::size_t i = 0; i < times.size() && i < 4; ++i)
    text += fmt::format("{}{:.2f}", i > 0 ? ", " : "", times[i]);
  if (times.size() > 4) text += fmt::format(", ... ({} in all)", times.size());
  return text.empty() ? "" : "at " + text + " s";
}

std::string steps_text(const Progress& progress) {
  Rows rows;
  for (const StepRecord& step : progress.steps()) {
    rows.push_back({step.outcome, step.name, step.title, fmt::format("{:.2f} s", step.ended - step.started),
                    step.limit > 0 ? fmt::format("of {:.0f} s", step.limit) : ""});
  }
  return table(rows, "lllrr");
}

/// Kinds in the order of their first event, with their times.
std::string events_text(const Progress& progress) {
  std::vector<std::pair<std::string, std::vector<double>>> kinds;
  for (const SessionEvent& event : progress.events()) {
    if (ends_a_step(event.kind)) continue;  // the steps' table says it
    const std::string &who = event.instrument, &what = event.organ;
    std::string name = fmt::format("{}{}{}{}{}", to_text(event.kind), who.empty() ? "" : " ", who,
                                   what.empty() ? "" : (who.empty() ? " " : " on "), what);
    if (event.cause != EventCause::none) name += fmt::format(" ({})", to_text(event.cause));
    if (!event.text.empty()) name += fmt::format(": {}", event.text);
    auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.first == name; });
    if (found == kinds.end()) found = kinds.insert(kinds.end(), {name, {}});
    found->second.push_back(event.time);
  }
  Rows rows;
  for (const auto& [name, times] : kinds) rows.push_back({name, times_text(times)});
  return table(rows, "ll");
}

std::string metrics_text(const std::map<std::string, double>& metrics) {
  Rows rows;
  for (const auto& [name, value] : metrics) rows.push_back({name, fmt::format("{:.5g}", value)});
  return table(rows, "lr");
}

std::string notes_text(const Progress& progress) {
  Rows rows;
  for (const Note& note : progress.notes()) {
    std::string value = "false";
    if (const auto* number = std::get_if<double>(&note.value)) value = fmt::format("{:.5g}", *number);
    if (const auto* text = std::get_if<std::string>(&note.value)) value = *text;
    if (const auto* flag = std::get_if<bool>(&note.value); flag != nullptr && *flag) value = "true";
    rows.push_back({note.name, value, note.unit, fmt::format("at {:.2f} s", note.time)});
  }
  return table(rows, "lrll");
}

std::string score_text(const Score& score) {
  Rows rows;
  for (const ScoredPart& part : score.parts) {
    rows.push_back({fmt::format("{:.1f}", part.points),
                    fmt::format("of {:.1f}", 100 * part.definition.weight), part.definition.name,
                    part.explanation, times_text(part.times)});
  }
  return table(rows, "rrlll");
}

std::string total_text(const Played& played) {
  const Score& score = played.report.score;
  if (played.report.has_total())
    return fmt::format("\n{} {:.1f} of 100, {} (pass mark {:.0f})\n", bold("Score"), score.total,
                       score.passed() ? green(verdict(score)) : red(verdict(score)),
                       played.exercise.score.pass);
  return fmt::format(
      "\n{} none: {}\n", bold("Score"),
      played.report.aborted ? "the session did not come to its end" : "this exercise has no score");
}

}  // namespace

std::string summary(const Played& played) {
  const SessionResult& session = played.session;
  const Score& score = played.report.score;
  std::string text = fmt::format("{} ({})\n", bold(played.exercise.title), played.exercise.id);
  text += fmt::format("\n{}\n{}", bold("Steps"), steps_text(session.progress));
  text += fmt::format("\n{}\n{}", bold("Events"), events_text(session.progress));
  if (!session.progress.notes().empty())
    text += fmt::format("\n{}\n{}", bold("Noted"), notes_text(session.progress));
  text += fmt::format("\n{}\n{}", bold("Metrics"), metrics_text(session.metrics));
  if (!session.rest.empty())
    text += fmt::format("\n{}\n  {}\n", bold("At rest"), fmt::join(session.rest, "\n  "));
  text += total_text(played);
  for (const TrippedGate& gate : score.gates)
    text += fmt::format("  {} ({}{}{}): the total is capped at {:.0f}\n", gate.reason, gate.explanation,
                        gate.times.empty() ? "" : " ", times_text(gate.times), gate.cap);
  if (played.report.has_total())
    text += score_text(score) + "  Benchmarks are design values, uncalibrated.\n";
  if (played.report.has_total() && played.exercise.api == 1) text += fmt::format("  {}\n", api_1_remark);
  text += fmt::format("\nState hash {}, {:.2f} x real time\n",
                      hex(session.state_hashes.empty() ? 0 : session.state_hashes.back()),
                      real_time_factor(session));
  return text;
}

}  // namespace calot
