#include "goldens/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "play/play.h"
#include "process/interrupt.h"
#include "process/project.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// The frames that a scenario declares, and those stored.
std::set<std::string> known_frames(const ExerciseDefinition& exercise, const fs::path& folder) {
  std::set<std::string> known;
  for (const std::string& name : stored_frames(folder)) known.insert(name);
  for (const std::string& name : golden_names(exercise)) known.insert(name);
  return known;
}

}  // namespace

std::vector<std::string> stored_frames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<Failure> check_selected(const std::vector<SelectedGolden>& selected, const fs::path& goldens) {
  for (const SelectedGolden& scenario : selected) {
    const Result<ExerciseDefinition> exercise = load_definition(scenario.file);
    if (!exercise) return exercise.failure();
    const std::set<std::string> known = known_frames(exercise.value(), goldens / scenario.name);
    for (const std::string& frame : scenario.frames)
      if (!known.contains(frame))
        return fail(FailureKind::usage, fmt::format("{} has no frame {}", scenario.name, frame),
                    fmt::format("frames: {}", fmt::join(known, ", ")));
  }
  return std::nullopt;
}

void use_stored_size(const fs::path& folder, PlayRequest& request) {
  for (const std::string& frame : stored_frames(folder)) {
    const Result<Golden> golden = read_golden(folder / frame);
    if (!golden) continue;
    request.width = golden->sidecar.width;
    request.height = golden->sidecar.height;
    return;
  }
}

ComparedScenario compare_scenario(const SelectedGolden& selected, const fs::path& goldens, int threads,
                                  const GoldenSink& sink) {
  ComparedScenario compared;
  const fs::path folder = goldens / selected.name;
  const Result<ExerciseDefinition> definition = load_definition(selected.file);
  if (!definition) {
    compared.failure = definition.failure();
    return compared;
  }
  std::set<std::string> wanted = known_frames(definition.value(), folder);
  std::erase_if(wanted, [&](const std::string& name) { return !selected.wants(name); });
  if (wanted.empty()) return compared;

  PlayRequest request;
  request.scenario = selected.file;
  request.threads = threads;
  request.end_frame = false;
  use_stored_size(folder, request);
  SessionJudge judge(selected.name, folder, std::move(wanted), sink);
  request.on_picture = [&](const Frame& frame) -> std::optional<Failure> {
    judge.see(frame);
    return std::nullopt;
  };
  const Result<Played> played = play(request);
  compared.interrupted = interrupt_flag();
  if (!played) compared.failure = played.failure();
  if (!played || compared.interrupted) return compared;
  judge.end(played.value());
  return compared;
}

std::vector<GoldenResult> goldens_without_scenario(const fs::path& goldens) {
  std::set<std::string> known;
  for (const fs::path& file : project_scenarios()) known.insert(scenario_name(file));
  std::vector<GoldenResult> lost;
  std::error_code error;
  fs::recursive_directory_iterator entry(goldens, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ".json") continue;
    const std::string scenario = entry->path().parent_path().lexically_relative(goldens).generic_string();
    if (known.contains(scenario)) continue;
    const std::string message = fmt::format("there is no scenarios/{0}.lua; restore it, or remove {1}",
                                            scenario, entry->path().parent_path().string());
    lost.push_back(
        {scenario, entry->path().stem().string(), {Verdict::no_scenario, false, message, {}}, {}, {}});
  }
  std::sort(lost.begin(), lost.end(), [](const GoldenResult& a, const GoldenResult& b) {
    return std::tie(a.scenario, a.frame) < std::tie(b.scenario, b.frame);
  });
  return lost;
}

}  // namespace calot
