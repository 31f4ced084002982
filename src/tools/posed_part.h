#pragma once
// An instrument's parts as functions of its pose, where the pose is unknown: places of their points, and any function of a
// point that a part carries along (its distance, a spring, friction), with first and second derivatives.
//
// A pose is a product of five motions, from the trocar on: pitch, yaw, insertion, roll, and the jaw's half angle about the
// hinge. The derivative of a point that the part carries by one of them is the twist's velocity there, u_i = w_i x p + v_i;
// the second one by i and j, i nearer to the trocar, is w_i x u_j. Seen from the part a point that stays moves the other
// way, and the order turns round.

#include "tools/tool.h"

namespace calot {

/// A tool's unknowns: two nodes of a group, (pitch, yaw, insertion | roll, jaw, spare), all in m: the angles times the
/// levers below. Nothing depends on the spare one but the spring that holds it.
using ToolVector = Eigen::Matrix<double, 6, 1>;
using ToolMatrix = Eigen::Matrix<double, 6, 6>;
inline constexpr int tool_nodes = 2;

/// What an angle is multiplied by, m: about the way that points of the tool go when it turns, so that all unknowns are of
/// one size. For pitch and yaw, for roll, and for the angle between the jaws, of which each turns half.
inline constexpr double turn_lever = 150e-3, roll_lever = 10e-3, jaw_lever = 10e-3;

ToolVector tool_coordinates(const InstrumentPose& pose);  ///< m, the spare one 0
InstrumentPose pose_at(const ToolVector& q);

/// By a point in the world and the tool's unknowns, in this order.
using PointAndTool = Eigen::Matrix<double, 9, 1>;
using PointAndToolMatrix = Eigen::Matrix<double, 9, 9>;

/// A part (0 shaft, 1 and 2 the jaws, or what a rod ends in) at a pose.
class PosedPart {
 public:
  PosedPart(const Tool& tool, const InstrumentPose& pose, int part);

  const Pose& frame() const { return frame_; }  ///< to the world: the jaw's, or the hinge's

  /// Derivatives by the tool's unknowns of a place p (m, in the world) that the part carries.
  Eigen::Matrix<double, 3, 6> slopes(const Vec3& p) const;
  /// Sum of force[k] times the second derivatives of its coordinate k; symmetric.
  ToolMatrix curvature(const Vec3& p, const Vec3& force) const;

  /// Derivatives of a function that the part carries along, f(x, q) = local(frame^-1 x), where its gradient by x and its
  /// Hessian by x are these.
  PointAndTool carried_gradient(const Vec3& x, const Vec3& gradient) const;
  PointAndToolMatrix carried_hessian(const Vec3& x, const Vec3& gradient, const Mat3& hessian) const;

 private:
  Pose frame_;
  Eigen::Matrix<double, 3, 6> turns_, shifts_;  ///< w and v of each unknown's twist, columns
};

/// The signed distance of x from the part's shape grown by `grown` (m; negative: shrunk), by x and the tool's unknowns.
struct CarriedDistance {
  double distance = 0;  ///< m
  PointAndTool gradient = PointAndTool::Zero();
  PointAndToolMatrix hessian = PointAndToolMatrix::Zero();  ///< 1/m; jumps where distance_hessian() does
};
CarriedDistance carried_distance(const Tool& tool, const InstrumentPose& pose, int part, double grown,
                                 const Vec3& x);

}  // namespace calot
