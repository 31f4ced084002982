#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/svg.h"

namespace calot {
namespace {

/// Kinds in the order of their rows: errors first, each as they first happen.
std::vector<std::string> kinds_of(const std::vector<PageEvent>& events) {
  std::vector<std::string> kinds;
  for (const bool errors : {true, false})
    for (const PageEvent& event : events)
      if (event.error == errors && std::find(kinds.begin(), kinds.end(), event.kind) == kinds.end())
        kinds.push_back(event.kind);
  return kinds;
}

/// As much of a title as a bar of that width takes.
std::string fitting(const std::string& words, double room) {
  const auto most = static_cast<std::size_t>(std::max(0.0, room / 6.6));
  if (words.size() <= most) return words;
  std::size_t end = most > 2 ? most - 2 : 0;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0u) == 0x80u) --end;  // not within a letter
  return end == 0 ? "" : words.substr(0, end) + "\xe2\x80\xa6";
}

class Timeline {
 public:
  explicit Timeline(const PageRecording& recording)
      : recording_(recording),
        kinds_(kinds_of(recording.events)),
        scale_(SvgScale::around(0, std::max(recording.stopped_at, 1e-3), 10)),
        height_(top + bar + 10 + lane * static_cast<double>(kinds_.size()) + 8) {
    scale_.high = std::max(recording.stopped_at, 1e-3);
  }

  std::string html() const {
    const auto errors = std::count_if(recording_.events.begin(), recording_.events.end(),
                                      [](const PageEvent& event) { return event.error; });
    std::string out = svg_begin(
        recording_.prefix + "timeline", width, height_, "Timeline",
        fmt::format("Steps: {}; events in {}: {}, of which errors: {}. All are in the tables below.",
                    recording_.steps.size(), seconds(recording_.stopped_at), recording_.events.size(),
                    errors),
        true);
    out += ticks();
    for (std::size_t i = 0; i < recording_.steps.size(); ++i) out += step(i);
    for (std::size_t i = 0; i < kinds_.size(); ++i) out += svg_text(left - 10, y_of(i) + 4, kinds_[i], "end");
    for (std::size_t i = 0; i < recording_.events.size(); ++i) out += mark(i);
    return out + "</svg>\n";
  }

 private:
  static constexpr double width = 900, left = 110, right = 16, top = 26, bar = 26, lane = 24;
  static constexpr double inner_width = width - left - right;

  double x_of(double time) const { return left + inner_width * scale_.share(time); }
  double y_of(std::size_t kind) const { return top + bar + 10 + lane * (static_cast<double>(kind) + 0.5); }

  std::string ticks() const {
    std::string out;
    for (double time = 0; time <= scale_.high + 1e-9; time += scale_.step) {
      out +=
          fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\" class=\"grid\"/>", x_of(time), top - 4, height_ - 4);
      out += svg_text(x_of(time), top - 10, scale_.text(time) + " s", "mid");
    }
    return out + svg_text(left - 10, top + bar / 2 + 4, "steps", "end");
  }

  std::string step(std::size_t index) const {
    const PageStep& step = recording_.steps[index];
    const double from = x_of(step.started), wide = std::max(1.0, x_of(step.ended) - from);
    return fmt::format(
        "<a href=\"#{0}step-{1}\" aria-label=\"step {2}: {3}, {4} to {5}\"><title>{2}: {3}</title><rect "
        "x=\"{6:.1f}\" "
        "y=\"{7:.1f}\" width=\"{8:.1f}\" height=\"{9:.1f}\" class=\"bar {10}\"/>{11}</a>\n",
        recording_.prefix, index + 1, escaped(step.title), escaped(step.outcome), seconds(step.started),
        seconds(step.ended), from, top, wide, bar, step.outcome == "done" ? "good" : "bad",
        svg_text(from + 6, top + bar / 2 + 4, fitting(step.title, wide - 10), "label"));
  }

  /// Errors are diamonds and are reached by the tab key, others are rings.
  std::string mark(std::size_t index) const {
    const PageEvent& event = recording_.events[index];
    const auto kind = std::find(kinds_.begin(), kinds_.end(), event.kind);
    const double x = x_of(event.time), y = y_of(static_cast<std::size_t>(kind - kinds_.begin()));
    const std::string shape =
        event.error
            ? fmt::format("<path d=\"M{:.1f} {:.1f}l7 8l-7 8l-7 -8z\" class=\"error-mark\"/>", x, y - 8)
            : fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" class=\"mark\"/>", x, y);
    return fmt::format(
        "<a id=\"{0}mark-{1}\" href=\"#{0}event-{1}\" aria-label=\"{2} at {3}\"{4}><title>{2} at "
        "{3}</title>{5}</a>\n",
        recording_.prefix, index + 1, escaped(event.kind), seconds(event.time),
        event.error ? "" : " tabindex=\"-1\"", shape);
  }

  const PageRecording& recording_;
  std::vector<std::string> kinds_;
  SvgScale scale_;
  double height_;
};

}  // namespace

std::string timeline_html(const PageRecording& recording) {
  return "<div class=\"wide drawing\" role=\"region\" tabindex=\"0\" aria-label=\"Timeline\">" +
         Timeline(recording).html() + "</div>\n";
}

}  // namespace calot
