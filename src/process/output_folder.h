#pragma once
// The folder that a session writes into: its own while it runs, and holding nothing of a session before.

#include <filesystem>

#include "base/status.h"

namespace calot {

/// Keeps other processes out of a folder for as long as it lives; the system ends that with the process, however that
/// ends.
class OutputFolder {
 public:
  /// Makes the folder where it is missing. Fails (usage) where it cannot be written to, or another process writes
  /// into it, which is then named.
  static Result<OutputFolder> claim(const std::filesystem::path& path);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  const std::filesystem::path& path() const { return path_; }
  /// Removes what an earlier session wrote, and the page about it: recording, table, report and pictures. Nothing else is touched.
  void clear() const;

 private:
  OutputFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  std::filesystem::path path_;
  int lock_ = -1;
};

/// Makes a folder that was not there: `wanted`, or else the first of wanted-2, wanted-3, ... Fails (usage) where none
/// can be made.
Result<std::filesystem::path> fresh_folder(const std::filesystem::path& wanted);

}  // namespace calot
