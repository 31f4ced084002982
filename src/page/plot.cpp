#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/decimate.h"
#include "page/html.h"
#include "page/svg.h"

namespace calot {
namespace {

constexpr double plot_width = 400, plot_height = 260, left = 46, right = 12, top = 10, bottom = 40;
constexpr double inner_width = plot_width - left - right, inner_height = plot_height - top - bottom;
constexpr std::size_t columns = 350, most_of_a_way = 4000, most_marks = 100;
constexpr double least_way = 0.7;  // drawing units
constexpr std::size_t colours = 5;

struct Axes {
  SvgScale x, y;
  double x_of(double value) const { return left + inner_width * x.share(value); }
  double y_of(double value) const { return top + inner_height * (1 - y.share(value)); }
};

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// One scale for both directions: the shorter one is given more room.
void widen(Extent& extent, double length) {
  const double middle = (extent.low + extent.high) / 2;
  extent = {middle - length / 2, middle + length / 2};
}

Axes axes_of(const PagePlot& plot) {
  Extent x, y;
  for (const PageCurve& curve : plot.curves)
    for (const auto& point : curve.points) {
      x.add(point[0]);
      y.add(point[1]);
    }
  for (const PageLevel& level : plot.levels) y.add(level.y);
  for (const PageBand& band : plot.bands) {
    y.add(band.low);
    y.add(band.high);
  }
  if (!plot.is_path) {
    if (y.low > 0 && y.low < 0.5 * y.high) y.low = 0;
    SvgScale time = SvgScale::around(x.low, x.high, 6);
    time.low = std::isfinite(x.low) ? std::min(x.low, time.low + time.step) : 0;
    return {time, SvgScale::around(y.low, y.high, 5)};
  }
  const double scale =
      1.08 * std::max({(x.high - x.low) / inner_width, (y.high - y.low) / inner_height, 1e-3});
  widen(x, scale * inner_width);
  widen(y, scale * inner_height);
  SvgScale across = SvgScale::around(x.low, x.high, 6), up = across;
  across.low = x.low, across.high = x.high;
  up.low = y.low, up.high = y.high;
  return {across, up};
}

std::string grid(const PagePlot& plot, const Axes& axes) {
  std::string out;
  const auto first = [](const SvgScale& scale) {
    return scale.step * std::ceil(scale.low / scale.step - 1e-9);
  };
  for (double x = first(axes.x); x <= axes.x.high + 1e-9 * axes.x.step; x += axes.x.step) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" class=\"grid\"/>", axes.x_of(x), top,
                       top + inner_height);
    out += svg_text(axes.x_of(x), top + inner_height + 15, axes.x.text(x), "mid");
  }
  for (double y = first(axes.y); y <= axes.y.high + 1e-9 * axes.y.step; y += axes.y.step) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"grid\"/>", left, axes.y_of(y),
                       left + inner_width);
    out += svg_text(left - 5, axes.y_of(y) + 4, axes.y.text(y), "end");
  }
  out += svg_text(left + inner_width / 2, plot_height - 6, plot.x_label, "mid");
  return out;
}

std::string bands(const PagePlot& plot, const Axes& axes) {
  std::string out;
  for (const PageBand& band : plot.bands)
    out += fmt::format("<path d=\"M{0:.1f} {2:.1f}H{1:.1f}V{3:.1f}H{0:.1f}Z\" class=\"band\"/>",
                       axes.x_of(band.from), axes.x_of(band.to), axes.y_of(band.low), axes.y_of(band.high));
  return out;
}

/// Where steps begin, and errors.
std::string moments(const PageRecording& recording, const Axes& axes) {
  std::string out;
  const auto line = [&](double time, const char* classes) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" class=\"{}\"/>", axes.x_of(time), top,
                       top + inner_height, classes);
  };
  for (std::size_t i = 0; i < std::min(recording.steps.size(), most_marks); ++i)
    if (recording.steps[i].started > 0) line(recording.steps[i].started, "step");
  std::size_t marks = 0;
  for (const PageEvent& event : recording.events)
    if (event.error && ++marks <= most_marks) line(event.time, "error");
  return out;
}

