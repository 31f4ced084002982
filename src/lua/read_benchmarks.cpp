#include "lua/read_benchmarks.h"

#include <fmt/format.h>

#include "lua/table_file.h"
#include "lua/table_reader.h"

namespace calot {
namespace {

constexpr double any_size = std::numeric_limits<double>::infinity();

const KeyTable& benchmarks_keys() {
  using Table = BenchmarkTable;
  static const KeyTable table = keys_of<Table>(
      "benchmarks", "a table of benchmarks: { name = ..., version = 1, exercise = ..., parts = { ... } }",
      {required(text("name", &Table::name, "what results call it, such as \"Residents, 2025\"")),
       required(
           count("version", &Table::version, 1, 1'000'000, "", "of the table: a whole number that grows")),
       required(text("exercise", &Table::exercise, "the id of the exercise that it is for")),
       text("calibration", &Table::calibration, "where the figures come from"),
       number("pass", &Table::pass, quantity::points, 0, 100, "", "the total from which on it is passed"),
       number("cap", &Table::cap, quantity::points, 0, 100, "",
              "the total's largest value after a critical event"),
       list("parts", "benchmark_of",
            "what changes, part by part: { part = ..., novice = ..., expert = ... }")});
  return table;
}

const KeyTable& part_keys() {
  using Part = PartBenchmark;
  static const KeyTable table = keys_of<Part>(
      "benchmark_of",
      "figures of one part of the score: { part = \"left.path_length_mm\", novice = 90, expert = 60 }",
      {required(text("part", &Part::part, "the part's name in the score")),
       number("novice", &Part::novice, quantity::number, -any_size, any_size, "", "earns nothing"),
       number("expert", &Part::expert, quantity::number, -any_size, any_size, "", "earns all"),
       number("each", &Part::each, quantity::number, 0, 1, "", "share lost with each event")});
  return table;
}

void check_texts(FieldCheck& check, const TableReader& reader, const BenchmarkTable& table) {
  for (const auto& [key, value] :
       {std::pair{"name", &table.name}, {"exercise", &table.exercise}, {"calibration", &table.calibration}})
    if (reader.has(key) && value->empty()) check.problem(key, fmt::format("{} is empty", key), "");
}

}  // namespace

Result<BenchmarkTable> read_benchmarks(const std::filesystem::path& path,
                                       const std::filesystem::path& modules) {
  Result<TableFile> file = read_table_file(path, modules, "return " + benchmarks_keys().doc);
  if (!file) return file.failure();
  FieldCheck check;
  BenchmarkTable table;
  const TableReader reader(check, &file->root, "", benchmarks_keys());
  reader.read(table);
  check_texts(check, reader, table);
  if (const Value* parts = reader.take("parts")) {
    for (std::size_t i = 0; i < parts->items.size(); ++i) {
      PartBenchmark part;
      part.place.path = indexed("parts", i);
      const TableReader entry(check, &parts->items[i], part.place.path, part_keys());
      entry.read(part);
      part.place.line = file->map.line_of(part.place.path);
      part.place.file = file->file;
      table.parts.push_back(std::move(part));
    }
  }
  std::vector<Problem> problems = check.take();
  for (Problem& problem : problems) locate(problem, file->map, file->file);
  keep_first(problems);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  table.place = {file->file, std::max(1, file->map.line_of("exercise")), "exercise"};
  table.source_hash = file->source_hash;
  return table;
}

}  // namespace calot
