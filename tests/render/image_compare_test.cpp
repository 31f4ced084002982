#include "render/image_compare.h"

#include "base/rng.h"

namespace calot {
namespace {

Image grey(int width, int height, unsigned char value) {
  return {width, height, std::vector<unsigned char>(static_cast<std::size_t>(3) * width * height, value)};
}

void put(Image& image, int x, int y, int channel, int value) {
  image.rgb[3 * (y * image.width + x) + channel] = static_cast<unsigned char>(value);
}

ImageDifference difference(const Image& a, const Image& b, const CompareTolerance& tolerance = {}) {
  Result<ImageDifference> result = compare(a, b, tolerance);
  EXPECT_TRUE(result);
  return std::move(result).value();
}

TEST(ImageCompare, ZeroOnItself) {
  Rng rng(3);
  Image image = grey(50, 40, 0);
  for (unsigned char& byte : image.rgb) byte = static_cast<unsigned char>(rng.next());
  const ImageDifference d = difference(image, image);
  EXPECT_EQ(d.differing_pixels, 0);
  EXPECT_EQ(d.largest_blob, 0);
  EXPECT_EQ(d.max_delta, 0);
  EXPECT_TRUE(d.within);
}

TEST(ImageCompare, SymmetricInItsNumbers) {
  Rng rng(5);
  Image a = grey(30, 30, 100), b = a;
  for (int i = 0; i < 200; ++i)
    put(rng.uniform() < 0.5 ? a : b, static_cast<int>(rng.next() % 30), static_cast<int>(rng.next() % 30),
        static_cast<int>(rng.next() % 3), static_cast<int>(rng.next() % 256));
  const CompareTolerance tolerance{4, 0, 60, 0};
  const ImageDifference ab = difference(a, b, tolerance), ba = difference(b, a, tolerance);
  EXPECT_EQ(ab.differing_pixels, ba.differing_pixels);
  EXPECT_EQ(ab.largest_blob, ba.largest_blob);
  EXPECT_EQ(ab.max_delta, ba.max_delta);
  EXPECT_GT(ab.largest_blob, 1);  // else the blob was not tried
}

TEST(ImageCompare, ExactByDefault) {
  const Image a = grey(20, 20, 50);
  for (int channel = 0; channel < 3; ++channel) {
    Image b = a;
    put(b, 19, 0, channel, 51);
    const ImageDifference d = difference(a, b);
    EXPECT_EQ(d.differing_pixels, 1);
    EXPECT_EQ(d.max_delta, 1);
    EXPECT_FALSE(d.within);
  }
}

TEST(ImageCompare, CountsPixelsAboveTheSmallDeltaOnly) {
  const Image a = grey(20, 20, 50);
  Image b = a;
  put(b, 1, 1, 0, 53);
  put(b, 1, 1, 1, 30);  // the same pixel: counted once
  put(b, 5, 5, 2, 52);
  EXPECT_EQ(difference(a, b, {1, 0, 255, 0}).differing_pixels, 2);
  EXPECT_EQ(difference(a, b, {2, 0, 255, 0}).differing_pixels, 1);
  EXPECT_FALSE(difference(a, b, {2, 0, 255, 0}).within);
  EXPECT_TRUE(difference(a, b, {2, 1, 255, 0}).within);
}

TEST(ImageCompare, BlobsConnectAcrossCornersAndNotAcrossGaps) {
  const Image a = grey(40, 30, 10);
  Image b = a;
  for (int i = 0; i < 7; ++i) put(b, 5 + i, 8 + i, 1, 200);   // a diagonal: 7 pixels
  for (int i = 0; i < 5; ++i) put(b, 20 + 2 * i, 3, 1, 200);  // single pixels with gaps
  const ImageDifference d = difference(a, b, {0, 1000, 100, 6});
  EXPECT_EQ(d.largest_blob, 7);
  EXPECT_EQ(d.blob_x, 5);
  EXPECT_EQ(d.blob_y, 8);
  EXPECT_EQ(d.blob_width, 7);
  EXPECT_EQ(d.blob_height, 7);
  EXPECT_FALSE(d.within);
  EXPECT_TRUE(difference(a, b, {0, 1000, 100, 7}).within);
}

TEST(ImageCompare, ASmallPatchIsFoundThoughFewPixelsDiffer) {
  // A vanished clip: 6 x 6 pixels, while noise of 1 covers far more of the picture.
  Image a = grey(200, 100, 40), b = a;
  for (int i = 0; i < 100; ++i) put(b, 2 * i, 50, 0, 41);
  for (int y = 70; y < 76; ++y)
    for (int x = 120; x < 126; ++x) put(b, x, y, 0, 100);
  const ImageDifference d = difference(a, b, {1, 500, 20, 10});
  EXPECT_EQ(d.largest_blob, 36);
  EXPECT_EQ(d.differing_pixels, 36);
  EXPECT_FALSE(d.within);
}

TEST(ImageCompare, BlobsDoNotWrapAroundRows) {
  const Image a = grey(10, 10, 0);
  Image b = a;
  put(b, 9, 4, 0, 255);
  put(b, 0, 5, 0, 255);
  EXPECT_EQ(difference(a, b).largest_blob, 1);
}

TEST(ImageCompare, DifferentSizesAreRefused) { EXPECT_FALSE(compare(grey(10, 10, 0), grey(10, 11, 0))); }

TEST(ImageCompare, ThePictureMarksWhatDiffersAndNothingElse) {
  const Image a = grey(10, 10, 90);
  Image b = a;
  put(b, 3, 4, 2, 91);
  const Image picture = difference(a, b).picture;
  for (int i = 0; i < 100; ++i) {
    const bool marked = picture.rgb[3 * i] == 255 && picture.rgb[3 * i + 2] == 0;
    EXPECT_EQ(marked, i == 43);
  }
}

}  // namespace
}  // namespace calot
