#pragma once
// The paper's two stages (section 5): the coarse structures first, then the extensions with their result as their
// boundary condition; their forces reach the coarse structure at the next solve only.

#include "group/group_problem.h"
#include "numerics/newton.h"

namespace calot {

/// A problem in some of its nodes: the others are held where they are.
class PartProblem : public ConstrainedEnergy {
 public:
  /// `free`: one a node.
  PartProblem(const ConstrainedEnergy& whole, std::vector<char> free)
      : whole_(whole), free_(std::move(free)) {}

  std::vector<Part> parts() const override { return whole_.parts(); }
  int constraints() const override { return whole_.constraints(); }
  double value(const VecX& x) const override { return whole_.value(x); }
  double cancelling() const override { return whole_.cancelling(); }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override;
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override;
  bool add_convexity(const VecX& x, BlockMatrix& matrix) const override;
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override;
  VecX constraint_values(const VecX& x) const override { return whole_.constraint_values(x); }
  VecX constraint_scales() const override { return whole_.constraint_scales(); }
  void prepare(NewtonWorkspace& work) const override { whole_.prepare(work); }
  double safe_share(const VecX& x, const VecX& step) const override { return whole_.safe_share(x, step); }
  double share_if_whole(const VecX& x, const VecX& step) const override {
    return whole_.share_if_whole(x, step);
  }

 private:
  const ConstrainedEnergy& whole_;
  std::vector<char> free_;
};

/// Solves each stage once. The first keeps the volumes; the second has its pressures, and frees the volumes. What the
/// extensions then press back on the coarse structure is left out of balance. The workspace is left without a factor.
NewtonResult solve_in_stages(std::span<const Member> members, std::span<const JoinPointer> joins,
                             GroupPatterns& patterns, const NewtonSettings& settings, NewtonWorkspace& work);

}  // namespace calot
