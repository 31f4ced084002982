#include "session/benchmarks.h"

#include <fmt/format.h>

#include "base/suggest.h"

namespace calot {
namespace {

void replace(const PartBenchmark& benchmark, ScorePart& part, const std::string& calibration,
             std::vector<Problem>& problems) {
  const bool between = part.kind == ScorePartKind::benchmark;
  if (!between && part.kind != ScorePartKind::penalty)
    return problems.push_back({benchmark.place,
                               fmt::format("{} is a {}: no table replaces its figures", part.name,
                                           score_part_kinds()[static_cast<std::size_t>(part.kind)]),
                               "leave it out: tables replace those of benchmarks and penalties"});
  if (between && benchmark.each)
    problems.push_back({benchmark.place,
                        fmt::format("{} lies between novice and expert: it has no \"each\"", part.name),
                        "give novice, expert or both"});
  if (!between && (benchmark.novice || benchmark.expert))
    problems.push_back({benchmark.place,
                        fmt::format("{} is a penalty: it has neither novice nor expert", part.name),
                        "give each"});
  part.novice = benchmark.novice.value_or(part.novice);
  part.expert = benchmark.expert.value_or(part.expert);
  part.each = benchmark.each.value_or(part.each);
  part.calibration = calibration;
  if (between && part.novice == part.expert)
    problems.push_back({benchmark.place,
                        fmt::format("{}: novice and expert are both {:g}", part.name, part.novice),
                        "the score runs from one to the other: they must differ"});
}

}  // namespace

std::vector<Problem> apply(const BenchmarkTable& table, ExerciseDefinition& exercise) {
  if (table.exercise != exercise.id)
    return {{table.place, fmt::format("these are benchmarks of {}, not of {}", table.exercise, exercise.id),
             "score that exercise, or name another table"}};
  std::vector<Problem> problems;
  std::vector<std::string> names;
  for (const ScorePart& part : exercise.score.parts) names.push_back(part.name);
  for (const PartBenchmark& benchmark : table.parts) {
    bool found = false;
    for (ScorePart& part : exercise.score.parts) {
      if (part.name != benchmark.part) continue;
      replace(benchmark, part, table.calibration, problems);
      found = true;
    }
    if (!found)
      problems.push_back({benchmark.place, fmt::format("the score has no part \"{}\"", benchmark.part),
                          suggestion(benchmark.part, names)});
  }
  exercise.score.pass = table.pass.value_or(exercise.score.pass);
  exercise.score.cap = table.cap.value_or(exercise.score.cap);
  return problems;
}

}  // namespace calot
