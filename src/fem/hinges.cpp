#include "fem/hinges.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace calot {
namespace {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

struct Corners {
  Vec3 at[4];
  Corners(const std::array<int, 4>& nodes, const VecX& x) {
    for (int k = 0; k < 4; ++k) at[k] = x.segment<3>(3 * nodes[k]);
  }
  Vec3 edge() const { return at[1] - at[0]; }
  /// Normals of twice the triangles' areas.
  Vec3 left() const { return edge().cross(at[2] - at[0]); }
  Vec3 right() const { return (at[3] - at[0]).cross(edge()); }
  double angle() const {
    const Vec3 n = left(), m = right();
    return std::atan2(n.cross(m).dot(edge().normalized()), n.dot(m));
  }
};

/// One triangle's part in the angle's derivatives. Its apex swings about the edge, along the normal n by
/// p = -|e| n / |n|^2; the ends of the edge take up -(1 - s) p and -s p, s being where the apex stands along
/// it, so that no rigid motion turns the hinge. Differentiating p and s gives the Hessian (Tamstorf and
/// Grinspun 2013, doi 10.1016/j.gmod.2013.07.001); only the sum of both triangles' parts is symmetric.
class Side {
 public:
  /// `apex` is 2 or 3; the normal of the right triangle has the edge reversed: `turn` = -1.
  Side(const Corners& corners, int apex)
      : apex_(apex),
        turn_(apex == 2 ? 1 : -1),
        e_(corners.edge()),
        f_(corners.at[apex] - corners.at[0]),
        length_(e_.norm()),
        n_(turn_ * e_.cross(f_)),
        square_(n_.squaredNorm()),
        s_(f_.dot(e_) / (length_ * length_)),
        p_(-length_ / square_ * n_) {}

  void add_gradient(Vector12& g) const {
    g.segment<3>(0) -= (1 - s_) * p_;
    g.segment<3>(3) -= s_ * p_;
    g.segment<3>(3 * apex_) += p_;
  }

  void add_hessian(Matrix12& h) const {
    // By e and by f; then e = x1 - x0, f = apex - x0.
    const Mat3 by_n = -length_ / square_ * (Mat3::Identity() - 2 / square_ * n_ * n_.transpose());
    const Mat3 p_e = by_n * (-turn_ * cross_matrix(f_)) - n_ * e_.transpose() / (length_ * square_);
    const Mat3 p_f = by_n * (turn_ * cross_matrix(e_));
    const Vec3 s_e = (f_ - 2 * s_ * e_) / (length_ * length_), s_f = e_ / (length_ * length_);
    add_columns(h, 3, p_e, s_e);
    add_columns(h, 3 * apex_, p_f, s_f);
    add_columns(h, 0, -p_e - p_f, -s_e - s_f);
  }

 private:
  void add_columns(Matrix12& h, int column, const Mat3& dp, const Vec3& ds) const {
    h.block<3, 3>(0, column) += p_ * ds.transpose() - (1 - s_) * dp;
    h.block<3, 3>(3, column) -= p_ * ds.transpose() + s_ * dp;
    h.block<3, 3>(3 * apex_, column) += dp;
  }

  int apex_;
  double turn_;
  Vec3 e_, f_;
  double length_;
  Vec3 n_;
  double square_, s_;
  Vec3 p_;
};

Vector12 angle_gradient(const Corners& corners) {
  Vector12 g = Vector12::Zero();
  for (int apex : {2, 3}) Side(corners, apex).add_gradient(g);
  return g;
}

Matrix12 angle_hessian(const Corners& corners) {
  Matrix12 h = Matrix12::Zero();
  for (int apex : {2, 3}) Side(corners, apex).add_hessian(h);
  return h;
}

}  // namespace

Result<Hinges> Hinges::create(const std::vector<Triangle>& triangles, const VecX& rest, double rigidity) {
  std::map<std::pair<int, int>, int> apex_of;  // by directed edge
  Hinges out;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
      if (!apex_of.emplace(std::pair(a, b), apex).second)
        return fail(FailureKind::scenario, fmt::format("edge {}-{} runs twice the same way", a, b),
                    "orient the triangles alike, at most two an edge");
      const auto other = apex_of.find({b, a});
      if (other == apex_of.end()) continue;
      Hinge hinge{{b, a, other->second, apex}};
      const Corners corners(hinge.nodes, rest);
      const double left = 0.5 * corners.left().norm(), right = 0.5 * corners.right().norm();
      if (!(left > 0) || !(right > 0) || !std::isfinite(left + right))
        return fail(FailureKind::scenario, fmt::format("a triangle at edge {}-{} has no area", a, b));
      hinge.stiffness = rigidity * corners.edge().squaredNorm() / (left + right);
      hinge.rest_angle = corners.angle();
      out.hinges_.push_back(hinge);
    }
  }
  return out;
}

double Hinges::value(const VecX& x) const {
  double sum = 0;
  for (const Hinge& hinge : hinges_) {
    const double bent = Corners(hinge.nodes, x).angle() - hinge.rest_angle;
    sum += 0.5 * hinge.stiffness * bent * bent;
  }
  return sum;
}

void Hinges::add_gradient(const VecX& x, VecX& gradient) const {
  for (const Hinge& hinge : hinges_) {
    const Corners corners(hinge.nodes, x);
    const double moment = hinge.stiffness * (corners.angle() - hinge.rest_angle);
    const Vector12 g = angle_gradient(corners);
    for (int k = 0; k < 4; ++k) gradient.segment<3>(3 * hinge.nodes[k]) += moment * g.segment<3>(3 * k);
  }
}

void Hinges::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  for (const Hinge& hinge : hinges_) {
    const Corners corners(hinge.nodes, x);
    const Vector12 g = angle_gradient(corners);
    const Matrix12 h =
        hinge.stiffness * (g * g.transpose() + (corners.angle() - hinge.rest_angle) * angle_hessian(corners));
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (hinge.nodes[a] >= hinge.nodes[b])
          matrix.add(hinge.nodes[a], hinge.nodes[b], h.block<3, 3>(3 * a, 3 * b));
  }
}

std::vector<std::vector<int>> Hinges::cliques() const {
  std::vector<std::vector<int>> out;
  for (const Hinge& hinge : hinges_) out.emplace_back(hinge.nodes.begin(), hinge.nodes.end());
  return out;
}

}  // namespace calot
