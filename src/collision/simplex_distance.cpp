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

  explicit Edges(std::span<const Vec3> corners) {
    if (corners.size() < 2) return;
    edge[0] = corners[1] - corners[0];
    const double aa = edge[0].squaredNorm();
    if (corners.size() == 2) {
      inverse(0, 0) = 1 / aa;
      return;
    }
    edge[1] = corners[2] - corners[0];
    const double ab = edge[0].dot(edge[1]), bb = edge[1].squaredNorm(), det = aa * bb - ab * ab;
    inverse << bb / det, -ab / det, -ab / det, aa / det;
  }
};

}  // namespace

FlatSample sample_flat(const Vec3& p, std::span<const Vec3> corners) {
  const Edges edges(corners);
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

namespace {

NearestPoint at_weights(const Vec3& from_first, const Vec3& ab, const Vec3& ac, double b, double c) {
  return {{1 - b - c, b, c}, (from_first - b * ab - c * ac).norm()};
}

/// Share of the way `along` that is nearest to the place `from` its beginning: 0 to 1.
double share_along(const Vec3& along, const Vec3& from) {
  const double way = along.dot(from), all = along.squaredNorm();
  if (!(way > 0)) return 0;
  return way < all ? way / all : 1;
}

NearestPoint nearest_of_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return at_weights(p - a, b - a, Vec3::Zero(), share_along(b - a, p - a), 0);
}

/// Of a triangle's sides.
NearestPoint nearest_of_sides(const Vec3& p, std::span<const Vec3> corners) {
  NearestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const NearestPoint side = nearest_of_segment(p, corners[k], corners[next]);
    if (side.distance >= best.distance) continue;
    best = {{}, side.distance};
    best.weight[k] = side.weight[0];
    best.weight[next] = side.weight[1];
  }
  return best;
}

/// By the regions about a triangle in which a corner, a side or its inside is nearest (Ericson 2005, Real-time collision
/// detection, 5.1.5).
NearestPoint nearest_of_triangle(const Vec3& p, std::span<const Vec3> corners) {
  constexpr double flattest = 1e-12;  // squared sine of an angle that rounding would decide
  const Vec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], from = p - corners[0];
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm(), det = bb * cc - bc * bc;
  if (!(det > flattest * bb * cc)) return nearest_of_sides(p, corners);
  const double b = ab.dot(from), c = ac.dot(from);
  const auto at = [&](double of_b, double of_c) { return at_weights(from, ab, ac, of_b, of_c); };
  if (b <= 0 && c <= 0) return at(0, 0);
  if (b >= bb && c - bc <= b - bb) return at(1, 0);
  if (c >= cc && b - bc <= c - cc) return at(0, 1);
  const double of_b = cc * b - bc * c, of_c = bb * c - bc * b;  // weights in the plane, times det
  if (of_c <= 0 && b >= 0 && b <= bb) return at(b / bb, 0);
  if (of_b <= 0 && c >= 0 && c <= cc) return at(0, c / cc);
  const double from_b = (c - bc) - (b - bb), from_c = (b - bc) - (c - cc);
  if (det - of_b - of_c <= 0 && from_b >= 0 && from_c >= 0) {
    const double share = from_b / (from_b + from_c);
    NearestPoint out = at(1 - share, share);
    out.weight[0] = 0;  // not what rounding leaves of it
    return out;
  }
  return at(of_b / det, of_c / det);
}

}  // namespace

NearestPoint nearest_point(const Vec3& p, std::span<const Vec3> corners) {
  if (corners.size() == 3) return nearest_of_triangle(p, corners);
  if (corners.size() == 2) return nearest_of_segment(p, corners[0], corners[1]);
  return {{1, 0, 0}, (p - corners[0]).norm()};
}

// With f = 1/2 distance^2 and the weights s of the edges, which minimise it, the Hessian of the least value is
// f_xx - f_xs f_ss^-1 f_sx, and distance * hessian(distance) = hessian(f) - gradient gradient'.
Eigen::Matrix<double, 12, 12> flat_hessian(std::span<const Vec3> corners, const FlatSample& sample) {
  using EdgeColumns = Eigen::Matrix<double, 12, 2>;
  const Edges edges(corners);
  const Vec3 arm = sample.distance * sample.normal;
  EdgeColumns mixed = EdgeColumns::Zero();  // f_xs
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
