#include "render/jpeg.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cstdlib>

namespace calot {
namespace {

/// A soft picture of three different channels.
Image shades() {
  Image image{64, 48, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const int value : {4 * x, 5 * y, 128}) image.rgb.push_back(static_cast<unsigned char>(value));
  return image;
}

TEST(Jpeg, ReadsBackAsNearlyTheSamePicture) {
  const Image image = shades();
  const Result<std::string> bytes = jpeg_bytes(image, 80);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes.value(), jpeg_bytes(image, 80).value()) << "same picture, same bytes";
  EXPECT_LT(bytes->size(), image.rgb.size() / 4);
  std::vector<unsigned char> back(image.rgb.size());
  const tjhandle decoder = tjInitDecompress();
  const int failed = tjDecompress2(decoder, reinterpret_cast<const unsigned char*>(bytes->data()),
                                   bytes->size(), back.data(), image.width, 0, image.height, TJPF_RGB, 0);
  tjDestroy(decoder);
  ASSERT_EQ(failed, 0);
  double sum = 0;
  for (std::size_t i = 0; i < back.size(); ++i) sum += std::abs(back[i] - image.rgb[i]);
  EXPECT_LT(sum / static_cast<double>(back.size()), 3) << "of 255: what quality 80 leaves of a soft picture";
}

TEST(Jpeg, RefusesAPictureWhoseSizeDoesNotFit) {
  Image image = shades();
  image.height += 1;
  EXPECT_FALSE(jpeg_bytes(image, 80));
  EXPECT_FALSE(jpeg_bytes({}, 80));
}

}  // namespace
}  // namespace calot
