#pragma once
// The one noise behind all procedural tissue patterns: cheaper to look up than to compute in a shader.

#include <vector>

namespace calot {

inline constexpr int noise_volume_size = 64;         ///< texels a side
inline constexpr int noise_volume_cells = 12;        ///< lattice cells a side; the pattern repeats after them
inline constexpr double noise_gradient_range = 2.5;  ///< a stored gradient of +-1 means so much a cell

/// Gradient noise (Perlin 2002: quintic fade, gradients towards the edges of a cube) on a lattice hashed by
/// integers. RGBA, 8 bits, periodic: rgb the gradient over its range, a the value, all mapped from [-1, 1].
std::vector<unsigned char> noise_volume();

}  // namespace calot
