#include <fmt/format.h>

#include "app/commands.h"
#include "app/conclude.h"
#include "field/field.h"
#include "play/play.h"
#include "play/replay_checks.h"
#include "process/terminal.h"
#include "render/offscreen.h"
#include "render/png.h"
#include "view/build_scene.h"
#include "view/pins.h"
#include "world/world.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

std::optional<Failure> draw_refused(const World& world, const std::vector<Vec3>& overlaps,
                                    const PlayRequest& request, const fs::path& file) {
  Scene scene = build_scene(world);
  for (SceneMesh& pin : pin_meshes(overlaps, scene.camera.position)) scene.meshes.push_back(std::move(pin));
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(request.width, request.height);
  if (!renderer) return renderer.failure();
  const Result<Image> image = renderer->render(scene);
  if (!image) return image.failure();
  const Result<std::string> png = write_png(file.string(), image.value());
  return png ? std::nullopt : std::optional<Failure>(png.failure());
}

/// What the laparoscope's lens is in, so that it sees nothing else; empty: nothing.
std::string around_lens(const World& world) {
  for (const Ground& ground : world.field().ground)
    if (signed_distance(ground.shape, world.report().laparoscope.view.position) < 0) return ground.name;
  return {};
}

/// Draws a scene that is refused into <folder>/refused.png, and says why it is.
ExitCode show_refused(const PlayRequest& request, bool json) {
  const Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  const std::string file = shell_word(request.scenario.string());
  if (!script) return print_failure(script.failure(), "calot check " + file, json);
  const ExerciseDefinition& exercise = script.value()->definition();
  const Result<World> made = World::create(exercise.scene, nullptr, request.threads);
  if (made && json)
    return print_failure(fail(FailureKind::usage, "the scene is not refused: there is nothing to show"),
                         "calot run " + file, json);
  if (made) {
    print("The scene is not refused: there is nothing to show.\nNext: calot run " + file);
    return ExitCode::ok;
  }
  std::vector<Vec3> overlaps;
  const Result<World> drawn = World::as_drawn(exercise.scene, overlaps);
  if (!drawn)
    return print_failure(script.value()->located(drawn.failure()), "calot check --build " + file, json);
  const fs::path folder = request.output.empty() ? fs::path("out") / exercise.id : request.output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (std::optional<Failure> failed = draw_refused(drawn.value(), overlaps, request, folder / "refused.png"))
    return print_failure(*failed, "calot run --help", json);
  if (json)
    return print_failure(script.value()->located(made.failure()), "calot check --build " + file, json);
  print(fmt::format("{}: {}.", (folder / "refused.png").string(),
                    overlaps.empty() ? "no organ is in another or in ground"
                                     : fmt::format("{} {}, where organs are in each other or in ground",
                                                   overlaps.size(), overlaps.size() == 1 ? "pin" : "pins")));
  if (const std::string around = around_lens(drawn.value()); !around.empty())
    print(fmt::format("The laparoscope is in '{}' and sees nothing else: have it look_at another organ.",
                      around));
  return print_failure(script.value()->located(made.failure()), "calot check --build " + file, json);
}

}  // namespace

ExitCode run_command(const RunCommand& command) {
  PlayRequest request;
  request.scenario = command.scenario;
  request.threads = command.threads.value_or(usual_threads());
  request.render = !command.no_render;
  request.profile = command.profile;
  request.at = command.at;
  if (command.seed) request.seed = *command.seed;
  if (command.until) request.until = *command.until;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = read_params(command.params, request);
  if (wrong) return print_failure(*wrong, "calot run --help", command.json);
  request.write = true;
  request.output = command.output;
  request.overwrite = command.overwrite;
  request.dry_run = command.dry_run;
  if (command.show_refused && !command.dry_run) return show_refused(request, command.json);
  const Result<Played> played = play(request);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const FailureKind kind = played.failure().kind;
    const std::string next = kind == FailureKind::usage         ? "calot run --help"
                             : kind == FailureKind::interrupted ? "calot run " + file
                                                                : "calot check --build " + file;
    return print_failure(played.failure(), next, command.json);
  }
  if (command.dry_run) return ExitCode::ok;
  return conclude(played.value(), command,
                  {"calot run " + file, "calot check --build " + file,
                   "calot replay " + shell_word((played->output / "recording.jsonl").string())});
}

ExitCode replay_command(const ReplayCommand& command) {
  const Result<Recording> recording = read_recording(command.recording);
  if (!recording) return print_failure(recording.failure(), "calot replay --help", command.json);
  PlayRequest request;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = check_replay_output(command.output, command.recording);
  const Result<fs::path> scenario = find_scenario(recording->header, command.recording, command.scenario);
  if (!wrong && !scenario) wrong = scenario.failure();
  if (wrong) return print_failure(*wrong, "calot replay --help", command.json);
  request.scenario = scenario.value();
  request.threads = command.threads.value_or(usual_threads());
  request.params = recording->header.params;
  request.seed = recording->header.seed;
  request.replay = &recording.value();
  request.render = !command.no_render && !command.output.empty();
  request.profile = command.profile;
  request.at = command.at;
  request.write = !command.output.empty();
  request.output = command.output;
  request.dry_run = command.dry_run;
  const Result<Played> played = play(request);
  if (!played) return print_failure(played.failure(), "calot replay --help", command.json);
  if (command.dry_run) return ExitCode::ok;
  warn_of_differences(recording.value(), played->exercise, !command.scenario.empty());
  const std::string file = shell_word(request.scenario.string());
  const std::string again = "calot replay " + shell_word(command.recording);
  const ExitCode code =
      conclude(played.value(), command, {again, "calot check --build " + file, "calot run " + file});
  if (code == ExitCode::interrupted) return code;
  const StateComparison compared = compare_states(recording.value(), played->session);
  if (!compared.message.empty()) std::fprintf(stderr, "%s\n", compared.message.c_str());
  if (!compared.differs && cut_note(recording.value()) == std::nullopt) {
    if (!command.json && compared.message.empty() && recording->header.state_hash)
      print("Every state is that of the recording.");
    return code;
  }
  std::fprintf(stderr, "Next: calot run %s\n", file.c_str());
  return code == ExitCode::ok ? ExitCode::mismatch : code;
}

}  // namespace calot
