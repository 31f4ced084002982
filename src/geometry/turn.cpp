#include "geometry/turn.h"

#include <cmath>

#include "geometry/decompose.h"

namespace calot {

// As Eigen::umeyama, in whose instance for three rows gcc 12 sees an array's bound passed, wrongly.
Mat3 turned_about(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3(Mat3::Identity());
}

Mat3 best_turn(const Points3& from, const Points3& to) {
  const Vec3 from_middle = from.rowwise().mean(), to_middle = to.rowwise().mean();
  Mat3 together = Mat3::Zero();
  for (Eigen::Index i = 0; i < from.cols(); ++i)
    together += (to.col(i) - to_middle) * (from.col(i) - from_middle).transpose();
  Singular parts = singular(together);
  if ((parts.left * parts.right.transpose()).determinant() < 0)
    parts.left.col(2) *= -1;  // the least of the three
  return parts.left * parts.right.transpose();
}

Vec3 best_spin(const Points3& at, const Points3& motions) {
  constexpr double open = 1e-9;  // of the whole: what holds points on a line still about that line
  const Vec3 middle = at.rowwise().mean(), shift = motions.rowwise().mean();
  Mat3 products = Mat3::Zero();
  Vec3 moment = Vec3::Zero();
  for (Eigen::Index i = 0; i < at.cols(); ++i) {
    const Vec3 arm = at.col(i) - middle;
    products += arm * arm.transpose();
    moment += arm.cross(motions.col(i) - shift);
  }
  const double whole = products.trace();
  if (!(whole > 0)) return Vec3::Zero();
  return ((1 + open) * whole * Mat3::Identity() - products).ldlt().solve(moment);
}

double spread_of(const Points3& points) {
  const Vec3 middle = points.rowwise().mean();
  return std::sqrt((points.colwise() - middle).colwise().squaredNorm().mean());
}

}  // namespace calot
