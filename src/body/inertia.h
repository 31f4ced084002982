#pragma once
// How bodies move where time counts: each part of a motion is a step of implicit Euler, which makes the incremental
// potential stationary: elastic energies, asked by their retardation ahead, loads, contact, and
// 1 / (2 h^2) (x - x0 - h v)' M (x - x0 - h v) of wall and liquid.

#include "body/body.h"
#include "fem/nodal_mass.h"
#include "numerics/retardation.h"

namespace calot {

/// A body slower than this acceleration (m/s^2, a millionth of gravity's) makes it in a part, at both ends of that,
/// stands still: what swings is not slow twice.
inline constexpr double rest_acceleration = 1e-5;

/// How the body moves at its state. Velocities are exactly zero where it stands still, or no part of a motion has ended.
LiquidMotion present_motion(const Body& body, const BodyState& state);

bool stands_still(const LiquidMotion& motion);

/// A part of a motion that begins so. Fails (simulation) where the skin is too coarse to tell how the liquid flows.
Result<MotionPart> motion_part(const Body& body, const LiquidMotion& begin, double duration);

/// A body's own energies and the inertia of its wall and liquid, in one part of a motion.
class Inertia {
 public:
  /// In the part state.motion, whose duration is not 0, with a time of retardation, s. The body must outlive it.
  Inertia(const Body& body, const BodyState& state, double retardation);
  Inertia(const Inertia&) = delete;
  Inertia& operator=(const Inertia&) = delete;

  /// Energies of body and wall, J; not finite where x is not admissible.
  double value(const VecX& x) const;
  /// Adds the gradient, N; returns the largest nodal force of the body or of the wall's inertia.
  double add_gradient(const VecX& x, VecX& gradient) const;
  /// The Hessian but for the liquid's, N/m; the matrix' values are overwritten.
  void hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const;
  /// Null: the body is not filled.
  const LiquidMass* liquid() const { return liquid_ ? &*liquid_ : nullptr; }
  /// How many compliant constraints a body's has.
  static int constraints(const Body& body) { return body.liquid() != nullptr ? LiquidMass::constraints : 0; }
  /// Of these where nothing else asks for others.
  VecX multipliers(const VecX& x) const;

 private:
  const Body& body_;
  VecX begin_, predicted_;
  double by_time_squared_;  ///< 1 / h^2
  Retardation retarded_;
  BlockMatrix constant_;           ///< of the Hessian, over its factor
  std::optional<NodalMass> mass_;  ///< none: the solid is weightless
  std::optional<LiquidMass> liquid_;
};

}  // namespace calot
