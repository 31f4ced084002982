#include "body/solid_body.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/units.h"
#include "body/loop_skin.h"
#include "geometry/decompose.h"
#include "numerics/parts.h"

namespace calot {
namespace {

static_assert(inner_modes % 3 == 0);
constexpr int mode_nodes = inner_modes / 3;

std::array<Vec3, 10> places_of(const QuadraticTet& tet, const std::vector<Vec3>& points) {
  std::array<Vec3, 10> out;
  for (int a = 0; a < 10; ++a) out[a] = points[tet[a]];
  return out;
}

/// Of the box' cells, each cut in as many; the points on its surface are blends of the control nodes.
SolidMesh mesh_of(const SolidBody::Setup& setup, const LoopSurface& surface) {
  TetGrid grid;
  for (int way = 0; way < 3; ++way) grid.cells[way] = setup.box.all_cells()[way] * setup.cells_each[way];
  std::vector<FacePoint> places;
  std::vector<int> points;
  for (int p = 0; p < grid.points(); ++p) {
    if (!grid.on_surface(p)) continue;
    Vec3 at;
    for (int way = 0; way < 3; ++way) at[way] = grid.place(p)[way] / (2.0 * setup.cells_each[way]);
    places.push_back(setup.box.place(at));
    points.push_back(p);
  }
  const StencilTable table = surface.evaluate(places, 0);
  std::vector<std::vector<std::pair<int, double>>> rows(static_cast<std::size_t>(grid.points()));
  for (int r = 0; r < table.rows(); ++r)
    for (int e = table.begin[r]; e < table.begin[r + 1]; ++e)
      rows[points[r]].emplace_back(table.node[e], table.value[e]);
  SolidMesh mesh;
  mesh.tets = grid.tets();
  mesh.rows = fill_by_surface(grid, rows);
  mesh.nodes = setup.box.points();
  for (int p = 0; p < grid.points(); ++p) mesh.averaged.push_back(grid.on_surface(p));
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    const std::array<int, 3> cell = grid.cell_of(t);
    mesh.piece_of.push_back(cell[0] * setup.strips[0] / grid.cells[0] +
                            setup.strips[0] * (cell[1] * setup.strips[1] / grid.cells[1]));
  }
  return mesh;
}

}  // namespace

Result<SolidBody> SolidBody::create(const Setup& setup, KeptResults* kept) {
  const Result<LoopSurface> surface = LoopSurface::create(setup.control);
  if (!surface) return surface.failure();
  SolidBody body;
  body.setup_ = setup;
  body.rest_ = VecX::Zero(3 * (Eigen::Index{setup.box.points()} + mode_nodes));
  body.rest_.head(3 * Eigen::Index{setup.box.points()}) = to_coordinates(setup.control.points);
  body.mesh_ = mesh_of(setup, surface.value());
  Result<ReducedSolid> reduced = kept_or_reduced(body.mesh_, body.rest_, setup.material, kept);
  if (!reduced) return reduced.failure();
  body.solid_ = FramedSolid(body.rest_, std::move(reduced->parts));
  const std::vector<Vec3> points = blend_all(body.mesh_.rows, body.mesh_.rows.value, body.rest_);
  for (const QuadraticTet& tet : body.mesh_.tets) {
    const TetMatrices matrices = tet_matrices(places_of(tet, points), setup.material).value();
    body.slopes_.push_back(matrices.slopes / matrices.volume);
  }
  const VecX shift = Vec3::UnitX().replicate(body.coarse_nodes(), 1);
  body.volume_ = shift.dot(reduced->mass * shift);
  body.skin_ = close_skin(surface.value(), body.rest_, solid_skin_spacing);
  if (setup.capsule.stiffness > 0)
    body.capsule_ = CapsuleNet(surface->tessellate(2), body.rest_, setup.capsule);
  body.build_skin();
  body.build_matrices(reduced.value());
  body.setup_.foundation = nullptr;  // what it refers to need not outlive this
  return body;
}

void SolidBody::build_skin() {
  skin_rest_ = blend_all(skin_.stencils, skin_.stencils.value, rest_);
  areas_ = areas_of(skin_rest_, skin_.triangles);
  skin_areas_ = lumped(areas_, skin_.triangles, skin_rest_.size());
  std::vector<char> seen(static_cast<std::size_t>(coarse_nodes()), 0);
  for (const std::vector<int>& points : points_of_faces(skin_, setup_.control.triangles.size()))
    add_nodes(skin_.stencils, points, 0, seen, face_nodes_.emplace_back());
  Eigen::AlignedBox3d box;
  for (const Vec3& p : skin_rest_) box.extend(p);
  size_ = box.diagonal().norm();
  edge_lengths_ = shortest_edges(setup_.control);
  edge_lengths_.insert(edge_lengths_.end(), mode_nodes,
                       *std::min_element(edge_lengths_.begin(), edge_lengths_.end()));
  // Where nothing loads it, forces are but rounding: a strain of 1e-4 on a node's part of the skin.
  double area = 0;
  for (double of_triangle : areas_) area += of_triangle;
  least_force_ = 1e-4 * setup_.material.young * area / nodes();
}

