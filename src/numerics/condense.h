#pragma once
// Static condensation (Guyan 1965, doi 10.2514/3.2874): unknowns inside a substructure are eliminated, what stays is
// the Schur complement on the kept ones. A structural extension is condensed onto the coarse nodes so, a strand's
// middle and a rod's inside onto what they are tied to, and a whole organ onto its interface (the paper, section 7).

#include <span>
#include <vector>

#include "numerics/cholesky.h"
#include "numerics/envelope.h"

namespace calot {

/// Some nodes of a block matrix are kept, the others condensed in pieces that are not coupled with each other. Kept
/// nodes are numbered among themselves, in the matrix' order.
class Condensation {
 public:
  /// `kept`, of each node: 0 where it is condensed.
  Condensation(const BlockMatrix& pattern, std::span<const char> kept);

  /// Room for another elimination of the same pattern.
  Condensation blank() const;

  /// Kept nodes that each kept node is coupled with once the others are condensed, increasing.
  std::vector<std::vector<int>> kept_couplings() const;
  /// Eliminates the condensed unknowns of a matrix of the analysed pattern, whose values must be finite, and loads the
  /// Schur complement into `kept`, a factor of kept_couplings(). Not positive definite: some piece is not.
  FactorStatus eliminate(const BlockMatrix& matrix, EnvelopeFactor& kept, Workers* workers = nullptr);

  /// Loads on all unknowns (3 a node) as loads on the kept ones.
  template <class Columns>
  Columns reduce(const Columns& right) const;
  /// L^-1 of the loads of 1 on each unknown of `nodes`, increasing: a column each, as loads on the kept ones; to `gram`
  /// the product of what of it lies in the pieces with itself is added.
  Eigen::MatrixXd reduce_units(std::span<const int> nodes, Eigen::MatrixXd& gram) const;
  /// All unknowns under loads `right`, from the kept ones.
  template <class Columns>
  Columns expand(const Columns& right, const Columns& kept) const;

  int pieces() const { return static_cast<int>(layout_->pieces.size()); }
  double flops() const;   ///< of one elimination
  long nonzeros() const;  ///< of the pieces' factors
  /// Smallest and largest pivot of the pieces' Cholesky factors; no pieces: infinity, 0.
  double smallest_pivot() const, largest_pivot() const;

 private:
  /// A block of the matrix from entry `from` on, whose entry (r, c) goes to values_[to + r * by_row + c * by_column].
  struct Move {
    int from, stride;
    Eigen::Index to, by_row, by_column;
  };
  /// Nodes that are eliminated at once. Most often they are coupled with each other; single ones that meet the same
  /// kept nodes (strands between the same two faces) share their product too, but each has a 3 x 3 factor of its own.
  struct Piece {
    bool single = false;
    std::vector<int> inner,
        outer;  ///< increasing: condensed nodes, and the kept ones they meet, in their numbers
    /// Offsets in values_. Factor: inner x inner, lower; single: 3 x inner, a block each. Coupling: inner x outer,
    /// after elimination L^-1 times it; single: its transpose. `size` of both.
    Eigen::Index factor = 0, coupling = 0, size = 0;
    Eigen::Index product = 0;  ///< offset in products_
    std::vector<Move> moves;   ///< where its values come from

    Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(inner.size()); }
    Eigen::Index meets() const { return 3 * static_cast<Eigen::Index>(outer.size()); }
  };
  /// A block between kept nodes i and j in their numbers.
  struct KeptBlock {
    int from, stride, i, j;
  };
  /// What does not change with the values: shared by copies.
  struct Layout {
    std::vector<int> kept;  ///< nodes, increasing
    std::vector<Piece> pieces;
    std::vector<KeptBlock> kept_blocks;
    Eigen::Index size = 0, products = 0;  ///< of values_ and products_
  };
  explicit Condensation(std::shared_ptr<const Layout> layout) : layout_(std::move(layout)) {}
  static void find_pieces(const BlockMatrix& pattern, const std::vector<int>& number, Layout& layout);
  static void lay_out(const BlockMatrix& pattern, const std::vector<int>& number, Layout& layout);
  void gather(const Piece& piece, const BlockMatrix& matrix);
  /// Its factor and coupling of what was gathered, and `product`, what it takes from the kept ones; false: it is not
  /// positive definite.
  bool eliminate(const Piece& piece, double* product);
  bool eliminate_coupled(const Piece& piece, double* product);
  bool eliminate_single(const Piece& piece, double* product);
  /// x := L^-1 x, L'^-1 x.
  template <class Columns>
  void solve_lower(const Piece& piece, Columns& x) const;
  template <class Columns>
  void solve_upper(const Piece& piece, Columns& x) const;
  /// Of L^-1 loads in a piece what reaches the kept ones is added to those.
  template <class Columns>
  void pass_on(const Piece& piece, const Columns& inner, Columns& kept) const;
  double pivot(const Piece& piece, Eigen::Index i) const;

  std::shared_ptr<const Layout> layout_;
  VecX values_;    ///< of the pieces; at the bounds that Eigen's sums go by
  VecX products_;  ///< workspace of pieces that are eliminated at once
};

}  // namespace calot
