#include "body/shell_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index_of.h"
#include "base/units.h"
#include "body/loop_skin.h"
#include "fem/point_mass.h"
#include "numerics/parts.h"
#include "skin/subdivision.h"

namespace calot {
namespace {

/// The rule's points on each whole face, in the parameters of the coarse faces, and their weights. Leaves that an
/// extension split lie four in a parent: one element, with the six points of degree 4 on the parent. (One in each leaf
/// errs hardly more under a constant load, but it leaves the wall soft in its shortest waves: a tool that was drawn over
/// it felt it snap, by up to 4 % of its force; three in each cost twice as much and did no better.) A leaf whose siblings
/// are split further has three.
struct RulePoints {
  std::vector<FacePoint> at;
  std::vector<int> first_rows;  ///< of each coarse face, and their number
  Quadrature quadrature;        ///< without stencils

  RulePoints(const SurfaceLevels& levels, const FaceTree& tree, const std::vector<QuadraturePoint>& rule) {
    const std::vector<QuadraturePoint> of_parent = six_point_rule(), of_leaf = three_point_rule();
    const int leaves = static_cast<int>(tree.leaves.size());
    int element = -1, face = 0;
    for (int k = 0; k < leaves; ++k) {
      const FaceTree::Leaf& leaf = tree.leaves[k];
      if (k == 0 || !leaf.sibling_of(tree.leaves[k - 1])) ++element;
      if (k == tree.first[face]) first_rows.push_back(static_cast<int>(at.size())), ++face;
      if (k + 3 < leaves && leaf.sibling_of(tree.leaves[k + 3])) {  // all four
        add(levels, leaf.level - 1, leaf.face / 4, of_parent, element);
        k += 3;
      } else {
        add(levels, leaf.level, leaf.face, leaf.level == 0 ? rule : of_leaf, element);
      }
    }
    first_rows.push_back(static_cast<int>(at.size()));
  }

 private:
  void add(const SurfaceLevels& levels, int level, int face, const std::vector<QuadraturePoint>& rule,
           int element) {
    for (const QuadraturePoint& q : rule) {
      at.push_back(levels.on_coarse(level, {face, q.u, q.v}));
      quadrature.element.push_back(element);
      quadrature.weights.push_back(std::ldexp(q.weight, -2 * level));
    }
  }
};

StencilTable without_derivatives(const StencilTable& table) {
  StencilTable out;
  out.begin = table.begin;
  out.node = table.node;
  out.value = table.value;
  return out;
}

/// Of each edge: flows cost 1 % less than by the skin, which has a point each mm and takes fifteen times as long.
constexpr int flow_parts = 3;

}  // namespace

Result<ShellBody> ShellBody::create(const Setup& setup) {
  Result<SurfaceLevels> levels = SurfaceLevels::create(setup.control, setup.levels);
  if (!levels) return levels.failure();
  const VecX rest = to_coordinates(setup.control.points);
  Base base{setup, std::move(levels).value()};
  base.skin = close_skin(base.levels.surface(), rest, skin_spacing);
  if (setup.bile) base.flow_skin = base.levels.surface().tessellate(flow_parts);
  base.skin_rest = blend_all(base.skin.stencils, base.skin.stencils.value, rest);
  base.triangle_areas = areas_of(base.skin_rest, base.skin.triangles);
  base.skin_areas = lumped(base.triangle_areas, base.skin.triangles, base.skin_rest.size());
  base.face_points = points_of_faces(base.skin, setup.control.triangles.size());
  std::vector<char> seen(base.levels.nodes(0), 0);
  for (const std::vector<int>& points : base.face_points)
    add_nodes(base.skin.stencils, points, 0, seen, base.face_nodes.emplace_back());
  for (int level = 1; level <= setup.levels; ++level)
    base.skin_by_level.push_back(base.levels.evaluate(level, base.skin.at, 1));
  base.skin_places = without_derivatives(base.skin.stencils);
  for (const StencilTable& table : base.skin_by_level)
    base.skin_places_by_level.push_back(without_derivatives(table));
  std::vector<FacePoint> places;
  for (int node = 0; node < base.levels.nodes(setup.levels); ++node)
    places.push_back(base.levels.place(node));
  const StencilTable at_nodes = base.levels.evaluate(0, places, 0);
  base.node_rest = blend_all(at_nodes, at_nodes.value, rest);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : base.skin_rest) box.extend(p);
  base.size = box.diagonal().norm();
  base.middle = box.center();
  if (setup.foundation) lay_bed(rest, base);
  ShellBody body(std::make_shared<const Base>(std::move(base)), {});
  if (std::optional<Failure> failure = body.build(nullptr)) return *failure;
  return body;
}

