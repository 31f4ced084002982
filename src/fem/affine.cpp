#include "fem/affine.h"

#include <fmt/format.h>

#include <cmath>

#include "geometry/decompose.h"
#include "geometry/turn.h"

namespace calot {
namespace {

using Nodes = Eigen::Matrix<double, 3, AffineBody::nodes>;

/// Corners of a regular tetrahedron, of unit length: they sum to 0, their products v v' to 4/3.
Nodes regular_corners() {
  Nodes out;
  out << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  return out / std::sqrt(3.0);
}

Eigen::Map<const Nodes> columns(const AffineBody::Coordinates& x) {
  return Eigen::Map<const Nodes>(x.data());
}

}  // namespace

Result<AffineBody> AffineBody::create(const SolidMoments& solid, double stiffness) {
  constexpr double flattest = 1e-12;  // squared ratio of its widths that rounding would decide
  const auto refuse = [](const std::string& message, const std::string& hint) {
    return fail(FailureKind::scenario, message, hint);
  };
  if (!(stiffness > 0) || !std::isfinite(stiffness))
    return refuse(fmt::format("a rigid body cannot be {} Pa stiff", stiffness), "give it more than 0");
  if (!(solid.volume > 0) || !solid.centroid.allFinite() || !solid.second.allFinite())
    return refuse(fmt::format("a rigid body has no volume ({} m^3)", solid.volume),
                  "close its mesh, its triangles facing outward, and give it a size above 0");
  const Principal widths = principal(solid.second / solid.volume);
  if (!(widths.values[0] > flattest * widths.values[2]))
    return refuse("a rigid body is flat", "give it a thickness");
  AffineBody body;
  body.centroid_ = solid.centroid;
  body.volume_ = solid.volume;
  body.stiffness_ = stiffness;
  // Of these four equal masses the second moments are the body's: the products' sum is a third of 4.
  const double root = std::sqrt(3.0);
  const Nodes corners = regular_corners();
  const Vec3 lengths = widths.values.cwiseSqrt();
  const Mat3 square_root = widths.vectors * lengths.asDiagonal() * widths.vectors.transpose();
  const Mat3 inverse_root = widths.vectors * lengths.cwiseInverse().asDiagonal() * widths.vectors.transpose();
  const Nodes places = root * square_root * corners;
  body.slopes_ = 0.75 / root * inverse_root * corners;
  for (int k = 0; k < nodes; ++k) body.rest_[k] = solid.centroid + places.col(k);
  return body;
}

AffineBody::Coordinates AffineBody::placed(const Pose& motion) const {
  Coordinates x;
  for (int k = 0; k < nodes; ++k) x.segment<3>(3 * k) = motion * rest_[k];
  return x;
}

std::array<double, AffineBody::nodes> AffineBody::weights(const Vec3& point) const {
  std::array<double, nodes> out;
  for (int k = 0; k < nodes; ++k) out[k] = 0.25 + slopes_.col(k).dot(point - centroid_);
  return out;
}

StencilTable AffineBody::stencils(std::span<const Vec3> points, int first) const {
  StencilTable table;
  for (const Vec3& point : points) {
    const std::array<double, nodes> weight = weights(point);
    for (int k = 0; k < nodes; ++k) {
      table.node.push_back(first + k);
      table.value.push_back(weight[k]);
    }
    table.begin.push_back(static_cast<int>(table.node.size()));
  }
  return table;
}

Mat3 AffineBody::deformation(const Coordinates& x) const { return columns(x) * slopes_.transpose(); }

double AffineBody::value(const Coordinates& x) const {
  const Mat3 a = deformation(x), excess = a.transpose() * a - Mat3::Identity();
  return stiffness_ * volume_ * excess.squaredNorm();
}

AffineBody::Sample AffineBody::sample(const Coordinates& x) const {
  const Mat3 a = deformation(x), excess = a.transpose() * a - Mat3::Identity(), spread = a * a.transpose();
  const double scale = 4 * stiffness_ * volume_;
  const Nodes along = a * slopes_;
  const Nodes gradient = scale * a * excess * slopes_;
  Sample out;
  out.energy = stiffness_ * volume_ * excess.squaredNorm();
  out.gradient = Eigen::Map<const Coordinates>(gradient.data());
  for (int k = 0; k < nodes; ++k) {
    for (int l = 0; l < nodes; ++l) {
      const Vec3 other = slopes_.col(l);
      out.hessian.block<3, 3>(3 * k, 3 * l) =
          scale * (other.dot(excess * slopes_.col(k)) * Mat3::Identity() +
                   along.col(l) * along.col(k).transpose() + other.dot(slopes_.col(k)) * spread);
    }
  }
  return out;
}

Eigen::Matrix4d AffineBody::mass(const SolidMoments& solid, double density) const {
  const std::array<double, nodes> weight = weights(solid.centroid);
  const Eigen::Map<const Eigen::Vector4d> middle(weight.data());
  return density *
         (solid.volume * middle * middle.transpose() + slopes_.transpose() * solid.second * slopes_);
}

AffineBody::Coordinates AffineBody::curved(const Coordinates& x, const Coordinates& step) const {
  constexpr double least_turn = 1e-4;  // rad: what a straight way strains then is rounding
  const Mat3 turned = pose(x).linear();
  const Mat3 end = turned.transpose() * deformation(x + step);
  const Mat3 skew = 0.5 * (end - end.transpose()), stretch = 0.5 * (end + end.transpose());
  const Vec3 turn(skew(2, 1), skew(0, 2), skew(1, 0));
  if (turn.norm() < least_turn) return step;
  const Mat3 there = turned * turned_about(turn) * stretch;
  const Vec3 middle = columns(x + step).rowwise().mean();
  Coordinates out;
  for (int k = 0; k < nodes; ++k)
    out.segment<3>(3 * k) = middle + there * (rest_[k] - centroid_) - x.segment<3>(3 * k);
  return out;
}

Pose AffineBody::pose(const Coordinates& x) const {
  Nodes before;
  for (int k = 0; k < nodes; ++k) before.col(k) = rest_[k];
  const Nodes now = columns(x);
  Pose out = Pose::Identity();
  out.linear() = best_turn(before, now);
  out.translation() = Vec3(now.rowwise().mean()) - out.linear() * centroid_;
  return out;
}

double AffineBody::distortion(const Coordinates& x) const {
  const Mat3 a = deformation(x);
  return 0.5 * principal_values(a.transpose() * a - Mat3::Identity()).cwiseAbs().maxCoeff();
}

}  // namespace calot
