#include "app/play.h"

#include <fmt/format.h>
#include <unistd.h>

#include "app/interrupt.h"
#include "app/project.h"
#include "app/terminal.h"
#include "lua/load_exercise.h"
#include "render/offscreen.h"
#include "render/png.h"
#include "session/metrics.h"
#include "view/build_scene.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// Golden times and those asked for, each once: two that share a name would share a file.
std::vector<double> frame_times(const ExerciseDefinition& exercise, const PlayRequest& request) {
  std::vector<double> times = exercise.golden.at;
  times.insert(times.end(), request.at.begin(), request.at.end());
  std::sort(times.begin(), times.end());
  const auto same_file = [](double a, double b) { return frame_name(a) == frame_name(b); };
  times.erase(std::unique(times.begin(), times.end(), same_file), times.end());
  return times;
}

/// Draws a frame when its golden time has come, and one at the end.
class FrameCapture {
 public:
  FrameCapture(OffscreenRenderer& renderer, const ExerciseDefinition& exercise, const PlayRequest& request,
               const fs::path& output)
      : renderer_(renderer),
        request_(request),
        output_(output),
        times_(frame_times(exercise, request)),
        half_step_(0.5 / exercise.scene.solver.rate) {}

  void observe(const World& world, bool last) {
    if (!builder_) builder_.emplace(world);  // at rest: the laparoscope is held still from then on
    builder_->follow(world);
    while (next_ < times_.size() && world.report().time >= times_[next_] - half_step_) {
      if (request_.on_frame) request_.on_frame(builder_->build(world), frame_name(times_[next_]));
      draw(world, frame_name(times_[next_]));
      ++next_;
    }
    if (last) draw(world, "end");
  }

  std::vector<Frame> frames;
  std::optional<Failure> failure;  ///< the first
  double first_frame_s = -1;       ///< since the process started

 private:
  void draw(const World& world, const std::string& name) {
    if (failure) return;
    Result<Image> image = renderer_.render(builder_->build(world));
    if (!image) {
      failure = image.failure();
      return;
    }
    if (first_frame_s < 0) first_frame_s = seconds_since_start();
    frames.push_back({name, world.report().time, world.report().state_hash, std::move(image).value()});
    if (output_.empty()) return;
    const Result<std::string> written = write_png((output_ / (name + ".png")).string(), frames.back().image);
    if (!written) failure = written.failure();
  }

  OffscreenRenderer& renderer_;
  const PlayRequest& request_;
  const fs::path& output_;
  std::vector<double> times_;
  double half_step_;
  std::size_t next_ = 0;
  std::optional<SceneBuilder> builder_;
};

/// The files that grow while a session is played.
struct Outputs {
  std::optional<RecordingWriter> recording;
  std::optional<StepTable> table;
};

Result<Outputs> open_outputs(const fs::path& folder, const ExerciseDefinition& exercise, const World& world) {
  Outputs outputs;
  if (folder.empty()) return outputs;
  const Result<fs::path> made = make_folder(folder);
  if (!made) return made.failure();
  Result<RecordingWriter> recording =
      RecordingWriter::create((folder / "recording.jsonl").string(), recording_header(exercise, world));
  if (!recording) return recording.failure();
  outputs.recording = std::move(recording).value();
  Result<StepTable> table = StepTable::create((folder / "steps.csv").string(), exercise.scene);
  if (!table) return table.failure();
  outputs.table = std::move(table).value();
  return outputs;
}

void show_progress(ProgressLine& line, const World& world, const Progress& progress, double time_limit) {
  if (!line.due()) return;
  const StepRecord* step = progress.running();
  line.show(fmt::format("{:6.1f} s of at most {:.0f} s  {}", world.report().time, time_limit,
                        step != nullptr ? step->title : ""));
}

std::optional<Failure> check_replay(const Recording& recording, const ExerciseDefinition& exercise) {
  std::vector<std::string> names;
  for (const InstrumentDefinition& instrument : exercise.scene.instruments) names.push_back(instrument.name);
  const RecordingHeader& header = recording.header;
  if (header.scenario == exercise.id && header.instruments == names &&
      header.rate == exercise.scene.solver.rate) {
    return std::nullopt;
  }
  return fail(FailureKind::usage,
              fmt::format("the recording is of {} ({} at {} Hz), the scenario is {} ({} at {} Hz)",
                          header.scenario, fmt::join(header.instruments, ", "), header.rate, exercise.id,
                          fmt::join(names, ", "), exercise.scene.solver.rate),
              "name the scenario it was made with: --scenario FILE");
}

