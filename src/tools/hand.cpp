#include "tools/hand.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

/// A tip that is hardly in is held as if it were this deep, m: in the trocar itself a turn would not move it.
constexpr double least_depth = 30e-3;
/// The jaws' stops: 20 N at the jaws' lever press 0.05 mm into them. N/m^2, of energy stop_stiffness way^3.
constexpr double stop_stiffness = 2.7e9;

/// How a spring that gives way answers to the way u.
struct Yielding {
  double energy, pull, bend;  ///< J; gradient = pull u; hessian = pull I - bend u u'
};
Yielding yielding(double stiffness, double force, double squared_way) {
  const double squared_share = squared_way * (stiffness / force) * (stiffness / force);
  const double root = std::sqrt(1 + squared_share);
  const double pull = stiffness / root;
  return {stiffness * squared_way / (1 + root), pull,
          pull / (root * root) * (stiffness / force) * (stiffness / force)};
}

void add_spring(const ToolVector& by, double way, double stiffness, double force, Hand::Sample& out) {
  const Yielding y = yielding(stiffness, force, way * way);
  out.energy += y.energy;
  out.gradient += y.pull * way * by;
  out.hessian += (y.pull - y.bend * way * way) * by * by.transpose();
}

}  // namespace

HandStrength hand_of(const Tool& tool) {
  HandStrength out;
  out.force = tool.definition.hand_force;
  out.pinch = tool.definition.pinch_force;
  if (tool.geometry.has_jaws()) out.pad_lever = 0.5 * tool.geometry.jaw_length;
  return out;
}

Hand::Hand(const Tool& tool, const InstrumentPose& command, const HandStrength& strength)
    : command_(command),
      strength_(strength),
      goal_(tool_coordinates(command)),
      gap_(strength.pad_lever / jaw_lever),
      has_jaws_(tool.geometry.has_jaws()),
      open_(tool.geometry.jaw_opening * jaw_lever) {
  const double depth =
      std::max(least_depth, (tip_position(tool.trocar, command, tool.geometry) - tool.trocar).norm());
  tip_ways_ = {depth * std::cos(command.yaw) / turn_lever, depth / turn_lever, 1.0};
}

Hand::Sample Hand::sample(const ToolVector& q) const {
  const ToolVector behind = lag(q);
  Sample out;
  const Vec3 tip = tip_ways_.cwiseProduct(behind.head<3>());
  const Yielding y = yielding(strength_.stiffness, strength_.force, tip.squaredNorm());
  out.energy = y.energy;
  out.gradient.head<3>() = y.pull * tip_ways_.cwiseProduct(tip);
  const Mat3 by_tip = y.pull * Mat3::Identity() - y.bend * tip * tip.transpose();
  out.hessian.topLeftCorner<3, 3>() = tip_ways_.asDiagonal() * by_tip * tip_ways_.asDiagonal();

  const double roll = strength_.roll_arm / roll_lever;
  add_spring(roll * ToolVector::Unit(3), roll * behind[3], strength_.stiffness, strength_.force, out);
  add_spring(gap_ * ToolVector::Unit(4), gap_ * behind[4], strength_.stiffness, strength_.pinch, out);
  if (has_jaws_) {
    const double way = std::min(q[4], 0.0) + std::max(q[4] - open_, 0.0), deep = std::abs(way);
    out.energy += stop_stiffness * deep * deep * deep;
    out.gradient[4] += 3 * stop_stiffness * deep * way;
    out.hessian(4, 4) += 6 * stop_stiffness * deep;
  }
  out.energy += 0.5 * strength_.stiffness * behind[5] * behind[5];
  out.gradient[5] = strength_.stiffness * behind[5];
  out.hessian(5, 5) = strength_.stiffness;
  return out;
}

Hand::Effort Hand::effort(const ToolVector& q) const {
  const ToolVector behind = lag(q);
  const Vec3 tip = tip_ways_.cwiseProduct(behind.head<3>());
  const auto force = [&](double way, double most) {
    return yielding(strength_.stiffness, most, way * way).pull * way;
  };
  return {force(tip.norm(), strength_.force),
          -strength_.roll_arm * force(strength_.roll_arm / roll_lever * behind[3], strength_.force),
          force(gap_ * behind[4], strength_.pinch)};
}

}  // namespace calot
