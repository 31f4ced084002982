#pragma once
// Surfaces with fewer triangles, for pictures that a processor draws: a third of their time goes into points that are denser
// than pixels (tests/bench/frame_bench.cpp: frame/live beside frame/live_full).

#include <vector>

#include "render/scene.h"

namespace calot {

/// How finely surfaces are laid out. Coarse ones are for pictures of live quality (render/offscreen.h).
enum class SceneDetail { full, coarse };

struct CoarseMesh {
  SceneMesh mesh;
  std::vector<int> kept;  ///< points of the finer one, one a position; for surfaces that move
};

/// Points are left out, none is moved, as long as the surface departs from the fine one by less than `most_error` (m; in the
/// library's measure, a mean over the triangles that meet at a point: single points by up to four times that) and at least
/// the share `least` of its triangles stays: a surface that will bend needs more of them than its rest shape. Per point:
/// positions (or rest positions, where there are none), normals and burns where there are.
CoarseMesh coarser(const SceneMesh& fine, double most_error, double least);

/// The entries of `values` that `kept` names.
template <class T>
std::vector<T> entries(const std::vector<T>& values, const std::vector<int>& kept) {
  std::vector<T> out;
  out.reserve(kept.size());
  for (const int k : kept) out.push_back(values[static_cast<std::size_t>(k)]);
  return out;
}

}  // namespace calot
