#include "play/play.h"

#include <fmt/format.h>
#include <unistd.h>

#include "lua/load_exercise.h"
#include "play/replay_checks.h"
#include "process/interrupt.h"
#include "process/output_folder.h"
#include "process/project.h"
#include "process/result_files.h"
#include "process/terminal.h"
#include "render/offscreen.h"
#include "render/png.h"
#include "session/force_plot.h"
#include "session/golden_moment.h"
#include "view/build_scene.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// Draws a frame when its golden time or moment has come, and one at the end.
class FrameCapture {
 public:
  FrameCapture(OffscreenRenderer& renderer, const ExerciseDefinition& exercise, const PlayRequest& request,
               const fs::path& output)
      : renderer_(renderer),
        request_(request),
        output_(output),
        source_hash_(exercise.source_hash),
        half_step_(0.5 / exercise.scene.solver.rate) {
    if (!request.golden_pictures) return;
    times_ = golden_frames(exercise, request.at);
    moments_ = exercise.golden.moments;
  }

  void observe(const World& world, const Progress& progress, bool last) {
    if (!builder_) builder_.emplace(world);  // at rest: the laparoscope is held still from then on
    builder_->follow(world);
    // Many times may fall between two steps: an interruption need not wait for all of them.
    for (; next_ < times_.size() && world.report().time >= times_[next_].time - half_step_; ++next_) {
      if (interrupt_flag()) return;
      draw_golden(world, times_[next_].name);
    }
    draw_moments(world, progress);
    if (request_.moment && !interrupt_flag())
      if (const std::string name = request_.moment(progress); !name.empty()) draw(world, name);
    if (last && request_.end_frame) draw(world, "end");
  }

  std::vector<std::string> pictures;
  std::optional<Failure> failure;  ///< the first
  double first_frame_s = -1;       ///< since the process started

 private:
  void draw_moments(const World& world, const Progress& progress) {
    std::vector<GoldenMoment> to_come;
    for (const GoldenMoment& moment : moments_) {
      const std::optional<double> due = due_time(moment, progress);
      if (due && world.report().time >= *due - half_step_ && !interrupt_flag())
        draw_golden(world, moment.name);
      else
        to_come.push_back(moment);
    }
    moments_ = std::move(to_come);
  }
  void draw_golden(const World& world, const std::string& name) {
    if (request_.on_scene) request_.on_scene(builder_->build(world), name);
    draw(world, name);
  }
  void draw(const World& world, const std::string& name) {
    if (failure) return;
    Result<Image> image = renderer_.render(builder_->build(world));
    if (!image) {
      failure = image.failure();
      return;
    }
    if (first_frame_s < 0) first_frame_s = seconds_since_start();
    pictures.push_back(name);
    const Frame frame{name,         world.report().time,     world.report().state_hash,
                      source_hash_, renderer_.description(), std::move(image).value()};
    if (request_.on_picture) failure = request_.on_picture(frame);
    if (failure || output_.empty()) return;
    const Result<std::string> written = write_png((output_ / (name + ".png")).string(), frame.image);
    if (!written) failure = written.failure();
  }

  OffscreenRenderer& renderer_;
  const PlayRequest& request_;
  const fs::path& output_;
  std::uint64_t source_hash_;
  std::vector<GoldenFrame> times_;
  std::vector<GoldenMoment> moments_;  ///< that are still to come
  double half_step_;
  std::size_t next_ = 0;
  std::optional<SceneBuilder> builder_;
};

/// The folder, and the files that grow while a session is played.
struct Outputs {
  std::optional<OutputFolder> folder;
  std::optional<RecordingWriter> recording;
  std::optional<StepTable> table;
  std::vector<ProfiledStep> profile;
};

/// The user's folder is theirs to reuse; without one, no session replaces another unless that was asked for.
Result<fs::path> choose_folder(const PlayRequest& request, const ExerciseDefinition& exercise) {
  if (!request.output.empty()) return request.output;
  const fs::path standard = fs::path("out") / exercise.id;
  return request.overwrite ? standard : fresh_folder(standard);
}

