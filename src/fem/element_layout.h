#pragma once
// Faces share one way to hold their nodes, so that element matrices of shell and bile add into the same
// blocks.

#include <vector>

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// Nodes that one face may blend: 12, some more beside a vertex of high valence, and those of the finer levels
/// that reach it.
inline constexpr int max_face_nodes = 96;

/// The nodes that the rows of one face (quadrature or skin points) blend, and dense weights for them.
struct FaceNodes {
  std::vector<int> nodes;  ///< increasing
  int padded = 0;          ///< length of a row of weights over them, zero filled

  /// Takes in the nodes of row r of a table; padded follows: their number, rounded up to a multiple of 4.
  void add_row(const StencilTable& table, int r);
  int count() const { return static_cast<int>(nodes.size()); }
};

/// Rows of `table` that belong to each face, in order: `face_of_row[r]` in [0, faces).
std::vector<FaceNodes> gather_faces(const StencilTable& table, const std::vector<int>& face_of_row,
                                    int faces);

/// Weights of row r over the face's nodes: padded entries.
void dense_weights(const StencilTable& table, const std::vector<double>& weights, int r,
                   const FaceNodes& face, double* out);

/// Pairs of components (c, d), c <= d, in the order in which an element matrix keeps them.
inline constexpr int component_pairs[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

/// Symmetric element matrix over a face's nodes, kept by component pairs (xx, xy, xz, yy, yz, zz): K[cd](b,
/// a) at cd * padded^2 + b * padded + a couples component c of node b with component d of node a.
class ElementMatrix {
 public:
  /// Zero, for rows of `padded` weights, a multiple of 4.
  void reset(int padded);
  /// K_cd += W' Q, c <= d the components of `pair`: W has `rows` rows of weights of length padded, Q the same of what
  /// they are coupled with. K must come out symmetric where c = d: of these the half a >= b is computed.
  void add(int pair, int rows, const double* weights, const double* products);
  /// Takes memory for rows of `padded` weights: how many bytes they fill.
  std::size_t reserve(int padded);
  void scatter(const FaceNodes& face, BlockMatrix& matrix) const { scatter(face, matrix, 0, matrix.nodes()); }
  /// The block columns first .. last - 1 only.
  void scatter(const FaceNodes& face, BlockMatrix& matrix, int first, int last) const;
  int padded() const { return padded_; }

 private:
  int padded_ = 0;
  std::vector<double> values_;
};

}  // namespace calot
