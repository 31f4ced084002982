#include "paper/star_structure.h"

#include <cmath>

#include "base/units.h"

namespace calot {
namespace {

/// The flat triangles themselves: their sum is exact.
BileSurface flat_surface(const TriMesh& mesh) {
  BileSurface out;
  for (int node = 0; node < static_cast<int>(mesh.points.size()); ++node) {
    out.points.node.push_back(node);
    out.points.value.push_back(1);
    out.points.begin.push_back(node + 1);
  }
  for (const Triangle& t : mesh.triangles) out.cells.push_back({{t, 1}});
  return out;
}

}  // namespace

Result<PaperElements> PaperElements::create(const TriMesh& mesh, const std::vector<Triangle>& neighbours,
                                            const PaperSetup& setup) {
  PaperElements out;
  out.rest = to_coordinates(mesh.points);
  const int faces = static_cast<int>(mesh.triangles.size());
  std::vector<FacePoint> middles;
  for (int f = 0; f < faces; ++f) middles.push_back({f, 1.0 / 3.0, 1.0 / 3.0});
  const double mu = setup.wall.shear_modulus, thickness = setup.wall.thickness;
  Result<Shell> membrane =
      Shell::create(face_by_face(linear_stencils(mesh.triangles, middles), {{1.0 / 3, 1.0 / 3, 0.5}}),
                    out.rest, {{mu, thickness}, {mu, thickness}, false});
  if (!membrane) return membrane.failure();
  std::vector<Triangle> hinged = mesh.triangles;
  hinged.insert(hinged.end(), neighbours.begin(), neighbours.end());
  Result<Hinges> hinges = Hinges::create(hinged, out.rest, KoiterBending{mu, thickness}.rigidity());
  if (!hinges) return hinges.failure();
  Result<Bile> bile =
      Bile::create(flat_surface(mesh), setup.bile_density * units::standard_gravity, setup.up, Vec3::Zero());
  if (!bile) return bile.failure();
  out.membrane = std::move(membrane).value();
  out.hinges = std::move(hinges).value();
  out.bile = std::move(bile).value();
  out.edges = shortest_edges(mesh);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.points) box.extend(p);
  out.size = box.diagonal().norm();
  out.cliques = out.membrane.cliques();
  for (std::vector<int>& clique : out.hinges.cliques()) out.cliques.push_back(std::move(clique));
  out.pattern = PaperProblem::pattern(out, 0);
  return out;
}

namespace {

/// The entries of nodes `first`, first + 1, ... among those of all: the unknowns come last and only the lower triangle
/// is kept.
std::vector<double> entries_from(const BlockMatrix& all, int first) {
  return {all.entries().begin() + all.column_starts()[3 * first], all.entries().end()};
}

}  // namespace

void PaperSprings::find_hessian(const PaperElements& elements, const StencilTable& points, int first) {
  BlockMatrix all = elements.pattern;
  links.add_hessian(points, all);
  hessian = entries_from(all, first);
}

PaperProblem::PaperProblem(const PaperElements& elements, const StencilTable& points,
                           const PaperSprings& springs, std::optional<double> volume, double datum_pressure,
                           const VecX& nodes, int first)
    : elements_(elements),
      points_(points),
      springs_(springs),
      volume_(volume),
      datum_pressure_(datum_pressure),
      nodes_(nodes),
      first_(first) {}

BlockMatrix PaperProblem::pattern(const PaperElements& elements, int first) {
  std::vector<std::vector<int>> cliques;
  for (const std::vector<int>& clique : elements.cliques) {
    cliques.emplace_back();
    for (int node : clique)
      if (node >= first) cliques.back().push_back(node - first);
  }
  return BlockMatrix(static_cast<int>(elements.rest.size()) / 3 - first, cliques);
}

VecX PaperProblem::whole(const VecX& x) const {
  VecX out = nodes_;
  out.tail(x.size()) = x;
  return out;
}

double PaperProblem::value(const VecX& x) const {
  const VecX all = whole(x);
  double sum = elements_.membrane.value(all);
  if (!std::isfinite(sum)) return sum;
  sum += elements_.hinges.value(all) + springs_.links.value(points_, all) + elements_.bile.value(all);
  if (!volume_) sum -= datum_pressure_ * elements_.bile.volume(all);
  return sum;
}

void PaperProblem::gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  const VecX all = whole(x);
  VecX g = VecX::Zero(all.size());
  elements_.membrane.add_gradient(all, g);
  elements_.hinges.add_gradient(all, g);
  largest_internal = largest_node(g.tail(x.size()));
  springs_.links.add_gradient(points_, all, g);
  elements_.bile.add_load(all, volume_ ? 0.0 : datum_pressure_, g);
  gradient = g.tail(x.size());
  largest_internal = force_scale(largest_internal, gradient);
}

void PaperProblem::add_elements(const VecX& all, double datum_pressure, BlockMatrix& matrix) const {
  elements_.membrane.add_hessian(all, matrix);
  elements_.hinges.add_hessian(all, matrix);
  elements_.bile.add_hessian(all, volume_ ? datum_pressure : datum_pressure_, matrix);
}

void PaperProblem::hessian(const VecX& x, double datum_pressure, BlockMatrix& matrix) const {
  if (first_ == 0) {
    matrix.set_zero();
    add_elements(x, datum_pressure, matrix);
  } else {
    BlockMatrix all = elements_.pattern;
    add_elements(whole(x), datum_pressure, all);
    matrix.assign(entries_from(all, first_));
  }
  matrix.add(springs_.hessian);
}

