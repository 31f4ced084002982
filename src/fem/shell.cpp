#include "fem/shell.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace calot {

std::vector<QuadraturePoint> one_point_rule() { return {{1.0 / 3.0, 1.0 / 3.0, 0.5}}; }

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

/// The surface at a quadrature point: derivatives d[0..4] = du, dv, duu, duv, dvv, forms and normal.
struct Shell::Local {
  Vec3 d[5];
  SurfaceTensor metric, curvature;
  Vec3 normal;
  double jacobian = 0;

  void finish() {
    metric = {d[0].dot(d[0]), d[0].dot(d[1]), d[1].dot(d[1])};
    const Vec3 m = d[0].cross(d[1]);
    jacobian = m.norm();
    normal = m / jacobian;
    curvature = {d[2].dot(normal), d[3].dot(normal), d[4].dot(normal)};
  }

  /// Gradient of the normal-direction products w . n by (d0, d1), for w constant.
  void normal_gradient(const Vec3& w, Vec3& by_u, Vec3& by_v) const {
    const Vec3 g = (w - normal * normal.dot(w)) / jacobian;
    by_u = d[1].cross(g);
    by_v = g.cross(d[0]);
  }
};

namespace {

using Matrix15 = Eigen::Matrix<double, 15, 15>;
using Matrix15x3 = Eigen::Matrix<double, 15, 3>;

/// Rows of the three metric components by the 15 derivatives: only d0, d1 take part.
void metric_rows(const Vec3* d, Eigen::Matrix<double, 6, 3>& rows) {
  rows.col(0) << 2 * d[0], Vec3::Zero();
  rows.col(1) << d[1], d[0];
  rows.col(2) << Vec3::Zero(), 2 * d[1];
}

void add_membrane(const Vec3* d, const MembraneSample& s, double area, Matrix15& h) {
  Eigen::Matrix<double, 6, 3> rows;
  metric_rows(d, rows);
  h.topLeftCorner<6, 6>() += area * (rows * s.hessian * rows.transpose());
  h.block<3, 3>(0, 0).diagonal().array() += area * 2 * s.gradient[0];
  h.block<3, 3>(3, 3).diagonal().array() += area * 2 * s.gradient[2];
  h.block<3, 3>(0, 3).diagonal().array() += area * s.gradient[1];
  h.block<3, 3>(3, 0).diagonal().array() += area * s.gradient[1];
}

/// Second derivatives of w . n (w constant) by (d0, d1), and of w . n by (w, d0 or d1).
/// f(m) = w . m / |m|, m = d0 x d1: Hess f = -(Pw n' + n (Pw)' + f P) / |m|^2, grad f = Pw / |m|.
void add_normal_hessian(const Vec3* d, const Vec3& normal, double jacobian, const Vec3& w, Matrix15& h) {
  const Mat3 projector = Mat3::Identity() - normal * normal.transpose();
  const Vec3 pw = projector * w;
  const Mat3 by_m = -(pw * normal.transpose() + normal * pw.transpose() + w.dot(normal) * projector) /
                    (jacobian * jacobian);
  // dm = -[d1] du + [d0] dv.
  const Mat3 mu = -cross_matrix(d[1]), mv = cross_matrix(d[0]);
  h.block<3, 3>(0, 0) += mu.transpose() * by_m * mu;
  h.block<3, 3>(3, 3) += mv.transpose() * by_m * mv;
  // d2m(du, dv) = du x dv, so grad . (du x dv) = du' [.] dv with -[grad].
  const Mat3 cross = mu.transpose() * by_m * mv - cross_matrix(pw / jacobian);
  h.block<3, 3>(0, 3) += cross;
  h.block<3, 3>(3, 0) += cross.transpose();
}

}  // namespace

Shell::Local Shell::local(const Point& point, const VecX& x) const {
  const FaceNodes& face = faces_[point.face];
  const double* w = weights_.data() + point.weights;
  Local out;
  for (Vec3& d : out.d) d.setZero();
  const int count = static_cast<int>(face.nodes.size());
  for (int a = 0; a < count; ++a) {
    const Vec3 p = x.segment<3>(3 * face.nodes[a]);
    for (int k = 0; k < 5; ++k) out.d[k] += w[k * face.padded + a] * p;
  }
  out.finish();
  return out;
}

