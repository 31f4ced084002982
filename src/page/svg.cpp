#include "page/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/html.h"

namespace calot {

SvgScale SvgScale::around(double low, double high, int about) {
  if (!std::isfinite(low) || !std::isfinite(high)) low = 0, high = 1;
  if (!(high > low)) {
    const double room = std::max(std::abs(low) * 0.1, 1e-3);
    low -= room;
    high += room;
  }
  const double rough = (high - low) / about, ten = std::pow(10, std::floor(std::log10(rough)));
  SvgScale scale;
  scale.step = rough > 5 * ten ? 10 * ten : rough > 2 * ten ? 5 * ten : rough > ten ? 2 * ten : ten;
  scale.low = scale.step * std::floor(low / scale.step + 1e-9);
  scale.high = scale.step * std::ceil(high / scale.step - 1e-9);
  return scale;
}

std::string SvgScale::text(double value) const {
  return fmt::format("{:.6g}", std::abs(value) < 1e-6 * step ? 0.0 : value);
}

std::string svg_begin(const std::string& id, double width, double height, const std::string& title,
                      const std::string& description, bool has_links) {
  return fmt::format(
      "<svg viewBox=\"0 0 {0:g} {1:g}\" role=\"{2}\" aria-labelledby=\"{3}-title {3}-desc\">"
      "<title id=\"{3}-title\">{4}</title><desc id=\"{3}-desc\">{5}</desc>\n",
      width, height, has_links ? "group" : "img", id, escaped(title), escaped(description));
}

std::string svg_text(double x, double y, const std::string& words, const char* classes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>\n", x, y, classes,
                     escaped(words));
}

std::string benchmark_bar(const PagePart& part, const std::string& id) {
  if (!part.novice_expert || !part.measured) return {};
  const auto [novice, expert] = *part.novice_expert;
  const double share = (*part.measured - novice) / (expert - novice);
  const double shown = std::clamp(share, -0.1, 1.1), x = 40 + 220 * shown;
  const char* where = share < 0   ? "worse than a novice"
                      : share > 1 ? "better than an expert"
                                  : "between the two";
  std::string out =
      svg_begin(id, 300, 44, "Between novice and expert",
                fmt::format("{} measured, novice {}, expert {}: {}", figure_text(*part.measured),
                            figure_text(novice), figure_text(expert), where));
  out +=
      "<line x1=\"40\" y1=\"14\" x2=\"260\" y2=\"14\" class=\"track\"/>"
      "<line x1=\"40\" y1=\"7\" x2=\"40\" y2=\"21\" class=\"axis\"/>"
      "<line x1=\"260\" y1=\"7\" x2=\"260\" y2=\"21\" class=\"axis\"/>";
  out += fmt::format("<path d=\"M{0:.1f} 5l7 9l-7 9l-7 -9z\" class=\"measured\"/>", x);
  out += svg_text(40, 38, "novice " + figure_text(novice), "mid");
  out += svg_text(260, 38, "expert " + figure_text(expert), "mid");
  return out + "</svg>\n";
}

}  // namespace calot
