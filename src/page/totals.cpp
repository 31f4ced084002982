#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/page.h"
#include "page/svg.h"

namespace calot {
namespace {

constexpr double totals_width = 600, totals_height = 240, totals_left = 40, totals_right = 16,
                 totals_top = 14, totals_bottom = 40;
constexpr double totals_inner_width = totals_width - totals_left - totals_right,
                 totals_inner_height = totals_height - totals_top - totals_bottom;
constexpr std::size_t most_labels = 20;

double y_of(double points) { return totals_top + totals_inner_height * (1 - points / 100); }

std::string level(double points, const std::string& words, const char* classes) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"{}\"/>", totals_left, y_of(points),
                     totals_left + totals_inner_width, classes) +
         svg_text(totals_left + totals_inner_width, y_of(points) - 4, words, "end");
}

/// Rows that have a score, as they stand.
std::vector<const PageRow*> scored(const Page& page) {
  std::vector<const PageRow*> rows;
  for (const PageRow& row : page.rows)
    if (row.problem.empty()) rows.push_back(&row);
  return rows;
}

/// A disc where it was passed, a ring where not: no colour is needed to tell.
std::string mark(const PageRow& row, double x) {
  return fmt::format(
      "<a href=\"#{0}recording\" aria-label=\"{1}: {2:.1f}, {3}\"><title>{1}: {2:.1f}, {3}</title><circle "
      "cx=\"{4:.1f}\" cy=\"{5:.1f}\" r=\"6\" class=\"{6}\"/></a>\n",
      row.prefix, escaped(row.name), row.total, escaped(row.verdict), x, y_of(row.total),
      row.passed ? "disc" : "ring");
}

}  // namespace

std::string totals_html(const Page& page) {
  const std::vector<const PageRow*> rows = scored(page);
  if (rows.size() < 2) return {};
  const auto x_of = [&](std::size_t i) {
    return totals_left +
           totals_inner_width * (static_cast<double>(i) + 0.5) / static_cast<double>(rows.size());
  };
  const std::optional<ClassTotals> totals = class_totals(page);
  const char* title =
      page.of_a_class ? "Scores of the class" : "Learning curve: score from attempt to attempt";
  std::string about = fmt::format("{} recordings, pass mark {:g}:", rows.size(), page.pass_mark);
  for (const PageRow* row : rows) about += fmt::format(" {} {:.1f};", row->name, row->total);
  std::string out = fmt::format(
      "<figure><figcaption><b>{}</b></figcaption>"
      "<div class=\"wide drawing\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n",
      title, title);
  out += svg_begin("totals", totals_width, totals_height, title, about, true);
  for (int points = 0; points <= 100; points += 20) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"grid\"/>", totals_left, y_of(points),
                       totals_left + totals_inner_width);
    out += svg_text(totals_left - 6, y_of(points) + 4, fmt::format("{}", points), "end");
  }
  out += level(page.pass_mark, "pass mark", "level");
  if (page.of_a_class && totals) out += level(totals->median, "median", "step");
  std::string way;
  for (std::size_t i = 0; i < rows.size(); ++i)
    way += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x_of(i), y_of(rows[i]->total));
  if (!page.of_a_class) out += fmt::format("<path d=\"{}\" class=\"curve c0\"/>", way);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += mark(*rows[i], x_of(i));
    if (rows.size() <= most_labels)
      out += svg_text(x_of(i), totals_top + totals_inner_height + 16, fmt::format("{}", i + 1), "mid");
  }
  out += svg_text(totals_left + totals_inner_width / 2, totals_height - 6,
                  page.of_a_class ? "recording" : "attempt", "mid");
  return out + "</svg></div><p class=\"soft\">Discs passed, rings did not.</p></figure>\n";
}

}  // namespace calot
