#pragma once
// Static condensation (Guyan 1965, doi 10.2514/3.2874): unknowns inside a substructure are eliminated, what stays is
// the Schur complement on the kept ones. A structural extension is condensed onto the coarse nodes so, and a whole
// organ onto its interface (the paper, section 7).

#include <Eigen/Cholesky>
#include <vector>

#include "numerics/cholesky.h"

namespace calot {

/// Nodes 0 .. kept - 1 of a block matrix are kept, the others condensed in groups that are not coupled with each
/// other.
class Condensation {
 public:
  Condensation(const BlockMatrix& pattern, int kept);

  /// Eliminates the condensed unknowns of a matrix of the analysed pattern, whose values must be finite.
  /// Not positive definite: some group is not.
  FactorStatus eliminate(const BlockMatrix& matrix);
  /// The Schur complement, 3 kept x 3 kept, lower triangle.
  const Eigen::MatrixXd& condensed() const { return condensed_; }

  /// Loads on all unknowns (3 a node) as loads on the kept ones.
  VecX reduce(const VecX& right) const;
  /// All unknowns under loads `right`, from the kept ones.
  VecX expand(const VecX& right, const VecX& kept) const;

  /// Kept nodes that each group is coupled with, increasing: afterwards these are coupled with each other.
  std::vector<std::vector<int>> outer_nodes() const;

  int groups() const { return static_cast<int>(groups_.size()); }
  double flops() const;   ///< of one elimination
  long nonzeros() const;  ///< of the groups' factors
  /// Smallest and largest pivot of the groups' Cholesky factors; empty groups: 1, 1.
  double smallest_pivot() const, largest_pivot() const;

 private:
  struct Group {
    std::vector<int> inner, outer;  ///< scalar unknowns, increasing: condensed, and the kept ones they meet
    Eigen::MatrixXd stiffness;      ///< inner x inner, lower
    Eigen::MatrixXd coupling;       ///< inner x outer; after elimination L^-1 times it
    Eigen::LLT<Eigen::MatrixXd> factor;
  };
  void find_groups(const BlockMatrix& pattern);
  void gather(const BlockMatrix& matrix);

  int kept_ = 0;  ///< scalar unknowns
  std::vector<Group> groups_;
  std::vector<int> group_of_, place_in_;  ///< of each condensed scalar unknown
  Eigen::MatrixXd condensed_;
};

}  // namespace calot