Result<Outputs> open_outputs(const PlayRequest& request, const ExerciseDefinition& exercise,
                             const World& world, const Attempt& attempt) {
  Outputs outputs;
  if (!request.write) return outputs;
  const Result<fs::path> path = choose_folder(request, exercise);
  if (!path) return path.failure();
  Result<OutputFolder> folder = OutputFolder::claim(path.value());
  if (!folder) return folder.failure();
  folder->clear();  // a session that is killed leaves no older report beside its recording
  const RecordingHeader header = recording_header(exercise, world, portable_path(request.scenario), attempt);
  Result<RecordingWriter> recording =
      RecordingWriter::create((path.value() / "recording.jsonl").string(), header);
  if (!recording) return recording.failure();
  outputs.recording = std::move(recording).value();
  Result<StepTable> table = StepTable::create((path.value() / "steps.csv").string(), exercise.scene);
  if (!table) return table.failure();
  outputs.table = std::move(table).value();
  outputs.folder.emplace(std::move(folder).value());
  return outputs;
}

void show_progress(ProgressLine& line, const World& world, const Progress& progress, double time_limit) {
  if (!line.due()) return;
  const StepRecord* step = progress.running();
  line.show(fmt::format("{:6.1f} s of at most {:.0f} s  {}", world.report().time, time_limit,
                        step != nullptr ? step->title : ""));
}

SessionResult run(const PlayRequest& request, ExerciseScript& script, World& world, Outputs& outputs,
                  FrameCapture* capture) {
  std::optional<ReplaySource> replay;
  if (request.replay != nullptr) replay.emplace(*request.replay);
  SessionOptions options;
  options.stop = &interrupt_flag();
  options.end_with_source = replay.has_value() || request.live != nullptr;
  if (replay && !came_to_its_end(request.replay->end))
    options.source_end = request.replay->end.empty() ? cut_end : request.replay->end;
  options.until = request.until;
  options.recording = outputs.recording ? &*outputs.recording : nullptr;
  options.table = outputs.table ? &*outputs.table : nullptr;
  options.profile = request.profile ? &outputs.profile : nullptr;
  ProgressLine line;
  options.observer = [&](const World& present, const Progress& progress, bool last) {
    if (request.show_progress) show_progress(line, present, progress, script.definition().time_limit);
    if (request.on_state && !last) request.on_state(present, progress);
    if (capture != nullptr) capture->observe(present, progress, last);
  };
  // The recording is on disk already, line by line; what is left to say is where to go from here.
  script.set_emergency_flush([next = "Next: calot run " + shell_word(request.scenario.string()) + "\n"] {
    const ssize_t ignored = write(STDERR_FILENO, next.data(), next.size());
    static_cast<void>(ignored);
  });
  InputSource* source = &script.demo();
  if (replay) source = &*replay;
  if (request.live != nullptr) source = request.live;
  return run_session(world, script, *source, options);
}

/// What a replay owes its reader besides the session.
void note_recording(const Recording& recording, SessionResult& session) {
  if (const std::optional<std::string> cut = cut_note(recording)) session.notes.push_back(*cut);
  if (!recording.header.state_hash)
    session.notes.emplace_back("the recording has no state hashes: nothing was compared");
}

/// A session that was cut earns no points, neither then nor when it is played again.
bool was_aborted(const SessionResult& session, const Recording* replay) {
  const bool short_recording = replay != nullptr && !came_to_its_end(replay->end);
  return session.end == SessionEnd::interrupted || session.end == SessionEnd::failed ||
         (session.end == SessionEnd::source_ended && short_recording);
}

LoadOptions project_options() {
  LoadOptions options;
  options.modules = project_part("scripts/lua");
  options.assets = project_part("assets");
  return options;
}

/// Measures and scores; writes the report where there is an output folder.
std::optional<Failure> make_report(Played& played) {
  const SessionResult& session = played.session;
  Result<Score> scored = score(played.exercise, session.metrics, session.progress);
  if (!scored) return scored.failure();
  played.report.score = std::move(scored).value();
  if (played.report.aborted) cut_short(played.report.score, session.end == SessionEnd::failed);
  played.json = report_json(played.exercise, session, played.report);
  if (played.output.empty()) return std::nullopt;
  if (const std::string plot = force_plot(played.exercise.scene, session.traces); !plot.empty()) {
    const Result<std::string> drawn = write_text(played.output / "force_over_way.svg", plot);
    if (!drawn) return drawn.failure();
  }
  const Result<std::string> table = write_text(played.output / "events.csv", events_csv(session.progress));
  if (!table) return table.failure();
  const Result<std::string> written = write_text(played.output / "report.json", played.json);
  return written ? std::nullopt : std::optional<Failure>(written.failure());
}

Attempt attempt_of(const PlayRequest& request) {
  if (request.replay == nullptr) return begin_attempt(request.attempt);
  Attempt attempt = request.replay->header.attempt;
  attempt.session = session_of(*request.replay);
  return attempt;
}

