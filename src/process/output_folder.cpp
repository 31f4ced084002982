#include "process/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <regex>

#include "base/log.h"
#include "process/project.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// Holds the number of the process that writes. The lock is on the folder, so what a killed process leaves of this
/// file keeps nobody out.
constexpr const char* writer_file = ".running";

Failure taken(const fs::path& path) {
  long process = 0;
  std::ifstream(path / writer_file) >> process;
  const std::string who = process > 0 ? fmt::format("process {}", process) : "another process";
  return fail(FailureKind::usage, fmt::format("{} writes into {} at this moment", who, path.string()),
              "wait until it has ended, or choose another folder with -o DIR");
}

bool written_by_session(const std::string& name) {
  static const std::regex pattern(
      R"((recording\.(jsonl|html)|(steps|events|profile)\.csv|profile\.svg|report\.json|force_over_way\.svg|end\.png|t\d{3,}\.\d\ds\.png)(\.part)?)");
  return std::regex_match(name, pattern);
}

}  // namespace

Result<OutputFolder> OutputFolder::claim(const fs::path& path) {
  const Result<fs::path> made = make_folder(path);
  if (!made) return made.failure();
  OutputFolder folder(path, open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.lock_ < 0 || flock(folder.lock_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (folder.lock_ >= 0) close(std::exchange(folder.lock_, -1));
    if (error == EWOULDBLOCK) return taken(path);
    log_warning(
        fmt::format("{} cannot be kept for this session alone: {}", path.string(), std::strerror(error)));
    return folder;
  }
  std::ofstream(path / writer_file) << getpid() << '\n';
  return folder;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

OutputFolder::~OutputFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(path_ / writer_file, ignored);
  close(lock_);
}

void OutputFolder::clear() const {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error))
    if (written_by_session(entry.path().filename().string())) fs::remove(entry.path(), error);
}

Result<fs::path> fresh_folder(const fs::path& wanted) {
  if (wanted.has_parent_path()) {
    const Result<fs::path> parent = make_folder(wanted.parent_path());
    if (!parent) return parent.failure();
  }
  fs::path path = wanted;
  std::error_code error;
  // Making it is the test, so that two processes never find the same one.
  for (int i = 2; !fs::create_directory(path, error); ++i) {
    if (error && error != std::errc::file_exists)
      return fail(FailureKind::usage, fmt::format("cannot make {}: {}", path.string(), error.message()),
                  "choose another folder with -o DIR");
    path = wanted;
    path += fmt::format("-{}", i);
  }
  return path;
}

}  // namespace calot