void Shell::lay_fibres(const FibreLayout& layout, const Local& at, Point& point) {
  const Vec3 axis = layout.axis.normalized();
  const Vec3 along = axis - at.normal * at.normal.dot(axis);
  Fibres fibres;
  fibres.share = along.squaredNorm();
  // At a pole, where `along` is zero, it stays zero when normalised: then I4 is 0 and the fibres are slack.
  const Vec3 u = along.normalized(), v = at.normal.cross(u);
  for (int k = 0; k < 2; ++k) {
    const Vec3 m = std::cos(layout.angle) * u + (k == 0 ? 1 : -1) * std::sin(layout.angle) * v;
    const double by_u = m.dot(at.d[0]), by_v = m.dot(at.d[1]);
    const SurfaceTensor& inverse = point.rest_inverse;
    fibres.directions[k] =
        fibre_direction(inverse[0] * by_u + inverse[1] * by_v, inverse[1] * by_u + inverse[2] * by_v);
  }
  point.fibres = static_cast<int>(fibres_.size());
  fibres_.push_back(fibres);
}

double Shell::membrane_energy(const Point& point, const SurfaceTensor& metric) const {
  double energy = material_.membrane.energy(point.rest_inverse, point.rest_determinant, metric);
  if (point.fibres < 0) return energy;
  const Fibres& fibres = fibres_[point.fibres];
  for (const SurfaceTensor& direction : fibres.directions)
    energy += fibres.share * material_.fibres->family.energy(direction, metric);
  return energy;
}

