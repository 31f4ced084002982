#include "session/force_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace calot {
namespace {

constexpr double width = 640, height = 360, left = 60, top = 40, bottom = 50;
constexpr std::array colours = {"#1b6ca8", "#d1495b", "#c9a227", "#6b9080", "#7a8b99"};

/// Steps of 1, 2 or 5 times a power of ten, about six of them up to the largest value.
struct Scale {
  double step = 1, last = 1;

  explicit Scale(double largest) {
    if (!(largest > 0)) return;
    const double rough = largest / 6, ten = std::pow(10, std::floor(std::log10(rough)));
    step = rough > 5 * ten ? 10 * ten : rough > 2 * ten ? 5 * ten : rough > ten ? 2 * ten : ten;
    last = step * std::ceil(largest / step);
  }
  double share(double value) const { return value / last; }
};

struct Point {
  double way_mm = 0, force = 0;
};

std::vector<Point> curve_of(const std::vector<InstrumentSample>& samples) {
  std::vector<Point> out;
  double way = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) way += (samples[k].tip - samples[k - 1].tip).norm();
    out.push_back({1e3 * way, samples[k].force});
  }
  return out;
}

double x_of(double share) { return left + share * (width - left - 20); }
double y_of(double share) { return height - bottom - share * (height - bottom - top); }

std::string text(double x, double y, const std::string& words, const char* anchor, const char* colour) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="12">{}</text>)"
                     "\n",
                     x, y, anchor, colour, words);
}

std::string axes(const Scale& ways, const Scale& forces) {
  std::string out;
  const auto line = [&](double x1, double y1, double x2, double y2) {
    out += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="#ddd"/>)"
                       "\n",
                       x1, y1, x2, y2);
  };
  for (double way = 0; way <= ways.last * 1.001; way += ways.step) {
    line(x_of(ways.share(way)), y_of(0), x_of(ways.share(way)), y_of(1));
    out += text(x_of(ways.share(way)), y_of(0) + 18, fmt::format("{:g}", way), "middle", "#333");
  }
  for (double force = 0; force <= forces.last * 1.001; force += forces.step) {
    line(x_of(0), y_of(forces.share(force)), x_of(1), y_of(forces.share(force)));
    out += text(x_of(0) - 8, y_of(forces.share(force)) + 4, fmt::format("{:.3g}", force), "end", "#333");
  }
  out += text(x_of(0.5), height - 10, "way of the tip, mm", "middle", "#333");
  out += text(left - 40, top - 20, "force on the whole instrument, N", "start", "#333");
  return out;
}

}  // namespace

std::string force_plot(const SceneDefinition& scene, const Traces& traces) {
  std::vector<std::vector<Point>> curves;
  double longest = 0, strongest = 0;
  for (const std::vector<InstrumentSample>& samples : traces.instruments) {
    curves.push_back(curve_of(samples));
    for (const Point& point : curves.back()) {
      longest = std::max(longest, point.way_mm);
      strongest = std::max(strongest, point.force);
    }
  }
  if (!(strongest > 0) || !std::isfinite(longest + strongest)) return {};
  const Scale ways(longest), forces(strongest);
  std::string out = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" font-family="sans-serif">)"
      "\n"
      R"(<rect width="{0:.0f}" height="{1:.0f}" fill="white"/>)"
      "\n",
      width, height);
  out += axes(ways, forces);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* colour = colours[i % colours.size()];
    std::string points;
    for (const Point& point : curves[i])
      points +=
          fmt::format("{:.1f},{:.1f} ", x_of(ways.share(point.way_mm)), y_of(forces.share(point.force)));
    out += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.5"/>)"
                       "\n",
                       points, colour);
    out += text(width - 20, top - 20 + 16 * static_cast<double>(i), scene.instruments[i].name, "end", colour);
  }
  return out + "</svg>\n";
}

}  // namespace calot
