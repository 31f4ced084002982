#include "process/project.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <utility>

#include "base/log.h"
#include "base/suggest.h"

namespace calot {
namespace fs = std::filesystem;

namespace {

/// The nearest of the current folder and its parents that holds all of these folders.
std::optional<fs::path> folder_with(std::initializer_list<const char*> parts) {
  std::error_code ignored;
  for (fs::path folder = fs::current_path(ignored); !folder.empty(); folder = folder.parent_path()) {
    if (std::all_of(parts.begin(), parts.end(),
                    [&](const char* part) { return fs::is_directory(folder / part, ignored); }))
      return folder;
    if (folder == folder.root_path()) break;
  }
  return std::nullopt;
}

std::optional<fs::path> own_project() { return folder_with({"scenarios", "scripts/lua"}); }

}  // namespace

fs::path project_folder() { return own_project().value_or(CALOT_SOURCE_DIR); }

std::optional<std::string> no_project_here() {
  if (own_project()) return std::nullopt;
  const std::optional<fs::path> half = folder_with({"scenarios"});
  return half ? fmt::format("no scripts/lua beside {}", (*half / "scenarios").string())
              : "no folder with scenarios/ and scripts/lua, here or above";
}

void tell_borrowed_project() {
  static bool told = false;
  const std::optional<std::string> why = no_project_here();
  if (why && !std::exchange(told, true))
    log_info(fmt::format("No project here ({}): using that of {}.", *why, CALOT_SOURCE_DIR));
}

void tell_half_project() {
  if (folder_with({"scenarios"})) tell_borrowed_project();
}

fs::path project_part(const std::string& name) {
  std::error_code ignored;
  const fs::path own = project_folder() / name;
  return fs::exists(own, ignored) ? own : fs::path(CALOT_SOURCE_DIR) / name;
}

std::vector<fs::path> project_scenarios() {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(project_folder() / "scenarios", error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() == ".lua" && entry->is_regular_file()) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> files_below(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    if (entry->is_directory(error) && path.filename().string().starts_with('.'))
      entry.disable_recursion_pending();
    else if (path.extension() == extension && !entry->is_directory(error))
      files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string scenario_name(const fs::path& file) {
  return file.lexically_relative(project_folder() / "scenarios").replace_extension().generic_string();
}

std::optional<Failure> check_scenario_path(const std::string& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {
    std::ifstream in(path, std::ios::binary);
    in.peek();
    if (in.is_open() && !in.bad()) return std::nullopt;
    return fail(FailureKind::usage, fmt::format("cannot read {}", path),
                "make it readable for you: chmod u+r");
  }
  if (fs::is_directory(path, ignored)) {
    return fail(FailureKind::usage, fmt::format("{} is a folder, not a scenario", path),
                "name a .lua file in it");
  }
  std::vector<std::string> known;
  for (const fs::path& file : project_scenarios()) known.push_back(fs::proximate(file, ignored).string());
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const std::string& file : known) names.push_back(fs::path(file).filename().string());
  const std::string near = closest_name(fs::path(path).filename().string(), names);
  std::string hint = fmt::format("scenarios here: {}", fmt::join(known, ", "));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == near) hint = fmt::format("did you mean {}?", known[i]);
  }
  return fail(FailureKind::usage, fmt::format("there is no file {}", path), known.empty() ? "" : hint);
}

Result<std::string> read_text(const fs::path& path, std::size_t most) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(FailureKind::usage, fmt::format("cannot read {}", path.string()));
  std::string text;
  for (std::array<char, 1 << 16> part; text.size() <= most;
       text.append(part.data(), static_cast<std::size_t>(in.gcount())))
    if (in.read(part.data(), part.size()).gcount() == 0) break;
  if (in.bad()) return fail(FailureKind::usage, fmt::format("cannot read {}", path.string()));
  if (text.size() <= most) return text;
  return fail(FailureKind::usage, fmt::format("the file has more than {} bytes", most),
              "restore it: this is none that was written here", {path.string(), 0, {}});
}

Result<std::string> write_text(const fs::path& path, const std::string& text, fs::path part) {
  // A file that was there is lost only to a whole new one.
  if (part.empty()) part = fs::path(path) += ".part";
  errno = 0;
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (!out)
    error = std::error_code(errno != 0 ? errno : EIO, std::generic_category());
  else
    fs::rename(part, path, error);
  if (!error) return path.string();
  std::error_code ignored;
  fs::remove(part, ignored);
  return fail(FailureKind::usage, fmt::format("cannot write {}: {}", path.string(), error.message()),
              "choose a folder that exists and has space");
}

Result<fs::path> make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && !fs::is_directory(path)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(path.c_str(), W_OK) != 0) error = std::make_error_code(std::errc::permission_denied);
  if (!error) return path;
  return fail(FailureKind::usage, fmt::format("cannot write into {}: {}", path.string(), error.message()),
              "choose another folder with -o DIR");
}

}  // namespace calot