MembraneSample Shell::membrane(const Point& point, const SurfaceTensor& metric) const {
  MembraneSample sum = material_.membrane.sample(point.rest_inverse, point.rest_determinant, metric);
  if (point.fibres < 0) return sum;
  const Fibres& fibres = fibres_[point.fibres];
  for (const SurfaceTensor& direction : fibres.directions) {
    const MembraneSample family = material_.fibres->family.sample(direction, metric);
    sum.energy += fibres.share * family.energy;
    sum.gradient += fibres.share * family.gradient;
    sum.hessian += fibres.share * family.hessian;
  }
  return sum;
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

Result<Shell> Shell::create(const Quadrature& quadrature, const VecX& rest, const ShellMaterial& material) {
  if (material.fibres && !(material.fibres->axis.norm() > 0))
    return fail(FailureKind::scenario, "the wall's fibres have no axis", "give a direction that is not zero");
  Shell shell;
  shell.material_ = material;
  const StencilTable& table = quadrature.stencils;
  shell.faces_ = gather_faces(table, quadrature.element, quadrature.elements());
  const std::vector<double>* orders[5] = {&table.du, &table.dv, &table.duu, &table.duv, &table.dvv};
  for (int r = 0; r < table.rows(); ++r) {
    Point point;
    point.face = quadrature.element[r];
    const FaceNodes& face = shell.faces_[point.face];
    if (face.padded > max_face_nodes)
      return fail(FailureKind::scenario,
                  fmt::format("face {} depends on {} nodes", point.face, face.nodes.size()),
                  "remesh: a vertex has too many neighbours");
    point.weights = static_cast<int>(shell.weights_.size());
    shell.weights_.resize(shell.weights_.size() + 5 * face.padded, 0.0);
    for (int k = 0; k < (material.bends ? 5 : 2); ++k)
      dense_weights(table, *orders[k], r, face, shell.weights_.data() + point.weights + k * face.padded);
    const Local at = shell.local(point, rest);
    const double det = at.jacobian * at.jacobian;
    if (!(det > 0) || !std::isfinite(det))
      return fail(FailureKind::scenario, fmt::format("the rest surface is degenerate in face {}", point.face),
                  "check the control mesh for flat or repeated triangles");
    point.area = quadrature.weights[r] * at.jacobian;
    point.rest_determinant = det;
    point.rest_inverse = Vec3(at.metric[2], -at.metric[1], at.metric[0]) / det;
    point.rest_curvature = at.curvature;
    if (material.bends) point.bending = material.bending.hessian(point.rest_inverse);
    if (material.fibres) shell.lay_fibres(*material.fibres, at, point);
    shell.points_.push_back(point);
  }
  return shell;
}

double Shell::value(const VecX& x) const {
  double sum = 0;
  for (const Point& point : points_) {
    const Local at = local(point, x);
    double energy = membrane_energy(point, at.metric);
    if (!std::isfinite(energy)) return std::numeric_limits<double>::infinity();
    if (material_.bends) {
      const Vec3 k = at.curvature - point.rest_curvature;
      energy += 0.5 * k.dot(point.bending * k);
    }
    sum += point.area * energy;
  }
  return sum;
}

void Shell::add_gradient(const VecX& x, VecX& gradient) const {
  for (const Point& point : points_) {
    const Local at = local(point, x);
    const MembraneSample s = membrane(point, at.metric);
    Vec3 g[5];
    g[0] = 2 * s.gradient[0] * at.d[0] + s.gradient[1] * at.d[1];
    g[1] = 2 * s.gradient[2] * at.d[1] + s.gradient[1] * at.d[0];
    int rows = 2;
    if (material_.bends) {
      rows = 5;
      const Vec3 moment = point.bending * (at.curvature - point.rest_curvature);
      const Vec3 w = moment[0] * at.d[2] + moment[1] * at.d[3] + moment[2] * at.d[4];
      Vec3 by_u, by_v;
      at.normal_gradient(w, by_u, by_v);
      g[0] += by_u;
      g[1] += by_v;
      for (int k = 0; k < 3; ++k) g[2 + k] = moment[k] * at.normal;
    }
    const FaceNodes& face = faces_[point.face];
    const double* weights = weights_.data() + point.weights;
    for (std::size_t a = 0; a < face.nodes.size(); ++a) {
      Vec3 sum = Vec3::Zero();
      for (int k = 0; k < rows; ++k) sum += weights[k * face.padded + static_cast<int>(a)] * g[k];
      gradient.segment<3>(3 * face.nodes[a]) += point.area * sum;
    }
  }
}

void Shell::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  ElementMatrix element;
  int current = -1;
  Matrix15 h;
  for (const Point& point : points_) {
    if (point.face != current) {
      if (current >= 0) element.scatter(faces_[current], matrix);
      current = point.face;
      element.reset(faces_[current].padded);
    }
    const Local at = local(point, x);
    const MembraneSample s = membrane(point, at.metric);
    h.setZero();
    add_membrane(at.d, s, point.area, h);
    const double* weights = weights_.data() + point.weights;
    if (!material_.bends) {
      element.add<2>(weights, h.topLeftCorner<6, 6>());
      continue;
    }
    // b_k = d[2 + k] . n; its gradient by all 15.
    Matrix15x3 rows;
    rows.setZero();
    for (int k = 0; k < 3; ++k) {
      Vec3 by_u, by_v;
      at.normal_gradient(at.d[2 + k], by_u, by_v);
      rows.col(k).segment<3>(0) = by_u;
      rows.col(k).segment<3>(3) = by_v;
      rows.col(k).segment<3>(6 + 3 * k) = at.normal;
    }
    const Mat3 bending = point.area * point.bending;
    const Vec3 moment = bending * (at.curvature - point.rest_curvature);
    h.noalias() += rows * bending * rows.transpose();
    const Vec3 w = moment[0] * at.d[2] + moment[1] * at.d[3] + moment[2] * at.d[4];
    add_normal_hessian(at.d, at.normal, at.jacobian, w, h);
    // Mixed by w_k and (d0, d1): moment_k P / |m| times dm.
    const Mat3 projector = (Mat3::Identity() - at.normal * at.normal.transpose()) / at.jacobian;
    const Mat3 pu = -projector * cross_matrix(at.d[1]), pv = projector * cross_matrix(at.d[0]);
    for (int k = 0; k < 3; ++k) {
      const int row = 6 + 3 * k;
      h.block<3, 3>(row, 0) += moment[k] * pu;
      h.block<3, 3>(row, 3) += moment[k] * pv;
      h.block<3, 3>(0, row) += moment[k] * pu.transpose();
      h.block<3, 3>(3, row) += moment[k] * pv.transpose();
    }
    element.add<5>(weights, h);
  }
  if (current >= 0) element.scatter(faces_[current], matrix);
}

double Shell::rest_area() const {
  double sum = 0;
  for (const Point& point : points_) sum += point.area;
  return sum;
}

std::vector<double> Shell::point_areas() const {
  std::vector<double> out;
  for (const Point& point : points_) out.push_back(point.area);
  return out;
}

double Shell::max_stretch(const VecX& x) const {
  double largest = 0;
  for (const Point& point : points_)
    largest = std::max(largest, largest_stretch(point.rest_inverse, local(point, x).metric));
  return largest;
}

std::vector<std::vector<int>> Shell::cliques() const {
  std::vector<std::vector<int>> out;
  for (const FaceNodes& face : faces_) out.push_back(face.nodes);
  return out;
}

}  // namespace calot
