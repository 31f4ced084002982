#include <fmt/format.h>

#include "app/commands.h"
#include "app/conclude.h"
#include "app/interrupt.h"
#include "app/line_feed.h"
#include "app/output_folder.h"
#include "app/terminal.h"
#include "base/log.h"

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
  options.watch_silence = true;
  options.stop = &interrupt_flag();
  options.say = log_info;
  return options;
}

/// One attempt after another, each with its own recording, until one is not begun again.
Result<Played> attempts(PlayRequest& request, const OperateCommand& command, LiveMailbox& mailbox,
                        const std::vector<LiveInstrument>& instruments) {
  for (;;) {
    LiveSource source(instruments, mailbox, live_options(command));
    StepTeller teller(source.figures().mode);
    request.live = &source;
    request.on_state = [&](const World& world, const Progress& progress) { teller.look(world, progress); };
    Result<Played> played = play(request);
    if (!played || !source.wants_restart()) return played;
    log_info(fmt::format("Begun again; the attempt before is in {}.", played->output.string()));
    request.overwrite = false;
    if (command.output.empty()) continue;
    const Result<std::filesystem::path> next = fresh_folder(command.output);
    if (!next) return next.failure();
    request.output = next.value();
  }
}

Result<Played> operate(PlayRequest& request, const OperateCommand& command) {
  const Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) return script.failure();
  const std::vector<LiveInstrument> instruments = live_instruments(script.value()->definition().scene);
  LiveMailbox mailbox;
  const Result<std::unique_ptr<LineFeed>> feed = LineFeed::open(command.input, instruments, mailbox);
  if (!feed) return feed.failure();
  return attempts(request, command, mailbox, instruments);
}

}  // namespace

ExitCode operate_command(const OperateCommand& command) {
  PlayRequest request;
  request.scenario = command.scenario;
  request.threads = command.threads;
  request.render = false;
  request.write = true;
  request.output = command.output;
  request.overwrite = command.overwrite;
  request.show_progress = false;
  if (command.seed) request.seed = *command.seed;
  if (const std::optional<Failure> wrong = read_params(command.params, request))
    return print_failure(*wrong, "calot operate --help", command.json);
  const Result<Played> played = operate(request, command);
  const std::string file = shell_word(command.scenario);
  if (!played) {
    const FailureKind kind = played.failure().kind;
    return print_failure(played.failure(),
                         kind == FailureKind::usage ? "calot operate --help" : "calot check --build " + file,
                         command.json);
  }
  return conclude(played.value(), command,
                  {"calot operate " + file, "calot check --build " + file,
                   "calot replay " + shell_word((played->output / "recording.jsonl").string())});
}

}  // namespace calot
