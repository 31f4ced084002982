#include <cstdio>

#include "app/commands.h"
#include "paper/bench_report.h"
#include "process/interrupt.h"
#include "process/project.h"
#include "process/terminal.h"

namespace calot {
namespace {

constexpr double travel = 6e-3;  // m

/// The quick one: one load, coarser meshes, few steps of the slow ones.
ComparisonCase case_of(bool quick) {
  ComparisonCase out;
  out.loads = standard_loads(travel);
  if (!quick) return out;
  out.loads.resize(1);
  out.uniform_levels = 2;
  out.extension_levels = 1;
  out.cycles = 1;
  out.patience = 0.2;
  return out;
}

std::optional<Failure> write_all(const Comparison& comparison, const std::string& json,
                                 const std::filesystem::path& folder) {
  const std::string& load = comparison.rows.front().load;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"bench.json", json + "\n"},
      {"table.md", bench_markdown(comparison.rows, load)},
      {"error_against_cost.svg", bench_plot(comparison.rows, load)}};
  for (const auto& [name, text] : files) {
    const Result<std::string> written = write_text(folder / name, text);
    if (!written) return written.failure();
  }
  return std::nullopt;
}

}  // namespace

ExitCode bench_command(const BenchCommand& command) {
  if (command.dry_run) return ExitCode::ok;
  const Result<std::filesystem::path> folder =
      make_folder(command.output.empty() ? "out/bench" : command.output);
  if (!folder) return print_failure(folder.failure(), "calot bench --help", command.json);
  const BenchMachine machine = this_machine();
  ComparisonCase given = case_of(command.quick);
  given.stop = &interrupt_flag();
  Result<Comparison> comparison = [&] {
    ProgressLine line;
    return compare(given, [&](const std::string& next) {
      if (line.due()) line.show(next);
    });
  }();
  if (!comparison) return print_failure(comparison.failure(), "calot doctor", command.json);
  const bool measured = !comparison->rows.empty();
  // Printed first: minutes of measuring are not lost to a full disk.
  const std::string json = bench_json(comparison.value(), machine, command.quick);
  if (command.json || measured) print(command.json ? json : bench_text(comparison.value(), machine));
  if (measured) {
    if (const std::optional<Failure> unwritten = write_all(comparison.value(), json, folder.value()))
      return print_failure(*unwritten, "calot bench -o DIR");
    const std::string first = (folder.value() / "bench.json").string();
    if (!command.json) print("Wrote " + first + ", with table.md and error_against_cost.svg beside it");
  }
  if (!comparison->interrupted) return ExitCode::ok;
  std::fflush(stdout);
  std::fprintf(stderr, "Interrupted: %s.\nNext: calot bench\n",
               measured ? "these are the meshes that were measured" : "nothing was measured or written");
  return ExitCode::interrupted;
}

}  // namespace calot
