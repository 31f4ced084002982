#pragma once
// What messages say of names: the nearest known one to a mistyped one, by edit distance (Levenshtein), and no
// more of a long one than a person reads.

#include <string>
#include <string_view>
#include <vector>

namespace calot {

/// Insertions, deletions and replacements of one byte that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, case ignored; the first of equals. Empty when none is near: more than a
/// third of the longer name would have to change (one letter is always allowed when two or more stay). Names of
/// more than 100 bytes are near to none.
std::string closest_name(std::string_view name, const std::vector<std::string>& candidates);

/// A hint for an unknown name: `did you mean "x"?`, or `known: a, b, c` when nothing is near; at most 60 of them.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// The text, or its first `most` bytes (never half a UTF-8 character) and how long it is.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace calot
