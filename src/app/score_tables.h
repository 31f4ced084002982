#pragma once
// The scores of a class as text, as JSON and as CSV, from the entries of score_recording.h.

#include <string>
#include <vector>

#include "session/benchmarks.h"
#include "session/json.h"

namespace calot {

struct ClassScores {
  const ExerciseDefinition& exercise;  ///< with the benchmarks
  const std::optional<BenchmarkTable>& benchmarks;
  const std::vector<OrderedJson>& entries;  ///< in the order in which they are shown
};

/// One object of schema calot.scores/2, with a line end: exercise, benchmarks, recordings (the entries) and class: how
/// many there are, were scored, came to their end, were finished and passed, and had each outcome; of the totals of those
/// that were finished, mean, median, standard deviation (of a sample), least and most; and each part's mean points.
std::string scores_json(const ClassScores& scores);

/// RFC 4180, a row a recording, by outcome: file, from, end, whole, stopped_at_s, outcome, verdict, total, passed,
/// completed, steps_done, steps, critical, gates with their reasons, each part's points, what was measured and the
/// reason, all metrics, failure. What is not known is empty.
std::string scores_csv(const ClassScores& scores);

/// A table by outcome, what has no total last; of a single recording its parts, explained.
std::string scores_text(const ClassScores& scores);

/// The score's parts, in the order of the exercise's; null of an entry without, or with others (other parameters).
const OrderedJson* parts_of(const ClassScores& scores, const OrderedJson& entry);

/// Not of one without a score, nor where the simulation failed.
bool has_total(const OrderedJson& entry);

/// Steps done, of those that there are, of an entry that was scored: "3/5".
std::string steps_text(const OrderedJson& entry);

/// Whether all steps were done, or left by a bail-out that was right: only such totals are averaged.
bool is_finished(const OrderedJson& entry);

/// Indices of the entries by outcome, those without a score last; within an outcome in the order in which they are given.
std::vector<std::size_t> by_outcome(const std::vector<OrderedJson>& entries);

/// "passed", or why not, of an entry that may have failed.
std::string verdict_text(const OrderedJson& entry);

/// A failure's problems, "file:line: message (hint)" each, one a line.
std::string failure_text(const OrderedJson& entry);

}  // namespace calot
