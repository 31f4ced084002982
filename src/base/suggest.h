#pragma once
// "Did you mean": the nearest known name to a mistyped one, by edit distance (Levenshtein).

#include <string>
#include <string_view>
#include <vector>

namespace calot {

/// Insertions, deletions and replacements of one byte that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, case ignored; the first of equals. Empty when none is near: more than a
/// third of the longer name would have to change (one letter is always allowed when two or more stay).
std::string closest_name(std::string_view name, const std::vector<std::string>& candidates);

/// A hint for an unknown name: `did you mean "x"?`, or `known: a, b, c` when nothing is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace calot
