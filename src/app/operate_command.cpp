#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <future>
#include <iterator>
#include <thread>

#include "app/commands.h"
#include "app/conclude.h"
#include "app/operate_view.h"
#include "base/log.h"
#include "input/igtl_messages.h"
#include "input/input_feed.h"
#include "input/live_lines.h"
#include "lua/read_registration.h"
#include "process/interrupt.h"
#include "process/output_folder.h"
#include "process/project.h"
#include "process/terminal.h"
#include "session/json.h"
#include "window/operate_window.h"

namespace calot {
namespace {

/// Says what is asked, each time that changes; in practice, how it is done too.
class StepTeller {
 public:
  explicit StepTeller(LiveMode mode) : mode_(mode) {}
  void look(const World& world, const Progress& progress) {
    for (; told_ < progress.steps().size(); ++told_) {
      const StepRecord& step = progress.steps()[told_];
      const std::string limit = step.limit > 0 ? fmt::format(" (within {:g} s)", step.limit) : "";
      log_info(fmt::format("{:6.1f} s  {}{}", world.report().time, step.title, limit));
      if (mode_ == LiveMode::practice && !step.hint.empty()) log_info("          " + step.hint);
    }
  }

 private:
  LiveMode mode_;
  std::size_t told_ = 0;
};

LiveOptions live_options(const OperateCommand& command) {
  LiveOptions options;
  options.mode = command.exam ? LiveMode::exam : LiveMode::practice;
  options.stamped = command.stamped;
  options.watch_silence = command.no_window || !command.input.empty() || !command.igtl.empty();
  options.stop = &interrupt_flag();
  options.say = log_info;
  return options;
}

/// What moves the instruments.
std::string source_of(const OperateCommand& command) {
  if (!command.igtl.empty()) return "openigtlink";
  return command.no_window || !command.input.empty() ? "lines" : "window";
}

/// What an attempt is made with.
struct Operation {
  PlayRequest& request;
  const OperateCommand& command;
  ExerciseDefinition exercise;
  std::vector<LiveInstrument> instruments;
  LiveMailbox mailbox;
  LatestView latest;
  SceneDetail detail = SceneDetail::full;
};

/// One attempt after another, each with its own recording, until one is not begun again.
Result<Played> attempts(Operation& operation) {
  PlayRequest& request = operation.request;
  for (int attempt = 0;; ++attempt) {
    LiveOptions options = live_options(operation.command);
    if (!operation.command.no_window) options.pictures = std::make_shared<LivePictures>();
    LiveSource source(operation.instruments, operation.mailbox, options);
    StepTeller teller(options.mode);
    ViewMaker view(
        operation.latest, source,
        {operation.exercise.time_limit, options.mode, operation.detail, options.pictures, attempt});
    request.live = &source;
    request.attempt = {.source = source_of(operation.command),
                       .mode = to_text(options.mode),
                       .trainee = operation.command.trainee,
                       .number = attempt + 1};
    request.on_state = [&](const World& world, const Progress& progress) {
      teller.look(world, progress);
      if (!operation.command.no_window) view.look(world, progress);
    };
    Result<Played> played = play(request);
    if (!played || !source.wants_restart()) return played;
    log_info(fmt::format("Begun again; the attempt before is in {}.", played->output.string()));
    request.overwrite = false;
    if (operation.command.output.empty()) continue;
    const Result<std::filesystem::path> next = fresh_folder(operation.command.output);
    if (!next) return next.failure();
    request.output = next.value();
  }
}

std::string result_lines(const Result<Played>& played) {
  if (!played) return to_text(played.failure());
  const Score& score = played->report.score;
  const std::string total = played->report.has_total()
                                ? fmt::format("{:.1f} of 100 points: {}", score.total, verdict(score))
                            : played->report.aborted ? "No score: the session did not come to its end."
                                                     : "No score: this exercise has none.";
  return fmt::format("{}\nWritten to {}", total, played->output.string());
}

/// What the chosen device file says, or the usual.
Result<GamepadMap> gamepad_map(const OperateCommand& command) {
  const std::string& file = command.device;
  if (file.empty()) return GamepadMap();
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail(FailureKind::usage, fmt::format("cannot read {}", file), "give a device file");
  return read_gamepad_map({std::istreambuf_iterator<char>(in), {}}, file);
}

Result<OperateWindow> open_window(const Operation& operation, LiveMailbox& mailbox) {
  WindowOptions options;
  options.title = operation.exercise.title;
  options.mode = operation.command.exam ? LiveMode::exam : LiveMode::practice;
  options.instruments = operation.instruments;
  options.picture_width = operation.request.width;
  options.picture_height = operation.request.height;
  if (!operation.command.quality.empty())
    options.quality = operation.command.quality == "live" ? live_quality : golden_quality;
  const Result<GamepadMap> map = gamepad_map(operation.command);
  if (!map) return map.failure();
  options.gamepad = map.value();
  return OperateWindow::open(std::move(options), mailbox);
}

/// Where a processor draws, pictures and steps share its cores, and a step whose second thread waits for a picture takes
/// longer than one that has no second one.
int threads_beside_pictures() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 1, usual_threads());
}

