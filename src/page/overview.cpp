#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/page.h"
#include "page/svg.h"

namespace calot {
namespace {

std::string points_text(double points) { return fmt::format("{:.1f}", points); }

/// Of what is there, which may be nothing.
std::optional<ClassTotals> summary_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return ClassTotals{values.back(), (values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), n};
}

std::optional<ClassTotals> part_summary(const Page& page, std::size_t part) {
  std::vector<double> points;
  for (const PageRow& row : page.rows)
    if (row.finished && part < row.points.size() && row.points[part]) points.push_back(*row.points[part]);
  return summary_of(std::move(points));
}

HtmlTable::Row row_html(const Page& page, const PageRow& row, std::size_t number) {
  HtmlTable::Row out;
  out.cells.push_back(fmt::format("{}", number));
  if (!row.problem.empty()) {
    out.cells.push_back(escaped(row.name));
    out.cells.emplace_back();
    out.cells.push_back(verdict_html(row.verdict, false));
    out.cells.insert(out.cells.end(), page.parts.size() + 3, "");
    return out;
  }
  out.cells.push_back(fmt::format("<a href=\"#{}recording\">{}</a>", row.prefix, escaped(row.name)));
  out.cells.push_back(row.total ? "<b>" + points_text(*row.total) + "</b>" : "");
  out.cells.push_back(verdict_html(row.verdict, row.passed));
  out.cells.push_back(row.steps);
  for (std::size_t i = 0; i < page.parts.size(); ++i)
    out.cells.push_back(i < row.points.size() && row.points[i] ? points_text(*row.points[i]) : "");
  out.cells.push_back(fmt::format("{}", row.errors));
  out.cells.push_back(seconds(row.stopped_at));
  return out;
}

/// Whether there were any.
bool add_summaries(const Page& page, HtmlTable& table) {
  const std::optional<ClassTotals> totals = class_totals(page);
  if (!totals || totals->count < 2) return false;
  const std::pair<const char*, double ClassTotals::*> kinds[] = {
      {"best", &ClassTotals::best}, {"median", &ClassTotals::median}, {"worst", &ClassTotals::worst}};
  for (const auto& [name, member] : kinds) {
    HtmlTable::Row row{" class=\"sum\"", {name, "", points_text(*totals.*member), "", ""}};
    for (std::size_t i = 0; i < page.parts.size(); ++i) {
      const std::optional<ClassTotals> part = part_summary(page, i);
      row.cells.push_back(part ? points_text(*part.*member) : "");
    }
    row.cells.insert(row.cells.end(), 2, "");
    table.rows.push_back(std::move(row));
  }
  return true;
}

/// Why some have no score; nothing where all have one.
std::string problems(const Page& page) {
  std::string items;
  for (const PageRow& row : page.rows)
    if (!row.problem.empty())
      items += fmt::format("<li><b>{}</b>: {}</li>\n", escaped(row.name), escaped(row.problem));
  return items.empty() ? "" : "<h3>Not scored</h3><ul class=\"path\">\n" + items + "</ul>\n";
}

std::string counts(const Page& page) {
  const auto count = [&](auto is) { return std::count_if(page.rows.begin(), page.rows.end(), is); };
  const auto passed = count([](const PageRow& row) { return row.passed; });
  const auto failed = count([](const PageRow& row) { return !row.problem.empty(); });
  const auto unfinished =
      count([](const PageRow& row) { return row.problem.empty() && !row.finished && !row.unsafe; });
  const auto unsafe = count([](const PageRow& row) { return row.unsafe; });
  std::string text =
      fmt::format("{} of {} passed; the pass mark is {:g}.", passed, page.rows.size(), page.pass_mark);
  if (unfinished > 0) text += fmt::format(" {} unfinished.", unfinished);
  if (unsafe > 0) text += fmt::format(" {} unsafe.", unsafe);
  if (failed > 0) text += fmt::format(" {} could not be scored.", failed);
  return text;
}

}  // namespace

std::optional<ClassTotals> class_totals(const Page& page) {
  std::vector<double> totals;
  for (const PageRow& row : page.rows)
    if (row.finished && row.total) totals.push_back(*row.total);
  return summary_of(std::move(totals));
}

std::string verdict_html(const std::string& verdict, bool passed) {
  return fmt::format("<span class=\"{}\"><span aria-hidden=\"true\">{}</span> {}</span>",
                     passed ? "good" : "bad", passed ? "&#10003;" : "&#10007;", escaped(verdict));
}

std::string overview_html(const Page& page) {
  if (page.rows.size() == 1) return {};
  HtmlTable table;
  table.caption = page.of_a_class ? "Recordings of the class, by outcome"
                                  : "Attempts of one trainee, in the order in which they were named";
  table.heads = {page.of_a_class ? "no." : "attempt", "recording", "score", "verdict", "steps"};
  table.numbers = "rlrlr";
  for (const PageFact& part : page.parts) {
    table.heads.push_back(fmt::format("{} (of {})", part.name, part.value));
    table.numbers += 'r';
  }
  for (const char* head : {"errors", "time"}) table.heads.emplace_back(head);
  table.numbers += "rr";
  table.labelled = true;
  std::size_t number = 0;
  for (const PageRow& row : page.rows) table.rows.push_back(row_html(page, row, ++number));
  const std::optional<ClassTotals> totals = class_totals(page);
  const std::string about =
      add_summaries(page, table)
          ? fmt::format(
                "<p class=\"soft\">Best, median and worst are of the {} finished of {} recordings, column by "
                "column: every step done, or left by a bail-out that was right.</p>",
                totals->count, page.rows.size())
          : "";
  return fmt::format("<section aria-labelledby=\"overview\"><h2 id=\"overview\">Overview</h2><p>{}</p>\n",
                     counts(page)) +
         totals_html(page) + "<div class=\"overview\">" + html(table) + "</div>" + about + problems(page) +
         "</section>\n";
}

}  // namespace calot
