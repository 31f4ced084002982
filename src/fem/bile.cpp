#include "fem/bile.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace calot {
namespace {

constexpr int few_points = 6, most_points = 12;  // of a cell: an element matrix is made for either

double tetra_volume(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) / 6.0; }

}  // namespace

Result<BileSurface> extrapolated(const Tessellation& surface, int faces) {
  BileSurface out;
  if (static_cast<int>(surface.triangles.size()) != 4 * faces)
    return fail(FailureKind::internal, fmt::format("bile needs 4 triangles a face, not {} for {} faces",
                                                   surface.triangles.size(), faces));
  out.points = surface.stencils;
  for (int f = 0; f < faces; ++f) {
    std::vector<BileSurface::Part> cell;
    std::map<int, int> uses;
    for (int t = 4 * f; t < 4 * f + 4; ++t) {
      cell.push_back({surface.triangles[t], 4.0 / 3.0});
      for (int p : surface.triangles[t]) ++uses[p];
    }
    // The whole face: each of its corners belongs to one of the four only, which lists it in the face's sense.
    BileSurface::Part whole{{}, -1.0 / 3.0};
    int corner = 0;
    for (int t = 4 * f; t < 4 * f + 4; ++t)
      for (int p : surface.triangles[t])
        if (uses[p] == 1 && corner < 3) whole.corners[corner++] = p;
    if (uses.size() != few_points || corner != 3)
      return fail(FailureKind::internal,
                  fmt::format("face {} of the bile's surface is not a split triangle", f));
    cell.push_back(whole);
    out.cells.push_back(std::move(cell));
  }
  return out;
}

Result<Bile> Bile::create(const BileSurface& surface, double specific_weight, const Vec3& up,
                          const Vec3& datum) {
  Bile bile;
  bile.points_ = surface.points;
  bile.specific_weight_ = specific_weight;
  bile.up_ = up;
  bile.datum_ = datum;
  const StencilTable& table = bile.points_;
  for (std::size_t c = 0; c < surface.cells.size(); ++c) {
    Cell cell;
    cell.first_part = static_cast<int>(bile.parts_.size());
    const std::vector<int> points = bile.add_parts(surface.cells[c]);
    if (points.size() > most_points)
      return fail(FailureKind::internal, fmt::format("cell {} of the bile has {} points", c, points.size()));
    cell.points = points.size() > few_points ? most_points : few_points;
    for (int p : points)
      cell.nodes.nodes.insert(cell.nodes.nodes.end(), table.node.begin() + table.begin[p],
                              table.node.begin() + table.begin[p + 1]);
    cell.nodes.finish();
    if (cell.nodes.padded > max_face_nodes)
      return fail(FailureKind::scenario,
                  fmt::format("cell {} of the bile depends on {} nodes", c, cell.nodes.nodes.size()),
                  "remesh: a vertex has too many neighbours");
    cell.weights = static_cast<int>(bile.weights_.size());
    bile.weights_.resize(bile.weights_.size() + static_cast<std::size_t>(cell.points) * cell.nodes.padded,
                         0.0);
    for (std::size_t k = 0; k < points.size(); ++k)
      dense_weights(table, table.value, points[k], cell.nodes,
                    &bile.weights_[cell.weights + k * cell.nodes.padded]);
    bile.cells_.push_back(std::move(cell));
  }
  return bile;
}

std::vector<int> Bile::add_parts(const std::vector<BileSurface::Part>& parts) {
  std::vector<int> points;
  for (const BileSurface::Part& from : parts) {
    Part part{from.corners, {}, from.weight};
    for (int k = 0; k < 3; ++k) {
      const auto found = std::find(points.begin(), points.end(), part.corners[k]);
      part.local[k] = static_cast<int>(found - points.begin());
      if (found == points.end()) points.push_back(part.corners[k]);
    }
    parts_.push_back(part);
  }
  return points;
}

std::vector<Vec3> Bile::positions(const VecX& x) const {
  std::vector<Vec3> out = blend_all(points_, points_.value, x);
  for (Vec3& p : out) p -= datum_;
  return out;
}

double Bile::volume(const VecX& x) const {
  const std::vector<Vec3> at = positions(x);
  double sum = 0;
  for (const auto& [t, local, w] : parts_) sum += w * tetra_volume(at[t[0]], at[t[1]], at[t[2]]);
  return sum;
}

double Bile::value(const VecX& x) const {
  const std::vector<Vec3> at = positions(x);
  double sum = 0;
  for (const auto& [t, local, w] : parts_)
    sum += w * tetra_volume(at[t[0]], at[t[1]], at[t[2]]) * up_.dot(at[t[0]] + at[t[1]] + at[t[2]]);
  return 0.25 * specific_weight_ * sum;  // the fourth corner of each tetrahedron is the datum, at height 0
}

