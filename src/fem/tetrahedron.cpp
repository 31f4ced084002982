#include "fem/tetrahedron.h"

namespace calot {
namespace {

using Four = Eigen::Vector4d;  ///< barycentric coordinates

struct RulePoint {
  Four at;
  double weight = 0;  ///< of the tetrahedron's volume
};

/// Exact to the second degree: the stiffness of a straight tetrahedron.
std::vector<RulePoint> four_points() {
  constexpr double a = 0.1381966011250105, b = 1 - 3 * a;
  std::vector<RulePoint> out;
  for (int k = 0; k < 4; ++k) {
    Four at = Four::Constant(a);
    at[k] = b;
    out.push_back({at, 0.25});
  }
  return out;
}

/// Exact to the fifth degree (Walkington 2000).
std::vector<RulePoint> fourteen_points() {
  std::vector<RulePoint> out;
  const auto corners = [&](double a, double weight) {
    for (int k = 0; k < 4; ++k) {
      Four at = Four::Constant(a);
      at[k] = 1 - 3 * a;
      out.push_back({at, weight});
    }
  };
  corners(0.31088591926330060980, 0.11268792571801585080);
  corners(0.092735250310891226402, 0.073493043116361949544);
  constexpr double a = 0.045503704125649649492;
  for (int k = 0; k < 4; ++k)
    for (int l = k + 1; l < 4; ++l) {
      Four at = Four::Constant(a);
      at[k] = at[l] = 0.5 - a;
      out.push_back({at, 0.042546020777081466438});
    }
  return out;
}

constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

std::array<double, 10> functions(const Four& at) {
  std::array<double, 10> out;
  for (int k = 0; k < 4; ++k) out[k] = at[k] * (2 * at[k] - 1);
  for (int e = 0; e < 6; ++e) out[4 + e] = 4 * at[edges[e][0]] * at[edges[e][1]];
  return out;
}

/// Derivatives of the functions (rows) by the barycentric coordinates 1 to 3, the first being what is left.
Eigen::Matrix<double, 10, 3> derivatives(const Four& at) {
  Eigen::Matrix<double, 10, 4> by_all = Eigen::Matrix<double, 10, 4>::Zero();
  for (int k = 0; k < 4; ++k) by_all(k, k) = 4 * at[k] - 1;
  for (int e = 0; e < 6; ++e)
    for (int side = 0; side < 2; ++side) by_all(4 + e, edges[e][side]) = 4 * at[edges[e][1 - side]];
  return by_all.rightCols<3>().colwise() - by_all.col(0);
}

Mat3 jacobian(const std::array<Vec3, 10>& points, const Eigen::Matrix<double, 10, 3>& d) {
  Mat3 out = Mat3::Zero();
  for (int k = 0; k < 10; ++k) out += points[k] * d.row(k);
  return out;
}

}  // namespace

std::optional<TetMatrices> tet_matrices(const std::array<Vec3, 10>& points, const ElasticSolid& solid) {
  static const std::vector<RulePoint> rule = four_points();
  const double mu = solid.shear(), lambda = solid.first_lame();
  TetMatrices out;
  out.stiffness.setZero();
  out.slopes.setZero();
  for (const RulePoint& q : rule) {
    const Eigen::Matrix<double, 10, 3> d = derivatives(q.at);
    const Mat3 j = jacobian(points, d);
    const double volume = q.weight * j.determinant() / 6;
    if (!(volume > 0)) return std::nullopt;
    const Eigen::Matrix<double, 3, 10> slopes = (d * j.inverse()).transpose();
    for (int a = 0; a < 10; ++a)
      for (int b = 0; b < 10; ++b)
        out.stiffness.block<3, 3>(3 * a, 3 * b) +=
            volume * (lambda * slopes.col(a) * slopes.col(b).transpose() +
                      mu * (slopes.col(b) * slopes.col(a).transpose() +
                            slopes.col(a).dot(slopes.col(b)) * Mat3::Identity()));
    out.slopes += volume * slopes;
    out.volume += volume;
    const std::array<double, 10> n = functions(q.at);
    for (int a = 0; a < 10; ++a) out.shares[a] += volume * n[a];
  }
  return out;
}

Eigen::Matrix<double, 10, 10> tet_products(const std::array<Vec3, 10>& points) {
  static const std::vector<RulePoint> rule = fourteen_points();
  Eigen::Matrix<double, 10, 10> out = Eigen::Matrix<double, 10, 10>::Zero();
  for (const RulePoint& q : rule) {
    const double volume = q.weight * jacobian(points, derivatives(q.at)).determinant() / 6;
    const std::array<double, 10> n = functions(q.at);
    const Eigen::Map<const Eigen::Matrix<double, 10, 1>> all(n.data());
    out += volume * all * all.transpose();
  }
  return out;
}

}  // namespace calot
