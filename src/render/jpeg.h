#pragma once
// JPEG of 8-bit RGB: a tenth of a PNG's size, for pictures that people look at and nothing is compared with.

#include <string>

#include "base/status.h"
#include "render/image.h"

namespace calot {

/// The bytes of the file; the same picture gives the same bytes. `quality` is 1 to 100. Fails (usage) where the picture's
/// size does not fit its bytes, (resource) where it cannot be coded.
Result<std::string> jpeg_bytes(const Image& image, int quality);

}  // namespace calot
