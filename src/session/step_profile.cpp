#include "session/step_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "session/csv.h"

namespace calot {
namespace {

std::string ms(double seconds) { return fmt::format("{:.3f}", 1e3 * seconds); }

/// "left 12; right 3", the largest first.
std::string counts_text(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : sorted)
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", name, count);
  return text;
}

std::string events_text(const std::vector<WorldEvent>& events) {
  std::string text;
  for (const WorldEvent& event : events)
    text += (text.empty() ? "" : "; ") + to_text(event.kind) +
            (event.instrument.empty() ? "" : " " + event.instrument);
  return text;
}

std::vector<std::string> row_of(const ProfiledStep& step) {
  const SolveStatistics& s = step.statistics;
  const double known = s.assembly_s + s.factorisation_s + s.solve_s + s.contact_s;
  std::vector<std::string> row{fmt::format("{}", step.time), ms(step.wall_s)};
  for (const int count :
       {s.substeps, s.solves, s.newton_iterations, s.factorisations, s.shifts, s.friction_rounds})
    row.push_back(std::to_string(count));
  row.push_back(csv_field(counts_text(s.jaw_trials)));
  row.push_back(s.cut_short || !s.balanced ? fmt::format("{:.2g}", s.residual) : "");
  for (const double part : {s.assembly_s, s.factorisation_s, s.solve_s, s.contact_s, s.extension_s,
                            std::max(0.0, step.wall_s - known)})
    row.push_back(ms(part));
  row.push_back(csv_field(counts_text(s.furthest)));
  row.push_back(csv_field(events_text(step.events)));
  return row;
}

/// Where the plot's values lie, in its drawing units.
struct Frame {
  static constexpr double width = 900, height = 320, left = 60, right = 20, top = 30, bottom = 45;
  double end;                    ///< s
  double lowest = 0.1, highest;  ///< ms, powers of ten

  double x_of(double time) const { return left + (width - left - right) * time / end; }
  double y_of(double time_ms) const {
    const double share = std::log10(std::max(time_ms, lowest) / lowest) / std::log10(highest / lowest);
    return top + (height - top - bottom) * (1 - share);
  }
};

std::string text_at(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"12\">{}</text>\n", x, y,
                     anchor, words);
}

std::string axes(const Frame& frame) {
  std::string out;
  for (double value = frame.lowest; value <= 1.001 * frame.highest; value *= 10) {
    const double y = frame.y_of(value);
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#ddd\"/>\n", frame.left, y,
                       frame.width - frame.right);
    out += text_at(frame.left - 6, y + 4, "end", fmt::format("{:g}", value));
  }
  const double rough = frame.end / 8, ten = std::pow(10, std::floor(std::log10(rough)));
  const double tick = rough > 5 * ten ? 10 * ten : rough > 2 * ten ? 5 * ten : rough > ten ? 2 * ten : ten;
  for (double time = 0; time <= 1.001 * frame.end; time += tick)
    out += text_at(frame.x_of(time), frame.height - frame.bottom + 18, "middle", fmt::format("{:g}", time));
  out += text_at((frame.left + frame.width) / 2, frame.height - 8, "middle", "time of the session, s");
  return out + text_at(frame.left - 6, frame.top - 12, "start", "time that a step took, ms");
}

}  // namespace

StepTimes step_times(std::vector<double> wall_s, double step) {
  if (wall_s.empty()) return {};
  std::sort(wall_s.begin(), wall_s.end());
  const auto quantile = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(wall_s.size()));
    return wall_s[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
  };
  return {quantile(0.5), quantile(0.9), quantile(0.99), wall_s.back(),
          static_cast<int>(wall_s.end() - std::upper_bound(wall_s.begin(), wall_s.end(), step))};
}

std::string profile_csv(const std::vector<ProfiledStep>& steps) {
  std::string text =
      csv_row({"time_s", "wall_ms", "parts", "solves", "newton_steps", "factorisations", "shifts",
               "friction_rounds", "trials", "cut_short_at", "assembly_ms", "factorisation_ms", "solve_ms",
               "contact_ms", "extension_ms", "other_ms", "furthest", "events"});
  for (const ProfiledStep& step : steps) text += csv_row(row_of(step));
  return text;
}

std::string profile_plot(const std::vector<ProfiledStep>& steps, double step) {
  if (steps.empty()) return {};
  double longest = 1e3 * step;
  for (const ProfiledStep& each : steps) longest = std::max(longest, 1e3 * each.wall_s);
  const Frame frame{steps.back().time, 0.1, std::pow(10, std::ceil(std::log10(longest)))};
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" font-family=\"sans-serif\">\n"
      "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"white\"/>\n",
      frame.width, frame.height);
  out += axes(frame) + "<path d=\"";
  for (const ProfiledStep& each : steps)
    out += fmt::format("M{:.1f} {:.1f}V{:.1f}", frame.x_of(each.time), frame.y_of(frame.lowest),
                       frame.y_of(1e3 * each.wall_s));
  out += "\" stroke=\"#1b6ca8\" fill=\"none\"/>\n";
  const double own = frame.y_of(1e3 * step);
  out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#d1495b\" stroke-dasharray=\"6 3\"/>\n",
                     frame.left, own, frame.width - frame.right);
  return out + text_at(frame.width - frame.right, own - 4, "end", "as long as it lasts") + "</svg>\n";
}

}  // namespace calot