Result<std::unique_ptr<ExerciseScript>> load(const PlayRequest& request) {
  if (std::optional<Failure> wrong = check_scenario_path(request.scenario.string())) return *wrong;
  LoadOptions options;
  options.params = request.params;
  options.seed = request.seed;
  options.modules = project_part("scripts/lua");
  options.assets = project_part("assets");
  return load_exercise(request.scenario, options);
}

SessionResult run(const PlayRequest& request, ExerciseScript& script, World& world, Outputs& outputs,
                  FrameCapture* capture) {
  std::optional<ReplaySource> replay;
  if (request.replay != nullptr) replay.emplace(*request.replay);
  SessionOptions options;
  options.stop = &interrupt_flag();
  options.end_with_source = replay.has_value();
  options.recording = outputs.recording ? &*outputs.recording : nullptr;
  options.table = outputs.table ? &*outputs.table : nullptr;
  ProgressLine line;
  options.observer = [&](const World& present, const Progress& progress, bool last) {
    show_progress(line, present, progress, script.definition().time_limit);
    if (capture != nullptr) capture->observe(present, last);
  };
  // The recording is on disk already, line by line; what is left to say is where to go from here.
  script.set_emergency_flush([next = "Next: calot check " + shell_word(request.scenario.string()) + "\n"] {
    const ssize_t ignored = write(STDERR_FILENO, next.data(), next.size());
    static_cast<void>(ignored);
  });
  InputSource& source = replay ? static_cast<InputSource&>(*replay) : script.demo();
  return run_session(world, script, source, options);
}

/// Measures and scores; writes the report where there is an output folder.
std::optional<Failure> make_report(Played& played) {
  const SessionResult& session = played.session;
  played.report.metrics = measure(played.exercise.scene, session.traces, session.progress);
  played.report.score = score(played.exercise, played.report.metrics, session.progress);
  played.json = report_json(played.exercise, session, played.report);
  if (played.output.empty()) return std::nullopt;
  const Result<std::string> written = write_text(played.output / "report.json", played.json);
  return written ? std::nullopt : std::optional<Failure>(written.failure());
}

}  // namespace

Result<ExerciseDefinition> load_definition(const fs::path& scenario) {
  PlayRequest request;
  request.scenario = scenario;
  Result<std::unique_ptr<ExerciseScript>> script = load(request);
  if (!script) return script.failure();
  return script.value()->definition();
}

std::string frame_name(double golden_time) { return fmt::format("t{:06.2f}s", golden_time); }

Result<Played> play(const PlayRequest& request) {
  interrupt_flag();  // from here on an interrupted session ends as one, with its files
  Result<std::unique_ptr<ExerciseScript>> script = load(request);
  if (!script) return script.failure();
  const ExerciseDefinition& exercise = script.value()->definition();
  if (request.replay != nullptr) {
    if (std::optional<Failure> wrong = check_replay(*request.replay, exercise)) return *wrong;
  }
  Played played;
  played.frame_times = frame_times(exercise, request);
  if (request.write) played.output = request.output.empty() ? fs::path("out") / exercise.id : request.output;
  std::optional<OffscreenRenderer> renderer;
  std::optional<FrameCapture> capture;
  if (request.render) {
    Result<OffscreenRenderer> created = OffscreenRenderer::create(request.width, request.height);
    if (!created) return created.failure();
    renderer = std::move(created).value();
    played.renderer = renderer->description();
    capture.emplace(*renderer, exercise, request, played.output);
  }
  Result<World> world = World::create(exercise.scene);
  if (!world) return world.failure();
  Result<Outputs> outputs = open_outputs(played.output, exercise, world.value());
  if (!outputs) return outputs.failure();

  played.session =
      run(request, *script.value(), world.value(), outputs.value(), capture ? &*capture : nullptr);
  played.exercise = exercise;
  if (capture) {
    played.frames = std::move(capture->frames);
    played.report.start_to_first_frame_s = capture->first_frame_s;
  }
  if (std::optional<Failure> unwritten = make_report(played)) return *unwritten;
  if (capture && capture->failure) return *capture->failure;
  return played;
}

}  // namespace calot
