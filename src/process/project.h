#pragma once
// Where the project's files are: scenarios, Lua modules, assets, goldens.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"

namespace calot {

/// The nearest of the current folder and its parents that holds scenarios/ and scripts/lua/; without one, the
/// folder that this program was built from.
std::filesystem::path project_folder();

/// Why the present folder lies in no project, so that project_folder() is another one; none where it lies in one.
std::optional<std::string> no_project_here();

/// Says once, on stderr, whose scenarios and goldens a command is about where the present folder lies in no project.
void tell_borrowed_project();
/// The same, but only where scenarios/ is here, so that whoever runs the command may believe that this is a project.
void tell_half_project();

/// A file or folder that every project has, such as "assets": the project's own, or the one that came with
/// this program.
std::filesystem::path project_part(const std::string& name);

/// Every scenario of the project (scenarios/**/*.lua), sorted.
std::vector<std::filesystem::path> project_scenarios();

/// Every file with that extension (".lua") below a folder, sorted; hidden folders are left out.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::string& extension);

/// What one of them is called: its path below scenarios/ without ".lua", such as "paper/figure_4".
std::string scenario_name(const std::filesystem::path& file);

/// What is wrong with a path that should be a scenario's file, with the nearest one that exists.
std::optional<Failure> check_scenario_path(const std::string& path);

/// The whole text of a file. Fails (usage) where it cannot be read or has more than `most` bytes.
Result<std::string> read_text(const std::filesystem::path& path, std::size_t most = std::size_t{64} << 20);
/// Fails (usage) where it cannot be written; a file that was there is then left as it was. The value is the path.
/// `part`: where it is until it is whole, a name of the writer's own where several may write at once; empty: the path
/// with ".part".
Result<std::string> write_text(const std::filesystem::path& path, const std::string& text,
                               std::filesystem::path part = {});
/// Makes a folder and its parents. Fails (usage) where it cannot be made or written to.
Result<std::filesystem::path> make_folder(const std::filesystem::path& path);

}  // namespace calot
