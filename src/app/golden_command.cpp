#include <fmt/format.h>

#include <set>

#include "app/commands.h"
#include "base/hash.h"
#include "base/log.h"
#include "goldens/compare.h"
#include "process/interrupt.h"
#include "process/project.h"
#include "process/terminal.h"
#include "render/png.h"
#include "session/json.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// What came of all selected scenarios, but for their frames, which went to a sink.
struct Compared {
  ExitCode code = ExitCode::ok;   ///< ok: every scenario was played
  std::optional<ExitCode> ended;  ///< nothing was to be played: it has been said why, or it was a dry run
  std::size_t frames = 0, failed = 0, unreadable = 0;
  std::set<std::string> differing;    ///< scenarios of which a frame failed
  std::vector<std::string> unplayed;  ///< scenarios that an interruption left out, wholly or in part
  OrderedJson failures = OrderedJson::array();
};

void note_failure(const SelectedGolden& scenario, const Failure& failure, Compared& compared) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", to_text(failure).c_str());
  if (compared.code == ExitCode::ok) compared.code = exit_code(failure.kind);
  compared.failures.push_back({{"scenario", scenario.name}, {"message", to_text(failure)}});
}

/// One scenario that cannot be played hides no other.
Compared compare_selected(const GoldenCommand& command, const GoldenSink& sink) {
  Compared compared;
  tell_borrowed_project();
  const std::atomic<bool>& stop = interrupt_flag();
  const Result<std::vector<SelectedGolden>> selected = select_goldens(command.names);
  if (!selected) {
    print_failure(selected.failure(), "calot golden test", command.json);
    compared.ended = ExitCode::nothing_selected;
    return compared;
  }
  if (command.dry_run) {
    compared.ended = golden_dry_run(command, selected.value());
    return compared;
  }
  const GoldenSink counted = [&](const GoldenResult& result) {
    ++compared.frames;
    if (!result.judgement.passed) ++compared.failed, compared.differing.insert(result.scenario);
    if (result.judgement.verdict == Verdict::unreadable) ++compared.unreadable;
    sink(result);
  };
  for (const SelectedGolden& scenario : selected.value()) {
    const ComparedScenario done =
        stop ? ComparedScenario{{}, true}
             : compare_scenario(scenario, golden_folder(command), command.threads, counted);
    if (done.interrupted)
      compared.unplayed.push_back(scenario.name);
    else if (done.failure)
      note_failure(scenario, *done.failure, compared);
  }
  if (!stop && command.names.empty())
    for (const GoldenResult& lost : goldens_without_scenario(golden_folder(command))) counted(lost);
  if (compared.frames == 0 && compared.code == ExitCode::ok && !stop) {
    print_failure(fail(FailureKind::usage, "no frame was selected",
                       "pictures are named as in the folder golden, such as exposure/t004.40s"),
                  "calot golden test", command.json);
    compared.ended = ExitCode::nothing_selected;
  }
  return compared;
}

/// Writes what a failed frame looks like now, and where it differs.
std::optional<Failure> keep_failed(const GoldenResult& result, const fs::path& folder) {
  if (result.judgement.passed || !result.actual) return std::nullopt;
  const Result<fs::path> made = make_folder(folder / result.scenario);
  if (!made) return made.failure();
  const std::string stem = (made.value() / result.frame).string();
  const Result<std::string> written = write_png(stem + ".actual.png", result.actual->image);
  if (!written) return written.failure();
  if (!result.judgement.difference) return std::nullopt;
  const Result<std::string> drawn = write_png(stem + ".difference.png", result.judgement.difference->picture);
  return drawn ? std::nullopt : std::optional<Failure>(drawn.failure());
}

OrderedJson result_json(const GoldenResult& result) {
  OrderedJson json = {{"scenario", result.scenario},
                      {"frame", result.frame},
                      {"passed", result.judgement.passed},
                      {"verdict", to_text(result.judgement.verdict)},
                      {"message", result.judgement.message}};
  if (result.actual) json["state_hash"] = hex(result.actual->sidecar.state_hash);
  if (result.judgement.difference) {
    json["differing_pixels"] = result.judgement.difference->differing_pixels;
    json["largest_blob_px"] = result.judgement.difference->largest_blob;
    json["max_delta"] = result.judgement.difference->max_delta;
  }
  return json;
}

