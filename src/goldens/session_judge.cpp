#include "goldens/session_judge.h"

#include <algorithm>

namespace calot {
namespace {

namespace fs = std::filesystem;

/// Reads the stored golden; without one the judgement is made.
void find_golden(GoldenResult& result, const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / (result.frame + ".json"), ignored)) {
    result.judgement = {Verdict::missing, false, "no golden is stored for this frame", {}};
    return;
  }
  Result<Golden> golden = read_golden(folder / result.frame);
  if (golden)
    result.golden = std::move(golden).value();
  else
    result.judgement = {Verdict::unreadable, false, to_text(golden.failure()), {}};
}

bool declares(const ExerciseDefinition& exercise, const std::string& name) {
  const std::vector<std::string> names = golden_names(exercise);
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

SessionJudge::SessionJudge(std::string scenario, fs::path folder, std::set<std::string> wanted,
                           GoldenSink sink)
    : scenario_(std::move(scenario)),
      folder_(std::move(folder)),
      wanted_(std::move(wanted)),
      sink_(std::move(sink)) {}

void SessionJudge::see(const Frame& frame) {
  if (wanted_.erase(frame.name) == 0) return;
  GoldenResult result{scenario_, frame.name};
  result.actual = make_golden(frame);
  find_golden(result, folder_);
  if (result.golden) result.judgement = judge(*result.golden, *result.actual);
  if (result.judgement.verdict == Verdict::drifted)
    drifted_.push_back(std::move(result));
  else
    sink_(result);
}

GoldenResult SessionJudge::undrawn(const std::string& frame, const Played& played) const {
  GoldenResult result{scenario_, frame};
  find_golden(result, folder_);
  if (!result.golden) return result;
  if (declares(played.exercise, frame))
    result.judgement = judge_undrawn(*result.golden, played.session);
  else
    result.judgement = {Verdict::stale, false, "the scenario declares no such frame", {}};
  return result;
}

void SessionJudge::end(const Played& played) {
  for (const std::string& name : wanted_) drifted_.push_back(undrawn(name, played));
  const Course here = course_of(played);
  for (GoldenResult& result : drifted_) {
    if (result.judgement.verdict == Verdict::drifted)
      judge_course(result.judgement, result.golden->sidecar.course, here, played.session);
    sink_(result);
  }
}

}  // namespace calot