void ShellBody::lay_bed(const VecX& rest, Base& base) {
  const RulePoints points(base.levels, FaceTree(base.levels, {}), base.setup.rule);
  const StencilTable table = base.levels.evaluate(0, points.at, 1);
  for (int r = 0; r < table.rows(); ++r) {
    const Vec3 at = blend(table, table.value, r, rest);
    const double jacobian = blend(table, table.du, r, rest).cross(blend(table, table.dv, r, rest)).norm();
    const double stiffness = base.setup.foundation(at) * points.quadrature.weights[r] * jacobian;
    if (stiffness <= 0) continue;
    base.bed.row.push_back(static_cast<int>(base.bed_places.size()));
    base.bed.target.push_back(at);
    base.bed.stiffness.push_back(stiffness);
    base.bed_places.push_back(points.at[r]);
  }
}

Result<ShellBody> ShellBody::with_foundation(std::function<double(const Vec3& x)> foundation) const {
  Setup setup = base_->setup;
  setup.foundation = std::move(foundation);
  Result<ShellBody> out = create(setup);
  if (!out) return out;
  if (kept_) out->keep_in_equilibrium(kept_->state);
  return details().empty() ? out : out->with_details(details());
}

Result<ShellBody> ShellBody::with_details(std::vector<int> details) const {
  ShellBody out(base_, std::move(details));
  if (std::optional<Failure> failure = out.build(this)) return *failure;
  out.kept_ = kept_;
  out.make_good();
  return out;
}

double ShellBody::value(const VecX& x) const {
  const double wall = refined_->shell.value(x);
  return std::isfinite(wall) ? wall + foundation().value(refined_->bed_points, x) : wall;
}

void ShellBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  refined_->shell.add_gradient(x, gradient);
  largest_internal = largest_node(gradient);
  foundation().add_gradient(refined_->bed_points, x, gradient);
}

void ShellBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const {
  refined_->shell.add_hessian(x, matrix, assembly);
}

Result<FlowModes> ShellBody::flow(const VecX& x) const {
  const VecX coarse = x.head(3 * Eigen::Index{coarse_nodes()});
  Result<FlowModes> out =
      FlowModes::inside(base_->flow_skin.stencils, base_->flow_skin.triangles, coarse, 0.5 * base_->size);
  if (!out) return out;
  FlowModes with_details{Eigen::MatrixXd::Zero(x.size(), FlowModes::count)};
  with_details.columns.topRows(coarse.size()) = out->columns;
  return with_details;
}

VecX ShellBody::own_forces(const VecX& x, double datum_pressure) const {
  VecX out = VecX::Zero(x.size());
  refined_->shell.add_gradient(x, out);
  foundation().add_gradient(refined_->bed_points, x, out);
  if (refined_->bile) refined_->bile->add_load(x, datum_pressure, out);
  return out;
}

std::map<std::string, int> ShellBody::landmarks() const {
  if (!base_->setup.landmarks) return {};
  return nearest_points(base_->setup.landmarks(skin_rest()));
}

VecX ShellBody::forces(const VecX& x, double datum_pressure) const {
  VecX out = own_forces(x, datum_pressure);
  if (refined_->kept_load.size() > 0) out -= refined_->kept_load;
  return out;
}

void ShellBody::keep_in_equilibrium(const BodyState& rest) {
  kept_ = std::make_shared<const Kept>(Kept{rest, forces(rest.x, rest.datum_pressure)});
}

void ShellBody::make_good() {
  if (!kept_ || details().empty()) return;
  const BodyState& state = kept_->state;
  VecX x = VecX::Zero(refined_->rest.size());
  x.head(state.x.size()) = state.x;
  refined_->kept_load = own_forces(x, state.datum_pressure);
  refined_->kept_load.head(state.x.size()) -= kept_->forces;
  if (refined_->bile) refined_->bile->kept_volume = refined_->bile->bile.volume(x) - state.volume;
}

DetailedSurface ShellBody::detailed(const SurfaceLevels& levels, std::vector<int> details) {
  FaceTree tree(levels, details);
  return {DetailBasis(levels, std::move(details)), std::move(tree)};
}