void print_result(const GoldenResult& result) {
  const Judgement& judgement = result.judgement;
  print(fmt::format("{}  {}/{}: {}{}{}", judgement.passed ? green("ok    ") : red("FAILED"), result.scenario,
                    result.frame, to_text(judgement.verdict), judgement.message.empty() ? "" : ": ",
                    judgement.message));
  std::fflush(stdout);
}

/// What an interruption leaves to be done.
ExitCode stopped(const Compared& compared, const std::string& command, const std::string& done) {
  const std::string names = shell_words(compared.unplayed);
  std::fprintf(stderr, "Interrupted: %s; not finished: %s.\nNext: calot golden %s %s\n", done.c_str(),
               names.c_str(), command.c_str(), names.c_str());
  return ExitCode::interrupted;
}

}  // namespace

fs::path golden_folder(const GoldenCommand& command) {
  return command.folder.empty() ? project_folder() / "golden" : fs::path(command.folder);
}

ExitCode golden_dry_run(const GoldenCommand& command, const std::vector<SelectedGolden>& selected) {
  const std::optional<Failure> wrong = check_selected(selected, golden_folder(command));
  return wrong ? print_failure(*wrong, "calot golden test", command.json) : ExitCode::ok;
}

ExitCode golden_test_command(const GoldenCommand& command) {
  OrderedJson json = {{"schema", "calot.golden_test/1"}, {"frames", OrderedJson::array()}};
  const fs::path output = command.output.empty() ? fs::path("out") / "golden" : fs::path(command.output);
  const Compared compared = compare_selected(command, [&](const GoldenResult& result) {
    json["frames"].push_back(result_json(result));
    if (!command.json) print_result(result);
    if (const std::optional<Failure> unwritten = keep_failed(result, output))
      log_warning(to_text(*unwritten));
  });
  if (compared.ended) return *compared.ended;
  json["failures"] = compared.failures;
  json["not_finished"] = compared.unplayed;
  if (command.json) print(json_text(json));
  std::fflush(stdout);
  if (!compared.unplayed.empty())
    return stopped(compared, "test",
                   fmt::format("{} frames were compared, {} differ", compared.frames, compared.failed));
  if (compared.failed > 0)
    std::fprintf(stderr, "%zu of %zu frames differ; what they look like now is in %s\n", compared.failed,
                 compared.frames, output.string().c_str());
  if (compared.code != ExitCode::ok) {
    std::fprintf(stderr, "%zu scenarios could not be played, see above.\nNext: calot check %s\n",
                 compared.failures.size(), shell_word((project_folder() / "scenarios").string()).c_str());
    return compared.code;
  }
  if (compared.failed == 0) return ExitCode::ok;
  std::fprintf(stderr, "Next: calot golden report %s\n",
               shell_words({compared.differing.begin(), compared.differing.end()}).c_str());
  return compared.unreadable > 0 ? ExitCode::usage : ExitCode::mismatch;
}

ExitCode golden_report_command(const GoldenCommand& command) {
  GoldenPage page;
  std::optional<Failure> unmade;
  const Compared compared = compare_selected(command, [&](const GoldenResult& result) {
    if (!unmade) unmade = page.add(result);
  });
  if (unmade) return print_failure(*unmade, "calot golden report --help");
  if (compared.ended) return *compared.ended;
  if (!compared.unplayed.empty()) return stopped(compared, "report", "no page was written");
  const fs::path file =
      command.output.empty() ? fs::path("out") / "golden_report.html" : fs::path(command.output);
  if (file.has_parent_path()) {
    const Result<fs::path> folder = make_folder(file.parent_path());
    if (!folder) return print_failure(folder.failure(), "calot golden report --help");
  }
  const Result<std::string> written = write_text(file, page.html());
  if (!written) return print_failure(written.failure(), "calot golden report --help");
  print(file.string());
  if (compared.code == ExitCode::ok) return ExitCode::ok;
  std::fflush(stdout);
  std::fprintf(stderr, "%zu scenarios could not be played, see above; the page is without them.\n",
               compared.failures.size());
  std::fprintf(stderr, "Next: calot check %s\n",
               shell_word((project_folder() / "scenarios").string()).c_str());
  return compared.code;
}

}  // namespace calot
