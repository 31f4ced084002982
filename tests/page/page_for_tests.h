#pragma once
// Made-up recordings, of any length, and how to look at a page's text.

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "page/page.h"

namespace calot::test {

inline constexpr std::size_t instruments = 4;

/// Every text that may come from outside is, or contains, `word`.
inline PageRecording made_up(const std::string& prefix, std::size_t samples, std::size_t events,
                             std::size_t pictures, std::size_t picture_bytes,
                             const std::string& word = "word") {
  PageRecording r;
  const double end = static_cast<double>(samples) / 50;
  r.prefix = prefix, r.name = word, r.file = word, r.verdict = word, r.stopped_at = end, r.pass_mark = 80;
  r.warnings = {word}, r.notes = {word};
  r.attempt = r.parameters = r.metrics = r.noted = {{word, word}};
  for (std::size_t i = 0; i < pictures; ++i)
    r.pictures.push_back(
        {0.5, word, "image/jpeg", std::string(picture_bytes, static_cast<char>(i)), 640, 360});
  const auto picture = [&](std::size_t i) {
    return pictures == 0 ? std::nullopt : std::optional(i % pictures);
  };
  for (std::size_t i = 0; i < 4; ++i)
    r.steps.push_back({word, word, i < 3 ? "done" : word, end * 0.25 * static_cast<double>(i),
                       end * 0.25 * static_cast<double>(i + 1), picture(i), picture(i + 1), word});
  for (std::size_t i = 0; i < events; ++i)
    r.events.push_back({word, word, end * static_cast<double>(i) / static_cast<double>(events), word, word,
                        word, word, i % 3 == 0, picture(i), word, word});
  PagePart part{word, word, word, 0.5, 20, 3.0, std::array{10.0, 2.0}, "", word, {}};
  for (std::size_t i = 0; i < events; ++i) part.events.push_back(i);
  r.score = {40, 60, {part, part}, {{word, word, 40, true, part.events}}};
  r.score.parts[1].novice_expert.reset();
  r.score.parts[1].rule = word;
  for (const bool is_path : {false, false, false, false, false, false, true, true}) {
    PagePlot plot{word, word, word, is_path, {}, {}, {}};
    if (!is_path) plot.levels = {{word, 5}}, plot.bands = {{word, 1, 3, 0.25 * end, 0.5 * end}};
    for (std::size_t c = 0; c < instruments; ++c) {
      PageCurve& curve = plot.curves.emplace_back(PageCurve{word, {}});
      for (std::size_t k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) / 50, wild = std::sin(37.0 * t * t) + static_cast<double>(c);
        curve.points.push_back({is_path ? 50 * std::cos(11.0 * t * t) : t, 40 * wild});
      }
    }
    r.plots.push_back(plot);
  }
  return r;
}

inline PageRow row(const std::string& prefix, double total, bool passed = false, bool finished = true) {
  PageRow r;
  r.prefix = prefix, r.name = "name of " + prefix, r.verdict = passed ? "passed" : "not passed";
  r.finished = finished, r.passed = passed, r.total = total, r.points = {total / 2, total / 2};
  return r;
}

inline Page page_of(std::vector<PageRow> rows) {
  Page page;
  page.title = "Title", page.scenario = "id", page.file = "x.lua", page.benchmarks = "own";
  page.calibration = "uncalibrated";
  page.groups = {{"exam", 80, {{"A", "50.0"}, {"B", "50.0"}}, std::move(rows)}};
  return page;
}

/// The first group of each match.
inline std::vector<std::string> all(const std::string& html, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(html.begin(), html.end(), regex), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

}  // namespace calot::test