/// The library that draws in software takes as many threads as there are cores unless its environment says otherwise: it
/// is left those that the steps do not take. To be said before other threads begin.
void leave_cores_to_steps(int threads) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const std::string left = std::to_string(std::max(1, cores - threads));
  setenv("LP_NUM_THREADS", left.c_str(), 0);
}

/// The window has the main thread, as window systems want it; the session another.
Result<Played> operate_in_window(Operation& operation) {
  Result<OperateWindow> window = open_window(operation, operation.mailbox);
  if (!window) return window.failure();
  log_info(fmt::format("Drawn by {}.", window->description()));
  if (window->quality() == live_quality) operation.detail = SceneDetail::coarse;
  if (window->in_software()) {
    log_info(
        "That is software: hands are asked once a picture, and a smaller one is faster: --size 480x270.");
    operation.request.threads = operation.command.threads.value_or(threads_beside_pictures());
  }
  operation.latest.when_put = OperateWindow::wake;
  std::future<Result<Played>> session = std::async(std::launch::async, [&] { return attempts(operation); });
  std::optional<Result<Played>> played;
  std::optional<Failure> broken;
  for (bool open = true; open && !(played && interrupt_flag());) {
    const Result<bool> turned = window->turn(operation.latest.take());
    if (!turned) broken = turned.failure();
    open = turned && turned.value();
    if (played || session.wait_for(std::chrono::seconds(0)) != std::future_status::ready) continue;
    played = session.get();
    window->set_result(result_lines(*played));
  }
  if (!played) operation.mailbox.put(LiveCommand::abandon);  // a window offers, and a full mailbox may refuse
  if (!played) played = session.get();
  if (broken) return *broken;
  return *std::move(played);
}

/// How OpenIGTLink's tools lie in the field.
Result<std::shared_ptr<const Registration>> live_registration(const Operation& operation) {
  const std::string& file = operation.command.registration;
  if (file.empty())
    return std::make_shared<const Registration>(
        direct_registration(operation.exercise.id, operation.instruments));
  Result<Registration> read = read_registration(file, project_part("scripts/lua"));
  if (!read) return read.failure();
  if (std::vector<Problem> problems = live_problems_with(read.value(), operation.exercise); !problems.empty())
    return Failure{FailureKind::usage, std::move(problems)};
  return std::make_shared<const Registration>(std::move(read).value());
}

Result<std::unique_ptr<InputFeed>> open_feed(Operation& operation) {
  const OperateCommand& command = operation.command;
  if (command.igtl.empty()) {
    const auto lines = [&](const std::string& source) {
      return std::make_unique<LiveLines>(operation.instruments, source);
    };
    Result<std::unique_ptr<InputFeed>> feed =
        InputFeed::open(command.input.empty() ? "-" : command.input, lines, operation.mailbox);
    if (feed && feed.value()->is_file() && !command.stamped)
      return fail(FailureKind::usage,
                  "a file holds all its lines at once: in real time only the last would count",
                  "add --stamped, so that the lines' times count, or send them through a pipe or socket");
    return feed;
  }
  const Result<std::shared_ptr<const Registration>> registration = live_registration(operation);
  if (!registration) return registration.failure();
  const auto messages = [&operation, registration = registration.value()](const std::string&) {
    return std::make_unique<IgtlMessages>(operation.instruments, registration, "OpenIGTLink");
  };
  return InputFeed::open("tcp:" + command.igtl, messages, operation.mailbox);
}

