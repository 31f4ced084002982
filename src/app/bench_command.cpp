#include "app/bench_report.h"
#include "app/commands.h"
#include "app/project.h"
#include "app/terminal.h"

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

}  // namespace

ExitCode bench_command(const BenchCommand& command) {
  const Result<std::filesystem::path> folder =
      make_folder(command.output.empty() ? "out/bench" : command.output);
  if (!folder) return print_failure(folder.failure(), "calot bench --help", command.json);
  const BenchMachine machine = this_machine();
  Result<Comparison> comparison = [&] {
    ProgressLine line;
    return compare(case_of(command.quick), [&](const std::string& next) {
      if (line.due()) line.show(next);
    });
  }();
  if (!comparison) return print_failure(comparison.failure(), "calot doctor", command.json);
  const std::string json = bench_json(comparison.value(), machine, command.quick);
  const std::string& load = comparison->rows.front().load;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"bench.json", json + "\n"},
      {"table.md", bench_markdown(comparison->rows, load)},
      {"error_against_cost.svg", bench_plot(comparison->rows, load)}};
  for (const auto& [name, text] : files) {
    const Result<std::string> written = write_text(folder.value() / name, text);
    if (!written) return print_failure(written.failure(), "calot bench --help", command.json);
  }
  if (command.json) {
    print(json);
    return ExitCode::ok;
  }
  print(bench_text(comparison.value(), machine));
  print("Wrote " + (folder.value() / "bench.json").string() +
        ", with table.md and error_against_cost.svg beside it");
  return ExitCode::ok;
}

}  // namespace calot
