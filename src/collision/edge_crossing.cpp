#include "collision/edge_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot {
namespace {

/// What the energy depends on, each a polynomial of u, v (the edges' vectors) and w (from the first's start to the
/// other's): c = |u x v|^2; s c and t c, where the lines are nearest; q = w . (u x v), their distance times |u x v|.
enum Term { term_c, term_sc, term_tc, term_q, terms };

/// A number with slope and bend by the terms.
struct Jet {
  using Slope = Eigen::Matrix<double, terms, 1>;
  using Bend = Eigen::Matrix<double, terms, terms>;
  double value = 0;
  Slope slope = Slope::Zero();
  Bend bend = Bend::Zero();

  static Jet of(Term term, double value) { return {value, Slope::Unit(term), Bend::Zero()}; }
  /// f of it, given f and its derivatives there.
  Jet through(double f, double first, double second) const {
    return {f, first * slope, second * slope * slope.transpose() + first * bend};
  }
  Jet operator*(const Jet& o) const {
    return {value * o.value, value * o.slope + o.value * slope,
            value * o.bend + o.value * bend + slope * o.slope.transpose() + o.slope * slope.transpose()};
  }
};

struct Vectors {
  Vec3 u, v, w;
  explicit Vectors(const EdgePair& ends) : u(ends[1] - ends[0]), v(ends[3] - ends[2]), w(ends[2] - ends[0]) {}
};

struct Derivatives {
  double value = 0, first = 0, second = 0;
};

Derivatives window(double s) {
  const double f = 4 * s * (1 - s), slope = 4 - 8 * s;
  return {f * f, 2 * f * slope, 2 * slope * slope - 16 * f};
}

Derivatives fade(double c, double below) {
  if (c >= below) return {1, 0, 0};
  const double y = c / below;
  return {y * y * (3 - 2 * y), 6 * y * (1 - y) / below, (6 - 12 * y) / (below * below)};
}

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Columns = Eigen::Matrix<double, 9, terms>;
using Bend9 = Eigen::Matrix<double, 9, 9>;

Vec9 stacked(const Vec3& by_u, const Vec3& by_v, const Vec3& by_w) {
  Vec9 out;
  out.segment<3>(0) = by_u;
  out.segment<3>(3) = by_v;
  out.segment<3>(6) = by_w;
  return out;
}

/// Adds `by` times a block right of the diagonal (rows and columns of u, v, w) and its mirror.
void add_mixed(Bend9& out, int row, int column, double by, const Mat3& block) {
  out.block<3, 3>(3 * row, 3 * column) += by * block;
  out.block<3, 3>(3 * column, 3 * row) += by * block.transpose();
}

/// Slope and `by` times the bend of (u.w)(v.v) - (v.w)(u.v), with u and v at the given rows.
Vec9 add_shared(const Vec3& u, const Vec3& v, const Vec3& w, int at_u, int at_v, double by, Bend9& bend) {
  const double uv = u.dot(v), uw = u.dot(w), vv = v.dot(v), vw = v.dot(w);
  const Mat3 one = Mat3::Identity();
  Vec9 slope;
  slope.segment<3>(3 * at_u) = vv * w - vw * v;
  slope.segment<3>(3 * at_v) = 2 * uw * v - uv * w - vw * u;
  slope.tail<3>() = vv * u - uv * v;
  add_mixed(bend, at_u, at_v, by, 2 * w * v.transpose() - v * w.transpose() - vw * one);
  add_mixed(bend, at_u, 2, by, vv * one - v * v.transpose());
  add_mixed(bend, at_v, 2, by, 2 * v * u.transpose() - u * v.transpose() - uv * one);
  bend.block<3, 3>(3 * at_v, 3 * at_v) += by * (2 * uw * one - w * u.transpose() - u * w.transpose());
  return slope;
}

/// Slopes of the terms by u, v, w; `bend` gains their bends, each times its factor.
Columns differentiate(const Vectors& at, const Jet::Slope& by, Bend9& bend) {
  const Vec3 &u = at.u, &v = at.v, &w = at.w;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
  const Mat3 one = Mat3::Identity();
  Columns slopes;
  slopes.col(term_c) = stacked(2 * (vv * u - uv * v), 2 * (uu * v - uv * u), Vec3::Zero());
  bend.block<3, 3>(0, 0) += 2 * by[term_c] * (vv * one - v * v.transpose());
  bend.block<3, 3>(3, 3) += 2 * by[term_c] * (uu * one - u * u.transpose());
  add_mixed(bend, 0, 1, 2 * by[term_c], 2 * u * v.transpose() - v * u.transpose() - uv * one);
  slopes.col(term_sc) = add_shared(u, v, w, 0, 1, by[term_sc], bend);
  slopes.col(term_tc) = -add_shared(v, u, w, 1, 0, -by[term_tc], bend);
  slopes.col(term_q) = stacked(v.cross(w), w.cross(u), u.cross(v));
  add_mixed(bend, 0, 1, by[term_q], -cross_matrix(w));
  add_mixed(bend, 0, 2, by[term_q], cross_matrix(v));
  add_mixed(bend, 1, 2, by[term_q], -cross_matrix(u));
  return slopes;
}

/// u, v, w by the ends: what a derivative by those is by these.
Eigen::Matrix<double, 9, 12> by_ends() {
  Eigen::Matrix<double, 9, 12> out = Eigen::Matrix<double, 9, 12>::Zero();
  const std::array<std::array<int, 2>, 3> from_to{{{0, 1}, {2, 3}, {0, 2}}};
  for (int k = 0; k < 3; ++k) {
    out.block<3, 3>(3 * k, 3 * from_to[k][0]) = -Mat3::Identity();
    out.block<3, 3>(3 * k, 3 * from_to[k][1]) = Mat3::Identity();
  }
  return out;
}

}  // namespace

