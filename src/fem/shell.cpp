#include "fem/shell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot {

std::vector<QuadraturePoint> three_point_rule() {
  const double a = 1.0 / 6.0, b = 2.0 / 3.0;
  return {{a, a, a}, {b, a, a}, {a, b, a}};
}

std::vector<QuadraturePoint> six_point_rule() {
  const double a = 0.445948490915965, wa = 0.5 * 0.223381589678011;
  const double b = 0.091576213509771, wb = 0.5 * 0.109951743655322;
  return {{a, a, wa}, {1 - 2 * a, a, wa}, {a, 1 - 2 * a, wa},
          {b, b, wb}, {1 - 2 * b, b, wb}, {b, 1 - 2 * b, wb}};
}

Quadrature face_by_face(StencilTable table, const std::vector<QuadraturePoint>& rule) {
  Quadrature out;
  const int per_face = static_cast<int>(rule.size());
  for (int r = 0; r < table.rows(); ++r) {
    out.element.push_back(r / per_face);
    out.weights.push_back(rule[r % per_face].weight);
  }
  out.stencils = std::move(table);
  return out;
}

namespace {

SurfaceTensor tensor(const Lanes* components, int lane) {
  return {components[0][lane], components[1][lane], components[2][lane]};
}
Vec3 vector(const Lanes3& v, int lane) { return {v[0][lane], v[1][lane], v[2][lane]}; }
void set(const Vec3& from, int lane, Lanes* to) {
  for (int k = 0; k < 3; ++k) to[k][lane] = from[k];
}
/// The upper half of a symmetric form.
void set(const Mat3& from, int lane, LanesForm& to) {
  for (int pair = 0; pair < 6; ++pair)
    to.at[pair][lane] = from(component_pairs[pair][0], component_pairs[pair][1]);
}

}  // namespace

Result<Shell> Shell::create(const Quadrature& quadrature, const VecX& rest, const ShellMaterial& material,
                            const Shell* known, std::span<const int> known_rows) {
  if (material.fibres && !(material.fibres->axis.norm() > 0))
    return fail(FailureKind::scenario, "the wall's fibres have no axis", "give a direction that is not zero");
  Shell shell;
  shell.material_ = material;
  const int rows = quadrature.stencils.rows();
  shell.faces_ = gather_faces(quadrature.stencils, quadrature.element, quadrature.elements());
  for (const FaceNodes& face : shell.faces_)
    if (face.count() > max_face_nodes)
      return fail(FailureKind::scenario, fmt::format("a face depends on {} nodes", face.count()),
                  "remesh: a vertex has too many neighbours");
  for (int row = 0; row < rows;) {
    Points points;
    points.face = quadrature.element[row];
    shell.first_points_.resize(static_cast<std::size_t>(points.face) + 1, shell.points_.size());
    points.first = row;
    while (points.used < lane_count && row < rows && quadrature.element[row] == points.face)
      ++points.used, ++row;
    points.weights = shell.weights_.size();
    if (known != nullptr && known_rows[points.first] >= 0) {
      shell.take_over(*known, known_rows[points.first], points);
      shell.points_.push_back(points);
      continue;
    }
    shell.lay_weights(quadrature, points.first, points);
    if (!shell.lay_points(rest, quadrature.weights, points))
      return fail(FailureKind::scenario,
                  fmt::format("the rest surface is degenerate in face {}", points.face),
                  "check the control mesh for flat or repeated triangles");
    shell.points_.push_back(points);
  }
  shell.first_points_.push_back(shell.points_.size());
  return shell;
}

void Shell::take_over(const Shell& known, int row, Points& points) {
  const Points& from = *std::lower_bound(known.points_.begin(), known.points_.end(), row,
                                         [](const Points& p, int r) { return p.first < r; });
  const Points place = points;
  points = from;
  points.face = place.face, points.first = place.first, points.weights = place.weights;
  const auto weights = known.weights_.begin() + static_cast<std::ptrdiff_t>(from.weights);
  weights_.insert(weights_.end(), weights, weights + faces_[place.face].count());
  if (known.fibres_.empty()) return;
  const auto fibres = known.fibres_.begin() + from.first;
  fibres_.insert(fibres_.end(), fibres, fibres + from.used);
}

void Shell::lay_weights(const Quadrature& quadrature, int row, Points& points) {
  const StencilTable& table = quadrature.stencils;
  const FaceNodes& face = faces_[points.face];
  const std::vector<double>* orders[5] = {&table.du, &table.dv, &table.duu, &table.duv, &table.dvv};
  weights_.resize(weights_.size() + face.nodes.size(), NodeWeights{});
  for (int lane = 0; lane < lane_count; ++lane) {
    const int r = row + std::min(lane, points.used - 1);
    std::size_t place = 0;  // nodes increase in the face as in the row
    for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) {
      while (face.nodes[place] != table.node[e]) ++place;
      for (int k = 0; k < (material_.bends ? 5 : 2); ++k)
        weights_[points.weights + place].row[k][lane] = (*orders[k])[e];
    }
  }
}

