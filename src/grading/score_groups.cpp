#include "grading/score_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "session/scoring.h"

namespace calot {
namespace {

/// More than all outcomes for one without a score.
std::size_t outcome_rank(const OrderedJson& entry) {
  const std::vector<OutcomeRow>& rows = outcome_rows();
  if (!is_scored(entry)) return rows.size();
  const auto is = [&](const OutcomeRow& row) { return entry["score"]["outcome"] == row.name; };
  return static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), is) - rows.begin());
}

void sort_by_outcome(const std::vector<OrderedJson>& entries, std::vector<std::size_t>& order) {
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return outcome_rank(entries[a]) < outcome_rank(entries[b]);
  });
}

bool counts_before(const OrderedJson& a, const OrderedJson& b) {
  if (a["whole"] != b["whole"]) return a["whole"].get<bool>();
  return a["stopped_at_s"].get<double>() > b["stopped_at_s"].get<double>();
}

std::string mode_of(const OrderedJson& entry) {
  for (const char* key : {"mode", "source"})
    if (entry[key].is_string()) return entry[key].get<std::string>();
  return "mode not recorded";
}

}  // namespace

bool is_scored(const OrderedJson& entry) { return !entry.contains("failure") && !entry.contains("copy_of"); }

void mark_copies(std::vector<OrderedJson>& entries) {
  std::map<std::string, std::size_t> counted;  // session -> entry
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!is_scored(entries[i])) continue;
    const auto [found, fresh] = counted.emplace(entries[i]["session"].get<std::string>(), i);
    if (!fresh && counts_before(entries[i], entries[found->second])) found->second = i;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!is_scored(entries[i])) continue;
    const std::size_t kept = counted.at(entries[i]["session"].get<std::string>());
    if (kept != i) entries[i]["copy_of"] = entries[kept]["file"];
  }
}

std::vector<ScoreGroup> score_groups(const std::vector<OrderedJson>& entries) {
  std::vector<ScoreGroup> groups;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const OrderedJson& entry = entries[i];
    if (!is_scored(entry)) continue;
    const OrderedJson& score = entry["score"];
    ScoreGroup fresh{mode_of(entry),
                     entry["params"],
                     score["digest"].get<std::string>(),
                     score["pass_mark"].get<double>(),
                     {},
                     score["parts"]};
    const auto is_same = [&](const ScoreGroup& group) {
      return group.mode == fresh.mode && group.params == fresh.params && group.digest == fresh.digest;
    };
    if (std::none_of(groups.begin(), groups.end(), is_same)) groups.push_back(fresh);
    std::find_if(groups.begin(), groups.end(), is_same)->members.push_back(i);
  }
  for (ScoreGroup& group : groups) sort_by_outcome(entries, group.members);
  return groups;
}

std::string group_title(const ScoreGroup& group, const std::vector<ScoreGroup>& all) {
  std::string title = group.mode;
  const auto differs = [&](const std::string& key, const OrderedJson& value) {
    return std::any_of(all.begin(), all.end(), [&](const ScoreGroup& other) {
      return !other.params.contains(key) || other.params[key] != value;
    });
  };
  for (const auto& [key, value] : group.params.items())
    if (differs(key, value)) title += fmt::format(", {} = {}", key, value.get<std::string>());
  const auto is_alike = [&](const ScoreGroup& other) {
    return other.mode == group.mode && other.params == group.params && other.digest != group.digest;
  };
  if (std::any_of(all.begin(), all.end(), is_alike)) title += ", score " + group.digest;
  return title;
}

std::vector<std::size_t> by_outcome(const std::vector<OrderedJson>& entries) {
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  sort_by_outcome(entries, order);
  return order;
}

}  // namespace calot
