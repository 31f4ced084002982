#include "skin/free_form.h"

#include <Eigen/LU>
#include <algorithm>

#include "geometry/finite.h"
#include "numerics/dense_cholesky.h"

namespace calot {

FreeForm::FreeForm(const Lattice& lattice)
    : lattice_(lattice), to_box_(lattice.frame.inverse(Eigen::Isometry)) {
  nodes_.setZero(Eigen::Index{1} * lattice.nodes[0] * lattice.nodes[1] * lattice.nodes[2], 3);
}

bool FreeForm::contains(const Vec3& x) const {
  return ((to_box_ * x).cwiseAbs().array() < lattice_.half.array()).all();
}

FreeForm::Reach FreeForm::reach(int axis, double at) const {
  const int n = lattice_.nodes[static_cast<std::size_t>(axis)];
  const double spans_per_metre = (n + 3) / (2 * lattice_.half[axis]);
  const double t = (at + lattice_.half[axis]) * spans_per_metre;
  Reach out;
  if (!(t > 0 && t < n + 3)) return out;
  const int span = std::min(static_cast<int>(t), n + 2);
  const double s = t - span, r = 1 - s;
  out.first = span - 3;
  out.value = {r * r * r / 6, (3 * s * s * s - 6 * s * s + 4) / 6, (3 * r * r * r - 6 * r * r + 4) / 6,
               s * s * s / 6};
  out.slope = {-r * r / 2, (3 * s - 4) * s / 2, -(3 * r - 4) * r / 2, s * s / 2};
  for (int k = 0; k < 4; ++k) {
    const bool whole = out.first + k >= 0 && out.first + k < n;  // the others would stick out of the box
    out.value[static_cast<std::size_t>(k)] *= whole ? 1 : 0;
    out.slope[static_cast<std::size_t>(k)] *= whole ? spans_per_metre : 0;
  }
  return out;
}

namespace {

/// Calls use(function, i, j, k) for each function of the lattice that lies in the three reaches.
template <class Reaches, class Use>
void for_each_function(const Reaches& r, const std::array<int, 3>& n, const Use& use) {
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int a = r[0].first + i, b = r[1].first + j, c = r[2].first + k;
        if (a < 0 || b < 0 || c < 0 || a >= n[0] || b >= n[1] || c >= n[2]) continue;
        use((Eigen::Index{1} * c * n[1] + b) * n[0] + a, static_cast<std::size_t>(i),
            static_cast<std::size_t>(j), static_cast<std::size_t>(k));
      }
}

}  // namespace

VecX FreeForm::weights(const Vec3& x) const {
  const Vec3 q = to_box_ * x;
  const std::array<Reach, 3> r{reach(0, q.x()), reach(1, q.y()), reach(2, q.z())};
  VecX w = VecX::Zero(nodes_.rows());
  for_each_function(r, lattice_.nodes, [&](Eigen::Index f, std::size_t i, std::size_t j, std::size_t k) {
    w[f] = r[0].value[i] * r[1].value[j] * r[2].value[k];
  });
  return w;
}

Vec3 FreeForm::displacement(const Vec3& x) const {
  const Vec3 q = to_box_ * x;
  const std::array<Reach, 3> r{reach(0, q.x()), reach(1, q.y()), reach(2, q.z())};
  Vec3 u = Vec3::Zero();
  for_each_function(r, lattice_.nodes, [&](Eigen::Index f, std::size_t i, std::size_t j, std::size_t k) {
    u += r[0].value[i] * r[1].value[j] * r[2].value[k] * nodes_.row(f).transpose();
  });
  return u;
}

Mat3 FreeForm::gradient(const Vec3& x) const {
  const Vec3 q = to_box_ * x;
  const std::array<Reach, 3> r{reach(0, q.x()), reach(1, q.y()), reach(2, q.z())};
  Mat3 by_box = Mat3::Zero();
  for_each_function(r, lattice_.nodes, [&](Eigen::Index f, std::size_t i, std::size_t j, std::size_t k) {
    const Vec3 slope(r[0].slope[i] * r[1].value[j] * r[2].value[k],
                     r[0].value[i] * r[1].slope[j] * r[2].value[k],
                     r[0].value[i] * r[1].value[j] * r[2].slope[k]);
    by_box += nodes_.row(f).transpose() * slope.transpose();
  });
  return by_box * to_box_.linear();
}

Vec3 FreeForm::moved_normal(const Vec3& x, const Vec3& n, double share) const {
  const Mat3 jacobian = Mat3::Identity() + share * gradient(x);
  return (jacobian.inverse().transpose() * n).normalized();
}

// By the normal equations of the damped least squares: a point has 64 weights at most, so the products are few.
Result<double> FreeForm::manipulate(const std::vector<Vec3>& points, const std::vector<Vec3>& targets,
                                    double damping) {
  if (points.size() != targets.size() || !all_finite(points) || !all_finite(targets))
    return fail(FailureKind::internal, "a lattice was given points and targets that do not pair up");
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(nodes_.rows(), nodes_.rows());
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(nodes_.rows(), 3);
  std::vector<Eigen::Index> reached;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const VecX w = weights(points[k]);
    reached.clear();
    for (Eigen::Index i = 0; i < w.size(); ++i)
      if (w[i] != 0) reached.push_back(i);
    for (const Eigen::Index j : reached) {
      right.row(j) += w[j] * (targets[k] - points[k]).transpose();
      for (const Eigen::Index i : reached)
        if (i >= j) normal(i, j) += w[i] * w[j];
    }
  }
  normal.diagonal().array() += damping * damping;
  if (!cholesky_in_place(normal)) return fail(FailureKind::internal, "a lattice's damping is too small");
  nodes_ = cholesky_solve(normal, Eigen::MatrixXd(right));
  double largest_miss = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    largest_miss = std::max(largest_miss, (points[k] + displacement(points[k]) - targets[k]).norm());
  return largest_miss;
}

}  // namespace calot
