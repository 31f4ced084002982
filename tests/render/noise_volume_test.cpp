#include "render/noise_volume.h"

namespace calot {
namespace {

constexpr int n = noise_volume_size;

double at(const std::vector<unsigned char>& texels, int x, int y, int z, int channel) {
  const int wrapped = (((z + n) % n) * n + (y + n) % n) * n + (x + n) % n;
  return texels[4 * wrapped + channel] / 127.5 - 1;
}

TEST(NoiseVolume, StoredGradientIsTheValuesSlope) {
  const std::vector<unsigned char> texels = noise_volume();
  ASSERT_EQ(texels.size(), 4u * n * n * n);
  const double cells_a_texel = static_cast<double>(noise_volume_cells) / n;
  double error = 0, slope = 0;
  int count = 0;
  for (int z = -1; z < n; z += 5)  // -1: the seam too, where the pattern repeats
    for (int y = -1; y < n; y += 5)
      for (int x = -1; x < n; x += 5, ++count) {
        const double difference =
            (at(texels, x + 1, y, z, 3) - at(texels, x - 1, y, z, 3)) / (2 * cells_a_texel);
        const double stored = at(texels, x, y, z, 0) * noise_gradient_range;
        error += std::abs(difference - stored);
        slope += std::abs(stored);
      }
  // Differences over 0.4 cells flatten peaks, and 8 bits round: a tenth or so of the mean slope.
  EXPECT_LT(error, 0.2 * slope);
  EXPECT_GT(slope / count, 0.2);
}

TEST(NoiseVolume, HasNoBiasAndUsesItsRange) {
  const std::vector<unsigned char> texels = noise_volume();
  double sum = 0, largest = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const double value = texels[4 * i + 3] / 127.5 - 1;
    sum += value;
    largest = std::max(largest, std::abs(value));
  }
  // Gradients are hashed, so the mean of 1728 cells wanders by about 0.25 / sqrt(1728).
  EXPECT_NEAR(sum / (n * n * n), 0, 0.03);
  EXPECT_GT(largest, 0.6);
  EXPECT_LE(largest, 1.0);
}

}  // namespace
}  // namespace calot
