#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/page.h"
#include "page/svg.h"

namespace calot {
namespace {

/// The totals as points over the numbers of their rows.
class TotalsChart {
 public:
  TotalsChart(const PageGroup& group, bool of_a_class, std::size_t number)
      : group_(group), of_a_class_(of_a_class), id_(fmt::format("totals-{}", number)) {
    for (std::size_t i = 0; i < group.rows.size(); ++i)
      if (group.rows[i].total) scored_.push_back({&group.rows[i], i + 1});
    if (scored_.size() > most_on_a_phone) width_ = 900;
  }

  std::size_t size() const { return scored_.size(); }

  std::string html() const {
    const bool narrow = width_ < 900;
    const char* title = of_a_class_ ? "Scores of the class" : "Learning curve: score from attempt to attempt";
    return fmt::format(
               "<figure{0}><figcaption><b>{1}</b></figcaption>"
               "<div class=\"wide{2}\" role=\"region\" tabindex=\"0\" aria-label=\"{1}\">\n",
               narrow ? " class=\"narrow\"" : "", title, narrow ? "" : " drawing") +
           svg_begin(id_, width_, height, title, description(), true) + levels() + way() + marks() +
           "</svg></div><p class=\"soft\">Discs passed, rings were finished and did not; dashed rings were "
           "not "
           "finished: beside them stand the steps done. A cross was unsafe.</p></figure>\n";
  }

 private:
  struct Scored {
    const PageRow* row;
    std::size_t number;
  };

  static constexpr double height = 240, left = 40, right = 16, top = 14, inner_height = 186;
  static constexpr std::size_t most_on_a_phone = 8, most_labels = 30;

  double x_of(std::size_t i) const {
    return left +
           (width_ - left - right) * (static_cast<double>(i) + 0.5) / static_cast<double>(scored_.size());
  }
  static double y_of(double points) { return top + inner_height * (1 - points / 100); }

  std::string description() const {
    std::string text = fmt::format("{} recordings, pass mark {:g}:", scored_.size(), group_.pass_mark);
    for (const Scored& each : scored_) text += fmt::format(" {} {:.1f};", each.row->name, *each.row->total);
    return text;
  }

  std::string level(double points, const char* classes) const {
    return fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"{}\"/>", left, y_of(points), width_ - right,
                       classes);
  }
  std::string levels() const {
    std::string out;
    for (int points = 0; points <= 100; points += 20)
      out += level(points, "grid") + svg_text(left - 6, y_of(points) + 4, fmt::format("{}", points), "end");
    out += level(group_.pass_mark, "level") +
           svg_text(width_ - right, y_of(group_.pass_mark) - 4, "pass mark", "end");
    const std::optional<ClassTotals> totals = class_totals(group_);
    if (of_a_class_ && totals)  // below its line, as the pass mark is above its own
      out += level(totals->median, "step") +
             svg_text(width_ - right, y_of(totals->median) + 13, "median", "end");
    return out +
           svg_text((width_ + left - right) / 2, height - 6, of_a_class_ ? "recording" : "attempt", "mid");
  }

  /// From attempt to attempt; what was not finished is none to compare.
  std::string way() const {
    if (of_a_class_) return {};
    std::string d;
    for (std::size_t i = 0; i < scored_.size(); ++i)
      if (scored_[i].row->finished)
        d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", x_of(i), y_of(*scored_[i].row->total));
    return fmt::format("<path d=\"{}\" class=\"curve c0\"/>", d);
  }

  /// No colour is needed to tell the marks apart.
  static std::string mark(const PageRow& row, double x, double y) {
    if (row.unsafe)
      return fmt::format("<path d=\"M{0:.1f} {1:.1f}l10 10M{0:.1f} {2:.1f}l10 -10\" class=\"cross\"/>", x - 5,
                         y - 5, y + 5);
    const char* shape = row.passed ? "disc" : row.finished ? "ring" : "ring cut";
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" class=\"{}\"/>", x, y, shape);
  }

  std::string marks() const {
    std::string out;
    for (std::size_t i = 0; i < scored_.size(); ++i) {
      const PageRow& row = *scored_[i].row;
      const double x = x_of(i), y = y_of(*row.total);
      out += fmt::format(
          "<a href=\"#{0}recording\" aria-label=\"{1}: {2:.1f}, {3}\"><title>{1}: {2:.1f}, "
          "{3}</title>{4}</a>\n",
          row.prefix, escaped(row.name), *row.total, escaped(row.verdict), mark(row, x, y));
      if (scored_.size() > most_labels) continue;
      if (!row.finished) out += svg_text(x + 9, y - 6, row.steps, "");
      out += svg_text(x, top + inner_height + 16, fmt::format("{}", scored_[i].number), "mid");
    }
    return out;
  }

  const PageGroup& group_;
  bool of_a_class_;
  std::string id_;
  std::vector<Scored> scored_;
  double width_ = 420;
};

}  // namespace

std::string totals_html(const PageGroup& group, bool of_a_class, std::size_t number) {
  const TotalsChart chart(group, of_a_class, number);
  return chart.size() < 2 ? "" : chart.html();
}

}  // namespace calot
