#pragma once
// Drawings in the page, without JavaScript. Colours are classes of its style sheet, so that they follow light and dark.

#include <string>

#include "page/page_data.h"

namespace calot {

/// Round steps, some `about` of them, that hold all of low .. high; a single value gets room around it.
struct SvgScale {
  double low = 0, step = 1, high = 1;
  static SvgScale around(double low, double high, int about);
  double share(double value) const { return (value - low) / (high - low); }
  std::string text(double value) const;
};

/// Begin of an <svg> with title and description; `id` is unique. A drawing with links in it is a group, another an image.
std::string svg_begin(const std::string& id, double width, double height, const std::string& title,
                      const std::string& description, bool has_links = false);
std::string svg_text(double x, double y, const std::string& words, const char* classes);

/// A plot with a legend. Over time it shows where the recording's steps begin and its errors happen.
std::string plot_html(const PageRecording& recording, std::size_t plot);
/// Steps as bars, events as marks that link to their rows, a line for each kind.
std::string timeline_html(const PageRecording& recording);
/// Where a part's measure lies between novice and expert.
std::string benchmark_bar(const PagePart& part, const std::string& id);

}  // namespace calot
