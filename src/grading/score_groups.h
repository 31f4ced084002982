#pragma once
// Which of the scored recordings may be averaged with which, and which of them are copies.

#include <string>
#include <vector>

#include "session/json.h"

namespace calot {

/// It was scored, and is no copy of another one.
bool is_scored(const OrderedJson& entry);

/// Of entries with one session the longest that came to its end counts, or the longest, and the first of equals; the others
/// get its file as `copy_of`.
void mark_copies(std::vector<OrderedJson>& entries);

/// Attempts of one mode (practice, exam; where nobody operated, what moved the instruments), one set of parameters and one
/// score: nothing is averaged across groups.
struct ScoreGroup {
  std::string mode;    ///< "exam", "demo"; "mode not recorded" where neither mode nor source is known
  OrderedJson params;  ///< of the exercise, as it was played
  std::string digest;  ///< score_digest
  double pass_mark = 0;
  std::vector<std::size_t> members;  ///< indices of entries, by outcome (by_outcome)
  /// The score's parts, of the member that was named first; names, titles and weights are the group's.
  OrderedJson parts;
};
/// In the order in which each has its first entry.
std::vector<ScoreGroup> score_groups(const std::vector<OrderedJson>& entries);

/// What tells a group from the others: "exam, anatomy = wide"; parameters that all groups have alike are left out. The score's
/// digest follows where nothing else differs.
std::string group_title(const ScoreGroup& group, const std::vector<ScoreGroup>& all);

/// Indices of the entries by outcome, those without a score and copies last; within an outcome in the order in which they are
/// given.
std::vector<std::size_t> by_outcome(const std::vector<OrderedJson>& entries);

}  // namespace calot
