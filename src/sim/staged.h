#pragma once
// The paper's two stages (section 5): the coarse structure first, then the extensions with its result as their
// boundary condition; their forces reach the coarse structure at the next solve only.

#include <functional>
#include <memory>

#include "sim/shell_body.h"

namespace calot {

/// A problem in part of its nodes, first .. last - 1: the others are held where they are.
class PartProblem : public BodyEnergy {
 public:
  PartProblem(const BodyEnergy& whole, int first, int last) : whole_(whole), first_(first), last_(last) {}

  bool constrained() const override { return whole_.constrained(); }
  double value(const VecX& x) const override { return whole_.value(x); }
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const override;
  double constraint(const VecX& x, VecX& gradient) const override;
  double constraint_value(const VecX& x) const override { return whole_.constraint_value(x); }
  double constraint_scale() const override { return whole_.constraint_scale(); }
  double length_scale() const override { return whole_.length_scale(); }
  int places() const override { return whole_.places(); }
  void prepare(NewtonWorkspace& work) const override { whole_.prepare(work); }
  double safe_share(const VecX& x, const VecX& step) const override { return whole_.safe_share(x, step); }

 private:
  /// Zero at the held nodes.
  void keep_free(VecX& v) const;

  const BodyEnergy& whole_;
  int first_, last_;
};

/// A problem in the whole body from a state on, its pressure fixed (and its volume free) or not.
using StagedProblem = std::function<std::unique_ptr<BodyEnergy>(const BodyState& start, bool fixed_pressure)>;

/// Both stages once. The volume is the coarse stage's, whose pressure the second one takes over; what is left out
/// of balance is what the extensions pass back. The workspace is left without a factor.
NewtonResult solve_in_stages(const ShellBody& body, const StagedProblem& problem,
                             const NewtonSettings& settings, NewtonWorkspace& work, BodyState& state);

}  // namespace calot