std::string curve_path(const PagePlot& plot, const PageCurve& curve, const Axes& axes, std::size_t colour) {
  PlanePoints drawn;
  for (const auto& point : curve.points) drawn.push_back({axes.x_of(point[0]), axes.y_of(point[1])});
  drawn = plot.is_path ? thinned_way(drawn, least_way, most_of_a_way) : thinned_over_x(drawn, columns);
  std::string d;
  for (const auto& point : drawn)
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", point[0], point[1]);
  std::string out = fmt::format("<path d=\"{}\" class=\"curve c{}\"/>", d, colour % colours);
  if (plot.is_path && !drawn.empty())
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" class=\"begin c{}\"/>", drawn.front()[0],
                       drawn.front()[1], colour % colours);
  return out + '\n';
}

std::string description(const PageRecording& recording, const PagePlot& plot) {
  std::string text = fmt::format("{} against {}.", plot.y_label, plot.x_label);
  for (const PageCurve& curve : plot.curves) {
    Extent x, y;
    for (const auto& point : curve.points) {
      x.add(point[0]);
      y.add(point[1]);
    }
    if (!std::isfinite(y.high)) continue;
    text += plot.is_path ? fmt::format(" {}: from {:.4g} to {:.4g} across, {:.4g} to {:.4g} up.", curve.name,
                                       x.low, x.high, y.low, y.high)
                         : fmt::format(" {}: {:.4g} to {:.4g}.", curve.name, y.low, y.high);
  }
  for (const PageLevel& level : plot.levels) text += fmt::format(" {}: {:.4g}.", level.name, level.y);
  for (const PageBand& band : plot.bands)
    text += fmt::format(" {}: {:.4g} to {:.4g}.", band.name, band.low, band.high);
  const auto errors = std::count_if(recording.events.begin(), recording.events.end(),
                                    [](const PageEvent& event) { return event.error; });
  if (!plot.is_path && errors > 0) text += fmt::format(" {} errors are marked.", errors);
  return text;
}

std::string legend(const PageRecording& recording, const PagePlot& plot) {
  std::string out;
  const auto entry = [&](const std::string& classes, const std::string& words) {
    out += fmt::format(
        "<li><svg viewBox=\"0 0 26 10\" class=\"key\" aria-hidden=\"true\"><path d=\"M1 5H25\" "
        "class=\"{}\"/></svg>{}</li>",
        classes, escaped(words));
  };
  for (std::size_t i = 0; i < plot.curves.size(); ++i)
    entry(fmt::format("curve c{}", i % colours), plot.curves[i].name);
  for (const PageLevel& level : plot.levels) entry("level", fmt::format("{}: {:.4g}", level.name, level.y));
  for (const PageBand& band : plot.bands)
    entry("band", fmt::format("{}: {:.4g} to {:.4g}", band.name, band.low, band.high));
  if (plot.is_path) return out + "<li>&#9679; where it begins</li>";
  const auto is_error = [](const PageEvent& event) { return event.error; };
  if (recording.steps.size() > 1) entry("step", "a step begins");
  if (std::any_of(recording.events.begin(), recording.events.end(), is_error)) entry("error", "an error");
  return out;
}

}  // namespace

std::string plot_html(const PageRecording& recording, std::size_t index) {
  const PagePlot& plot = recording.plots[index];
  const Axes axes = axes_of(plot);
  const std::string id = fmt::format("{}plot-{}", recording.prefix, index + 1);
  std::string out = fmt::format("<figure id=\"{}\"><figcaption><b>{}</b><br>{}</figcaption>\n", id,
                                escaped(plot.title), escaped(plot.y_label));
  out += svg_begin(id, plot_width, plot_height, plot.title, description(recording, plot));
  out += bands(plot, axes) + grid(plot, axes);
  if (!plot.is_path) out += moments(recording, axes);
  for (const PageLevel& level : plot.levels)
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"level\"/>", left, axes.y_of(level.y),
                       left + inner_width);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) out += curve_path(plot, plot.curves[i], axes, i);
  return out + "</svg><ul class=\"legend\">" + legend(recording, plot) + "</ul></figure>\n";
}

}  // namespace calot
