#pragma once
// Two pictures held against each other, in absolute terms: endoscopic frames are dark, so relative measures
// and means hide what matters (a vanished clip moves a mean less than rounding noise does).

#include "base/status.h"
#include "render/image.h"

namespace calot {

/// Differences are per pixel: the largest of the three channels' |a - b|, 0 to 255. The default is exact
/// equality.
struct CompareTolerance {
  int small_delta = 0;       ///< a pixel counts as differing above this
  int differing_pixels = 0;  ///< so many may differ
  int large_delta = 0;       ///< a pixel belongs to a blob above this
  int blob_pixels = 0;       ///< the largest connected blob (8 neighbours) may have so many pixels
};

struct ImageDifference {
  int differing_pixels = 0;  ///< above small_delta
  int largest_blob = 0;      ///< pixels of the largest connected set above large_delta
  int blob_x = 0, blob_y = 0, blob_width = 0, blob_height = 0;  ///< its bounding box, px from the top left
  int max_delta = 0;                                            ///< 0 to 255
  bool within = true;                                           ///< both numbers within the tolerance
  Image picture;  ///< for a report: `b` dimmed and grey, differences in red to yellow by size
};

/// Fails (usage) when the sizes differ.
Result<ImageDifference> compare(const Image& a, const Image& b, const CompareTolerance& tolerance = {});

}  // namespace calot
