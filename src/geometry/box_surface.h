#pragma once
// The surface of a box of cells as triangles, each quadrangle cut from its least to its greatest corner, whatever the
// box is bent into.

#include "geometry/stencil.h"

namespace calot {

/// One cell thick in its third way, so that every corner of a cell is on the surface.
struct BoxSurface {
  std::array<int, 2> cells{1, 1};

  std::array<int, 3> all_cells() const { return {cells[0], cells[1], 1}; }
  int points() const { return 2 * (cells[0] + 1) * (cells[1] + 1); }
  int point(const std::array<int, 3>& at) const {
    return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
  }
  /// Counter-clockwise seen from outside where the three ways are right-handed.
  std::vector<Triangle> triangles() const;
  /// Of a place on the surface, in cells: on the first of the sides that it is on.
  FacePoint place(const Vec3& at) const;
  /// Whether a triangle is on the side where `way` is at its beginning (`end` 0) or end (1).
  bool on_side(int triangle, int way, int end) const;

 private:
  int first_face(int way, int end) const;
};

}  // namespace calot
