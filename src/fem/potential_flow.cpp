#include "fem/potential_flow.h"

#include <Eigen/LU>
#include <array>

#include "numerics/dense_cholesky.h"

namespace calot {
namespace {

constexpr int harmonics = PotentialFlow::harmonics, linear = PotentialFlow::linear;

/// As wide as the processor's registers are; what is beyond is zero.
constexpr int padded = (harmonics + 3) / 4 * 4;
using Harmonics = Eigen::Matrix<double, padded, 1>;
using NodeFlow = Eigen::Matrix<double, padded, 3>;

/// Values and gradients of the solid harmonics at p.
void sample_harmonics(const Vec3& p, Harmonics& h, std::array<Vec3, harmonics>& g) {
  const double x = p.x(), y = p.y(), z = p.z();
  h.head<harmonics>() << x, y, z, x * y, y * z, z * x, x * x - y * y, 2 * z * z - x * x - y * y,
      z * (2 * z * z - 3 * x * x - 3 * y * y), x * (4 * z * z - x * x - y * y),
      y * (4 * z * z - x * x - y * y), z * (x * x - y * y), x * y * z, x * (x * x - 3 * y * y),
      y * (3 * x * x - y * y);
  g = {Vec3(1, 0, 0),
       Vec3(0, 1, 0),
       Vec3(0, 0, 1),
       Vec3(y, x, 0),
       Vec3(0, z, y),
       Vec3(z, 0, x),
       Vec3(2 * x, -2 * y, 0),
       Vec3(-2 * x, -2 * y, 4 * z),
       Vec3(-6 * x * z, -6 * y * z, 6 * z * z - 3 * x * x - 3 * y * y),
       Vec3(4 * z * z - 3 * x * x - y * y, -2 * x * y, 8 * x * z),
       Vec3(-2 * x * y, 4 * z * z - x * x - 3 * y * y, 8 * y * z),
       Vec3(2 * x * z, -2 * y * z, x * x - y * y),
       Vec3(y * z, z * x, x * y),
       Vec3(3 * x * x - 3 * y * y, -6 * x * y, 0),
       Vec3(6 * x * y, 3 * x * x - 3 * y * y, 0)};
}

/// Third of the area vectors of the triangles around each point: they sum to zero on a closed surface.
std::vector<Vec3> area_vectors(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> out(points.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 area = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]) / 6.0;
    for (int p : t) out[p] += area;
  }
  return out;
}

}  // namespace

PotentialFlow PotentialFlow::inside(const StencilTable& points, const std::vector<Triangle>& triangles,
                                    const VecX& x, double length) {
  const std::vector<Vec3> at = blend_all(points, points.value, x);
  const std::vector<Vec3> areas = area_vectors(at, triangles);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : at) centre += p / static_cast<double>(at.size());
  const double scale = 1.0 / length;
  std::vector<NodeFlow> flow(static_cast<std::size_t>(x.size()) / 3, NodeFlow::Zero());
  Eigen::Matrix<double, padded, harmonics> kinetic = Eigen::Matrix<double, padded, harmonics>::Zero();
  Harmonics h = Harmonics::Zero();
  std::array<Vec3, harmonics> g;
  for (int p = 0; p < points.rows(); ++p) {
    sample_harmonics(scale * (at[p] - centre), h, g);
    const NodeFlow here = h * areas[p].transpose();
    for (int e = points.begin[p]; e < points.begin[p + 1]; ++e)
      flow[points.node[e]] += points.value[e] * here;
    const Harmonics scaled = h * scale;
    for (int l = 0; l < harmonics; ++l) kinetic.col(l) += scaled * g[l].dot(areas[p]);
  }
  PotentialFlow out{Eigen::MatrixXd(x.size(), harmonics), kinetic.topRows<harmonics>()};
  for (std::size_t node = 0; node < flow.size(); ++node)
    out.flow.middleRows<3>(3 * static_cast<Eigen::Index>(node)) = flow[node].topRows<harmonics>().transpose();
  return out;
}

// A surface that translates moves the flow by the first columns of A, all of it the linear harmonics' own. What those
// tell of each other harmonic is taken off it: nothing is left of a translation, and the energies of both parts add up
// (the Schur complement of A is the rest's).
Result<FlowModes> FlowModes::inside(const StencilTable& points, const std::vector<Triangle>& triangles,
                                    const VecX& x, double length) {
  const PotentialFlow whole = PotentialFlow::inside(points, triangles, x, length);
  Eigen::MatrixXd taken(count, harmonics);
  taken.leftCols<linear>() = -whole.kinetic.bottomLeftCorner<count, linear>() *
                             whole.kinetic.topLeftCorner<linear, linear>().inverse();
  taken.rightCols<count>().setIdentity();
  Eigen::MatrixXd factor = taken * whole.energy() * taken.transpose();
  if (!cholesky_in_place(factor))
    return fail(FailureKind::simulation, "the surface is too coarse to tell how the liquid inside it flows",
                "give the organ more nodes");
  FlowModes out{whole.flow * taken.transpose()};
  factor.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(out.columns);
  return out;
}

}  // namespace calot
