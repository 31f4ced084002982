#include "collision/simplex_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/parted_motion.h"

namespace calot {
namespace {

/// Edge vectors from the first corner and the inverse of their products.
struct Edges {
  std::array<Vec3, 2> edge{Vec3::Zero(), Vec3::Zero()};
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();  ///< zero where there is no edge
  bool span = true;

  explicit Edges(std::span<const Vec3> corners) {
    constexpr double flattest = 1e-12;  // squared sine of an angle that rounding would decide
    if (corners.size() < 2) return;
    edge[0] = corners[1] - corners[0];
    const double aa = edge[0].squaredNorm();
    span = aa > 0;
    if (corners.size() == 2) {
      inverse(0, 0) = 1 / aa;
      return;
    }
    edge[1] = corners[2] - corners[0];
    const double ab = edge[0].dot(edge[1]), bb = edge[1].squaredNorm(), det = aa * bb - ab * ab;
    span = det > flattest * aa * bb;
    inverse << bb / det, -ab / det, -ab / det, aa / det;
  }
};

FlatSample sample_with(const Vec3& p, std::span<const Vec3> corners, const Edges& edges) {
  const Vec3 from = p - corners[0];
  const Eigen::Vector2d along =
      edges.inverse * Eigen::Vector2d(edges.edge[0].dot(from), edges.edge[1].dot(from));
  const Vec3 arm = from - along[0] * edges.edge[0] - along[1] * edges.edge[1];
  FlatSample out;
  out.distance = arm.norm();
  if (out.distance > 0) out.normal = arm / out.distance;
  out.weight = {1, along[0] + along[1] - 1, -along[0], -along[1]};
  return out;
}

}  // namespace

FlatSample sample_flat(const Vec3& p, std::span<const Vec3> corners) {
  return sample_with(p, corners, Edges(corners));
}

NearestPoint nearest_point(const Vec3& p, std::span<const Vec3> corners) {
  const Edges edges(corners);
  const int count = static_cast<int>(corners.size());
  if (edges.span) {
    const FlatSample flat = sample_with(p, corners, edges);
    NearestPoint out{{}, flat.distance};
    bool between = true;
    for (int k = 0; k < count; ++k) {
      out.weight[k] = -flat.weight[k + 1];
      between &= count == 1 || out.weight[k] > 0;
    }
    if (between) return out;
  }
  NearestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (int left_out = count - 1; left_out >= 0; --left_out) {
    std::array<Vec3, 3> side;
    int n = 0;
    for (int k = 0; k < count; ++k)
      if (k != left_out) side[n++] = corners[k];
    const NearestPoint there = nearest_point(p, std::span<const Vec3>(side.data(), n));
    if (there.distance >= best.distance) continue;
    best.distance = there.distance;
    n = 0;
    for (int k = 0; k < count; ++k) best.weight[k] = k == left_out ? 0 : there.weight[n++];
  }
  return best;
}

// With f = 1/2 distance^2 and the weights s of the edges, which minimise it, the Hessian of the least value is
// f_xx - f_xs f_ss^-1 f_sx, and distance * hessian(distance) = hessian(f) - gradient gradient'.
Eigen::Matrix<double, 12, 12> flat_hessian(std::span<const Vec3> corners, const FlatSample& sample) {
  using Columns = Eigen::Matrix<double, 12, 2>;
  const Edges edges(corners);
  const Vec3 arm = sample.distance * sample.normal;
  Columns mixed = Columns::Zero();  // f_xs
  for (int i = 0; i + 1 < static_cast<int>(corners.size()); ++i) {
    for (int k = 0; k < 4; ++k) mixed.col(i).segment<3>(3 * k) = -sample.weight[k] * edges.edge[i];
    mixed.col(i).segment<3>(3) += arm;
    mixed.col(i).segment<3>(6 + 3 * i) -= arm;
  }
  Eigen::Matrix<double, 12, 12> out = -mixed * edges.inverse * mixed.transpose();
  const Mat3 across = Mat3::Identity() - sample.normal * sample.normal.transpose();
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) out.block<3, 3>(3 * a, 3 * b) += sample.weight[a] * sample.weight[b] * across;
  return out / sample.distance;
}

double safe_share(const Vec3& p, const Vec3& motion, std::span<const Vec3> corners,
                  std::span<const Vec3> corner_motions, double keep, double thickness) {
  constexpr int max_steps = 256;
  std::array<Vec3, 3> now;
  return safe_share_of(
      {{&p, 1}, {&motion, 1}}, {corners, corner_motions}, keep, max_steps,
      [&](double share) -> Parting {
        const Vec3 at = p + share * motion;
        Vec3 arm = at;
        for (std::size_t k = 0; k < corners.size(); ++k) now[k] = corners[k] + share * corner_motions[k];
        const NearestPoint nearest = nearest_point(at, std::span<const Vec3>(now.data(), corners.size()));
        for (std::size_t k = 0; k < corners.size(); ++k) arm -= nearest.weight[k] * now[k];
        return {nearest.distance, arm / nearest.distance};
      },
      thickness);
}

}  // namespace calot
