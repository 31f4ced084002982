#include <fmt/format.h>

#include <algorithm>

#include "paper/bench_report.h"

namespace calot {
namespace {

/// A mesh's line: the fastest solver's row at each rate.
struct Line {
  std::vector<const ComparisonRow*> fastest;
};

bool same_mesh(const ComparisonRow& a, const ComparisonRow& b) {
  return a.formulation == b.formulation && a.nodes == b.nodes && a.extensions == b.extensions;
}

std::vector<Line> lines_of(const std::vector<ComparisonRow>& rows, const std::string& load) {
  std::vector<Line> out;
  for (const ComparisonRow& row : rows) {
    if (row.load != load || row.step_ms_median <= 0) continue;
    if (out.empty() || !same_mesh(*out.back().fastest.front(), row)) out.push_back({});
    std::vector<const ComparisonRow*>& of_rates = out.back().fastest;
    const auto same = std::find_if(of_rates.begin(), of_rates.end(),
                                   [&](const ComparisonRow* r) { return r->rate_hz == row.rate_hz; });
    if (same == of_rates.end())
      of_rates.push_back(&row);
    else if (row.step_ms_median < (*same)->step_ms_median)
      *same = &row;
  }
  return out;
}

std::string mesh_name(const ComparisonRow& row) {
  if (row.extensions == 0) return fmt::format("{}, uniform", row.formulation);
  return fmt::format("{}, {} extensions, level {}", row.formulation, row.extensions, row.levels);
}

}  // namespace

std::string bench_markdown(const std::vector<ComparisonRow>& rows, const std::string& load) {
  const std::vector<Line> lines = lines_of(rows, load);
  if (lines.empty()) return {};
  std::string head = "| mesh | nodes |", rule = "|---|--:|";
  for (const ComparisonRow* row : lines.front().fastest) {
    head += fmt::format(" {0:g} Hz, ms | speedup |", row->rate_hz);
    rule += "--:|--:|";
  }
  std::string out = head + " mean % | near % | most % | MB |\n" + rule + "--:|--:|--:|--:|\n";
  for (const Line& line : lines) {
    const ComparisonRow& first = *line.fastest.front();
    out += fmt::format("| {} | {} |", mesh_name(first), first.nodes);
    for (const ComparisonRow* row : line.fastest)
      out += fmt::format(" {:.{}f} {} | {} |", row->step_ms_median, row->step_ms_median < 10 ? 2 : 0,
                         row->solver, row->speedup > 0 ? fmt::format("{:.1f}", row->speedup) : "");
    out += fmt::format(" {:.2f} | {:.2f} | {:.1f} | {:.2f} |\n", first.mean_error_pct,
                       first.contact_error_pct, first.max_error_pct, 1e-6 * first.memory_bytes);
  }
  return out;
}

}  // namespace calot
