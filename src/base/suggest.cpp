#include "base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace calot {
namespace {

constexpr std::size_t longest_name = 100;  // bytes
constexpr std::size_t most_listed = 60;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

int allowed_distance(std::size_t longer) {
  return longer < 3 ? 0 : std::max(1, static_cast<int>(longer) / 3);
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);  // distances from a's first i bytes to each start of b
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string closest_name(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.size() > longest_name) return {};
  const std::string wanted = lower(name);
  const std::string* best = nullptr;
  int best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest_name) continue;
    const int distance = edit_distance(wanted, lower(candidate));
    if (distance > allowed_distance(std::max(name.size(), candidate.size()))) continue;
    if (best != nullptr && distance >= best_distance) continue;
    best = &candidate;
    best_distance = distance;
  }
  return best != nullptr ? *best : std::string();
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string near = closest_name(name, candidates);
  if (!near.empty()) return fmt::format("did you mean \"{}\"?", near);
  if (candidates.empty()) return {};
  std::string known = "known: ";
  for (std::size_t i = 0; i < candidates.size() && i < most_listed; ++i)
    known += (i > 0 ? ", " : "") + shortened(candidates[i], longest_name);
  if (candidates.size() > most_listed) known += fmt::format(" and {} more", candidates.size() - most_listed);
  return known;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t cut = most;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) --cut;
  return fmt::format("{}... ({} bytes)", text.substr(0, cut), text.size());
}

}  // namespace calot
