#pragma once
// The inertia of a liquid in a closed surface, for one implicit Euler step.

#include "fem/bile.h"
#include "fem/potential_flow.h"
#include "geometry/state_members.h"

namespace calot {

/// How a liquid moves.
struct LiquidMotion {
  VecX x;                        ///< of the surface's nodes, m
  VecX velocity;                 ///< of these, m/s
  Vec3 centroid = Vec3::Zero();  ///< velocity of the liquid's centroid, m/s: as centroid_velocity() gave it
};
void visit_members(auto&& visit, MembersOf<LiquidMotion> auto& motion) {
  auto& [x, velocity, centroid] = motion;
  visit(x, velocity, centroid);
}

/// A step of h seconds minimises, beside all other energies, the liquid's
///
///   mass / (2 h^2) |c(x) - chat|^2 + density / (2 h^2) |modes' (x - xhat)|^2,   chat = c(x0) + h centroid velocity,
///                                                                              xhat = x0 + h velocity,
///
/// c its centroid: the whole mass moves with that, the flow beside it by its modes at the beginning of the step. Both
/// are constraints with a compliance (see ConstrainedEnergy), the centroid's first. The volume must be kept by one of
/// its own: the centroid is the first moment's share of the kept volume.
///
/// The modes are linear; the centroid's Hessian is that of a weight (N/m^3) which weight() tells of the multipliers:
/// minus density times acceleration. Give the sum of both weights to Bile::add_hessian(), of gravity alone to the loads.
class LiquidMass {
 public:
  static constexpr int constraints = 3 + FlowModes::count;

  /// `bile`, which must outlive it, holds `volume`, m^3, of `density`, kg/m^3.
  LiquidMass(const Bile& bile, FlowModes modes, double density, double volume, const LiquidMotion& start,
             double h);

  /// 15, m and m^(5/2).
  VecX constraint_values(const VecX& x) const;
  /// A column each, 3 rows a node.
  Eigen::MatrixXd constraint_gradients(const VecX& x) const;
  VecX compliances() const;
  VecX constraint_scales() const;  ///< of the liquid's size
  /// From its multipliers, N/m^3, the way it pulls.
  Vec3 weight(const Eigen::Ref<const VecX>& multipliers) const { return multipliers.head<3>() / volume_; }

  double mass() const { return density_ * volume_; }  ///< kg
  /// After a step to x, m/s.
  Vec3 centroid_velocity(const VecX& x) const { return (centroid(x) - begin_) / h_; }
  /// J, of nodal velocities and the centroid's.
  double kinetic_energy(const VecX& velocity, const Vec3& of_centroid) const;

 private:
  Vec3 centroid(const VecX& x) const { return bile_.moments(x).first / volume_; }

  const Bile& bile_;
  FlowModes modes_;
  double density_, volume_, h_;
  Vec3 begin_;  ///< the centroid, from the datum
  Vec3 predicted_centroid_;
  VecX predicted_flow_;
};

}  // namespace calot