double PaperProblem::constraint(const VecX& x, VecX& gradient) const {
  gradient.setZero(x.size());
  return elements_.bile.add_volume_gradient(x, gradient) - *volume_;
}

double PaperProblem::constraint_value(const VecX& x) const { return elements_.bile.volume(x) - *volume_; }

double PaperProblem::safe_share(const VecX&, const VecX& step) const {
  double share = 1.0;
  for (int i = 0; 3 * i < step.size(); ++i)
    share = std::min(share, 0.5 * elements_.edges[first_ + i] / step.segment<3>(3 * i).norm());
  return share;
}

PaperBody::Stage PaperBody::make_stage(PaperElements elements, StencilTable points, std::vector<bool> loaded,
                                       std::optional<double> volume, int first,
                                       std::optional<FactorKind> solver) {
  const VecX rest = elements.rest;
  NewtonWorkspace work(PaperProblem::pattern(elements, first));
  if (solver) work.factor = Cholesky(work.matrix, work.matrix.nodes(), *solver);
  Stage stage{std::move(elements),
              std::move(points),
              std::move(loaded),
              volume,
              first,
              rest,
              std::move(work),
              {},
              {},
              {}};
  stage.springs.find_hessian(stage.elements, stage.points, first);
  return stage;
}

Result<PaperBody> PaperBody::one_system(const TriMesh& mesh, const std::vector<FacePoint>& points,
                                        const PaperSetup& setup) {
  Result<PaperElements> elements = PaperElements::create(mesh, {}, setup);
  if (!elements) return elements.failure();
  PaperBody body;
  body.setup_ = setup;
  const double volume = setup.fill * elements->bile.volume(elements->rest);
  body.stages_.push_back(make_stage(std::move(elements).value(), linear_stencils(mesh.triangles, points),
                                    std::vector<bool>(points.size(), true), volume, 0, setup.solver));
  return body;
}

Result<PaperBody> PaperBody::two_stages(const TriMesh& coarse, const std::vector<FacePoint>& points,
                                        const StarMesh& split, const std::vector<FacePoint>& split_points,
                                        const PaperSetup& setup) {
  Result<PaperBody> body = one_system(coarse, points, setup);
  if (!body) return body;
  TriMesh stars{split.mesh.points, {}};
  std::vector<Triangle> others;
  for (std::size_t t = 0; t < split.parent.size(); ++t)
    (split.extended[t] ? stars.triangles : others).push_back(split.mesh.triangles[t]);
  Result<PaperElements> elements = PaperElements::create(stars, others, setup);
  if (!elements) return elements.failure();
  std::vector<bool> loaded;
  for (const FacePoint& p : split_points) loaded.push_back(split.extended[p.face]);
  body->stages_.push_back(make_stage(std::move(elements).value(),
                                     linear_stencils(split.mesh.triangles, split_points), std::move(loaded),
                                     std::nullopt, split.coarse_nodes, setup.solver));
  body->places_ = linear_stencils(coarse.triangles, split.places);
  return body;
}

void PaperBody::bind(const std::vector<double>& stiffness, const Vec3& travel) {
  for (Stage& stage : stages_) {
    for (int p = 0; p < stage.points.rows(); ++p) {
      if (stiffness[p] <= 0 || !stage.loaded[p]) continue;
      const Vec3 at = blend(stage.points, stage.points.value, p, stage.nodes);
      stage.springs.links.row.push_back(p);
      stage.springs.links.target.push_back(at);
      stage.springs.links.stiffness.push_back(stiffness[p]);
      stage.from.push_back(at);
      stage.travel.push_back(travel);
    }
    stage.springs.find_hessian(stage.elements, stage.points, stage.first);
  }
}

/// The coarse nodes go to where the first stage has them, and the extension with them.
void PaperBody::carry_extension() {
  const VecX& coarse = stages_[0].nodes;
  VecX& nodes = stages_[1].nodes;
  const VecX moved = coarse - nodes.head(coarse.size());
  nodes.head(coarse.size()) = coarse;
  for (int r = 0; r < places_.rows(); ++r)
    nodes.segment<3>(coarse.size() + 3 * r) += blend(places_, places_.value, r, moved);
}

NewtonResult PaperBody::solve(Stage& stage, double share) {
  for (std::size_t i = 0; i < stage.from.size(); ++i)
    stage.springs.links.target[i] = stage.from[i] + share * stage.travel[i];
  const PaperProblem problem(stage.elements, stage.points, stage.springs, stage.volume, datum_pressure_,
                             stage.nodes, stage.first);
  VecX x = stage.nodes.tail(stage.nodes.size() - 3 * stage.first);
  double datum_pressure = datum_pressure_;
  const NewtonResult result = solve_equilibrium(problem, setup_.newton, stage.work, x, datum_pressure);
  stage.nodes.tail(x.size()) = x;
  if (stage.volume) datum_pressure_ = datum_pressure;
  return result;
}

NewtonResult PaperBody::settle(double share) {
  NewtonResult total = solve(stages_[0], share);
  if (stages_.size() == 1 || !total.converged()) return total;
  carry_extension();
  total.add(solve(stages_[1], share));
  return total;
}

std::vector<Vec3> PaperBody::surface() const {
  const Stage& stage = stages_.back();
  return blend_all(stage.points, stage.points.value, stage.nodes);
}

std::vector<const NewtonWorkspace*> PaperBody::systems() const {
  std::vector<const NewtonWorkspace*> out;
  for (const Stage& stage : stages_) out.push_back(&stage.work);
  return out;
}

double PaperBody::volume() const { return stages_[0].elements.bile.volume(stages_[0].nodes); }

}  // namespace calot
