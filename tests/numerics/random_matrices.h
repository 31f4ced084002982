#pragma once
// Random symmetric matrices of 3x3 blocks.

#include "support/derivatives.h"

namespace calot::test {

inline Mat3 random_block(Rng& rng) {
  Mat3 block;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) block(r, c) = rng.uniform(-1, 1);
  return block;
}

/// A ring with some chords; entries of order one, symmetric diagonal blocks.
inline BlockMatrix random_matrix(Rng& rng, int nodes) {
  std::vector<std::vector<int>> cliques;
  for (int i = 0; i < nodes; ++i) cliques.push_back({i, (i + 1) % nodes, (i * i + 3) % nodes});
  BlockMatrix matrix(nodes, cliques);
  for (int j = 0; j < nodes; ++j)
    for (int i = j; i < nodes; ++i) {
      if (matrix.slot(i, j) < 0) continue;
      const Mat3 block = random_block(rng);
      matrix.add(i, j, i == j ? Mat3(block + block.transpose()) : block);
    }
  return matrix;
}

/// The same made positive definite: its diagonal outweighs every row.
inline BlockMatrix random_positive(Rng& rng, int nodes) {
  BlockMatrix matrix = random_matrix(rng, nodes);
  matrix.add_to_diagonal(1.0 + dense(matrix).cwiseAbs().rowwise().sum().maxCoeff());
  return matrix;
}

}  // namespace calot::test
