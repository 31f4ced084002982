#include "process/result_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <vector>

#include "base/digest.h"
#include "process/loaded_code.h"
#include "process/project.h"

namespace calot {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view whole_ending = ".kept", part_ending = ".part";
constexpr std::string_view format_line = "calot kept result 1\n";

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hex();
}

/// What a result's file begins with: a file of another format, name or content has another.
std::string head_of(const std::string& name, std::string_view bytes) {
  return fmt::format("{}{}\n{}\n", format_line, name, digest_of(bytes));
}

struct KeptFile {
  fs::path path;
  fs::file_time_type used;
  std::uintmax_t size = 0;
};

/// With that ending, oldest first.
std::vector<KeptFile> files_in(const fs::path& folder, std::string_view ending) {
  std::vector<KeptFile> out;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ending) continue;
    // Another process may have removed it by now: then it is not counted.
    std::error_code gone;
    const KeptFile file{entry->path(), entry->last_write_time(gone), gone ? 0 : entry->file_size(gone)};
    if (!gone) out.push_back(file);
  }
  std::sort(out.begin(), out.end(), [](const KeptFile& a, const KeptFile& b) {
    return a.used != b.used ? a.used < b.used : a.path < b.path;
  });
  return out;
}

}  // namespace

fs::path ResultFiles::file_of(const std::string& key) const {
  Digest digest;
  digest.add(std::string_view(program_));
  digest.add(std::string_view(key));
  return folder_ / (digest.hex() + std::string(whole_ending));
}

std::optional<std::string> ResultFiles::find(const std::string& key) {
  const fs::path path = file_of(key);
  const Result<std::string> read = read_text(path, 2 * most_bytes);
  if (!read) return std::nullopt;
  const std::string& text = read.value();
  const std::string name = path.stem().string();
  const std::size_t head = head_of(name, {}).size();
  if (text.size() < head) return std::nullopt;
  std::string bytes = text.substr(head);
  if (text.compare(0, head, head_of(name, bytes)) != 0) return std::nullopt;
  std::error_code ignored;  // a folder that is only read serves as well
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return bytes;
}

void ResultFiles::keep(const std::string& key, const std::string& bytes) {
  static std::atomic<int> written{0};
  if (bytes.size() > most_bytes) return;
  if (!make_folder(folder_)) return;
  const fs::path path = file_of(key);
  // Nobody else writes into this one: processes by their number, threads of one by their turn.
  const fs::path part = fmt::format("{}.{}-{}{}", path.string(), getpid(), written++, part_ending);
  if (!write_text(path, head_of(path.stem().string(), bytes) + bytes, part)) return;
  tidy();
}

void ResultFiles::tidy() const {
  std::error_code ignored;
  const auto now = fs::file_time_type::clock::now();
  for (const KeptFile& part : files_in(folder_, part_ending))
    if (now - part.used > std::chrono::hours(1)) fs::remove(part.path, ignored);
  const std::vector<KeptFile> files = files_in(folder_, whole_ending);
  std::uintmax_t bytes = 0;
  for (const KeptFile& file : files) bytes += file.size;
  for (std::size_t k = 0; k < files.size() && (files.size() - k > most_files || bytes > most_bytes); ++k) {
    fs::remove(files[k].path, ignored);
    bytes -= files[k].size;
  }
}

fs::path results_folder() {
  if (const char* named = std::getenv("CALOT_CACHE")) return named;
  // The standard for base directories has paths that are not absolute ignored.
  const char* caches = std::getenv("XDG_CACHE_HOME");
  if (caches != nullptr && fs::path(caches).is_absolute()) return fs::path(caches) / "calot";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache" / "calot";
  return {};
}

KeptResults* kept_results() {
  static const fs::path folder = results_folder();
  static const std::string program = loaded_code();
  if (folder.empty() || program.empty()) return nullptr;
  static ResultFiles files(folder, program);
  return &files;
}

}  // namespace calot