double EdgeCrossing::parallel_bound(double length, double other_length, double range) {
  const double width = range * std::max(length, other_length);
  return width * width;
}

double EdgeCrossing::energy(const EdgePair& ends) const {
  const NearestOfEdges nearest = nearest_of_edges(ends);
  if (nearest.meet != EdgesMeet::between_ends || nearest.distance >= barrier.range) return 0;
  const Vectors at(ends);
  return fade(at.u.cross(at.v).squaredNorm(), parallel_below).value * window(nearest.weight[1]).value *
         window(-nearest.weight[3]).value * barrier.sample(nearest.distance).energy;
}

EdgeCrossing::Sample EdgeCrossing::sample(const EdgePair& ends) const {
  const NearestOfEdges nearest = nearest_of_edges(ends);
  if (nearest.meet != EdgesMeet::between_ends || nearest.distance >= barrier.range) return {};
  Sample out;
  if (nearest.distance == 0) {
    out.energy = std::numeric_limits<double>::infinity();
    return out;
  }
  const Vectors at(ends);
  const Vec3 n = at.u.cross(at.v);
  const double nn = n.squaredNorm(), q = at.w.dot(n), root = std::sqrt(nn);
  const Jet c = Jet::of(term_c, nn), inverse = c.through(1 / nn, -1 / (nn * nn), 2 / (nn * nn * nn));
  const auto part = [](const Jet& jet, const Derivatives& d) {
    return jet.through(d.value, d.first, d.second);
  };
  const auto windowed = [&](Term term, double share) {
    return part(Jet::of(term, share * nn) * inverse, window(share));
  };
  const Jet distance = Jet::of(term_q, q).through(std::abs(q), std::copysign(1.0, q), 0) *
                       c.through(1 / root, -0.5 / (nn * root), 0.75 / (nn * nn * root));
  const BarrierSample b = barrier.sample(nearest.distance);
  const Jet e = part(c, fade(nn, parallel_below)) * windowed(term_sc, nearest.weight[1]) *
                windowed(term_tc, -nearest.weight[3]) * distance.through(b.energy, b.derivative, b.second);
  Bend9 bend = Bend9::Zero();
  const Columns slopes = differentiate(at, e.slope, bend);
  bend += slopes * e.bend * slopes.transpose();
  static const Eigen::Matrix<double, 9, 12> map = by_ends();
  out.energy = e.value;
  out.gradient = map.transpose() * (slopes * e.slope);
  out.hessian = map.transpose() * bend * map;
  return out;
}

}  // namespace calot
