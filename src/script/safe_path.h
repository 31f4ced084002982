#pragma once
// Scenarios name files only below folders that are theirs.

#include <filesystem>

namespace calot {

/// True when the existing `path`, with all links followed, lies below `folder`, with all links followed.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace calot
