#pragma once
// The scores of a class as text, as JSON and as CSV, from the entries of score_recording.h.

#include <string>
#include <vector>

#include "grading/name_register.h"
#include "grading/score_groups.h"
#include "session/benchmarks.h"
#include "session/json.h"

namespace calot {

struct ClassScores {
  const ExerciseDefinition& exercise;  ///< with the benchmarks
  const std::optional<BenchmarkTable>& benchmarks;
  const std::vector<OrderedJson>& entries;  ///< as they were named; copies are marked
  NameRegister names = {};                  ///< of trainees, to be joined
};

/// One object of schema calot.scores/3, with a line end: exercise, benchmarks, recordings (the entries; a copy has copy_of)
/// with --names the name) and groups (score_groups.h): mode, params, digest, pass mark, files; how many of each were scored, came to their end, were finished and passed, and had each
/// outcome; of the totals of those that were finished, mean, median, standard deviation (of a sample), least and most; and
/// each part's mean points.
std::string scores_json(const ClassScores& scores);

/// RFC 4180, a row a recording, by outcome: who, when and by what; outcome, verdict and total; gates with their reasons; each
/// part's points, weight, what was measured and the reason; all metrics; failure. What is not known is empty.
std::string scores_csv(const ClassScores& scores);

/// A table for each group, by outcome, and what is not counted; of a single recording its parts, explained.
std::string scores_text(const ClassScores& scores);

/// When it began, UTC, to the minute: "2026-11-25 20:13"; may be empty.
std::string began_text(const OrderedJson& entry);

/// Not of one without a score, nor where the simulation failed.
bool has_total(const OrderedJson& entry);

/// Steps done, of those that there are, of an entry that was scored: "3/5".
std::string steps_text(const OrderedJson& entry);

/// Whether all steps were done, or left by a bail-out that was right: only such totals are averaged.
bool is_finished(const OrderedJson& entry);

/// "passed", or why not, of an entry that may have failed.
std::string verdict_text(const OrderedJson& entry);

/// A failure's problems, "file:line: message (hint)" each, one a line; of a copy, whose.
std::string failure_text(const OrderedJson& entry);

}  // namespace calot
