#pragma once

#include <vector>

namespace calot {

struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;  ///< 3 bytes a pixel, rows from the top
};

}  // namespace calot
