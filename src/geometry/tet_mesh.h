#pragma once
// Quadratic tetrahedra that fill a box of cells, whatever the box is bent into.

#include "geometry/stencil.h"

namespace calot {

/// Four corners, then the middles of the edges 01, 12, 20, 03, 13, 23.
using QuadraticTet = std::array<int, 10>;

/// A box of `cells` along its three ways, each six tetrahedra around the diagonal from its least to its greatest
/// corner, so that its faces are cut along theirs. Points stand at every half of a cell.
struct TetGrid {
  std::array<int, 3> cells{1, 1, 1};

  std::array<int, 3> points_along() const { return {2 * cells[0] + 1, 2 * cells[1] + 1, 2 * cells[2] + 1}; }
  int points() const {
    const std::array<int, 3> n = points_along();
    return n[0] * n[1] * n[2];
  }
  int point(const std::array<int, 3>& at) const {
    const std::array<int, 3> n = points_along();
    return at[0] + n[0] * (at[1] + n[1] * at[2]);
  }
  std::array<int, 3> place(int point) const {
    const std::array<int, 3> n = points_along();
    return {point % n[0], point / n[0] % n[1], point / n[0] / n[1]};
  }
  bool on_surface(int point) const;
  /// Those of one cell follow each other; cells run fastest along the first way.
  std::vector<QuadraticTet> tets() const;
  std::array<int, 3> cell_of(int tet) const {
    return {tet / 6 % cells[0], tet / 6 / cells[0] % cells[1], tet / 6 / cells[0] / cells[1]};
  }
};

/// Rows for all points of the grid from those of its surface (`of_surface`, by the grid's points; others are not read):
/// points inside are evenly spread along the third way between the two sides that it leads to.
StencilTable fill_by_surface(const TetGrid& grid,
                             const std::vector<std::vector<std::pair<int, double>>>& of_surface);

}  // namespace calot
