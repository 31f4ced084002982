#include "render/noise_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace calot {
namespace {

constexpr int cells = noise_volume_cells;

struct Lattice {
  std::array<std::array<float, 3>, cells * cells * cells> gradient;
};

std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

Lattice make_lattice() {
  static constexpr float edges[12][3] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},
                                         {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                                         {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}};
  Lattice lattice;
  for (int i = 0; i < cells * cells * cells; ++i) {
    const float* edge = edges[scramble(static_cast<std::uint32_t>(i) + 1) % 12];
    lattice.gradient[i] = {edge[0], edge[1], edge[2]};
  }
  return lattice;
}

/// Cell, offset and fades of one axis; the same for every texel of a row.
struct AxisSample {
  int cell[2];
  float offset, fade, slope;
};

std::array<AxisSample, noise_volume_size> axis_samples() {
  std::array<AxisSample, noise_volume_size> axis;
  for (int i = 0; i < noise_volume_size; ++i) {
    const float at = (static_cast<float>(i) + 0.5f) * cells / noise_volume_size;
    const int cell = static_cast<int>(at);
    const float t = at - static_cast<float>(cell);
    axis[i] = {
        {cell, (cell + 1) % cells}, t, t * t * t * (t * (t * 6 - 15) + 10), 30 * t * t * (t - 1) * (t - 1)};
  }
  return axis;
}

/// Gradient in [0..2], value in [3].
std::array<float, 4> sample(const Lattice& lattice, const AxisSample& x, const AxisSample& y,
                            const AxisSample& z) {
  std::array<float, 4> sum{};
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const auto& g = lattice.gradient[(z.cell[k] * cells + y.cell[j]) * cells + x.cell[i]];
    const float wx = i ? x.fade : 1 - x.fade, wy = j ? y.fade : 1 - y.fade, wz = k ? z.fade : 1 - z.fade;
    const float dot = g[0] * (x.offset - static_cast<float>(i)) + g[1] * (y.offset - static_cast<float>(j)) +
                      g[2] * (z.offset - static_cast<float>(k));
    const float w = wx * wy * wz;
    sum[0] += w * g[0] + (i ? x.slope : -x.slope) * wy * wz * dot;
    sum[1] += w * g[1] + (j ? y.slope : -y.slope) * wx * wz * dot;
    sum[2] += w * g[2] + (k ? z.slope : -z.slope) * wx * wy * dot;
    sum[3] += w * dot;
  }
  return sum;
}

unsigned char pack(float value) {
  return static_cast<unsigned char>(std::lround(127.5f * (std::clamp(value, -1.0f, 1.0f) + 1.0f)));
}

}  // namespace

std::vector<unsigned char> noise_volume() {
  const Lattice lattice = make_lattice();
  const auto axis = axis_samples();
  std::vector<unsigned char> texels;
  texels.reserve(4u * noise_volume_size * noise_volume_size * noise_volume_size);
  for (const AxisSample& z : axis)
    for (const AxisSample& y : axis)
      for (const AxisSample& x : axis) {
        const std::array<float, 4> s = sample(lattice, x, y, z);
        for (int c = 0; c < 3; ++c) texels.push_back(pack(s[c] / static_cast<float>(noise_gradient_range)));
        texels.push_back(pack(s[3]));
      }
  return texels;
}

}  // namespace calot
