#pragma once
// What Newton's method keeps from one solve to the next.

#include "numerics/border.h"
#include "numerics/sharp_terms.h"

namespace calot {

struct NewtonWorkspace {
  /// Nodes whose `kept` is 0 may be condensed onto the others; an empty one keeps all.
  explicit NewtonWorkspace(BlockMatrix pattern, std::span<const char> kept = {})
      : matrix(std::move(pattern)), factor(matrix, kept) {}
  /// `coarse` nodes first, those of extensions after them.
  NewtonWorkspace(BlockMatrix pattern, int coarse) : matrix(std::move(pattern)), factor(matrix, coarse) {}
  BlockMatrix matrix;
  Cholesky factor;
  Border border;  ///< of the factor
  bool factored = false;
  bool shifted =
      false;  ///< the factor is of a matrix that was made positive definite: no use for chord steps

  std::vector<SharpTangent> sharp;  ///< in the matrix that the factor is of

  /// All that later solves depend on: the matrix' values are written anew by each. Cheap to copy, as the factor is
  /// shared until the next one is made.
  struct Kept {
    BlockMatrix pattern;
    Cholesky factor;
    Border border;
    bool factored, shifted;
    std::vector<SharpTangent> sharp;
  };
  Kept keep() const { return {matrix.pattern_only(), factor, border, factored, shifted, sharp}; }
  void restore(const Kept& kept);
};
/// All that later solves depend on; the factor by the matrix that it is of.
void visit_members(auto&& visit, const NewtonWorkspace& work) {
  const auto& [matrix, factor, border, factored, shifted, sharp] = work;
  visit(matrix, factor.kept(), factored, shifted);
  if (factored) visit(border, factor.factorised(), sharp);
}
void visit_members(MemberReader& read, NewtonWorkspace& work);

}  // namespace calot
