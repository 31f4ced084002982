#pragma once
// The commands behind `calot`, each with what its command line fills in. None of them parses arguments.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/workers.h"
#include "goldens/select.h"
#include "process/exit_code.h"

namespace calot {

/// Shared by all commands.
struct AnyCommand {
  bool dry_run =
      false;  ///< fail as the command would on its arguments and the files that they name; else do nothing
};

/// Shared by the commands that play a session.
struct SessionCommand : AnyCommand {
  std::optional<int> threads;  ///< none: as many as is usual, or, beside a window drawn in software, as fit
  std::string output;          ///< folder
  bool json = false, no_render = false;
  bool profile = false;              ///< write what each step took
  std::string size = "960x540";      ///< "WxH", px
  std::vector<double> at;            ///< s, of frames besides the scenario's own
  std::optional<double> fail_below;  ///< points of 100
};

struct RunCommand : SessionCommand {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> params;  ///< "key=value"
  bool overwrite = false;           ///< see PlayRequest
  bool show_refused = false;        ///< draw a scene that is refused instead of playing it
  std::optional<double> until;      ///< s: play no further
};
ExitCode run_command(const RunCommand& command);

struct ReplayCommand : SessionCommand {
  std::string recording;
  std::string scenario;  ///< empty: the one named in the recording
};
ExitCode replay_command(const ReplayCommand& command);

struct OperateCommand : SessionCommand {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> params;  ///< "key=value"
  bool overwrite = false;           ///< see PlayRequest
  std::string input;  ///< of lines, see InputFeed::open; empty: the window's, or without one standard input
  std::string igtl;   ///< where OpenIGTLink comes from instead, see input/sockets.h
  std::string registration;  ///< file that says how its tools lie in the field; empty: as the field itself
  std::string device;        ///< file that says what a gamepad does; empty: the usual
  std::string trainee;       ///< a pseudonym; empty: not said
  std::string quality;       ///< of the picture, "live" or "golden"; empty: as what draws allows
  bool exam = false, stamped = false, no_window = false;
  bool devices = false;  ///< list them, and no more
};
ExitCode operate_command(const OperateCommand& command);

/// As many as there are cores.
inline int usual_jobs() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, most_threads);
}

struct ScoreCommand : AnyCommand {
  std::string exercise;
  std::vector<std::string> recordings;  ///< files, or folders with all below them
  std::string benchmarks;               ///< a table's file; empty: the exercise's own
  std::string names;                    ///< a register's file (name_register.h); empty: none
  std::string output;                   ///< folder of results; empty: nowhere
  int jobs = usual_jobs();              ///< processes
  bool json = false, csv = false;
  bool replay = false, again = false;
  std::optional<double> fail_below;  ///< points of 100
};
ExitCode score_command(const ScoreCommand& command);

struct PageCommand : AnyCommand {
  std::vector<std::string> recordings;  ///< files, or folders with all below them
  std::string scenario;                 ///< empty: the one named in the first recording
  std::string benchmarks;               ///< a table's file; empty: the exercise's own
  std::string names;                    ///< a register's file (name_register.h); empty: none
  std::string output;       ///< the HTML file; empty: beside the recording, or <exercise's id>.html
  int jobs = usual_jobs();  ///< processes
  bool no_pictures = false;
  bool of_a_class = false;  ///< recordings of different people, not one's attempts
};
ExitCode page_command(const PageCommand& command);

struct ImportCommand : AnyCommand {
  std::string exercise, registration;  ///< files
  std::vector<std::string> files;      ///< of motion from elsewhere
  std::string output;                  ///< folder for the recordings
  bool json = false;
};
ExitCode import_command(const ImportCommand& command);

struct CheckCommand : AnyCommand {
  std::vector<std::string> scenarios;  ///< files, or folders with all below them
  bool build = false;                  ///< build the worlds too
  bool json = false;
};
ExitCode check_command(const CheckCommand& command);

struct ListCommand : AnyCommand {
  std::string scenario;  ///< empty: what every scenario can name
  bool json = false;
};
ExitCode list_command(const ListCommand& command);

struct NewCommand : AnyCommand {
  std::string name;
};
ExitCode new_command(const NewCommand& command);

struct GoldenCommand : AnyCommand {
  std::vector<std::string> names;  ///< see goldens/select.h
  std::string folder;              ///< of the goldens; empty: the project's golden/
  std::string output;              ///< report: the HTML file; test: the folder for what differs
  bool json = false;
  int threads = usual_threads();
};
/// Where a golden command's pictures are stored.
std::filesystem::path golden_folder(const GoldenCommand& command);
/// What a dry run says of the scenarios and frames that the names mean.
ExitCode golden_dry_run(const GoldenCommand& command, const std::vector<SelectedGolden>& selected);
ExitCode golden_test_command(const GoldenCommand& command);
ExitCode golden_accept_command(const GoldenCommand& command);
ExitCode golden_report_command(const GoldenCommand& command);

struct BenchCommand : AnyCommand {
  std::string output;  ///< folder; empty: out/bench
  bool json = false, quick = false;
};
ExitCode bench_command(const BenchCommand& command);

struct DoctorCommand : AnyCommand {};
ExitCode doctor_command(const DoctorCommand& command);

}  // namespace calot
