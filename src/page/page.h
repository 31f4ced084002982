#pragma once
// One HTML page about recordings that opens offline: its pictures, drawings and style are inside, it has no script, and
// a policy in its head forbids the browser every request. Everything from outside is escaped.

#include <optional>
#include <string>
#include <vector>

#include "page/page_data.h"

namespace calot {

/// One recording's part of the page.
std::string recording_html(const PageRecording& recording);

/// The whole page; `sections` are recording_html() of the rows that have a score, in their order.
std::string page_html(const Page& page, const std::vector<std::string>& sections);

/// Of a group's attempts that were finished; none where there is none.
struct ClassTotals {
  double best = 0, median = 0, worst = 0;  ///< points
  std::size_t count = 0;
};
std::optional<ClassTotals> class_totals(const PageGroup& group);

/// Passed, in words, and with a mark that needs no colour. HTML.
std::string verdict_html(const std::string& verdict, bool passed);

/// The overview of several recordings; empty of a single one that has a score.
std::string overview_html(const Page& page);

/// A group's totals: of one person from attempt to attempt, of a class side by side with the median. `number` makes its ids the page's only ones. Empty of less than two.
std::string totals_html(const PageGroup& group, bool of_a_class, std::size_t number);

/// The page's style sheet.
const char* page_style();

}  // namespace calot
