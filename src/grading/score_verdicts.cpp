#include "grading/score_verdicts.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "base/log.h"
#include "grading/score_tables.h"
#include "process/project.h"
#include "process/terminal.h"
#include "session/recording.h"

namespace calot {

std::vector<std::string> recordings_of(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  std::set<std::filesystem::path> seen;
  std::error_code error;
  const auto add = [&](const std::string& file) {
    if (seen.insert(std::filesystem::weakly_canonical(file, error)).second)
      files.push_back(file);
    else
      log_info(fmt::format("{} is named twice; it is scored once.", file));
  };
  for (const std::string& name : names) {
    if (!std::filesystem::is_directory(name, error)) {
      add(name);
      continue;
    }
    for (const std::filesystem::path& file : files_below(name, ".jsonl")) add(file.string());
  }
  return files;
}

Failure no_recordings(const std::vector<std::string>& names) {
  return fail(FailureKind::usage,
              fmt::format("there is no recording (.jsonl) below {}", fmt::join(names, ", ")));
}

std::optional<Failure> first_unreadable(const std::vector<std::string>& recordings) {
  for (const std::string& file : recordings)
    if (const Result<Recording> recording = read_recording(file); !recording) return recording.failure();
  return std::nullopt;
}

void tell_why(const std::vector<OrderedJson>& entries) {
  std::map<std::string, int> reasons;
  for (const OrderedJson& entry : entries)
    if (entry.contains("why") && entry["why"].is_string()) ++reasons[entry["why"].get<std::string>()];
  for (const auto& [why, count] : reasons)
    if (why != "--replay") log_info(fmt::format("{} of {} simulated: {}.", count, entries.size(), why));
}

ExitCode judge(const std::vector<OrderedJson>& entries, const std::string& exercise_file,
               std::optional<double> fail_below) {
  std::optional<ExitCode> failed;
  std::string next;
  const std::string exercise = shell_word(exercise_file);
  const auto tell = [&](const OrderedJson& entry, const std::string& what, const char* look) {
    const auto& name = entry["file"].get_ref<const std::string&>();
    std::fprintf(stderr, "%s: %s\n", name.c_str(), what.c_str());
    if (next.empty()) next = fmt::format(fmt::runtime(look), exercise, shell_word(name));
  };
  for (const OrderedJson& entry : entries) {
    if (entry.contains("failure")) {
      std::fprintf(stderr, "%s\n", failure_text(entry).c_str());
      if (!failed) failed = static_cast<ExitCode>(entry["exit_code"].get<int>());
      continue;
    }
    if (entry["verified"] == false)
      for (const OrderedJson& difference : entry["differences"])
        tell(entry, difference.get<std::string>(), "calot replay {1} --scenario {0}");
    if (!is_scored(entry)) continue;  // a copy: the one that counts is judged
    const OrderedJson& total = entry["score"]["total"];
    if (!entry["whole"].get<bool>())
      tell(entry,
           fmt::format("it did not come to its end ({}): scored up to {:.3f} s",
                       entry["end"].get<std::string>(), entry["stopped_at_s"].get<double>()),
           "calot replay {1} --scenario {0}");
    else if (fail_below && (total.is_null() || total.get<double>() < *fail_below))
      tell(entry,
           total.is_null()
               ? fmt::format("there is no score to be {:g} or more", *fail_below)
               : fmt::format("the score, {:.1f}, is below {:g}", total.get<double>(), *fail_below),
           "calot score {0} {1}");
  }
  if (next.empty() && failed) next = "calot run " + exercise;
  if (!next.empty()) std::fprintf(stderr, "Next: %s\n", next.c_str());
  return failed.value_or(next.empty() ? ExitCode::ok : ExitCode::mismatch);
}

}  // namespace calot
