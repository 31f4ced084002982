#pragma once
// Linear springs between surface points and places: an organ's bed, a grip. Any surface point may be held,
// through its weights, never a control node.

#include <algorithm>
#include <array>
#include <span>

#include "base/workers.h"
#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// 1/2 stiffness |surface point - target|^2 a link.
struct Links {
  std::vector<int> row;           ///< of the stencil table
  std::vector<Vec3> target;       ///< m
  std::vector<double> stiffness;  ///< N/m

  double value(const StencilTable& table, const VecX& x) const;
  void add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const;
  void add_hessian(const StencilTable& table, BlockMatrix& matrix) const;
};

/// Adds weight_a weight_b h to every node pair of row r.
void add_point_hessian(const StencilTable& table, int r, const Mat3& h, BlockMatrix& matrix);

/// A point by its row of a table whose first node is the matrix' `first_node`.
struct StencilPoint {
  const StencilTable* table = nullptr;  ///< null: none
  int row = 0, first_node = 0;
};

/// Columns of every `of`-th node, from node `first` on: what one of several threads adds.
struct ColumnShare {
  int first = 0, of = 1;
  bool has(int node) const { return node % of == first; }
};

/// Adds a Hessian by up to four points to their nodes' pairs by all their weights, in the columns of `share`. Couplings that the pattern does not
/// hold are left out: then false.
bool add_points_hessian(const std::array<StencilPoint, 4>& points,
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix,
                        const ColumnShare& share = {});
/// The same with points of one table (`rows`, unused ones negative).
bool add_points_hessian(const StencilTable& table, const std::array<int, 4>& rows,
                        const Eigen::Matrix<double, 12, 12>& hessian, BlockMatrix& matrix,
                        const ColumnShare& share = {});
/// Rows of one table (unused ones negative) as points.
std::array<StencilPoint, 4> points_of(const StencilTable& table, const std::array<int, 4>& rows);

/// Adds `count` Hessians in their order by add(k, share), which says whether the pattern holds all that the k-th one
/// couples. `workers` take columns of their own, so that the bits are the same. Whether it holds what all of them couple.
template <class Add>
bool add_in_columns(Workers* workers, std::size_t count, const Add& add) {
  constexpr std::size_t few = 8;
  constexpr int most = 4;  // what each share does for itself is a tenth of the whole
  const int shares = workers == nullptr || count < few ? 1 : most;
  std::array<char, most> complete;
  complete.fill(1);
  for_each_chunk(workers, shares, [&](int share) {
    for (std::size_t k = 0; k < count; ++k)
      if (!add(k, ColumnShare{share, shares})) complete[static_cast<std::size_t>(share)] = 0;
  });
  return std::find(complete.begin(), complete.end(), 0) == complete.end();
}

/// A Hessian by up to four points, N/m.
struct PointsStiffness {
  std::array<StencilPoint, 4> points;
  Eigen::Matrix<double, 12, 12> matrix;
};
/// Adds them all in their order; whether the pattern holds what they couple.
bool add_all(std::span<const PointsStiffness> all, Workers* workers, BlockMatrix& matrix);

}  // namespace calot
