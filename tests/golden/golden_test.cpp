// The test of the test: what the golden images are there to catch, they catch.

#include <gtest/gtest.h>

#include "golden/stored_goldens.h"

namespace calot {
namespace {

using test::expect_caught;
using test::Stored;

Image filled(const Image& like, unsigned char level) {
  Image image = like;
  std::fill(image.rgb.begin(), image.rgb.end(), level);
  return image;
}

Image shifted(const Image& image, int dx, int dy) {
  Image result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int from_x = std::clamp(x - dx, 0, image.width - 1),
                from_y = std::clamp(y - dy, 0, image.height - 1);
      for (int c = 0; c < 3; ++c) {
        result.rgb[3 * (y * image.width + x) + c] = image.rgb[3 * (from_y * image.width + from_x) + c];
      }
    }
  }
  return result;
}

TEST(Golden, EachFailsAgainstEveryOtherAgainstBlankAndShiftedByOnePixel) {
  const std::vector<Stored> goldens = test::stored_goldens();
  ASSERT_FALSE(goldens.empty()) << "accept some: calot golden accept grasp_and_traction";
  for (const Stored& stored : goldens) {
    EXPECT_TRUE(judge(stored.golden, stored.golden).passed);
    // Two pictures differ one way as the other.
    for (const Stored* other = &stored + 1; other != goldens.data() + goldens.size(); ++other)
      expect_caught(stored, other->golden.image, other->scenario + "/" + other->frame);
    expect_caught(stored, filled(stored.golden.image, 0), "a black frame");
    expect_caught(stored, filled(stored.golden.image, 255), "a white frame");
    expect_caught(stored, shifted(stored.golden.image, 1, 0), "a shift by one pixel to the right");
    expect_caught(stored, shifted(stored.golden.image, 0, 1), "a shift by one pixel down");
  }
}

}  // namespace
}  // namespace calot
