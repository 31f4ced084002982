#pragma once
// Stencil rows of a surface whose details changed, from those that it had: what an extension costs does not grow with
// the parts of the organ that it does not reach.

#include "skin/detail_basis.h"

namespace calot {

/// A surface's basis and the tree of its faces, to be changed into others.
struct DetailedSurface {
  DetailBasis basis;
  FaceTree tree;
};

class SharedRows {
 public:
  /// Both of the same levels; they must outlive this.
  SharedRows(const DetailedSurface& before, const DetailedSurface& now);

  /// Whether a coarse face is split alike in both and reached by the same details: then its rows are the same but for
  /// the numbers of their columns.
  bool same(int face) const { return same_[face] != 0; }
  /// What basis.evaluate(points, order) gives of the present basis. Point k, on a face that is the same, may have the
  /// row known[k] of `table`, a table of that order of the basis before; -1: not known.
  StencilTable rows(std::span<const FacePoint> points, int order, const StencilTable& table,
                    std::span<const int> known) const;

 private:
  /// Rows of the basis before, with its columns as those of the present one.
  void append(const StencilTable& from, int first, int last, StencilTable& to) const;

  const DetailBasis& basis_;
  std::vector<char> same_;
  std::vector<int> column_;  ///< of each one before; -1: gone
};

}  // namespace calot
