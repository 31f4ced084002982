#include "sim/rod_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/units.h"
#include "fem/centreline.h"
#include "fem/point_mass.h"
#include "numerics/parts.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double rod_spacing = 1.0e-3;  // m, of the points that are touched: less than half a duct's radius
constexpr int rod_sectors = 20;         // of the tube that is drawn

RodSection section_of(double young, double radius, double wall) {
  return wall < radius ? tube_section(young, radius - 0.5 * wall, wall) : solid_section(young, radius);
}

}  // namespace

double RodBody::radius_along(double share) const {
  const double end = setup_.end_radius > 0 ? setup_.end_radius : setup_.radius;
  return setup_.radius + share * (end - setup_.radius);
}

Result<RodBody> RodBody::create(const Setup& setup) {
  RodBody body;
  body.setup_ = setup;
  const Result<Centreline> line = Centreline::create(setup.nodes);
  if (!line) return line.failure();
  Result<VecX> rest = line->along(setup.points);
  if (!rest) return rest.failure();
  body.rest_ = std::move(rest).value();
  RodQuadrature quadrature = line->quadrature();
  body.shares_ = quadrature.shares;
  std::vector<RodSection> sections;
  double axial = std::numeric_limits<double>::infinity();
  for (double share : body.shares_) {
    sections.push_back(section_of(3 * setup.shear_modulus, body.radius_along(share), setup.wall));
    axial = std::min(axial, sections.back().axial);
  }
  Result<Rod> rod = Rod::create(std::move(quadrature), body.rest_, std::move(sections));
  if (!rod) return rod.failure();
  // Where nothing loads it, forces are but rounding: a strain of 1e-4 is what they are judged beside then.
  body.least_force_ = 1e-4 * axial;
  body.rod_ = std::move(rod).value();
  for (double length : body.rod_.point_lengths()) body.length_ += length;
  body.lay_skin(line.value());
  Result<TubeMesh> tube = TubeMesh::create(body.skin_rest_, rod_sectors);
  if (!tube) return tube.failure();
  body.tube_ = std::move(tube).value();
  body.drawn_rest_ = body.drawn(body.rest_).positions;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : body.drawn_rest_) box.extend(p);
  body.size_ = box.diagonal().norm();
  const int nodes = body.nodes();
  for (int i = 0; i < nodes; ++i) {
    double shortest = body.size_;
    for (int other : {i - 1, i + 1})
      if (other >= 0 && other < nodes)
        shortest = std::min(
            shortest, (body.rest_.segment<3>(3 * i) - body.rest_.segment<3>(Eigen::Index{3} * other)).norm());
    body.edge_lengths_.push_back(shortest);
  }
  std::vector<std::vector<int>> cliques = body.rod_.cliques();
  cliques.insert(cliques.end(), body.face_nodes_.begin(), body.face_nodes_.end());
  body.constant_ = BlockMatrix(nodes, cliques);
  body.lay_bed(line.value());
  body.weigh();
  return body;
}

