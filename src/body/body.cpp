#include "body/body.h"

#include <algorithm>
#include <numeric>

#include "body/body_cut.h"
#include "geometry/tri_mesh.h"
#include "numerics/parts.h"

namespace calot {

double widest_gap(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  double widest = 0;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) widest = std::max(widest, (points[t[k]] - points[t[(k + 1) % 3]]).norm());
  return widest;
}

const VecX& Body::kept_load() const {
  static const VecX none;
  return none;
}

const std::vector<double>& Body::skin_radii() const {
  static const std::vector<double> none;
  return none;
}

const std::vector<double>& Body::core_radii() const { return skin_radii(); }

std::span<const int> Body::contact_points(bool broad) const {
  if (broad) return broad_points;
  static const std::array<int, contacts_each> all = [] {
    std::array<int, contacts_each> out{};
    std::iota(out.begin(), out.end(), 0);
    return out;
  }();
  return all;
}

double Body::radius_at_contact(int point) const {
  if (skin_radii().empty()) return 0;
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += contact_weights(point)[c] *
           skin_radii()[static_cast<std::size_t>(skin().triangles[point / contacts_each][c])];
  return sum;
}

std::map<std::string, int> Body::nearest_points(const std::map<std::string, Vec3>& places) const {
  std::map<std::string, int> out;
  for (const auto& [name, place] : places) out[name] = nearest_of(skin_rest(), place);
  return out;
}

Result<std::optional<BodyCut>> Body::divide(double /*share*/) const { return std::optional<BodyCut>(); }

double Body::thickest() const {
  const std::vector<double>& radii = skin_radii();
  return radii.empty() ? 0.0 : *std::max_element(radii.begin(), radii.end());
}

Eigen::AlignedBox3d Body::box_of(std::span<const int> nodes, const VecX& x, double wider) const {
  Eigen::AlignedBox3d box;
  for (int node : nodes) {
    const Vec3 at = x.segment<3>(Eigen::Index{3} * node);
    if (node < coarse_nodes())
      box.extend(at);
    else
      wider += 0.5 * at.norm();
  }
  return {box.min() - Vec3::Constant(wider), box.max() + Vec3::Constant(wider)};
}

double Body::core_depth() const {
  double depth = contact_guard;
  for (std::size_t row = 0; row < skin_radii().size(); ++row)
    depth = std::min(depth, skin_radii()[row] + contact_guard - core_radii()[row]);
  return depth;
}

Vec3 Body::surface_point(int row, const VecX& x) const {
  const Vec3 at = skin_point(row, x);
  return skin_radii().empty() ? at : Vec3(at + skin_radii()[row] * skin_normals(x)[row]);
}

const std::vector<int>& Body::details() const {
  static const std::vector<int> none;
  return none;
}

double Body::largest_motion(const VecX& dx) const { return largest_node(dx); }

std::vector<Vec3> Body::skin_positions(const VecX& x) const {
  return blend_all(skin().stencils, skin().stencils.value, x);
}

}  // namespace calot