bool Shell::lay_points(const VecX& rest, const std::vector<double>& weights, Points& points) {
  const ShellPoint at = local(points, rest);
  for (int lane = 0; lane < lane_count; ++lane) {
    const double det = at.jacobian[lane] * at.jacobian[lane];
    if (!(det > 0) || !std::isfinite(det)) return false;
    const SurfaceTensor metric = tensor(at.metric, lane);
    const SurfaceTensor inverse = Vec3(metric[2], -metric[1], metric[0]) / det;
    points.rest_determinant[lane] = det;
    set(inverse, lane, points.rest_inverse);
    set(tensor(at.curvature, lane), lane, points.rest_curvature);
    if (material_.bends) set(material_.bending.hessian(inverse), lane, points.bending);
    if (lane >= points.used) continue;
    points.area[lane] = weights[points.first + lane] * at.jacobian[lane];
    if (material_.fibres) lay_fibres(at, points, lane);
  }
  return true;
}

void Shell::lay_fibres(const ShellPoint& at, const Points& points, int lane) {
  const FibreLayout& layout = *material_.fibres;
  const Vec3 axis = layout.axis.normalized(), normal = vector(at.normal, lane);
  const Vec3 along = axis - normal * normal.dot(axis);
  const SurfaceTensor inverse = tensor(points.rest_inverse, lane);
  Fibres fibres;
  fibres.share = along.squaredNorm();
  // At a pole, where `along` is zero, it stays zero when normalised: then I4 is 0 and the fibres are slack.
  const Vec3 u = along.normalized(), v = normal.cross(u);
  for (int k = 0; k < 2; ++k) {
    const Vec3 m = std::cos(layout.angle) * u + (k == 0 ? 1 : -1) * std::sin(layout.angle) * v;
    const double by_u = m.dot(vector(at.d[0], lane)), by_v = m.dot(vector(at.d[1], lane));
    fibres.directions[k] =
        fibre_direction(inverse[0] * by_u + inverse[1] * by_v, inverse[1] * by_u + inverse[2] * by_v);
  }
  fibres_.push_back(fibres);
}

ShellPoint Shell::local(const Points& points, const VecX& x) const {
  const FaceNodes& face = faces_[points.face];
  const NodeWeights* weights = weights_.data() + points.weights;
  ShellPoint out;
  // Derivatives in two goes: their sums then stay in the processor's registers.
  Lanes3 first[2] = {}, second[3] = {};
  for (std::size_t a = 0; a < face.nodes.size(); ++a) {
    const double* p = x.data() + 3 * face.nodes[a];
    for (int k = 0; k < 2; ++k)
      for (int c = 0; c < 3; ++c) first[k][c] = fused(weights[a].row[k], all_lanes(p[c]), first[k][c]);
  }
  for (std::size_t a = 0; a < face.nodes.size() && material_.bends; ++a) {
    const double* p = x.data() + 3 * face.nodes[a];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) second[k][c] = fused(weights[a].row[2 + k], all_lanes(p[c]), second[k][c]);
  }
  for (int k = 0; k < 2; ++k) out.d[k] = first[k];
  for (int k = 0; k < 3; ++k) out.d[2 + k] = second[k];
  out.finish();
  return out;
}

double Shell::membrane_energy(const Points& points, int lane, const SurfaceTensor& metric) const {
  double energy =
      material_.membrane.energy(tensor(points.rest_inverse, lane), points.rest_determinant[lane], metric);
  if (fibres_.empty()) return energy;
  const Fibres& fibres = fibres_[points.first + lane];
  for (const SurfaceTensor& direction : fibres.directions)
    energy += fibres.share * material_.fibres->family.energy(direction, metric);
  return energy;
}

MembraneSample Shell::membrane(const Points& points, int lane, const SurfaceTensor& metric) const {
  MembraneSample sum =
      material_.membrane.sample(tensor(points.rest_inverse, lane), points.rest_determinant[lane], metric);
  if (fibres_.empty()) return sum;
  const Fibres& fibres = fibres_[points.first + lane];
  for (const SurfaceTensor& direction : fibres.directions) {
    const MembraneSample family = material_.fibres->family.sample(direction, metric);
    sum.energy += fibres.share * family.energy;
    sum.gradient += fibres.share * family.gradient;
    sum.hessian += fibres.share * family.hessian;
  }
  return sum;
}

double Shell::value(const VecX& x) const {
  double sum = 0;
  for (const Points& points : points_) {
    const ShellPoint at = local(points, x);
    Lanes energy = {};
    for (int lane = 0; lane < points.used; ++lane) {
      energy[lane] = membrane_energy(points, lane, tensor(at.metric, lane));
      if (!std::isfinite(energy[lane])) return std::numeric_limits<double>::infinity();
    }
    if (material_.bends) {
      Lanes bent[3];
      for (int k = 0; k < 3; ++k) bent[k] = at.curvature[k] - points.rest_curvature[k];
      for (int k = 0; k < 3; ++k) energy += 0.5 * bent[k] * points.bending.times(bent, k);
    }
    sum += sum_of(points.area * energy);
  }
  return sum;
}

