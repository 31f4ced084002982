#pragma once
// Surfaces with fewer triangles, for pictures that a processor draws: most of their time goes into points (measured,
// tests/bench/frame_bench.cpp), and triangles smaller than a pixel of theirs show nothing.

#include <vector>

#include "render/scene.h"

namespace calot {

struct CoarseMesh {
  SceneMesh mesh;
  std::vector<int> kept;  ///< points of the finer one, one a position; for surfaces that move
};

/// Points are left out, none is moved, as long as the surface departs from the fine one by less than `most_error` (m)
/// and at least the share `least` of its triangles stays: a surface that will bend needs more of them than its rest
/// shape. Per point: positions (or rest positions, where there are none), normals and burns where there are.
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