/// Each segment between two points is two triangles flat as lines, one from either end, so that their contact points lie
/// evenly on it.
void RodBody::lay_skin(const Centreline& line) {
  // An even number, so that the middle is a point.
  const int segments = std::max(4, 2 * static_cast<int>(std::ceil(0.5 * length_ / rod_spacing)));
  std::vector<double> parameters;
  for (int k = 0; k <= segments; ++k) parameters.push_back(static_cast<double>(line.spans()) * k / segments);
  skin_.stencils = line.stencils(parameters);
  skin_rest_ = blend_all(skin_.stencils, skin_.stencils.value, rest_);
  skin_areas_.assign(skin_rest_.size(), 0.0);
  for (int k = 0; k <= segments; ++k) {
    const double radius = radius_along(static_cast<double>(k) / segments);
    radii_.push_back(radius);
    const bool solid = setup_.wall >= radius;
    // A trial may flatten a tube but for a hundredth of its lumen, where the section's law ends.
    const double folded = solid ? radius - contact_guard : setup_.wall + 0.01 * (radius - setup_.wall);
    core_radii_.push_back(folded + contact_guard);
    skin_.at.push_back({std::min(k, segments - 1), 0, 0});
  }
  for (int k = 0; k < segments; ++k) {
    const double radius = 0.5 * (radii_[k] + radii_[k + 1]);
    skin_.triangles.push_back({k, k + 1, k + 1});
    skin_.triangles.push_back({k + 1, k, k});
    segment_areas_.push_back(radius * (skin_rest_[k + 1] - skin_rest_[k]).norm());
    for (int end : {k, k + 1}) skin_areas_[end] += 0.5 * segment_areas_.back();
    rings_.push_back(setup_.wall < radius ? FlatRing::of_tube(4 * setup_.shear_modulus,
                                                              radius - 0.5 * setup_.wall, setup_.wall)
                                          : FlatRing{0, 0, radius});
    std::vector<int>& nodes = face_nodes_.emplace_back();
    for (int row : {k, k + 1})
      nodes.insert(nodes.end(), skin_.stencils.node.begin() + skin_.stencils.begin[row],
                   skin_.stencils.node.begin() + skin_.stencils.begin[row + 1]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

void RodBody::lay_bed(const Centreline& line) {
  std::vector<double> parameters;
  for (const HeldPart& held : setup_.held) parameters.push_back(held.share * line.spans());
  const StencilTable middles = line.stencils(parameters);
  const StencilTable& table = rod_.stencils();
  for (int row = 0; row < table.rows(); ++row) {
    const Vec3 at = blend(table, table.value, row, rest_);
    const double around = 2 * pi * radius_along(shares_[row]) * rod_.point_lengths()[row];
    double stiffness = 0;
    for (std::size_t k = 0; k < setup_.held.size(); ++k)
      if ((at - blend(middles, middles.value, static_cast<int>(k), rest_)).norm() < setup_.held[k].radius)
        stiffness += setup_.held[k].stiffness * around;
    if (stiffness <= 0) continue;
    bed_.row.push_back(row);
    bed_.target.push_back(at);
    bed_.stiffness.push_back(stiffness);
  }
  bed_.add_hessian(table, constant_);
}

void RodBody::weigh() {
  weight_ = VecX::Zero(rest_.size());
  const StencilTable& table = rod_.stencils();
  for (int row = 0; row < table.rows(); ++row)
    spread(table, row, -units::standard_gravity * row_mass(row) * setup_.up, weight_);
  PointMass mass;
  for (int row = 0; row < table.rows(); ++row) mass.mass.push_back(row_mass(row));
  if (!(mass.total() > 0)) return;
  mass_ = constant_.blank();
  mass.add_hessian(table, 1, *mass_);
}

double RodBody::row_mass(int row) const {
  const double outer = radius_along(shares_[row]), inner = std::max(0.0, outer - setup_.wall);
  const double lumen = pi * inner * inner, wall = pi * outer * outer - lumen;
  return rod_.point_lengths()[row] * (setup_.density * wall + setup_.liquid_density * lumen);
}

double RodBody::value(const VecX& x) const {
  return rod_.value(x, setup_.pressure) + bed_.value(rod_.stencils(), x);
}

void RodBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  rod_.add_gradient(x, setup_.pressure, gradient);
  largest_internal = std::max({largest_node(gradient), largest_node(weight_), least_force_});
  bed_.add_gradient(rod_.stencils(), x, gradient);
}

void RodBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* /*assembly*/) const {
  rod_.add_hessian(x, setup_.pressure, matrix);
}

double RodBody::max_stretch(const VecX& x) const {
  double largest = 0;
  for (const Rod::Sample& sample : rod_.samples(x, setup_.pressure))
    largest = std::max(largest, sample.stretch);
  return largest;
}

double RodBody::contact_area(int point) const {
  return 0.5 * segment_areas_[point / (2 * contacts_each)] / felt_points.size();
}

BarrierSample RodBody::contact_sample(int point, double distance, const Barrier& barrier) const {
  const FlatRing& ring = rings_[point / (2 * contacts_each)];
  const double width = ring.outer;  // as contact_area() counts it
  const SectionSample s =
      RodContactLaw<Barrier>{ring, barrier, width}.sample(distance + ring.outer, setup_.pressure).section;
  return {s.energy / width, s.slope / width, s.bend / width};
}

std::vector<Vec3> RodBody::skin_normals(const VecX& x) const {
  std::vector<Vec3> normals;
  const StencilTable& table = skin_.stencils;
  for (int row = 0; row < table.rows(); ++row) {
    const Vec3 along = blend(table, table.du, row, x).normalized();
    const Vec3 across = setup_.up - along * along.dot(setup_.up);
    normals.push_back(across.norm() > 1e-6 ? across.normalized() : along.unitOrthogonal());
  }
  return normals;
}

DrawnSurface RodBody::drawn(const VecX& x) const {
  std::vector<TubeSection> sections;
  for (double radius : radii_) sections.push_back({radius, radius, Vec3::Zero()});
  TubeMesh::Surface surface;
  tube_->place(skin_positions(x), sections, surface);
  return {std::move(surface.positions), std::move(surface.normals)};
}

}  // namespace calot
