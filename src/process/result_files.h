#pragma once
// Results that took long to find, a file each, for the next start of the same program.

#include <cstdint>
#include <filesystem>

#include "base/kept_results.h"

namespace calot {

/// Several processes may share the folder: a file is whole or not there. What is broken, or no result of this program, is
/// as if it were not there, and so is a folder that cannot be read or written.
class ResultFiles : public KeptResults {
 public:
  /// Of all programs in the folder together; the files that were used least lately go.
  static constexpr std::size_t most_files = 64;
  static constexpr std::uintmax_t most_bytes = 200'000'000;

  /// `program`: what tells programs apart whose results may differ (loaded_code.h).
  ResultFiles(std::filesystem::path folder, std::string program)
      : folder_(std::move(folder)), program_(std::move(program)) {}
  std::optional<std::string> find(const std::string& key) override;
  void keep(const std::string& key, const std::string& bytes) override;

  /// Where a result of this name is, or would be.
  std::filesystem::path file_of(const std::string& key) const;

 private:
  /// Removes the oldest, and what ended processes left half written.
  void tidy() const;

  std::filesystem::path folder_;
  std::string program_;
};

/// Where this user's results are kept: $CALOT_CACHE, else calot in $XDG_CACHE_HOME, else ~/.cache/calot. Empty, as
/// CALOT_CACHE may be: nowhere.
std::filesystem::path results_folder();

/// This process' own; null where nothing is kept.
KeptResults* kept_results();

}  // namespace calot