std::optional<Failure> ShellBody::build(const ShellBody* before) {
  std::optional<SharedRows> shared;
  if (before != nullptr) shared.emplace(before->refined_->surface, refined_->surface);
  const SharedRows* rows = shared ? &*shared : nullptr;
  refined_->rest = VecX::Zero(3 * Eigen::Index{refined_->surface.basis.nodes()});
  refined_->rest.head(3 * Eigen::Index{coarse_nodes()}) = to_coordinates(control().points);
  if (std::optional<Failure> failure = build_shell(before, rows)) return failure;
  build_skin();
  refined_->edge_lengths = shortest_edges(control());
  for (int detail : details()) {
    double shortest = base_->size;
    for (int node : base_->levels.faces(0)[base_->levels.place(detail).face])
      shortest = std::min(shortest, refined_->edge_lengths[node]);
    refined_->edge_lengths.push_back(std::ldexp(shortest, -base_->levels.level_of(detail)));
  }
  std::vector<std::vector<int>> cliques = refined_->shell.cliques();
  if (base_->setup.bile) {
    if (Result<bool> built = build_bile(before, rows); !built) return built.failure();
    for (std::vector<int>& clique : refined_->bile->bile.cliques()) cliques.push_back(std::move(clique));
  }
  cliques.insert(cliques.end(), refined_->face_nodes.begin(), refined_->face_nodes.end());
  build_bed(before, rows);
  refined_->constant = BlockMatrix(nodes(), cliques);
  if (base_->setup.wall_density > 0) build_mass();
  foundation().add_hessian(refined_->bed_points, refined_->constant);
  return std::nullopt;
}

void ShellBody::build_mass() {
  PointMass wall;
  for (double area : refined_->shell.point_areas())
    wall.mass.push_back(area * base_->setup.material.membrane.thickness * base_->setup.wall_density);
  refined_->mass = refined_->constant.blank();
  wall.add_hessian(refined_->quadrature, 1, *refined_->mass);
  refined_->kept_load = VecX::Zero(refined_->rest.size());
  wall.add_weight(refined_->quadrature, -units::standard_gravity * base_->setup.up, refined_->kept_load);
}

std::optional<Failure> ShellBody::build_shell(const ShellBody* before, const SharedRows* shared) {
  RulePoints points(base_->levels, refined_->surface.tree, base_->setup.rule);
  refined_->first_rows = std::move(points.first_rows);
  std::vector<int> known(points.at.size(), -1);
  for (int face = 0; shared && face < static_cast<int>(refined_->first_rows.size()) - 1; ++face)
    for (int row = refined_->first_rows[face]; shared->same(face) && row < refined_->first_rows[face + 1];
         ++row)
      known[row] = before->refined_->first_rows[face] + row - refined_->first_rows[face];
  points.quadrature.stencils = shared ? shared->rows(points.at, 2, before->refined_->quadrature, known)
                                      : refined_->surface.basis.evaluate(points.at, 2);
  Result<Shell> shell = Shell::create(points.quadrature, refined_->rest, base_->setup.material,
                                      before ? &before->refined_->shell : nullptr, known);
  if (!shell) return shell.failure();
  refined_->shell = std::move(shell).value();
  refined_->quadrature = std::move(points.quadrature.stencils);
  return std::nullopt;
}

void ShellBody::build_skin() {
  refined_->skin.at = base_->skin.at;
  refined_->skin.triangles = base_->skin.triangles;
  refined_->skin.stencils =
      refined_->surface.basis.extend(base_->skin_places, refined_->skin.at, base_->skin_places_by_level);
  refined_->face_nodes = base_->face_nodes;
  std::vector<char> seen(details().size(), 0);
  for (std::size_t f = 0; f < refined_->face_nodes.size() && !details().empty(); ++f)
    add_nodes(refined_->skin.stencils, base_->face_points[f], coarse_nodes(), seen, refined_->face_nodes[f]);
}

void ShellBody::build_bed(const ShellBody* before, const SharedRows* shared) {
  std::vector<int> known(base_->bed_places.size(), -1);
  for (int k = 0; shared && k < static_cast<int>(known.size()); ++k)
    if (shared->same(base_->bed_places[k].face)) known[k] = k;
  refined_->bed_points = shared ? shared->rows(base_->bed_places, 0, before->refined_->bed_points, known)
                                : refined_->surface.basis.evaluate(base_->bed_places, 0);
}

