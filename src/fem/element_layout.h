#pragma once
// Faces share one way to hold their nodes, so that element matrices of shell and bile add into the same
// blocks.

#include <vector>

#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// The nodes that the rows of one face (quadrature or skin points) blend, and dense weights for them.
/// Nodes that one face may blend: 12, some more beside a vertex of high valence, and those of the finer levels
/// that reach it.
inline constexpr int max_face_nodes = 96;

struct FaceNodes {
  std::vector<int> nodes;  ///< increasing
  int padded = 0;          ///< length of a row of weights over them, zero filled

  /// Sorts the nodes, drops repeats and sets padded: the next of 4, 8, 12, 16, 20, 24, 32, 40, 64, 96; above
  /// these the number of nodes itself, which no element takes.
  void finish();
};

/// Rows of `table` that belong to each face, in order: `face_of_row[r]` in [0, faces).
std::vector<FaceNodes> gather_faces(const StencilTable& table, const std::vector<int>& face_of_row,
                                    int faces);

/// Weights of row r over the face's nodes: padded entries.
void dense_weights(const StencilTable& table, const std::vector<double>& weights, int r,
                   const FaceNodes& face, double* out);

/// Symmetric element matrix over a face's nodes, kept by component pairs (xx, xy, xz, yy, yz, zz): K[cd](b,
/// a) at cd * padded^2 + b * padded + a couples component c of node b with component d of node a.
class ElementMatrix {
 public:
  void reset(int padded);
  /// K_cd += sum over rows k, l of W_k^T h(k, l)_cd W_l; `h` is 3 rows x 3 rows, symmetric; `weights` rows of
  /// length padded.
  template <int Rows>
  void add(const double* weights, const Eigen::Matrix<double, 3 * Rows, 3 * Rows>& h);
  void scatter(const FaceNodes& face, BlockMatrix& matrix) const;

 private:
  template <int Rows, int Padded>
  void add_sized(const double* weights, const Eigen::Matrix<double, 3 * Rows, 3 * Rows>& h);

  int padded_ = 0;
  std::vector<double> values_;
};

/// Sizes known to the compiler: the inner loops run over nodes and vectorise without reordering any sum.
template <int Rows, int Padded>
void ElementMatrix::add_sized(const double* weights, const Eigen::Matrix<double, 3 * Rows, 3 * Rows>& h) {
  double product[Rows][Padded];
  double* target = values_.data();
  for (int c = 0; c < 3; ++c) {
    for (int d = c; d < 3; ++d, target += Padded * Padded) {
      // product(k, a) = sum_l h(3k + c, 3l + d) W(l, a)
      for (int k = 0; k < Rows; ++k) {
        for (int a = 0; a < Padded; ++a) product[k][a] = 0;
        for (int l = 0; l < Rows; ++l) {
          const double value = h(3 * k + c, 3 * l + d);
          for (int a = 0; a < Padded; ++a) product[k][a] += value * weights[l * Padded + a];
        }
      }
      for (int b = 0; b < Padded; ++b) {
        double row[Padded];
        for (int a = 0; a < Padded; ++a) row[a] = target[b * Padded + a];
        for (int k = 0; k < Rows; ++k) {
          const double w = weights[k * Padded + b];
          for (int a = 0; a < Padded; ++a) row[a] += w * product[k][a];
        }
        for (int a = 0; a < Padded; ++a) target[b * Padded + a] = row[a];
      }
    }
  }
}

template <int Rows>
void ElementMatrix::add(const double* weights, const Eigen::Matrix<double, 3 * Rows, 3 * Rows>& h) {
  switch (padded_) {
    case 4:
      return add_sized<Rows, 4>(weights, h);
    case 8:
      return add_sized<Rows, 8>(weights, h);
    case 12:
      return add_sized<Rows, 12>(weights, h);
    case 16:
      return add_sized<Rows, 16>(weights, h);
    case 20:
      return add_sized<Rows, 20>(weights, h);
    case 24:
      return add_sized<Rows, 24>(weights, h);
    case 32:
      return add_sized<Rows, 32>(weights, h);
    case 40:
      return add_sized<Rows, 40>(weights, h);
    case 64:
      return add_sized<Rows, 64>(weights, h);
    default:
      return add_sized<Rows, max_face_nodes>(weights, h);
  }
}

}  // namespace calot
