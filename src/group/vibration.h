#pragma once
// Small vibrations of an organ about its equilibrium: the licence for statics (the paper, section 4: shaken
// below a third of its lowest natural frequency, a structure may be treated as static).

#include "body/shell_body.h"
#include "group/equilibrium.h"

namespace calot {

/// Share of the lowest natural frequency below which shaking may be treated as static (the paper, section 4).
inline constexpr double static_share = 1.0 / 3.0;
/// Density of the wall, kg/m^3: that of soft tissue (liver: 1050 to 1060).
inline constexpr double wall_density = 1050;

/// Mass of an organ's wall and bile at a state, as it resists accelerations of the control nodes.
///
/// The bile is ideal (see PotentialFlow): as motions finer than its harmonics feel too little of it, a frequency found
/// with it is an upper bound, close where the motion is a sway.
class BodyMass {
 public:
  /// `bile_density` in kg/m^3; the wall has wall_density.
  BodyMass(const ShellBody& body, const VecX& x, double wall_thickness, double bile_density);
  /// Mass times a nodal motion: N at 1 m/s^2, 3 a node.
  VecX multiply(const VecX& motion) const;
  double wall() const { return wall_; }  ///< kg

 private:
  const ShellBody& body_;
  std::vector<double> row_mass_;  ///< kg, of each quadrature point
  double wall_ = 0, bile_density_ = 0;
  Eigen::MatrixXd flow_;     ///< column k: h_k integrated with each node's normal motion, m^3 or more
  Eigen::MatrixXd kinetic_;  ///< its Cholesky factor, lower triangle
};

/// Lowest natural frequency, Hz, of the organ in `field` at its present state: the smallest w of K v = w^2 M v among
/// motions v that keep the volume to first order. Fails (simulation) where K is not positive definite on these: the
/// state is not stable.
Result<double> lowest_frequency(const ShellBody& body, const ContactLoads& loads, const BodyState& state,
                                const BodyMass& mass);

}  // namespace calot