Result<bool> ShellBody::build_bile(const ShellBody* before, const SharedRows* shared) {
  const SurfaceLevels& levels = base_->levels;
  BileSurface surface;
  // The rule splits each face in four itself: with one split less errors near a contact are the same to 0.04 % of the
  // displacement (1.03 % become 0.99, 0.61 stay), at half the cost.
  const FaceTree tree(levels, details(), true);
  const std::vector<FaceTree::Leaf>& leaves = tree.leaves;
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    if (k == 0 || !leaves[k].sibling_of(leaves[k - 1])) surface.cells.emplace_back();
    std::vector<BileSurface::Part>& cell = surface.cells.back();
    for (const Triangle& t : cover(levels, leaves[k], true)) cell.push_back({t, 4.0 / 3.0});
    for (const Triangle& t : cover(levels, leaves[k], false)) cell.push_back({t, -1.0 / 3.0});
  }
  for (const std::vector<BileSurface::Part>& cell : surface.cells)
    for (const BileSurface::Part& part : cell)
      refined_->bile_nodes.insert(refined_->bile_nodes.end(), part.corners.begin(), part.corners.end());
  std::sort(refined_->bile_nodes.begin(), refined_->bile_nodes.end());
  refined_->bile_nodes.erase(std::unique(refined_->bile_nodes.begin(), refined_->bile_nodes.end()),
                             refined_->bile_nodes.end());
  std::vector<FacePoint> places;
  std::vector<int> known;
  for (int node : refined_->bile_nodes) {
    places.push_back(levels.place(node));
    known.push_back(shared && shared->same(places.back().face) ? index_of(node, before->refined_->bile_nodes)
                                                               : -1);
  }
  surface.points = shared ? shared->rows(places, 0, before->refined_->bile->bile.points(), known)
                          : refined_->surface.basis.evaluate(places, 0);
  for (std::vector<BileSurface::Part>& cell : surface.cells)
    for (BileSurface::Part& part : cell)
      for (int& corner : part.corners) corner = index_of(corner, refined_->bile_nodes);
  const double weight = base_->setup.bile->density * units::standard_gravity;
  Result<Bile> bile = Bile::create(surface, weight, base_->setup.up, base_->middle);
  if (!bile) return bile.failure();
  refined_->bile.emplace(std::move(bile).value());
  return true;
}

VecX ShellBody::coordinates_in(const ShellBody& other, const VecX& x) const {
  const Eigen::Index coarse = 3 * Eigen::Index{coarse_nodes()};
  VecX out = VecX::Zero(other.refined_->rest.size());
  out.head(coarse) = x.head(coarse);
  for (std::size_t i = 0; i < other.details().size(); ++i) {
    const int here = index_of(other.details()[i], details());
    if (here >= 0)
      out.segment<3>(coarse + 3 * static_cast<Eigen::Index>(i)) = x.segment<3>(coarse + 3 * here);
  }
  return out;
}

int ShellBody::levels_used() const { return details().empty() ? 0 : levels().level_of(details().back()); }

double ShellBody::detail_stiffness(int index) const {
  const ShellMaterial& material = base_->setup.material;
  // In membrane and in bending; the factors fit the diagonal of the Hessian at rest of a ball and a gallbladder, two
  // levels each.
  const double h = material.membrane.thickness, slope = h / refined_->edge_lengths[coarse_nodes() + index];
  return material.membrane.shear_modulus * h * (1.5 + 0.27 * slope * slope);
}

double ShellBody::largest_motion(const VecX& dx) const {
  const Eigen::Index coarse = 3 * Eigen::Index{coarse_nodes()};
  if (dx.size() == coarse) return largest_node(dx);
  // The weights of the coarse nodes sum to 1, those of one level's details to less.
  double sum = largest_node(dx.head(coarse));
  std::size_t begin = 0;
  while (begin < details().size()) {
    std::size_t end = begin;
    const int level = levels().level_of(details()[begin]);
    while (end < details().size() && details()[end] < levels().nodes(level)) ++end;
    sum += largest_node(dx.segment(coarse + 3 * static_cast<Eigen::Index>(begin),
                                   3 * static_cast<Eigen::Index>(end - begin)));
    begin = end;
  }
  return sum;
}

std::vector<Vec3> ShellBody::skin_normals(const VecX& x) const {
  // Only the base has derivatives: details are added to a copy of it, where there are any.
  std::optional<StencilTable> extended;
  if (!details().empty())
    extended = refined_->surface.basis.extend(base_->skin.stencils, base_->skin.at, base_->skin_by_level);
  const StencilTable& table = extended ? *extended : base_->skin.stencils;
  const std::vector<Vec3> u = blend_all(table, table.du, x), v = blend_all(table, table.dv, x);
  std::vector<Vec3> normals(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) normals[i] = u[i].cross(v[i]).normalized();
  return normals;
}

}  // namespace calot
