#include "app/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <exception>
#include <functional>

#include "app/commands.h"
#include "app/usage_error.h"
#include "base/workers.h"
#include "process/terminal.h"
#include "session/build_info.h"
#include "session/json_fields.h"

namespace calot {
namespace {

constexpr const char* names_doc =
    "a register, CSV with the columns trainee and name: shows names, which no recording or result has";

/// Commands as CLI11 fills them in, and the one that was chosen.
struct Program {
  CLI::App app{"Calot, a scriptable simulator of laparoscopic cholecystectomy"};
  RunCommand run;
  OperateCommand operate;
  ReplayCommand replay;
  ScoreCommand score;
  PageCommand page;
  ImportCommand import;
  CheckCommand check;
  ListCommand list;
  NewCommand fresh;
  GoldenCommand golden;
  BenchCommand bench;
  DoctorCommand doctor;
  std::function<ExitCode()> chosen;
};

/// For those who test what is written about commands: no part of the help.
template <class Command>
void add_dry_run(CLI::App& command, Command& options) {
  command.add_flag("--dry-run", options.dry_run, "check arguments and the files they name, and no more")
      ->group("");
}

/// Count: an int, or an optional one.
template <class Count>
void add_threads(CLI::App& command, Count& threads) {
  command
      .add_option("--threads", threads, "threads that share the work of a step; results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, most_threads))
      ->default_str(std::to_string(usual_threads()));
}

/// A check that a number is from 0 to `most`. To the library's own one nan is within any range.
std::function<std::string(const std::string&)> from_0_to(double most, const char* what) {
  return [most, what](const std::string& text) {
    double value = 0;
    const bool number = CLI::detail::lexical_cast(text, value);
    return number && value >= 0 && value <= most
               ? ""
               : fmt::format("{} is no {}: give 0 to {:g}", text, what, most);
  };
}
std::function<std::string(const std::string&)> is_time() { return from_0_to(3600, "time, s"); }

void add_fail_below(CLI::App& command, std::optional<double>& points, const char* about) {
  command.add_option("--fail-below", points, about)->type_name("S")->check(from_0_to(100, "score"));
}

void add_report_options(CLI::App& command, SessionCommand& options) {
  add_threads(command, options.threads);
  command.add_flag("--json", options.json, "print the report as JSON, and nothing else, to stdout");
  add_fail_below(command, options.fail_below, "exit with 1 when the score is below this");
}

void add_session_options(CLI::App& command, SessionCommand& options) {
  add_report_options(command, options);
  command.add_flag("--no-render", options.no_render, "draw no frames");
  command.add_flag("--profile", options.profile,
                   "write what each step took: profile.csv, and profile.svg over time");
  command.add_option("--size", options.size, "size of the frames, px")
      ->type_name("WxH")
      ->capture_default_str();
  command.add_option("--at", options.at, "draw frames at these times too, s: --at 3,4.5")
      ->type_name("TIMES")
      ->delimiter(',')
      ->check(is_time());
}

/// What run and operate share.
template <typename Command>
void add_new_session_options(CLI::App& command, Command& options) {
  command
      .add_option("-o,--output", options.output,
                  "output folder, of which an earlier session's files are replaced (default: a new one, "
                  "out/<scenario id>)")
      ->type_name("DIR");
  command.add_option("--seed", options.seed, "seed of the scenario's random numbers")
      ->type_name("N")
      ->check([](const std::string& text) {
        // The library would turn -1 into 2^64 - 1.
        std::uint64_t seed = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
        return error == std::errc() && end == text.data() + text.size()
                   ? ""
                   : text + " is no seed: give a whole number from 0 on";
      });
  command.add_flag(
      "--overwrite", options.overwrite,
      "replace what an earlier session left in out/<scenario id> (else: out/<scenario id>-2, ...)");
  command.add_option("--param", options.params, "set a parameter of the scenario; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

void add_run(Program& program) {
  CLI::App& command = *program.app.add_subcommand("run", "play a scenario, score it and draw its frames");
  command.add_option("scenario", program.run.scenario, "the scenario's .lua file")->required();
  add_new_session_options(command, program.run);
  add_session_options(command, program.run);
  command
      .add_option("--until", program.run.until, "end the session at this time, s, and score what was done")
      ->type_name("T")
      ->check(is_time());
  command.add_flag("--show-refused", program.run.show_refused,
                   "play nothing: draw a scene that is refused as it is drawn up, pins where organs are in "
                   "each other or in "
                   "ground");
  add_dry_run(command, program.run);
  command.callback([&program] { program.chosen = [&program] { return run_command(program.run); }; });
}

void add_operate(Program& program) {
  CLI::App& command = *program.app.add_subcommand(
      "operate", "move the instruments of a scenario while it runs, and be scored");
  OperateCommand& operate = program.operate;
  command.add_option("scenario", operate.scenario, "the scenario's .lua file");
  command.add_flag("--no-window", operate.no_window, "open no window: lines of input move the instruments");
  command
      .add_option(
          "--input", operate.input,
          "where lines of input come from: a file or named pipe, - for standard input, unix:PATH for a "
          "local socket that is made there, tcp:PORT or tcp:HOST:PORT (default: mouse, keyboard and gamepad; "
          "without a window -)")
      ->type_name("SOURCE");
  CLI::Option* igtl =
      command
          .add_option(
              "--igtl", operate.igtl,
              "OpenIGTLink moves the instruments: a port to be connected to from this machine, *:PORT "
              "from others too, or HOST:PORT of a sender")
          ->type_name("WHERE")
          ->excludes("--input");
  command
      .add_option("--registration", operate.registration,
                  "with --igtl: the file that says how its tools lie in the field (default: in mm in the "
                  "patient's frame, called as the instruments)")
      ->type_name("T.lua")
      ->needs(igtl);
  command
      .add_flag("--stamped", operate.stamped,
                "wait for nothing: the time in each line decides its step (default: real time, in which the "
                "newest line counts)")
      ->excludes(igtl);
  CLI::Option* practice =
      command.add_flag("--practice")->description("show hints; may be paused and begun again (default)");
  command.add_flag("--exam", operate.exam, "no hints, no pause; scored as it stands when it is given up")
      ->excludes(practice);
  command.add_option("--trainee", operate.trainee, "who operates: a pseudonym, recorded with the session")
      ->type_name("ID");
  command.add_option("--device", operate.device, "a file that says what a gamepad does: see --devices")
      ->type_name("FILE");
  command.add_flag("--devices", operate.devices,
                   "list what is plugged in, and print a device file to start from");
  command
      .add_option(
          "--quality", operate.quality,
          "of the picture: live or golden, as fine as golden images and five times as slow (default: live "
          "where no graphics card draws, else golden)")
      ->check(CLI::IsMember({"live", "golden"}));
  command.add_option("--size", operate.size, "size of the picture before it is scaled to the window, px")
      ->type_name("WxH")
      ->capture_default_str();
  add_new_session_options(command, operate);
  add_report_options(command, operate);
  command.get_option("--threads")
      ->description(
          "threads that share the work of a step; where the processor draws the window, one on two cores");
  command.footer(
      "Lines of input: pose T NAME pitch yaw insertion roll jaw [ACTION], tip T NAME x y z roll jaw "
      "[ACTION],\n"
      "pause, resume, restart, abandon, end, time_out [WORDS], bail_out [HOW]. Times in s, places in m, "
      "angles in rad.");
  add_dry_run(command, operate);
  command.callback([&program] { program.chosen = [&program] { return operate_command(program.operate); }; });
}

void add_replay(Program& program) {
  CLI::App& command = *program.app.add_subcommand("replay", "play a recording again and compare every state");
  command.add_option("recording", program.replay.recording, "a recording.jsonl written by run")->required();
  command.add_option("--scenario", program.replay.scenario, "the scenario's file (default: as recorded)")
      ->type_name("FILE");
  command
      .add_option("-o,--output", program.replay.output,
                  "write report, frames and table there (default: nowhere)")
      ->type_name("DIR");
  add_session_options(command, program.replay);
  command.get_option("--profile")->needs(command.get_option("--output"));
  add_dry_run(command, program.replay);
  command.callback([&program] { program.chosen = [&program] { return replay_command(program.replay); }; });
}

void add_score(Program& program) {
  CLI::App& command = *program.app.add_subcommand("score", "score recordings of one trainee or of a class");
  ScoreCommand& score = program.score;
  command.add_option("exercise", score.exercise, "the scenario's .lua file")->required();
  command
      .add_option("recordings", score.recordings,
                  "recordings, or folders with all recordings (.jsonl) below them")
      ->required();
  command
      .add_option("--benchmarks", score.benchmarks,
                  "a Lua table of novice's and expert's figures, used instead of the exercise's own")
      ->type_name("FILE");
  command.add_option("--names", score.names, names_doc)->type_name("FILE");
  command.add_option("-j,--jobs", score.jobs, "recordings scored at once; results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, most_threads))
      ->capture_default_str();
  command
      .add_option("-o,--output", score.output,
                  "folder for scores.json, scores.csv and one result for each recording, which a second run "
                  "takes as it is")
      ->type_name("DIR");
  command.add_flag("--again", score.again, "score anew what the output folder has already");
  command.add_flag("--replay", score.replay,
                   "simulate every recording, and compare with what it holds (default: simulate only where "
                   "the exercise has changed)");
  CLI::Option* json =
      command.add_flag("--json", score.json, "print the scores as JSON, and nothing else, to stdout");
  command.add_flag("--csv", score.csv, "print the scores as CSV, and nothing else, to stdout")
      ->excludes(json);
  add_fail_below(command, score.fail_below, "exit with 1 when any score is below this");
  add_dry_run(command, score);
  command.callback([&program] { program.chosen = [&program] { return score_command(program.score); }; });
}

void add_page(Program& program) {
  CLI::App& command = *program.app.add_subcommand(
      "page", "write one HTML page about recordings: score, timeline, pictures, plots");
  PageCommand& page = program.page;
  command
      .add_option(
          "recordings", page.recordings,
          "recordings, or folders with all recordings (.jsonl) below them: one trainee's attempts, first "
          "to last, or with --class those of different people")
      ->required();
  command.add_flag("--class", page.of_a_class, "they are of different people: no learning curve is drawn");
  command
      .add_option("-o,--output", page.output,
                  "the page (default: beside a single recording, else <exercise id>.html)")
      ->type_name("FILE");
  command.add_option("--scenario", page.scenario, "the scenario's file (default: as the first one recorded)")
      ->type_name("FILE");
  command
      .add_option("--benchmarks", page.benchmarks,
                  "a Lua table of novice's and expert's figures, used instead of the exercise's own")
      ->type_name("FILE");
  command.add_option("--names", page.names, names_doc)->type_name("FILE");
  command.add_flag(
      "--no-pictures", page.no_pictures,
      "draw no pictures; what a recording holds is then not played again, and forces are not shown");
  command.add_option("-j,--jobs", page.jobs, "recordings played at once; the page does not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, most_threads))
      ->capture_default_str();
  add_dry_run(command, page);
  command.callback([&program] { program.chosen = [&program] { return page_command(program.page); }; });
}

void add_import(Program& program) {
  CLI::App& command =
      *program.app.add_subcommand("import", "make recordings of motion that was recorded elsewhere");
  ImportCommand& import = program.import;
  command.add_option("exercise", import.exercise, "the scenario's .lua file")->required();
  command.add_option("files", import.files, "CSV, JIGSAWS kinematics (.txt) or sequence files (.mha)")
      ->required();
  command
      .add_option("--registration", import.registration,
                  "a Lua table: format, units, axes, and which tool is which instrument")
      ->type_name("FILE")
      ->required();
  command.add_option("-o,--output", import.output, "folder for the recordings")->type_name("DIR")->required();
  command.add_flag("--json", import.json, "print what was done as JSON, and nothing else, to stdout");
  add_dry_run(command, import);
  command.callback([&program] { program.chosen = [&program] { return import_command(program.import); }; });
}

void add_check(Program& program) {
  CLI::App& command =
      *program.app.add_subcommand("check", "find what is wrong with scenarios without playing them");
  command.add_option("scenarios", program.check.scenarios, "files, or folders with all scenarios below them")
      ->required();
  command.add_flag(
      "--build", program.check.build,
      "build the operating fields too: fill the organs, and try whether the demo's places are in reach");
  command.add_flag("--json", program.check.json, "print the findings as JSON, and nothing else, to stdout");
  add_dry_run(command, program.check);
  command.callback([&program] { program.chosen = [&program] { return check_command(program.check); }; });
}

void add_list(Program& program) {
  CLI::App& command = *program.app.add_subcommand(
      "list", "list what a scenario can name: ports, landmarks, instruments, events, metrics");
  command.add_option("scenario", program.list.scenario,
                     "list what this one has, with its parameters and steps");
  command.add_flag("--json", program.list.json, "print the lists as JSON, and nothing else, to stdout");
  add_dry_run(command, program.list);
  command.callback([&program] { program.chosen = [&program] { return list_command(program.list); }; });
}

void add_new(Program& program) {
  CLI::App& command = *program.app.add_subcommand("new", "write a commented exercise to start from");
  command.add_option("name", program.fresh.name, "its name, such as hold_tight")->required();
  add_dry_run(command, program.fresh);
  command.callback([&program] { program.chosen = [&program] { return new_command(program.fresh); }; });
}

void add_golden(Program& program) {
  CLI::App& golden = *program.app.add_subcommand("golden", "compare frames with the stored golden images");
  golden.require_subcommand(1);
  const auto add = [&](const char* name, const char* about,
                       ExitCode (*action)(const GoldenCommand&)) -> CLI::App& {
    CLI::App& command = *golden.add_subcommand(name, about);
    command.add_option("names", program.golden.names, "scenarios, or single frames as scenario/frame");
    command.add_option("--folder", program.golden.folder, "folder of the goldens (default: golden/)")
        ->type_name("DIR");
    add_threads(command, program.golden.threads);
    add_dry_run(command, program.golden);
    command.callback(
        [&program, action] { program.chosen = [&program, action] { return action(program.golden); }; });
    return command;
  };
  CLI::App& test = add("test", "play the scenarios and compare every golden frame", golden_test_command);
  test.add_option("-o,--output", program.golden.output,
                  "folder for the frames that differ (default: out/golden)")
      ->type_name("DIR");
  test.add_flag("--json", program.golden.json, "print the findings as JSON, and nothing else, to stdout");
  add("accept", "store the named scenarios' or frames' pictures as golden", golden_accept_command);
  add("report", "write one HTML page with expected, actual and difference", golden_report_command)
      .add_option("-o,--output", program.golden.output, "the page (default: out/golden_report.html)")
      ->type_name("FILE");
}

void add_bench(Program& program) {
  CLI::App& command = *program.app.add_subcommand(
      "bench", "compare structural extensions with uniform meshes: error and cost");
  command
      .add_option("-o,--output", program.bench.output,
                  "folder for bench.json and the plot (default: out/bench)")
      ->type_name("DIR");
  command.add_flag("--json", program.bench.json, "print the figures as JSON, and nothing else, to stdout");
  command.add_flag("--quick", program.bench.quick, "one load and coarser meshes, a few seconds");
  add_dry_run(command, program.bench);
  command.callback([&program] { program.chosen = [&program] { return bench_command(program.bench); }; });
}

void add_doctor(Program& program) {
  CLI::App& command = *program.app.add_subcommand("doctor", "check what this program needs on this machine");
  add_dry_run(command, program.doctor);
  command.callback([&program] { program.chosen = [&program] { return doctor_command(program.doctor); }; });
}

/// The first argument that is not UTF-8, with its odd bytes escaped: it could be neither printed nor recorded.
std::optional<Failure> check_encoding(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (is_utf8(word)) continue;
    std::string shown;
    for (const char c : word)
      shown += static_cast<unsigned char>(c) < 0x80 ? std::string(1, c)
                                                    : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    return fail(FailureKind::usage, fmt::format("argument {} is not UTF-8: {}", i, shown),
                "rename the file, or write the value in UTF-8");
  }
  return std::nullopt;
}

int parse_and_run(int argc, char** argv) {
  if (const std::optional<Failure> wrong = check_encoding(argc, argv))
    return static_cast<int>(print_failure(*wrong, "calot --help"));
  Program program;
  program.app.set_version_flag("--version", "calot " + version());
  program.app.require_subcommand(0, 1);
  add_run(program);
  add_operate(program);
  add_replay(program);
  add_score(program);
  add_page(program);
  add_import(program);
  add_check(program);
  add_list(program);
  add_new(program);
  add_golden(program);
  add_bench(program);
  add_doctor(program);
  program.app.footer(
      "Exit codes: 0 ok, 1 mismatch, a recording without end or score below --fail-below, 2 interrupted,\n"
      "3 internal, 4 usage, 5 nothing selected, 6 scenario error, 7 resource limit,\n"
      "8 the simulation could not follow.");
  try {
    program.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0;  // for help or the version
    if (asked && unexpected_words(program.app).empty()) return program.app.exit(error);
    return static_cast<int>(explain_usage_error(program.app, error));
  }
  if (!program.chosen) {
    print(program.app.help());
    return static_cast<int>(ExitCode::ok);
  }
  return static_cast<int>(program.chosen());
}

}  // namespace

int run_program(int argc, char** argv) {
  try {
    const int code = parse_and_run(argc, argv);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    const ExitCode unprinted =
        print_failure(fail(FailureKind::usage, "what was to be printed could not be written",
                           "free space where the output goes, or print it elsewhere"),
                      "calot --help");
    return code != 0 ? code : static_cast<int>(unprinted);
  } catch (const std::bad_alloc&) {
    return static_cast<int>(print_failure(fail(FailureKind::resource, "out of memory"), "calot doctor"));
  } catch (const std::exception& error) {
    return static_cast<int>(print_failure(fail(FailureKind::internal, error.what()), "calot doctor"));
  }
}

}  // namespace calot
