#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/golden_report.h"
#include "app/golden_select.h"
#include "app/golden_store.h"
#include "app/project.h"
#include "app/terminal.h"
#include "base/hash.h"
#include "base/log.h"
#include "render/png.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

fs::path golden_folder(const GoldenCommand& command) {
  return command.folder.empty() ? project_folder() / "golden" : fs::path(command.folder);
}

/// Frames that are stored for a scenario, sorted.
std::vector<std::string> stored_frames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The size its goldens have, so that frames are drawn alike.
void use_stored_size(const fs::path& folder, PlayRequest& request) {
  for (const std::string& frame : stored_frames(folder)) {
    const Result<Golden> golden = read_golden(folder / frame);
    if (!golden) continue;
    request.width = golden->sidecar.width;
    request.height = golden->sidecar.height;
    return;
  }
}

GoldenResult compare_frame(const std::string& scenario, const std::string& frame, const fs::path& folder,
                           const Frame* drawn, const Played& played) {
  GoldenResult result{scenario, frame, {}, {}, {}};
  if (drawn != nullptr) result.actual = make_golden(*drawn, played.exercise, played.renderer);
  std::error_code ignored;
  if (!fs::exists(folder / (frame + ".json"), ignored)) {
    result.judgement = {Verdict::missing, false, "no golden is stored for this frame", {}};
    return result;
  }
  Result<Golden> golden = read_golden(folder / frame);
  if (!golden) {
    result.judgement = {Verdict::missing, false, to_text(golden.failure()), {}};
    return result;
  }
  result.golden = std::move(golden).value();
  if (drawn == nullptr) {
    const std::vector<double>& at = played.exercise.golden.at;
    const bool declared = std::any_of(at.begin(), at.end(), [&](double t) { return frame_name(t) == frame; });
    result.judgement = {declared ? Verdict::not_played : Verdict::stale,
                        false,
                        declared ? "the session ended before this time (" + to_text(played.session.end) + ")"
                                 : "the scenario declares no frame at this time",
                        {}};
  } else {
    result.judgement = judge(*result.golden, *result.actual);
  }
  return result;
}

/// Plays a scenario and compares its golden frames. Interruption is a failed session like any other.
Result<std::vector<GoldenResult>> compare_scenario(const SelectedGolden& selected, const fs::path& goldens,
                                                   bool& interrupted) {
  std::vector<GoldenResult> results;
  const fs::path folder = goldens / selected.name;
  const Result<ExerciseDefinition> definition = load_definition(selected.file);
  if (!definition) return definition.failure();
  std::vector<std::string> names = stored_frames(folder);
  for (const double time : definition->golden.at) names.push_back(frame_name(time));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::erase_if(names, [&](const std::string& name) { return !selected.wants(name); });
  if (names.empty()) return results;

  PlayRequest request;
  request.scenario = selected.file;
  use_stored_size(folder, request);
  const Result<Played> played = play(request);
  if (!played) return played.failure();
  interrupted = played->session.end == SessionEnd::interrupted;
  for (const std::string& name : names) {
    const auto drawn = std::find_if(played->frames.begin(), played->frames.end(),
                                    [&](const Frame& frame) { return frame.name == name; });
    results.push_back(compare_frame(selected.name, name, folder,
                                    drawn == played->frames.end() ? nullptr : &*drawn, played.value()));
  }
  return results;
}

struct Compared {
  std::vector<GoldenResult> results;
  std::optional<ExitCode> ended;  ///< why there is nothing to judge
};

