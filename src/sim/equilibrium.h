#pragma once
// Static equilibrium of one organ against its bile, its bed, the shapes that touch it and the grips that hold
// it.
//
// Converged, everywhere: largest nodal residual / largest internal nodal force and last increment / organ's
// size both at most `tolerance` (a scenario's solver.tolerance), volume kept to 1e-10 of itself.

#include "sim/contact_search.h"

namespace calot {

/// No step takes a contact point nearer to a shape's core (contact_guard below it) than this share of its distance
/// before it.
inline constexpr double contact_keep = 0.2;

/// No equilibrium takes more Newton iterations, whatever its rounds: one that needs them is blocked.
inline constexpr int settle_iterations = 1000;

class BodyProblem : public BodyEnergy {
 public:
  /// `fixed_pressure`: the multiplier is prescribed and the volume free. Without contact of the skin with itself.
  BodyProblem(const ShellBody& body, const ContactLoads& loads, std::vector<ContactPair> pairs,
              const BodyState& start, bool fixed_pressure = false);
  /// With it. `search` finds the pairs, where they are asked for, and remembers what touches; it must outlive the
  /// problem.
  BodyProblem(const ShellBody& body, const ContactLoads& loads, ContactSearch& search, const BodyState& start,
              bool fixed_pressure = false);

  bool constrained() const override { return body_.bile().has_value() && !fixed_pressure_; }
  double value(const VecX& x) const override;
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const override;
  double constraint(const VecX& x, VecX& gradient) const override;
  double constraint_value(const VecX& x) const override;
  double gradient_and_constraint(const VecX& x, VecX& of_energy, double& largest_internal,
                                 VecX& of_constraint) const override;
  double constraint_scale() const override { return volume_; }
  double length_scale() const override { return body_.size(); }
  int places() const override { return body_.coarse_nodes(); }
  void prepare(NewtonWorkspace& work) const override;
  double safe_share(const VecX& x, const VecX& step) const override;

 private:
  /// How far any node, and so any skin point, is from where the solve began, m.
  double moved(const VecX& x) const;
  const std::vector<ContactPair>& pairs() const;
  const std::vector<Touch>& touching(const VecX& x) const;
  /// Gradient but for the bile's part.
  void add_dry_gradient(const VecX& x, VecX& gradient, double& largest_internal) const;
  /// Calls use(first coordinate, N/m) for the details that springs hold at rest.
  template <class Use>
  void for_held_details(const Use& use) const;
  const ShellBody& body_;
  const ContactLoads& loads_;
  mutable std::optional<std::vector<ContactPair>> pairs_;  ///< none: not looked for yet
  std::vector<Shape> cores_;                               ///< of the shapes: what no trial may reach
  VecX start_;
  double volume_, multiplier_;
  bool fixed_pressure_;
  ContactSearch* search_;
  mutable TouchMemory touches_;  ///< where no search remembers
};

/// Equilibrium under loads that stand still, however far from `state` it is: where a solve ends at the margin, the next
/// goes on from there with fresh pairs, always downhill. On failure `state` holds the last iterate. Counts of
/// all rounds.
NewtonResult settle(const ShellBody& body, const ContactLoads& loads, const NewtonSettings& settings,
                    NewtonWorkspace& work, ContactSearch& search, BodyState& state,
                    bool fixed_pressure = false, ExtensionScheme scheme = ExtensionScheme::condensed);

struct ContactForce {
  int shape = 0;
  int point = 0;                 ///< contact point
  Vec3 at = Vec3::Zero();        ///< its place, m
  Vec3 on_shape = Vec3::Zero();  ///< N, of the skin on the shape
};
/// One for each contact point in range.
std::vector<ContactForce> contact_forces(const ShellBody& body, const ContactLoads& loads,
                                         const std::vector<Touch>& touches);
std::vector<ContactForce> contact_forces(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                                         const std::vector<ContactPair>& pairs);
/// Hessian of a contact point's energy by its place, N/m.
Mat3 contact_hessian(const ShellBody& body, const ContactLoads& loads, const Touch& touch);

}  // namespace calot
