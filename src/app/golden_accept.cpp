#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "goldens/compare.h"
#include "goldens/select.h"
#include "goldens/store.h"
#include "play/play.h"
#include "process/interrupt.h"
#include "process/project.h"
#include "process/terminal.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// A scenario's new goldens wait in a folder of their own until the session has come to its end: none or all.
class Staging {
 public:
  explicit Staging(fs::path folder) : folder_(std::move(folder)) { fs::remove_all(staged(), ignored_); }
  ~Staging() { fs::remove_all(staged(), ignored_); }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  std::optional<Failure> add(const Frame& frame) {
    const Golden golden = make_golden(frame);
    const Result<std::string> written = write_golden(staged() / frame.name, golden);
    if (!written) return written.failure();
    names_.push_back(frame.name);
    sidecars_.push_back(golden.sidecar);
    return std::nullopt;
  }
  const std::vector<std::string>& names() const { return names_; }
  /// What became of the session is written beside each picture before the first is moved.
  std::optional<Failure> publish(const Course& course) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      sidecars_[i].course = course;
      const Result<std::string> written = write_sidecar(staged() / names_[i], sidecars_[i]);
      if (!written) return written.failure();
    }
    for (const std::string& name : names_) {
      for (const char* extension : {".png", ".json"}) {
        std::error_code error;
        fs::rename(staged() / (name + extension), folder_ / (name + extension), error);
        if (error)
          return fail(
              FailureKind::usage,
              fmt::format("cannot write {}: {}", (folder_ / (name + extension)).string(), error.message()));
      }
      print(fmt::format("accepted {}", (folder_ / (name + ".png")).string()));
    }
    return std::nullopt;
  }

 private:
  fs::path staged() const { return folder_ / ".new"; }
  fs::path folder_;
  std::vector<std::string> names_;
  std::vector<GoldenSidecar> sidecars_;  ///< of these, in their order
  std::error_code ignored_;
};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void remove_stale(const fs::path& folder, const std::vector<std::string>& declared) {
  for (const std::string& name : stored_frames(folder)) {
    if (contains(declared, name)) continue;
    fs::remove(folder / (name + ".png"));
    fs::remove(folder / (name + ".json"));
    print(fmt::format("removed {}, which the scenario no longer declares", (folder / name).string()));
  }
}

/// Adds to `count` the frames that were accepted: none where the session does not come to its end.
std::optional<Failure> accept_scenario(const SelectedGolden& selected, const fs::path& goldens,
                                       std::size_t& count) {
  const fs::path folder = goldens / selected.name;
  Staging staging(folder);
  PlayRequest request;
  request.scenario = selected.file;
  request.end_frame = false;
  use_stored_size(folder, request);
  request.on_picture = [&](const Frame& frame) {
    return selected.wants(frame.name) ? staging.add(frame) : std::nullopt;
  };
  const Result<Played> played = play(request);
  if (!played && played.failure().kind == FailureKind::interrupted) return std::nullopt;
  if (!played) return played.failure();
  if (played->session.end == SessionEnd::failed) return played->session.failure;
  if (interrupt_flag()) return std::nullopt;
  const std::vector<std::string> declared = golden_names(played->exercise);
  std::vector<std::string> lacking = selected.frames.empty() ? declared : selected.frames;
  std::erase_if(lacking, [&](const std::string& name) { return contains(staging.names(), name); });
  if (!lacking.empty())
    return fail(FailureKind::scenario,
                fmt::format("the session of {} ended at {:g} s without {}: nothing of it was accepted",
                            selected.name, played->session.traces.time.back(), fmt::join(lacking, ", ")),
                fmt::format("frames that were drawn: {}", fmt::join(played->pictures, ", ")));
  if (std::optional<Failure> failure = staging.publish(course_of(played.value()))) return failure;
  count += staging.names().size();
  if (selected.frames.empty()) remove_stale(folder, declared);
  return std::nullopt;
}

/// Pictures go into another project only where the command line names its folder.
std::optional<Failure> check_goldens_place(const GoldenCommand& command) {
  const std::optional<std::string> why = no_project_here();
  if (!why || !command.folder.empty()) return std::nullopt;
  return fail(FailureKind::usage,
              fmt::format("no project here ({}): the pictures would go into {}", *why,
                          golden_folder(command).string()),
              "run it inside the project, which has scenarios/ and scripts/lua/: make scripts/lua where it "
              "is missing");
}

ExitCode stopped(std::size_t accepted, const std::vector<SelectedGolden>& all, std::size_t from) {
  std::vector<std::string> left;
  for (std::size_t i = from; i < all.size(); ++i) left.push_back(all[i].name);
  const std::string names = shell_words(left);
  std::fflush(stdout);
  std::fprintf(stderr, "Interrupted: %zu frames were accepted, those named above; nothing of %s.\n", accepted,
               names.c_str());
  std::fprintf(stderr, "Next: calot golden accept %s\n", names.c_str());
  return ExitCode::interrupted;
}

}  // namespace

ExitCode golden_accept_command(const GoldenCommand& command) {
  if (command.names.empty()) {
    return print_failure(fail(FailureKind::usage, "name what to accept: a scenario, or scenario/frame"),
                         "calot golden test");
  }
  if (const std::optional<Failure> wrong = check_goldens_place(command))
    return print_failure(*wrong, "cd PROJECT, then: calot golden accept " + shell_word(command.names[0]));
  tell_borrowed_project();
  const Result<std::vector<SelectedGolden>> selected = select_goldens(command.names);
  if (!selected) {
    print_failure(selected.failure(), "calot golden test");
    return ExitCode::nothing_selected;
  }
  if (command.dry_run) return golden_dry_run(command, selected.value());
  const fs::path goldens = golden_folder(command);
  std::size_t accepted = 0;
  ExitCode ended = ExitCode::ok;  // the first failure's: the other scenarios are accepted all the same
  for (std::size_t i = 0; i < selected->size(); ++i) {
    const SelectedGolden& scenario = selected.value()[i];
    if (interrupt_flag()) return stopped(accepted, selected.value(), i);
    const std::size_t before = accepted;
    const std::optional<Failure> failure = accept_scenario(scenario, goldens, accepted);
    if (failure) {
      const ExitCode code = print_failure(*failure, "calot run " + shell_word(scenario.file.string()));
      if (ended == ExitCode::ok) ended = code;
    }
    if (interrupt_flag() && accepted == before) return stopped(accepted, selected.value(), i);
  }
  return ended;
}

}  // namespace calot
