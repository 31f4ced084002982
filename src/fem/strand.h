#pragma once
// A strand of connective tissue: a thread from a place a by way of a node of its own, m, to a place b. It has one strain,
// that of its whole way, and one damage, so what pulls on it anywhere pulls on all of it; a hook under it carries it.
//
// Slack it resists nothing; taut it stiffens exponentially up to its strength; then its tension falls in a straight line
// to nothing, and the area under the curve is its break energy (a cohesive law, so that many strands tear at a force that
// does not depend on how many they are, nor on how finely time is cut). What it was opened to once stays: less stretched,
// its tension is the elastic one less its damage. That grows between solves only; within one it is as if it had grown.

#include <algorithm>

#include "base/status.h"
#include "geometry/state_members.h"

namespace calot {

using StrandVector = Eigen::Matrix<double, 9, 1>;  ///< of a, m and b
using StrandMatrix = Eigen::Matrix<double, 9, 9>;

/// How far a strand has been opened, and how quickly it may tear.
struct StrandPast {
  double opened = 0;  ///< the largest strain so far
  /// tearing_delay over the seconds that pass in the solve; 0: tearing takes no time.
  double delay = 0;
};

/// The growth of damage is viscous: a strand that is being torn resists with (1 + this time times its strain's rate over
/// the strain in which it tears) its tension, s. A peel at 20 mm/s takes some 5 % more force than a slow one.
inline constexpr double tearing_delay = 5e-3;
/// Tension falls over no less strain than this: else strands would tear by leaps, at a force that depends on their number.
inline constexpr double least_tail = 0.5;

/// Tension over the whole way of a strand.
class StrandLaw {
 public:
  struct Setup {
    double taut = 2e-3;          ///< m, the way at which it begins to resist
    double length = 2e-3;        ///< m: (way - taut) / length is its strain
    double stiffness = 0.04;     ///< N a strain, as it becomes taut
    double stiffening = 1.5;     ///< exponent a strain; 0: it does not stiffen
    double strength = 0.12;      ///< N, its largest tension
    double break_energy = 5e-4;  ///< J, to pull it from slack until it is torn
  };
  /// Fails (scenario) where the break energy leaves no tail of at least_tail.
  static Result<StrandLaw> create(const Setup& setup);
  /// J that a strand takes at least.
  static double least_break_energy(const Setup& setup);

  struct Sample {
    double energy = 0;     ///< J
    double tension = 0;    ///< N
    double stiffness = 0;  ///< N/m
  };
  Sample sample(double way, const StrandPast& past) const;
  double strain(double way) const { return (way - setup_.taut) / setup_.length; }
  /// Its present tension, N a strain of what is not torn of it: damage as a share of 1.
  double damage(double opened) const { return 1 - intact(opened); }
  bool torn(double opened) const { return opened >= peak_ + tail_; }
  /// Strains at which its tension is largest, and over which that falls.
  double peak() const { return peak_; }
  double tail() const { return tail_; }
  const Setup& setup() const { return setup_; }

 private:
  /// Elastic energy over the length, N; tension, N; its slope, N a strain.
  static Sample elastic(const Setup& setup, double strain);
  static double strain_at_strength(const Setup& setup);
  double intact(double opened) const;

  Setup setup_;
  double peak_ = 0, tail_ = 0;
};
void visit_members(auto&& visit, MembersOf<StrandLaw::Setup> auto& setup) {
  auto& [taut, length, stiffness, stiffening, strength, break_energy] = setup;
  visit(taut, length, stiffness, stiffening, strength, break_energy);
}
void visit_members(auto&& visit, const StrandLaw& law) { visit(law.setup()); }
void visit_members(MemberReader& read, StrandLaw& law);

/// The whole strand. Beside its tension a weak spring centres its node between the places: slack it would float, and
/// along a straight one it would slip freely. Torn it hangs by that spring at a.
struct Strand {
  StrandLaw law;

  /// m; a way's corners are rounded by a thousandth of the length, so that it has a slope everywhere.
  double way(const StrandVector& places) const;
  double value(const StrandVector& places, const StrandPast& past) const;           ///< J
  StrandVector gradient(const StrandVector& places, const StrandPast& past) const;  ///< N
  StrandMatrix hessian(const StrandVector& places, const StrandPast& past) const;   ///< N/m
  /// N/m by the square of its way's slope: added to the Hessian of a strand that softens this makes it positive
  /// semidefinite. 0: it is.
  double convexity(const StrandVector& places, const StrandPast& past) const {
    return std::max(0.0, -law.sample(way(places), past).stiffness);
  }
  StrandVector slope(const StrandVector& places) const;  ///< of way()
  double tension(const StrandVector& places, const StrandPast& past) const {
    return law.sample(way(places), past).tension;
  }
  double centring() const;  ///< N/m
};
void visit_members(auto&& visit, MembersOf<Strand> auto& strand) {
  auto& [law] = strand;
  visit(law);
}

}  // namespace calot
