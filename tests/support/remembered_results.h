#pragma once
// What is kept, in memory: a test sees it, counts how often it was found, and may break it.

#include <map>

#include "base/kept_results.h"

namespace calot::test {

struct RememberedResults : KeptResults {
  std::optional<std::string> find(const std::string& key) override {
    const auto at = all.find(key);
    if (at == all.end()) return std::nullopt;
    ++found;
    return at->second;
  }
  void keep(const std::string& key, const std::string& bytes) override {
    ++kept;
    all[key] = bytes;
  }
  std::map<std::string, std::string> all;
  int found = 0, kept = 0;
};

}  // namespace calot::test