Compared compare_selected(const GoldenCommand& command) {
  Compared compared;
  const Result<std::vector<SelectedGolden>> selected = select_goldens(command.names);
  if (!selected) {
    print_failure(selected.failure(), "calot golden test", command.json);
    compared.ended = ExitCode::nothing_selected;
    return compared;
  }
  for (const SelectedGolden& scenario : selected.value()) {
    bool interrupted = false;
    Result<std::vector<GoldenResult>> results =
        compare_scenario(scenario, golden_folder(command), interrupted);
    if (!results) {
      compared.ended =
          print_failure(results.failure(), "calot check " + shell_word(scenario.file.string()), command.json);
      return compared;
    }
    if (interrupted) {
      std::fputs("Interrupted.\nNext: calot golden test\n", stderr);
      compared.ended = ExitCode::interrupted;
      return compared;
    }
    for (GoldenResult& result : results.value()) compared.results.push_back(std::move(result));
  }
  if (compared.results.empty()) {
    compared.ended =
        print_failure(fail(FailureKind::usage, "no frame was selected"), "calot golden test", command.json);
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

nlohmann::ordered_json result_json(const GoldenResult& result) {
  nlohmann::ordered_json json = {{"scenario", result.scenario},
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

std::optional<Failure> accept_scenario(const SelectedGolden& selected, const fs::path& goldens) {
  PlayRequest request;
  request.scenario = selected.file;
  const Result<Played> played = play(request);
  if (!played) return played.failure();
  if (played->session.end == SessionEnd::failed) return played->session.failure;
  if (played->session.end == SessionEnd::interrupted)
    return fail(FailureKind::usage, "interrupted; nothing was accepted");
  const fs::path folder = goldens / selected.name;
  std::vector<std::string> declared;
  for (const double time : played->exercise.golden.at) declared.push_back(frame_name(time));
  std::vector<std::string> accepted;
  for (const Frame& frame : played->frames) {
    const bool golden = std::find(declared.begin(), declared.end(), frame.name) != declared.end();
    if (!golden || !selected.wants(frame.name)) continue;
    const Result<std::string> written =
        write_golden(folder / frame.name, make_golden(frame, played->exercise, played->renderer));
    if (!written) return written.failure();
    accepted.push_back(frame.name);
    print(fmt::format("accepted {}", (folder / (frame.name + ".png")).string()));
  }
  for (const std::string& name : selected.frames.empty() ? declared : selected.frames) {
    if (std::find(accepted.begin(), accepted.end(), name) != accepted.end()) continue;
    return fail(FailureKind::scenario, fmt::format("{} has no frame {}", selected.name, name),
                fmt::format("frames that were drawn: {}", fmt::join(accepted, ", ")));
  }
  for (const std::string& name : stored_frames(folder)) {
    if (!selected.frames.empty() || std::find(declared.begin(), declared.end(), name) != declared.end())
      continue;
    fs::remove(folder / (name + ".png"));
    fs::remove(folder / (name + ".json"));
    print(fmt::format("removed {}, which the scenario no longer declares", (folder / name).string()));
  }
  return std::nullopt;
}

}  // namespace

ExitCode golden_test_command(const GoldenCommand& command) {
  const Compared compared = compare_selected(command);
  if (compared.ended) return *compared.ended;
  nlohmann::ordered_json json = {{"schema", "calot.golden_test/1"}, {"frames", nlohmann::json::array()}};
  std::size_t failed = 0;
  const fs::path output = command.output.empty() ? fs::path("out") / "golden" : fs::path(command.output);
  for (const GoldenResult& result : compared.results) {
    if (!result.judgement.passed) ++failed;
    json["frames"].push_back(result_json(result));
    const std::string verdict = to_text(result.judgement.verdict);
    if (!command.json) {
      print(fmt::format("{}  {}/{}: {}{}{}", result.judgement.passed ? green("ok    ") : red("FAILED"),
                        result.scenario, result.frame, verdict, result.judgement.message.empty() ? "" : ": ",
                        result.judgement.message));
    }
    if (const std::optional<Failure> unwritten = keep_failed(result, output))
      log_warning(to_text(*unwritten));
  }
  if (command.json) print(json.dump(2));
  if (failed == 0) return ExitCode::ok;
  std::fflush(stdout);
  std::fprintf(stderr,
               "%zu of %zu frames differ; what they look like now is in %s\nNext: calot golden report\n",
               failed, compared.results.size(), output.string().c_str());
  return ExitCode::mismatch;
}

ExitCode golden_report_command(const GoldenCommand& command) {
  const Compared compared = compare_selected(command);
  if (compared.ended) return *compared.ended;
  const fs::path file =
      command.output.empty() ? fs::path("out") / "golden_report.html" : fs::path(command.output);
  const Result<std::string> html = golden_html(compared.results);
  if (!html) return print_failure(html.failure(), "calot golden report --help");
  if (file.has_parent_path()) {
    const Result<fs::path> folder = make_folder(file.parent_path());
    if (!folder) return print_failure(folder.failure(), "calot golden report --help");
  }
  const Result<std::string> written = write_text(file, html.value());
  if (!written) return print_failure(written.failure(), "calot golden report --help");
  print(file.string());
  return ExitCode::ok;
}

ExitCode golden_accept_command(const GoldenCommand& command) {
  if (command.names.empty()) {
    return print_failure(fail(FailureKind::usage, "name what to accept: a scenario, or scenario/frame"),
                         "calot golden test");
  }
  const Result<std::vector<SelectedGolden>> selected = select_goldens(command.names);
  if (!selected) {
    print_failure(selected.failure(), "calot golden test");
    return ExitCode::nothing_selected;
  }
  for (const SelectedGolden& scenario : selected.value()) {
    const std::optional<Failure> failure = accept_scenario(scenario, golden_folder(command));
    if (failure) return print_failure(*failure, "calot run " + shell_word(scenario.file.string()));
  }
  return ExitCode::ok;
}

}  // namespace calot
