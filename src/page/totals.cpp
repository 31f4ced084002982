#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/page.h"
#include "page/svg.h"

namespace calot {
namespace {

constexpr double totals_width = 420, totals_height = 240, totals_left = 40, totals_right = 16,
                 totals_top = 14, totals_bottom = 40;
constexpr double totals_inner_width = totals_width - totals_left - totals_right,
                 totals_inner_height = totals_height - totals_top - totals_bottom;
constexpr std::size_t most_labels = 20, most_on_a_phone = 8;

double y_of(double points) { return totals_top + totals_inner_height * (1 - points / 100); }

std::string level(double points, const std::string& words, const char* classes) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"{}\"/>", totals_left, y_of(points),
                     totals_left + totals_inner_width, classes) +
         svg_text(totals_left + totals_inner_width, y_of(points) - 4, words, "end");
}

/// A row that has a score, and its number among all.
struct Numbered {
  const PageRow* row;
  std::size_t number;
};

std::vector<Numbered> scored(const Page& page) {
  std::vector<Numbered> rows;
  for (std::size_t i = 0; i < page.rows.size(); ++i)
    if (page.rows[i].problem.empty()) rows.push_back({&page.rows[i], i + 1});
  return rows;
}

/// A disc where it was passed, a ring where not, a dashed one of what was cut: no colour is needed to tell.
std::string mark(const PageRow& row, double x) {
  return fmt::format(
      "<a href=\"#{0}recording\" aria-label=\"{1}: {2:.1f}, {3}\"><title>{1}: {2:.1f}, {3}</title><circle "
      "cx=\"{4:.1f}\" cy=\"{5:.1f}\" r=\"6\" class=\"{6}\"/></a>\n",
      row.prefix, escaped(row.name), row.total, escaped(row.verdict), x, y_of(row.total),
      row.passed  ? "disc"
      : row.whole ? "ring"
                  : "ring cut");
}

}  // namespace

std::string totals_html(const Page& page) {
  const std::vector<Numbered> rows = scored(page);
  if (rows.size() < 2) return {};
  const auto x_of = [&](std::size_t i) {
    return totals_left +
           totals_inner_width * (static_cast<double>(i) + 0.5) / static_cast<double>(rows.size());
  };
  const std::optional<ClassTotals> totals = class_totals(page);
  const char* title =
      page.of_a_class ? "Scores of the class" : "Learning curve: score from attempt to attempt";
  std::string about = fmt::format("{} recordings, pass mark {:g}:", rows.size(), page.pass_mark);
  for (const Numbered& each : rows) about += fmt::format(" {} {:.1f};", each.row->name, each.row->total);
  std::string out = fmt::format(
      "<figure class=\"narrow\"><figcaption><b>{}</b></figcaption>"
      "<div class=\"wide{}\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n",
      title, rows.size() > most_on_a_phone ? " drawing" : "", title);
  out += svg_begin("totals", totals_width, totals_height, title, about, true);
  for (int points = 0; points <= 100; points += 20) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"grid\"/>", totals_left, y_of(points),
                       totals_left + totals_inner_width);
    out += svg_text(totals_left - 6, y_of(points) + 4, fmt::format("{}", points), "end");
  }
  out += level(page.pass_mark, "pass mark", "level");
  if (page.of_a_class && totals) out += level(totals->median, "median", "step");
  std::string way;  // what was cut is no attempt to compare
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].row->whole)
      way += fmt::format("{}{:.1f} {:.1f}", way.empty() ? "M" : "L", x_of(i), y_of(rows[i].row->total));
  if (!page.of_a_class) out += fmt::format("<path d=\"{}\" class=\"curve c0\"/>", way);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += mark(*rows[i].row, x_of(i));
    if (rows.size() <= most_labels)
      out +=
          svg_text(x_of(i), totals_top + totals_inner_height + 16, fmt::format("{}", rows[i].number), "mid");
  }
  out += svg_text(totals_left + totals_inner_width / 2, totals_height - 6,
                  page.of_a_class ? "recording" : "attempt", "mid");
  return out +
         "</svg></div><p class=\"soft\">Discs passed, rings did not; dashed rings were cut, and have the "
         "score up to there.</p></figure>\n";
}

}  // namespace calot
