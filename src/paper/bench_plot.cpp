#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paper/bench_report.h"

namespace calot {
namespace {

struct Mark {
  double cost = 0, error = 0;  ///< ms, %
  std::string label;
};
struct Series {
  std::string formulation;
  bool extended = false;
  const char* name;
  const char* colour;
  double label_x, label_y;  ///< of marks, beside them
};
constexpr const char* ink = "#333";
const std::vector<Series> all_series = {
    {"shell", false, "shell, uniform: nodes", "#1b6ca8", -28, 4},
    {"shell", true, "shell, 3 extensions: levels", "#d1495b", -3, -9},
    {"1997", false, "1997, uniform: nodes", "#7a8b99", 7, 14},
    {"1997", true, "1997, 3 extensions: levels", "#c9a227", -3, -22},
    {"1997 two stages", true, "1997, two stages: levels", "#6b9080", -3, -9}};

/// Powers of ten that enclose some values.
struct Decades {
  int first = 0, last = 1;

  explicit Decades(const std::vector<double>& values) {
    if (values.empty()) return;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    first = static_cast<int>(std::floor(std::log10(*least)));
    last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(*most))));
  }
  double share(double value) const { return (std::log10(value) - first) / (last - first); }
};

/// By the fastest solver of each mesh. The finest uniform mesh is what errors are measured against: none.
std::vector<Mark> marks_of(const std::vector<ComparisonRow>& rows, const Series& series,
                           const std::string& load, double rate) {
  std::vector<Mark> out;
  for (const ComparisonRow& row : rows) {
    if (row.formulation != series.formulation || (row.extensions > 0) != series.extended) continue;
    if (row.load != load || row.rate_hz != rate || row.step_ms_median <= 0 || row.contact_error_pct <= 0)
      continue;
    const std::string label = row.extensions > 0 ? std::to_string(row.levels) : std::to_string(row.nodes);
    const auto same = std::find_if(out.begin(), out.end(), [&](const Mark& m) { return m.label == label; });
    if (same == out.end())
      out.push_back({row.step_ms_median, row.contact_error_pct, label});
    else
      same->cost = std::min(same->cost, row.step_ms_median);
  }
  return out;
}

struct Panel {
  double left, top, width, height;
  Decades costs, errors;

  double x(double cost) const { return left + width * costs.share(cost); }
  double y(double error) const { return top + height * (1 - errors.share(error)); }
};

std::string text(double x, double y, const std::string& words, const char* anchor, const char* colour,
                 int size = 12) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{}">{}</text>)"
                     "\n",
                     x, y, anchor, colour, size, words);
}

std::string axes(const Panel& panel, double rate) {
  std::string out;
  const auto line = [&](double x1, double y1, double x2, double y2) {
    out += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="#ddd"/>)"
                       "\n",
                       x1, y1, x2, y2);
  };
  const double right = panel.left + panel.width, bottom = panel.top + panel.height;
  for (int k = panel.costs.first; k <= panel.costs.last; ++k) {
    const double value = std::pow(10, k);
    line(panel.x(value), panel.top, panel.x(value), bottom);
    out += text(panel.x(value), bottom + 18, fmt::format("{:g}", value), "middle", ink);
  }
  for (int k = panel.errors.first; k <= panel.errors.last; ++k) {
    const double value = std::pow(10, k);
    line(panel.left, panel.y(value), right, panel.y(value));
    out += text(panel.left - 8, panel.y(value) + 4, fmt::format("{:g}", value), "end", ink);
  }
  out += text(0.5 * (panel.left + right), bottom + 40, "time of a step, ms (median, fastest solver)",
              "middle", ink);
  out += text(0.5 * (panel.left + right), panel.top - 12, fmt::format("{:g} Hz, 100 mm/s", rate), "middle",
              ink, 14);
  return out;
}

std::string curve(const Panel& panel, const std::vector<Mark>& marks, const Series& series) {
  std::string points, out;
  for (const Mark& mark : marks)
    points += fmt::format("{:.1f},{:.1f} ", panel.x(mark.cost), panel.y(mark.error));
  out += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="2"/>)"
                     "\n",
                     points, series.colour);
  for (const Mark& mark : marks) {
    out += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}"/>)"
                       "\n",
                       panel.x(mark.cost), panel.y(mark.error), series.colour);
    out += text(panel.x(mark.cost) + series.label_x, panel.y(mark.error) + series.label_y, mark.label,
                "start", series.colour, 11);
  }
  return out;
}

std::string legend(double left, double top) {
  std::string out;
  for (const Series& series : all_series) {
    out += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}"/>)"
                       "\n",
                       left, top, series.colour);
    out += text(left + 10, top + 4, series.name, "start", ink);
    left += 195;
  }
  return out;
}

}  // namespace

std::string bench_plot(const std::vector<ComparisonRow>& rows, const std::string& load) {
  std::vector<double> rates, costs, errors;
  for (const ComparisonRow& row : rows) {
    if (row.load != load || row.step_ms_median <= 0 || row.contact_error_pct <= 0) continue;
    if (std::find(rates.begin(), rates.end(), row.rate_hz) == rates.end()) rates.push_back(row.rate_hz);
    costs.push_back(row.step_ms_median);
    errors.push_back(row.contact_error_pct);
  }
  constexpr double width = 400, height = 380, gap = 80, top = 80;
  const double whole = gap + static_cast<double>(std::max<std::size_t>(rates.size(), 1)) * (width + gap);
  std::string out = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" font-family="sans-serif">)"
      "\n"
      R"(<rect width="{0:.0f}" height="{1:.0f}" fill="white"/>)"
      "\n",
      std::max(whole, 1020.0), top + height + 60);
  out += legend(40, 24);
  double left = gap;
  for (double rate : rates) {
    const Panel panel{left, top, width, height, Decades(costs), Decades(errors)};
    out += axes(panel, rate);
    for (const Series& series : all_series) out += curve(panel, marks_of(rows, series, load, rate), series);
    left += width + gap;
  }
  const double middle = top + 0.5 * height;
  out += fmt::format("<g transform=\"rotate(-90 24 {0:.0f})\">", middle);
  out +=
      text(24, middle, "mean error within 10 mm of a contact, % of the largest displacement", "middle", ink);
  out += "</g>\n</svg>\n";
  return out;
}

}  // namespace calot
