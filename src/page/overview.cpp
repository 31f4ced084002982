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

std::optional<ClassTotals> part_summary(const PageGroup& group, std::size_t part) {
  std::vector<double> points;
  for (const PageRow& row : group.rows)
    if (row.finished && part < row.points.size() && row.points[part]) points.push_back(*row.points[part]);
  return summary_of(std::move(points));
}

/// A group's table; columns that nobody has are left out.
class GroupTable {
 public:
  explicit GroupTable(const PageGroup& group) : group_(group) {
    for (const PageRow& row : group.rows) {
      has_trainees_ = has_trainees_ || !row.trainee.empty();
      has_times_ = has_times_ || !row.began.empty();
    }
  }

  std::string html(bool of_a_class) const {
    HtmlTable table;
    table.caption =
        (of_a_class ? "Recordings of the class, by outcome" : "Attempts of one trainee, in their order") +
        std::string(": ") + group_.title;
    add_heads(table);
    table.labelled = true;
    std::size_t number = 0;
    for (const PageRow& row : group_.rows) table.rows.push_back(cells(row, ++number));
    const bool summed = add_summaries(table);
    std::string out = "<div class=\"overview\">" + calot::html(table) + "</div>";
    if (summed)
      out += fmt::format(
          "<p class=\"soft\">Best, median and worst are of the {} finished of {} attempts, column by "
          "column: every step done, or left by a bail-out that was right.</p>",
          class_totals(group_)->count, group_.rows.size());
    return out;
  }

 private:
  void add_heads(HtmlTable& table) const {
    table.heads = {"no.", "recording"};
    table.numbers = "rl";
    if (has_trainees_) table.heads.emplace_back("trainee"), table.numbers += 'l';
    if (has_times_) table.heads.emplace_back("began, UTC"), table.numbers += 'l';
    for (const char* head : {"score", "verdict", "steps"}) table.heads.emplace_back(head);
    table.numbers += "rlr";
    for (const PagePartHead& part : group_.parts) {
      table.heads.push_back(fmt::format("{} (of {})", part.title, part.points));
      table.numbers += 'r';
    }
    for (const char* head : {"errors", "time"}) table.heads.emplace_back(head);
    table.numbers += "rr";
  }

  HtmlTable::Row cells(const PageRow& row, std::size_t number) const {
    HtmlTable::Row out;
    out.cells.push_back(fmt::format("{}", number));
    out.cells.push_back(fmt::format("<a href=\"#{}recording\">{}</a>", row.prefix, escaped(row.name)));
    if (has_trainees_) out.cells.push_back(escaped(row.trainee));
    if (has_times_) out.cells.push_back(escaped(row.began));
    out.cells.push_back(row.total ? "<b>" + points_text(*row.total) + "</b>" : "");
    out.cells.push_back(verdict_html(row.verdict, row.passed));
    out.cells.push_back(escaped(row.steps));
    for (std::size_t i = 0; i < group_.parts.size(); ++i)
      out.cells.push_back(i < row.points.size() && row.points[i] ? points_text(*row.points[i]) : "");
    out.cells.push_back(fmt::format("{}", row.errors));
    out.cells.push_back(seconds(row.stopped_at));
    return out;
  }

  /// Whether there were any.
  bool add_summaries(HtmlTable& table) const {
    const std::optional<ClassTotals> totals = class_totals(group_);
    if (!totals || totals->count < 2) return false;
    const std::pair<const char*, double ClassTotals::*> kinds[] = {
        {"best", &ClassTotals::best}, {"median", &ClassTotals::median}, {"worst", &ClassTotals::worst}};
    for (const auto& [name, member] : kinds) {
      HtmlTable::Row row{" class=\"sum\"", {name}};
      row.cells.resize(2U + (has_trainees_ ? 1U : 0U) + (has_times_ ? 1U : 0U));
      row.cells.push_back(points_text(*totals.*member));
      row.cells.insert(row.cells.end(), 2, "");
      for (std::size_t i = 0; i < group_.parts.size(); ++i) {
        const std::optional<ClassTotals> part = part_summary(group_, i);
        row.cells.push_back(part ? points_text(*part.*member) : "");
      }
      row.cells.insert(row.cells.end(), 2, "");
      table.rows.push_back(std::move(row));
    }
    return true;
  }

  const PageGroup& group_;
  bool has_trainees_ = false, has_times_ = false;
};

/// Why some do not count; nothing where all do.
std::string problems(const Page& page) {
  std::string items;
  for (const PageRow& row : page.not_counted)
    items += fmt::format("<li><b>{}</b>: {}</li>\n", escaped(row.name), escaped(row.problem));
  return items.empty() ? "" : "<h3>Not counted</h3><ul class=\"path\">\n" + items + "</ul>\n";
}

std::string counts(const PageGroup& group) {
  const auto count = [&](auto is) { return std::count_if(group.rows.begin(), group.rows.end(), is); };
  const auto passed = count([](const PageRow& row) { return row.passed; });
  const auto unfinished = count([](const PageRow& row) { return !row.finished && !row.unsafe; });
  const auto unsafe = count([](const PageRow& row) { return row.unsafe; });
  std::string text =
      fmt::format("{} of {} passed; the pass mark is {:g}.", passed, group.rows.size(), group.pass_mark);
  if (unfinished > 0) text += fmt::format(" {} unfinished.", unfinished);
  if (unsafe > 0) text += fmt::format(" {} unsafe.", unsafe);
  return text;
}

}  // namespace

std::optional<ClassTotals> class_totals(const PageGroup& group) {
  std::vector<double> totals;
  for (const PageRow& row : group.rows)
    if (row.finished && row.total) totals.push_back(*row.total);
  return summary_of(std::move(totals));
}

std::string verdict_html(const std::string& verdict, bool passed) {
  return fmt::format("<span class=\"verdict {}\"><span aria-hidden=\"true\">{}</span> {}</span>",
                     passed ? "good" : "bad", passed ? "&#10003;" : "&#10007;", escaped(verdict));
}

std::string overview_html(const Page& page) {
  if (page.count() == 1 && !page.groups.empty()) return {};
  std::string out = "<section aria-labelledby=\"overview\"><h2 id=\"overview\">Overview</h2>\n";
  if (page.groups.size() > 1)
    out += "<p>Attempts of another mode, other parameters or another score are not averaged together.</p>\n";
  for (std::size_t i = 0; i < page.groups.size(); ++i) {
    const PageGroup& group = page.groups[i];
    if (page.groups.size() > 1) out += fmt::format("<h3>{}</h3>\n", escaped(group.title));
    out += fmt::format("<p>{}</p>\n", counts(group)) + totals_html(group, page.of_a_class, i + 1) +
           GroupTable(group).html(page.of_a_class);
  }
  return out + problems(page) + "</section>\n";
}

}  // namespace calot