void SolidBody::build_matrices(const ReducedSolid& reduced) {
  std::vector<int> all(static_cast<std::size_t>(nodes()));
  std::iota(all.begin(), all.end(), 0);
  constant_ = BlockMatrix(nodes(), std::vector<std::vector<int>>{all});
  mode_stiffness_ = reduced.mode_stiffness;
  lay_bed(setup_.foundation);
  const int places = coarse_nodes();
  if (!(setup_.density > 0)) return;
  mass_ = constant_.blank();
  for (int b = 0; b < places; ++b) {
    for (int a = b; a < places; ++a)
      mass_->add(a, b, setup_.density * reduced.mass.block<3, 3>(3 * a, 3 * b));
    for (int k = 0; k < mode_nodes; ++k)
      mass_->add(places + k, b, setup_.density * reduced.mode_coupling.block<3, 3>(3 * b, 3 * k).transpose());
  }
  add_modes(setup_.density * reduced.mode_inertia, *mass_);
  if (!setup_.sags) return;
  load_ = VecX::Zero(rest_.size());
  const VecX up = setup_.up.replicate(places, 1);
  load_.head(up.size()) = -units::standard_gravity * setup_.density * (reduced.mass * up);
}

void SolidBody::lay_bed(const std::function<double(const Vec3& x, int triangle)>& foundation) {
  bed_ = {};
  for (int row = 0; foundation && row < skin_.stencils.rows(); ++row) {
    const double stiffness = foundation(skin_rest_[row], skin_.at[row].face) * skin_areas_[row];
    if (stiffness <= 0) continue;
    bed_.row.push_back(row);
    bed_.target.push_back(skin_rest_[row]);
    bed_.stiffness.push_back(stiffness);
  }
  bed_.add_hessian(skin_.stencils, constant_);
  add_modes(mode_stiffness_, constant_);
}

void SolidBody::add_modes(const VecX& diagonal, BlockMatrix& matrix) const {
  const int places = coarse_nodes();
  for (int k = 0; k < mode_nodes; ++k)
    matrix.add(places + k, places + k, Mat3(diagonal.segment<3>(3 * k).asDiagonal()));
}

SolidBody SolidBody::with_foundation(
    const std::function<double(const Vec3& x, int triangle)>& foundation) const {
  SolidBody out = *this;
  out.constant_ = constant_.blank();
  out.lay_bed(foundation);
  return out;
}

double SolidBody::value(const VecX& x) const {
  const VecX modes = x.tail<inner_modes>();
  return strain_energy(x) + 0.5 * modes.dot(mode_stiffness_.cwiseProduct(modes)) +
         bed_.value(skin_.stencils, x);
}

void SolidBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  solid_.add_gradient(x, gradient);
  capsule_.add_gradient(x, gradient);
  gradient.tail<inner_modes>() += mode_stiffness_.cwiseProduct(x.tail<inner_modes>());
  largest_internal = std::max(largest_node(gradient), least_force_);
  if (load_.size() > 0) largest_internal = std::max(largest_internal, largest_node(load_));
  bed_.add_gradient(skin_.stencils, x, gradient);
}

void SolidBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* /*assembly*/) const {
  solid_.add_hessian(x, matrix);
  capsule_.add_hessian(x, matrix);
}

namespace {

/// No eigenvalue of a symmetric matrix is larger: three numbers of that mean and spread are all below.
double bound_of_eigenvalues(const Mat3& symmetric) {
  const double mean = symmetric.trace() / 3;
  return mean + std::sqrt(2.0 / 3) * (symmetric - mean * Mat3::Identity()).norm();
}

}  // namespace

double SolidBody::max_stretch(const VecX& x) const {
  const std::vector<Vec3> points = blend_all(mesh_.rows, mesh_.rows.value, x);
  double largest_squared = 0;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    Mat3 mean = Mat3::Zero();
    for (int a = 0; a < 10; ++a) mean += points[mesh_.tets[t][a]] * slopes_[t].col(a).transpose();
    const Mat3 squared = mean.transpose() * mean;
    if (bound_of_eigenvalues(squared) > largest_squared)  // few are: eigenvalues take longest
      largest_squared = std::max(largest_squared, principal_values(squared)[2]);
  }
  return std::sqrt(largest_squared);
}

std::vector<Vec3> SolidBody::skin_normals(const VecX& x) const {
  const StencilTable& table = skin_.stencils;
  const std::vector<Vec3> u = blend_all(table, table.du, x), v = blend_all(table, table.dv, x);
  std::vector<Vec3> normals(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) normals[i] = u[i].cross(v[i]).normalized();
  return normals;
}

}  // namespace calot