/// Checks the files that the command line names, and opens neither window nor socket.
std::optional<Failure> check_files(Operation& operation) {
  const OperateCommand& command = operation.command;
  if (const Result<GamepadMap> map = gamepad_map(command); !map) return map.failure();
  if (const auto registration = live_registration(operation); !registration) return registration.failure();
  const std::string& input = command.input;
  if (input.empty() || input == "-" || input.starts_with("unix:") || input.starts_with("tcp:"))
    return std::nullopt;
  const Result<std::unique_ptr<InputFeed>> feed = open_feed(operation);
  return feed ? std::nullopt : std::optional<Failure>(feed.failure());
}

Result<Played> operate(PlayRequest& request, const OperateCommand& command) {
  const Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) return script.failure();
  const ExerciseDefinition& exercise = script.value()->definition();
  if (exercise.scene.instruments.empty())
    return fail(FailureKind::usage, "this exercise has no instrument to move", "play it by `calot run`");
  Operation operation{request, command, exercise, live_instruments(exercise.scene), LiveMailbox(), {}};
  if (command.dry_run) {
    const std::optional<Failure> wrong = check_files(operation);
    return wrong ? Result<Played>(*wrong) : Played();
  }
  std::unique_ptr<InputFeed> feed;
  if (command.no_window || !command.input.empty() || !command.igtl.empty()) {
    Result<std::unique_ptr<InputFeed>> opened = open_feed(operation);
    if (!opened) return opened.failure();
    feed = std::move(opened).value();
    if (!feed->heard_at().empty()) log_info("Waiting to be connected to at " + feed->heard_at());
  }
  return command.no_window ? attempts(operation) : operate_in_window(operation);
}

/// What is plugged in, and a device file to start from.
ExitCode print_devices(bool json) {
  const Result<std::vector<DeviceRow>> devices = list_devices();
  if (!devices) return print_failure(devices.failure(), "calot operate --help", json);
  if (json) {
    OrderedJson list = {{"schema", "calot.devices/1"}, {"devices", OrderedJson::array()}};
    for (const DeviceRow& row : devices.value())
      list["devices"].push_back({{"name", row.name}, {"usable", row.usable}});
    print(json_text(list));
    return ExitCode::ok;
  }
  for (const DeviceRow& row : devices.value())
    print(
        fmt::format("{}: {}", row.name, row.usable ? "a gamepad" : "not usable: it has no gamepad mapping"));
  if (devices->empty()) print("No gamepad is plugged in; mouse and keyboard always do.");
  print("\nWhat a gamepad does; a file of this for --device may leave out what is to stay so:\n\n" +
        gamepad_map_text({}));
  return ExitCode::ok;
}

}  // namespace

ExitCode operate_command(const OperateCommand& command) {
  if (command.devices) return command.dry_run ? ExitCode::ok : print_devices(command.json);
  PlayRequest request;
  request.scenario = command.scenario;
  request.threads = command.threads.value_or(usual_threads());
  if (!command.no_window) leave_cores_to_steps(command.threads.value_or(threads_beside_pictures()));
  request.render = false;
  request.write = true;
  request.output = command.output;
  request.overwrite = command.overwrite;
  request.show_progress = false;
  if (command.seed) request.seed = *command.seed;
  std::optional<Failure> wrong = read_size(command.size, request);
  if (!wrong) wrong = read_params(command.params, request);
  if (!wrong && !command.trainee.empty()) wrong = check_pseudonym(command.trainee);
  if (!wrong && command.scenario.empty())
    wrong = fail(FailureKind::usage, "which exercise?", "name a scenario's .lua file");
  if (wrong) return print_failure(*wrong, "calot operate --help", command.json);
  const Result<Played> played = operate(request, command);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const FailureKind kind = played.failure().kind;
    const bool is_scenario = kind == FailureKind::scenario || kind == FailureKind::simulation;
    return print_failure(played.failure(),
                         is_scenario ? "calot check --build " + file : "calot operate --help", command.json);
  }
  if (command.dry_run) return ExitCode::ok;
  return conclude(played.value(), command,
                  {"calot operate " + file, "calot check --build " + file,
                   "calot replay " + shell_word((played->output / "recording.jsonl").string())});
}

}  // namespace calot