std::optional<Failure> write_profile(const PlayRequest& request, const Played& played,
                                     const std::vector<ProfiledStep>& steps) {
  if (!request.profile || played.output.empty()) return std::nullopt;
  const Result<std::string> table = write_text(played.output / "profile.csv", profile_csv(steps));
  if (!table) return table.failure();
  const Result<std::string> plot =
      write_text(played.output / "profile.svg", profile_plot(steps, 1 / played.exercise.scene.solver.rate));
  return plot ? std::nullopt : std::optional<Failure>(plot.failure());
}

}  // namespace

Result<std::unique_ptr<ExerciseScript>> load_scenario(const PlayRequest& request) {
  if (std::optional<Failure> wrong = check_scenario_path(request.scenario.string())) return *wrong;
  tell_half_project();
  LoadOptions options = project_options();
  options.params = request.params;
  options.seed = request.seed;
  return load_exercise(request.scenario, options);
}

bool is_module(const fs::path& file) { return is_module(file, project_options()); }

Result<ExerciseDefinition> load_definition(const fs::path& scenario) {
  PlayRequest request;
  request.scenario = scenario;
  Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) return script.failure();
  return script.value()->definition();
}

std::vector<GoldenFrame> golden_frames(const ExerciseDefinition& exercise, const std::vector<double>& at) {
  std::vector<double> times = exercise.golden.at;
  times.insert(times.end(), at.begin(), at.end());
  std::sort(times.begin(), times.end());
  std::vector<GoldenFrame> frames;
  for (const double time : times) {
    const std::string name = fmt::format("t{:06.2f}s", time);
    if (frames.empty() || frames.back().name != name) frames.push_back({time, name});
  }
  return frames;
}

std::vector<std::string> golden_names(const ExerciseDefinition& exercise) {
  std::vector<std::string> names;
  for (const GoldenFrame& frame : golden_frames(exercise, {})) names.push_back(frame.name);
  for (const GoldenMoment& moment : exercise.golden.moments) names.push_back(moment.name);
  return names;
}

std::string portable_path(const fs::path& scenario) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(scenario, error);
  for (const fs::path& folder : {project_folder(), fs::current_path(error)}) {
    const fs::path below = file.lexically_relative(fs::weakly_canonical(folder, error));
    if (!below.empty() && *below.begin() != "..") return below.generic_string();
  }
  return scenario.filename().string();
}

Result<Played> play(const PlayRequest& request) {
  interrupt_flag();  // from here on an interrupted session ends as one, with its files
  Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) return script.failure();
  const ExerciseDefinition& exercise = script.value()->definition();
  if (request.replay != nullptr) {
    if (std::optional<Failure> wrong =
            check_replay(*request.replay, exercise, "name the scenario it was made with: --scenario FILE"))
      return *wrong;
  }
  Played played;
  if (request.dry_run) return played;
  played.rendered = request.render;
  std::optional<OffscreenRenderer> renderer;
  std::optional<FrameCapture> capture;
  if (request.render) {
    Result<OffscreenRenderer> created = OffscreenRenderer::create(request.width, request.height);
    if (!created) return created.failure();
    renderer = std::move(created).value();
    capture.emplace(*renderer, exercise, request, played.output);
  }
  Result<World> world = World::create(exercise.scene, &interrupt_flag(), request.threads, kept_results());
  if (!world) return script.value()->located(world.failure());
  played.report.attempt = attempt_of(request);
  Result<Outputs> outputs = open_outputs(request, exercise, world.value(), played.report.attempt);
  if (!outputs) return outputs.failure();
  if (outputs->folder) played.output = outputs->folder->path();

  played.session =
      run(request, *script.value(), world.value(), outputs.value(), capture ? &*capture : nullptr);
  if (request.replay != nullptr) note_recording(*request.replay, played.session);
  if (request.live != nullptr) played.report.live = request.live->figures();
  played.exercise = exercise;
  played.report.aborted = was_aborted(played.session, request.replay);
  if (capture) {
    played.pictures = std::move(capture->pictures);
    played.report.start_to_first_frame_s = capture->first_frame_s;
  }
  if (std::optional<Failure> unwritten = make_report(played)) return *unwritten;
  if (std::optional<Failure> unwritten = write_profile(request, played, outputs->profile)) return *unwritten;
  if (capture && capture->failure) return *capture->failure;
  return played;
}

}  // namespace calot
