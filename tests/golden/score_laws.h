#pragma once
// Laws of every shipped score, from one session of its demo.

#include <gtest/gtest.h>

#include "play/play.h"
#include "session/metrics.h"
#include "session/scoring.h"

namespace calot::test {

/// What is scored of a session.
struct Attempt {
  std::map<std::string, double> metrics;
  Progress progress;
};

/// The session as if it had been broken off at a time, s: what was done, traced and noted until then.
inline Attempt broken_off(const Played& played, double time) {
  const Progress& whole = played.session.progress;
  std::vector<StepRecord> steps;
  for (const StepRecord& step : whole.steps())
    if (step.ended <= time) steps.push_back(step);
  std::vector<SessionEvent> events;
  for (const SessionEvent& event : whole.events())
    if (event.time <= time) events.push_back(event);
  std::vector<Note> notes;
  for (const Note& note : whole.notes())
    if (note.time <= time) notes.push_back(note);
  Progress progress(steps, events, notes);
  for (const auto& [name, value] : whole.metrics()) {
    const std::string owner = name.substr(0, name.find('.'));
    const auto is = [&](const StepRecord& step) { return step.name == owner; };
    const bool of_a_step = std::any_of(whole.steps().begin(), whole.steps().end(), is);
    if (name.starts_with("note.")) continue;
    progress.set_metric(name, of_a_step && std::none_of(steps.begin(), steps.end(), is) ? 0 : value);
  }
  for (const Note& note : notes)
    if (const double* number = std::get_if<double>(&note.value))
      progress.set_metric("note." + note.name, *number);
  Traces traces = played.session.traces;
  const auto kept = static_cast<std::size_t>(std::upper_bound(traces.time.begin(), traces.time.end(), time) -
                                             traces.time.begin());
  traces.time.resize(kept);
  for (auto& samples : traces.instruments) samples.resize(kept);
  traces.laparoscope.resize(kept);
  traces.off_level.resize(kept);
  for (auto& samples : traces.organs) samples.resize(std::min(samples.size(), kept));
  return {measure(played.exercise.scene, traces, progress), progress};
}

inline Score scored(const Played& played, const Attempt& attempt) {
  Result<Score> result = score(played.exercise, attempt.metrics, attempt.progress);
  EXPECT_TRUE(result) << to_text(result.failure());
  return result ? result.value() : Score();
}

/// Who stops after a step earns no more than who goes on, and nothing before the first.
inline void expect_more_for_more(const Played& played) {
  std::vector<double> stops{0};
  for (const StepRecord& step : played.session.progress.steps()) stops.push_back(step.ended);
  double before = 0;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const Score stopped = scored(played, broken_off(played, stops[i]));
    EXPECT_GE(stopped.total, before) << "after " << i << " steps";
    if (i == 0) {
      EXPECT_EQ(stopped.total, 0) << "for nothing";
    }
    EXPECT_EQ(stopped.outcome == AttemptOutcome::unfinished, i + 1 < stops.size());
    EXPECT_EQ(stopped.steps_done, i);
    before = stopped.total;
  }
  EXPECT_NEAR(before, played.report.score.total, 1e-9) << "the last stop is the whole session";
}

/// An error more, of whatever kind, never helps. Each kind happens to one organ, all organs in turn.
inline void expect_no_error_helps(const Played& played) {
  const SceneDefinition& scene = played.exercise.scene;
  const double total = played.report.score.total;
  std::size_t tried = 0, costly = 0;
  for (const EventRow& row : event_rows()) {
    if (!row.error) continue;
    Attempt worse{played.session.metrics, played.session.progress};
    WorldEvent event;
    event.kind = row.kind;
    event.time = played.session.traces.time.back() / 2;
    event.instrument = scene.instruments[0].name;
    event.organ = scene.anatomy.organs[tried++ % scene.anatomy.organs.size()].name;
    worse.progress.add_event(event);
    worse.metrics = measure(scene, played.session.traces, worse.progress);
    const Score scored_worse = scored(played, worse);
    EXPECT_LE(scored_worse.total, total + 1e-9) << row.name << " of " << event.organ;
    costly += scored_worse.total < total ? 1 : 0;
  }
  EXPECT_GT(costly, 0u) << "no error costs anything";
}

}  // namespace calot::test
