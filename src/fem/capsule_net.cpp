#include "fem/capsule_net.h"

#include <algorithm>
#include <map>

#include "fem/links.h"
#include "geometry/tri_mesh.h"

namespace calot {

double CapsuleMaterial::energy(double stretch) const {
  const double y = std::max(0.0, stretch - slack);
  return y < straight ? stiffness * y * y * y / (6 * straight)
                      : stiffness * (0.5 * y * (y - straight) + straight * straight / 6);
}

double CapsuleMaterial::tension(double stretch) const {
  const double y = std::max(0.0, stretch - slack);
  return y < straight ? stiffness * y * y / (2 * straight) : stiffness * (y - 0.5 * straight);
}

double CapsuleMaterial::tangent(double stretch) const {
  const double y = std::max(0.0, stretch - slack);
  return stiffness * std::min(1.0, y / straight);
}

CapsuleNet::CapsuleNet(const Tessellation& surface, const VecX& x, const CapsuleMaterial& capsule)
    : material(capsule), table(surface.stencils) {
  const std::vector<Vec3> points = blend_all(table, table.value, x);
  const std::vector<double> areas = areas_of(points, surface.triangles);
  std::map<std::array<int, 2>, double> around;  // area of an edge's triangles, m^2
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& triangle = surface.triangles[t];
    for (int k = 0; k < 3; ++k) {
      std::array<int, 2> edge{triangle[k], triangle[(k + 1) % 3]};
      std::sort(edge.begin(), edge.end());
      around[edge] += areas[t];
    }
  }
  for (const auto& [edge, area] : around) {
    ends.push_back(edge);
    rest.push_back((points[edge[1]] - points[edge[0]]).norm());
    width.push_back(area / rest.back());
  }
}

namespace {

/// Calls use(cord, unit vector along it, length) for each that is stretched beyond its slack.
template <class Use>
void for_taut(const CapsuleNet& net, const VecX& x, const Use& use) {
  const std::vector<Vec3> points = blend_all(net.table, net.table.value, x);
  for (std::size_t k = 0; k < net.ends.size(); ++k) {
    const Vec3 along = points[net.ends[k][1]] - points[net.ends[k][0]];
    const double most = net.material.slack * net.rest[k], squared = along.squaredNorm();
    if (squared <= most * most) continue;
    const double length = std::sqrt(squared);
    use(k, Vec3(along / length), length);
  }
}

}  // namespace

double CapsuleNet::value(const VecX& x) const {
  double sum = 0;
  for_taut(*this, x, [&](std::size_t k, const Vec3& /*along*/, double length) {
    sum += width[k] * rest[k] * material.energy(length / rest[k]);
  });
  return sum;
}

void CapsuleNet::add_gradient(const VecX& x, VecX& gradient) const {
  for_taut(*this, x, [&](std::size_t k, const Vec3& along, double length) {
    const Vec3 pull = width[k] * material.tension(length / rest[k]) * along;
    spread(table, ends[k][0], -pull, gradient);
    spread(table, ends[k][1], pull, gradient);
  });
}

void CapsuleNet::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  for_taut(*this, x, [&](std::size_t k, const Vec3& along, double length) {
    const double stretch = length / rest[k];
    const Mat3 projector = along * along.transpose();
    const Mat3 block = width[k] * (material.tangent(stretch) / rest[k] * projector +
                                   material.tension(stretch) / length * (Mat3::Identity() - projector));
    Eigen::Matrix<double, 12, 12> hessian = Eigen::Matrix<double, 12, 12>::Zero();
    hessian.block<3, 3>(0, 0) = hessian.block<3, 3>(3, 3) = block;
    hessian.block<3, 3>(0, 3) = hessian.block<3, 3>(3, 0) = -block;
    add_points_hessian(table, {ends[k][0], ends[k][1], -1, -1}, hessian, matrix);
  });
}

}  // namespace calot
