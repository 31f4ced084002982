#pragma once
// PNG files of 8-bit RGB: the same picture gives the same bytes (no time stamp, fixed compression).

#include <string>

#include "base/status.h"
#include "render/image.h"

namespace calot {

/// Writes to a temporary name beside `path` and renames it, so that an interrupted run leaves the old file
/// whole. Failures (usage): the picture's size does not fit its bytes, or the file cannot be written.
Result<std::string> write_png(const std::string& path, const Image& image);

/// Any PNG, brought to 8-bit RGB (alpha dropped). Failures (usage): not readable, not a PNG, broken, or too
/// large.
Result<Image> read_png(const std::string& path);

}  // namespace calot
