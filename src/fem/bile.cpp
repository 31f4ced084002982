#include "fem/bile.h"

#include <fmt/format.h>

#include <algorithm>

namespace calot {
namespace {

constexpr int points_per_face = 6;
constexpr std::size_t parts_per_face = 5;

double tetra_volume(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) / 6.0; }

}  // namespace

Result<Bile> Bile::create(const Tessellation& surface, int faces, double specific_weight, const Vec3& up,
                          const Vec3& datum) {
  Bile bile;
  if (static_cast<int>(surface.triangles.size()) != 4 * faces)
    return fail(FailureKind::internal, fmt::format("bile needs 4 triangles a face, not {} for {} faces",
                                                   surface.triangles.size(), faces));
  bile.surface_ = surface;
  bile.specific_weight_ = specific_weight;
  bile.up_ = up;
  bile.datum_ = datum;
  bile.faces_.resize(faces);
  const StencilTable& table = surface.stencils;
  for (int f = 0; f < faces; ++f) {
    const std::vector<int> points = bile.add_parts(f);
    if (static_cast<int>(points.size()) != points_per_face)
      return fail(FailureKind::internal,
                  fmt::format("face {} of the bile's surface is not a split triangle", f));
    FaceNodes& face = bile.faces_[f];
    for (int p : points)
      face.nodes.insert(face.nodes.end(), table.node.begin() + table.begin[p],
                        table.node.begin() + table.begin[p + 1]);
    face.finish();
    if (face.padded > max_face_nodes)
      return fail(FailureKind::scenario, fmt::format("face {} depends on {} nodes", f, face.nodes.size()),
                  "remesh: a vertex has too many neighbours");
    bile.weight_start_.push_back(static_cast<int>(bile.weights_.size()));
    for (int p : points) {
      bile.weights_.resize(bile.weights_.size() + face.padded);
      dense_weights(table, table.value, p, face, &bile.weights_[bile.weights_.size() - face.padded]);
    }
  }
  return bile;
}

std::vector<int> Bile::add_parts(int face) {
  std::vector<int> points, uses;
  for (int t = 4 * face; t < 4 * face + 4; ++t) {
    Part part{surface_.triangles[t], {}, 4.0 / 3.0};
    for (int k = 0; k < 3; ++k) {
      const auto found = std::find(points.begin(), points.end(), part.corners[k]);
      part.local[k] = static_cast<int>(found - points.begin());
      if (found == points.end()) {
        points.push_back(part.corners[k]);
        uses.push_back(0);
      }
      ++uses[part.local[k]];
    }
    parts_.push_back(part);
  }
  // The whole face: each of its corners belongs to one of the four only, which lists it in the face's sense.
  Part whole{{}, {}, -1.0 / 3.0};
  int corner = 0;
  for (std::size_t t = parts_.size() - 4; t < parts_.size(); ++t)
    for (int k = 0; k < 3 && corner < 3; ++k)
      if (uses[parts_[t].local[k]] == 1) {
        whole.corners[corner] = parts_[t].corners[k];
        whole.local[corner++] = parts_[t].local[k];
      }
  parts_.push_back(whole);
  return points;
}

std::vector<Vec3> Bile::positions(const VecX& x) const {
  std::vector<Vec3> out = blend_all(surface_.stencils, surface_.stencils.value, x);
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
  spread(surface_.stencils, by_point, gradient);
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
  spread(surface_.stencils, by_point, gradient);
}

namespace {

using FaceHessian = Eigen::Matrix<double, 3 * points_per_face, 3 * points_per_face>;

/// Second derivatives of weight V (g4 up . (a + b + c) - m) by the corners, added to `h` at local points
/// `local`.
void add_triangle_hessian(const Vec3* corner, const int* local, double weight, double g4, const Vec3& up,
                          double multiplier, FaceHessian& h) {
  const double s = weight * (g4 * up.dot(corner[0] + corner[1] + corner[2]) - multiplier) / 6.0;
  Vec3 by[3];  // gradient of V, weighed
  for (int i = 0; i < 3; ++i) by[i] = weight / 6.0 * corner[(i + 1) % 3].cross(corner[(i + 2) % 3]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Mat3 block = g4 * (by[i] * up.transpose() + up * by[j].transpose());
      // d2V by (i, i + 1) = -[third corner] / 6, by (i + 1, i) its transpose.
      if (j == (i + 1) % 3) block -= s * cross_matrix(corner[(i + 2) % 3]);
      if (i == (j + 1) % 3) block += s * cross_matrix(corner[(j + 2) % 3]);
      h.block<3, 3>(3 * local[i], 3 * local[j]) += block;
    }
  }
}

}  // namespace

void Bile::add_hessian(const VecX& x, double multiplier, BlockMatrix& matrix) const {
  const std::vector<Vec3> at = positions(x);
  const double g4 = 0.25 * specific_weight_;
  ElementMatrix element;
  FaceHessian h;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    h.setZero();
    for (std::size_t k = f * parts_per_face; k < (f + 1) * parts_per_face; ++k) {
      const Part& part = parts_[k];
      const Vec3 corner[3] = {at[part.corners[0]], at[part.corners[1]], at[part.corners[2]]};
      add_triangle_hessian(corner, part.local, part.weight, g4, up_, multiplier, h);
    }
    element.reset(faces_[f].padded);
    element.add<points_per_face>(weights_.data() + weight_start_[f], h);
    element.scatter(faces_[f], matrix);
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
  for (const FaceNodes& face : faces_) out.push_back(face.nodes);
  return out;
}

}  // namespace calot
