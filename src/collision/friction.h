#pragma once
// Coulomb friction of a point on a shape as a lagged dissipative potential (Incremental Potential Contact, Li
// et al. 2020, section 5, doi 10.1145/3386569.3392425). As motion is quasi-static it is a function of place,
// not of velocity: the point is tied to where it stuck by a tangential spring that gives way at Coulomb's
// limit. The mollifier is therefore quadratic up to limit / stiffness and linear beyond (Huber's): with one
// stiffness for all pressures a rising pressure adds no energy to what is strained already, as a mollifier of
// fixed width would, so a cycle can only lose energy.

#include "geometry/state_members.h"
#include "geometry/types.h"

namespace calot {

struct FrictionSample {
  double energy = 0;             ///< J
  Vec3 gradient = Vec3::Zero();  ///< N; minus the friction force on the point
  Mat3 hessian = Mat3::Zero();   ///< N/m, positive semidefinite
};

/// One point's hold. Limit and normal are lagged: constants of the potential.
struct StickSlip {
  Vec3 anchor = Vec3::Zero();   ///< m, where the spring pulls to, carried by the shape
  Vec3 normal = Vec3::UnitZ();  ///< unit, of the shape: only motion across it rubs
  double limit = 0;             ///< N, coefficient times normal force
  double stiffness = 0;         ///< N/m, > 0

  /// With u the part of x - anchor across the normal: energy stiffness / 2 u^2 while that pulls by at most
  /// the limit, then limit (|u| - reach / 2), reach = limit / stiffness. C1; the force never exceeds the
  /// limit. The Hessian jumps at the reach, where sliding begins.
  FrictionSample sample(const Vec3& x) const;
  /// Where the anchor is once the point has come to x: unmoved while it sticks; slid along behind it, at
  /// reach (to 1e-9), where the limit was passed (return mapping). The force at x does not change by it.
  Vec3 anchor_after(const Vec3& x) const;
  /// Anchor and normal moved rigidly.
  StickSlip carried(const Pose& motion) const;
};
void visit_members(auto&& visit, MembersOf<StickSlip> auto& hold) {
  auto& [anchor, normal, limit, stiffness] = hold;
  visit(anchor, normal, limit, stiffness);
}

}  // namespace calot
