#include "goldens/select.h"

#include <fmt/format.h>

#include <algorithm>

#include "process/project.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Meaning {
  fs::path file;
  std::string frame;  ///< empty: all
};

/// Scenarios called `name` in full, or else those that end in it after a folder.
std::vector<fs::path> called(const std::vector<fs::path>& scenarios, const std::string& name) {
  std::vector<fs::path> ending;
  for (const fs::path& file : scenarios) {
    if (scenario_name(file) == name) return {file};
    if (scenario_name(file).ends_with("/" + name)) ending.push_back(file);
  }
  return ending;
}

/// A name may be a scenario, or a scenario and a frame; a scenario's full name settles it.
std::vector<Meaning> meanings(const std::vector<fs::path>& scenarios, const std::string& name) {
  std::vector<Meaning> all;
  for (const fs::path& file : called(scenarios, name)) {
    if (scenario_name(file) == name) return {{file, ""}};
    all.push_back({file, ""});
  }
  const std::size_t slash = name.rfind('/');
  if (slash == std::string::npos) return all;
  for (const fs::path& file : called(scenarios, name.substr(0, slash)))
    all.push_back({file, name.substr(slash + 1)});
  return all;
}

void add(std::vector<SelectedGolden>& selected, const Meaning& meaning) {
  auto entry = std::find_if(selected.begin(), selected.end(),
                            [&](const SelectedGolden& s) { return s.file == meaning.file; });
  const bool first = entry == selected.end();
  if (first) entry = selected.insert(selected.end(), {meaning.file, scenario_name(meaning.file), {}});
  if (meaning.frame.empty())
    entry->frames.clear();
  else if (first || !entry->frames.empty())
    entry->frames.push_back(meaning.frame);
}

std::string names_of(const std::vector<Meaning>& meanings) {
  std::vector<std::string> names;
  names.reserve(meanings.size());
  for (const Meaning& meaning : meanings)
    names.push_back(scenario_name(meaning.file) + (meaning.frame.empty() ? "" : "/" + meaning.frame));
  return fmt::format("{}", fmt::join(names, " or "));
}

}  // namespace

bool SelectedGolden::wants(const std::string& frame) const {
  return frames.empty() || std::find(frames.begin(), frames.end(), frame) != frames.end();
}

Result<std::vector<SelectedGolden>> select_goldens(const std::vector<std::string>& names) {
  const std::vector<fs::path> scenarios = project_scenarios();
  std::vector<SelectedGolden> selected;
  if (names.empty())
    for (const fs::path& file : scenarios) add(selected, {file, ""});
  std::vector<Problem> problems;
  std::vector<std::string> known;
  known.reserve(scenarios.size());
  for (const fs::path& file : scenarios) known.push_back(scenario_name(file));
  const std::string hint =
      fmt::format("scenarios: {}; name one, or one of its frames as scenario/frame", fmt::join(known, ", "));
  for (const std::string& name : names) {
    const std::vector<Meaning> found = meanings(scenarios, name);
    if (found.size() == 1) {
      add(selected, found.front());
    } else if (found.empty()) {
      problems.push_back({{}, fmt::format("no scenario is called {}", name), hint});
    } else {
      problems.push_back({{}, fmt::format("{} may mean {}", name, names_of(found)), "write it in full"});
    }
  }
  if (!problems.empty()) return Failure{FailureKind::usage, std::move(problems)};
  return selected;
}

}  // namespace calot