double Bile::add_volume_gradient(const VecX& x, VecX& gradient) const {
  const std::vector<Vec3> at = positions(x);
  std::vector<Vec3> by_point(at.size(), Vec3::Zero());
  double sum = 0;
  for (const auto& [t, local, w] : parts_) {
    const Vec3 &a = at[t[0]], &b = at[t[1]], &c = at[t[2]];
    sum += w * tetra_volume(a, b, c);
    by_point[t[0]] += w / 6.0 * b.cross(c);
    by_point[t[1]] += w / 6.0 * c.cross(a);
    by_point[t[2]] += w / 6.0 * a.cross(b);
  }
  spread(points_, by_point, gradient);
  return sum;
}

void Bile::add_load(const VecX& x, double multiplier, VecX& gradient) const {
  const std::vector<Vec3> at = positions(x);
  std::vector<Vec3> by_point(at.size(), Vec3::Zero());
  const double g4 = 0.25 * specific_weight_;
  for (const auto& [t, local, w] : parts_) {
    const Vec3 &a = at[t[0]], &b = at[t[1]], &c = at[t[2]];
    const double s = w * (g4 * up_.dot(a + b + c) - multiplier) / 6.0;
    const Vec3 same = w * g4 * tetra_volume(a, b, c) * up_;
    by_point[t[0]] += s * b.cross(c) + same;
    by_point[t[1]] += s * c.cross(a) + same;
    by_point[t[2]] += s * a.cross(b) + same;
  }
  spread(points_, by_point, gradient);
}

namespace {

/// Second derivatives of weight V (g4 up . (a + b + c) - m) by the corners, added to `h` at local points
/// `local`.
template <class CellHessian>
void add_triangle_hessian(const Vec3* corner, const int* local, double weight, double g4, const Vec3& up,
                          double multiplier, CellHessian& h) {
  const double s = weight * (g4 * up.dot(corner[0] + corner[1] + corner[2]) - multiplier) / 6.0;
  Vec3 by[3];  // gradient of V, weighed
  for (int i = 0; i < 3; ++i) by[i] = weight / 6.0 * corner[(i + 1) % 3].cross(corner[(i + 2) % 3]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Mat3 block = g4 * (by[i] * up.transpose() + up * by[j].transpose());
      // d2V by (i, i + 1) = -[third corner] / 6, by (i + 1, i) its transpose.
      if (j == (i + 1) % 3) block -= s * cross_matrix(corner[(i + 2) % 3]);
      if (i == (j + 1) % 3) block += s * cross_matrix(corner[(j + 2) % 3]);
      h.template block<3, 3>(3 * local[i], 3 * local[j]) += block;
    }
  }
}

}  // namespace

template <int Points>
void Bile::add_cell_hessian(std::size_t cell, const std::vector<Vec3>& at, double multiplier,
                            BlockMatrix& matrix) const {
  const double g4 = 0.25 * specific_weight_;
  Eigen::Matrix<double, 3 * Points, 3 * Points> h;
  h.setZero();
  const std::size_t end =
      cell + 1 < cells_.size() ? static_cast<std::size_t>(cells_[cell + 1].first_part) : parts_.size();
  for (std::size_t k = cells_[cell].first_part; k < end; ++k) {
    const Part& part = parts_[k];
    const Vec3 corner[3] = {at[part.corners[0]], at[part.corners[1]], at[part.corners[2]]};
    add_triangle_hessian(corner, part.local, part.weight, g4, up_, multiplier, h);
  }
  ElementMatrix element;
  element.reset(cells_[cell].nodes.padded);
  element.add<Points>(weights_.data() + cells_[cell].weights, h);
  element.scatter(cells_[cell].nodes, matrix);
}

void Bile::add_hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const {
  const std::vector<Vec3> at = positions(x);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (cells_[c].points == few_points)
      add_cell_hessian<few_points>(c, at, multiplier, matrix);
    else
      add_cell_hessian<most_points>(c, at, multiplier, matrix);
  }
}

double Bile::pressure_at(const Vec3& position, double multiplier) const {
  return multiplier - specific_weight_ * up_.dot(position - datum_);
}

double Bile::pressure_at_top(const VecX& x, double multiplier) const {
  double top = -1e300;
  for (const Vec3& p : positions(x)) top = std::max(top, up_.dot(p));
  return multiplier - specific_weight_ * top;
}

std::vector<std::vector<int>> Bile::cliques() const {
  std::vector<std::vector<int>> out;
  for (const Cell& cell : cells_) out.push_back(cell.nodes.nodes);
  return out;
}

}  // namespace calot