/// Times the points' areas.
ShellStress Shell::stress(const Points& points, const ShellPoint& at) const {
  ShellStress out;
  for (Lanes& component : out.membrane) component = Lanes{};
  out.membrane_stiffness = {};
  for (int lane = 0; lane < points.used; ++lane) {
    const MembraneSample sample = membrane(points, lane, tensor(at.metric, lane));
    set(sample.gradient, lane, out.membrane);
    set(sample.hessian, lane, out.membrane_stiffness);
  }
  for (Lanes& component : out.membrane) component *= points.area;
  for (Lanes& component : out.membrane_stiffness.at) component *= points.area;
  if (!material_.bends) return out;
  Lanes bent[3];
  for (int k = 0; k < 3; ++k) bent[k] = at.curvature[k] - points.rest_curvature[k];
  for (int i = 0; i < 6; ++i) out.bending_stiffness.at[i] = points.area * points.bending.at[i];
  for (int k = 0; k < 3; ++k) out.moment[k] = out.bending_stiffness.times(bent, k);
  return out;
}

template <bool Bends>
void Shell::add_gradient(const Points& points, const VecX& x, VecX& gradient) const {
  constexpr int rows = Bends ? 5 : 2;
  const ShellPoint at = local(points, x);
  Lanes3 by[5];
  shell_gradient<Bends>(at, stress(points, at), by);
  const FaceNodes& face = faces_[points.face];
  const NodeWeights* weights = weights_.data() + points.weights;
  for (std::size_t a = 0; a < face.nodes.size(); ++a) {
    Lanes3 force;
    for (int k = 0; k < rows; ++k)
      for (int c = 0; c < 3; ++c) force[c] = fused(weights[a].row[k], by[k][c], force[c]);
    double* node = gradient.data() + 3 * face.nodes[a];
    for (int c = 0; c < 3; ++c) node[c] += sum_of(force[c]);
  }
}

void Shell::add_gradient(const VecX& x, VecX& gradient) const {
  for (const Points& points : points_)
    material_.bends ? add_gradient<true>(points, x, gradient) : add_gradient<false>(points, x, gradient);
}

template <bool Bends>
void Shell::add_hessian(const Points& points, const VecX& x, ElementMatrix& element) const {
  constexpr int derivatives = Bends ? 5 : 2;
  const ShellPoint at = local(points, x);
  ShellHessian h;
  shell_hessian<Bends>(at, stress(points, at), h);
  const int n = element.padded(), count = faces_[points.face].count();
  // Rows of weights, derivative k of point p at row p * derivatives + k, over the nodes.
  double weights[lane_count * derivatives * max_face_nodes],
      products[lane_count * derivatives * max_face_nodes];
  for (int p = 0; p < points.used; ++p) {
    for (int k = 0; k < derivatives; ++k) {
      double* row = weights + (p * derivatives + k) * n;
      for (int a = 0; a < count; ++a) row[a] = weights_[points.weights + a].row[k][p];
      for (int a = count; a < n; ++a) row[a] = 0;
    }
  }
  for (int pair = 0; pair < 6; ++pair) {
    for (int p = 0; p < points.used; ++p) {
      const double* w = weights + p * derivatives * n;
      for (int k = 0; k < derivatives; ++k) {
        double* row = products + (p * derivatives + k) * n;
        for (int a = 0; a < n; a += lane_count) {
          Lanes sum = {};
          for (int l = 0; l < derivatives; ++l)
            sum = fused(all_lanes(h.at[pair][k][l][p]), load_lanes(w + l * n + a), sum);
          store_lanes(sum, row + a);
        }
      }
    }
    element.add(pair, points.used * derivatives, weights, products);
  }
}

void Shell::face_hessian(std::size_t face, const VecX& x, ElementMatrix& element) const {
  element.reset(faces_[face].padded);
  for (std::size_t k = first_points_[face]; k < first_points_[face + 1]; ++k)
    material_.bends ? add_hessian<true>(points_[k], x, element) : add_hessian<false>(points_[k], x, element);
}

void Shell::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const {
  add_elements(faces_, matrix, assembly,
               [&](std::size_t face, ElementMatrix& element) { face_hessian(face, x, element); });
}

std::vector<double> Shell::point_areas() const {
  std::vector<double> out;
  for (const Points& points : points_)
    for (int lane = 0; lane < points.used; ++lane) out.push_back(points.area[lane]);
  return out;
}

double Shell::max_stretch(const VecX& x) const {
  double largest = 0;
  for (const Points& points : points_) {
    const ShellPoint at = local(points, x);
    for (int lane = 0; lane < points.used; ++lane)
      largest =
          std::max(largest, largest_stretch(tensor(points.rest_inverse, lane), tensor(at.metric, lane)));
  }
  return largest;
}

std::vector<std::vector<int>> Shell::cliques() const {
  std::vector<std::vector<int>> out;
  for (const FaceNodes& face : faces_) out.push_back(face.nodes);
  return out;
}

}  // namespace calot
