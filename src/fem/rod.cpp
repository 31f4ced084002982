#include "fem/rod.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace calot {
namespace {

using std::numbers::pi;

/// The line's derivatives at a row, and what its energy is made of.
struct RodPoint {
  Vec3 d;          ///< r'
  Vec3 across;     ///< r'' less its part along r'
  double squared;  ///< |r'|^2
  double along;    ///< r' . r'' / |r'|^2
  double stretch;  ///< |r'| / |r0'|
  double bend;     ///< |across|^2 / |r'|^2 = (K |r0'|)^2

  RodPoint(const StencilTable& table, int row, double speed, const VecX& x)
      : d(blend(table, table.du, row, x)), squared(d.squaredNorm()), stretch(std::sqrt(squared) / speed) {
    const Vec3 second = blend(table, table.duu, row, x);
    along = d.dot(second) / squared;
    across = second - along * d;
    bend = across.squaredNorm() / squared;
  }

  /// Derivatives of `bend` by r' and r''.
  Vec3 bend_by_first() const { return -2 / squared * (along * across + bend * d); }
  Vec3 bend_by_second() const { return 2 / squared * across; }

  /// Projects onto the plane across the line.
  Mat3 projector() const { return Mat3::Identity() - d * d.transpose() / squared; }

  /// Second derivatives of `bend`; `mixed` has r'' in its rows, r' in its columns.
  struct Hessian {
    Mat3 first, mixed, second;
  };
  Hessian bend_hessian() const {
    const Mat3 plane = projector(), turn = across * d.transpose();
    const double half = 2 / squared;
    Hessian h;
    h.second = half * plane;
    h.mixed = -half * (along * plane + (2 * turn + turn.transpose()) / squared);
    h.first = half * (along * along * plane - bend * Mat3::Identity() +
                      (3 * along * (turn + turn.transpose()) + 4 * bend * d * d.transpose() -
                       across * across.transpose()) /
                          squared);
    return h;
  }
};

bool has_stiffness(const RodSection& s) {
  const bool finite =
      std::isfinite(s.axial) && std::isfinite(s.bending) && std::isfinite(s.radius) && std::isfinite(s.hoop);
  return finite && s.axial > 0 && s.bending > 0 && s.radius > 0 && s.hoop >= 0;
}

}  // namespace

RodSection tube_section(double young, double radius, double wall) {
  return {.axial = young * 2 * pi * radius * wall,
          .bending = young * pi * radius * radius * radius * wall,
          .radius = radius,
          .hoop = young * wall};
}

RodSection solid_section(double young, double radius) {
  const double squared = radius * radius;
  return {.axial = young * pi * squared, .bending = young * pi / 4 * squared * squared, .radius = radius};
}

SectionAnswer answer(const RodSection& section, double stretch, double pressure) {
  const double strain = stretch - 1;
  SectionAnswer out{.energy = 0.5 * section.axial * strain * strain,
                    .force = section.axial * strain,
                    .stiffness = section.axial,
                    .radius = section.radius};
  if (section.hoop == 0) return out;
  const double growth = pressure * section.radius / section.hoop;  // of the radius, a unit of stretch
  const double left = 1 - growth * stretch;
  if (!(left > 0)) {
    out.energy = out.force = out.stiffness = out.radius = std::numeric_limits<double>::infinity();
    return out;
  }
  const double push = pressure * pi * section.radius * section.radius;
  out.energy -= push * stretch / left;
  out.force -= push / (left * left);
  out.stiffness -= 2 * push * growth / (left * left * left);
  out.radius /= left;
  return out;
}

Result<Rod> Rod::create(RodQuadrature quadrature, const VecX& rest, std::vector<RodSection> sections) {
  Rod rod;
  rod.stencils_ = std::move(quadrature.stencils);
  rod.sections_ = std::move(sections);
  for (int row = 0; row < rod.stencils_.rows(); ++row) {
    const double share = quadrature.shares[row];
    const double speed = blend(rod.stencils_, rod.stencils_.du, row, rest).norm();
    if (!(speed > 0) || !std::isfinite(speed))
      return fail(FailureKind::scenario,
                  fmt::format("a rod's rest line has no direction at {:.3g} of its way", share),
                  "keep its points apart");
    if (!has_stiffness(rod.sections_[row]))
      return fail(FailureKind::scenario,
                  fmt::format("a rod's section has no stiffness at {:.3g} of its way", share),
                  "give it a radius, a wall and a modulus above zero");
    rod.speeds_.push_back(speed);
    rod.lengths_.push_back(quadrature.weights[row] * speed);
  }
  return rod;
}

double Rod::value(const VecX& x, double pressure) const {
  double sum = 0;
  for (int row = 0; row < stencils_.rows(); ++row) {
    const RodPoint at(stencils_, row, speeds_[row], x);
    if (!(at.stretch > 0)) return std::numeric_limits<double>::infinity();
    const double bending = 0.5 * sections_[row].bending / (speeds_[row] * speeds_[row]) * at.bend;
    sum += lengths_[row] * (answer(sections_[row], at.stretch, pressure).energy + bending);
  }
  return sum;
}

void Rod::add_gradient(const VecX& x, double pressure, VecX& gradient) const {
  for (int row = 0; row < stencils_.rows(); ++row) {
    const RodPoint at(stencils_, row, speeds_[row], x);
    const double squared_speed = speeds_[row] * speeds_[row];
    const double force = answer(sections_[row], at.stretch, pressure).force;
    const double rigidity = 0.5 * lengths_[row] * sections_[row].bending / squared_speed;
    const Vec3 first =
        lengths_[row] * force / (at.stretch * squared_speed) * at.d + rigidity * at.bend_by_first();
    const Vec3 second = rigidity * at.bend_by_second();
    for (int e = stencils_.begin[row]; e < stencils_.begin[row + 1]; ++e)
      gradient.segment<3>(3 * stencils_.node[e]) += stencils_.du[e] * first + stencils_.duu[e] * second;
  }
}

void Rod::add_hessian(const VecX& x, double pressure, BlockMatrix& matrix) const {
  for (int row = 0; row < stencils_.rows(); ++row) {
    const RodPoint at(stencils_, row, speeds_[row], x);
    const double squared_speed = speeds_[row] * speeds_[row];
    const SectionAnswer section = answer(sections_[row], at.stretch, pressure);
    const double rigidity = 0.5 * lengths_[row] * sections_[row].bending / squared_speed;
    const RodPoint::Hessian bend = at.bend_hessian();
    const double stretching = lengths_[row] / squared_speed;
    const Mat3 first = stretching * (section.stiffness / at.squared * at.d * at.d.transpose() +
                                     section.force / at.stretch * at.projector()) +
                       rigidity * bend.first;
    const Mat3 mixed = rigidity * bend.mixed, second = rigidity * bend.second;
    for (int b = stencils_.begin[row]; b < stencils_.begin[row + 1]; ++b) {
      const double du = stencils_.du[b], duu = stencils_.duu[b];
      const Mat3 by_first = du * first + duu * mixed.transpose(), by_second = du * mixed + duu * second;
      for (int a = b; a < stencils_.begin[row + 1]; ++a)
        matrix.add(stencils_.node[a], stencils_.node[b],
                   stencils_.du[a] * by_first + stencils_.duu[a] * by_second);
    }
  }
}

std::vector<Rod::Sample> Rod::samples(const VecX& x, double pressure) const {
  std::vector<Sample> out;
  for (int row = 0; row < stencils_.rows(); ++row) {
    const RodPoint at(stencils_, row, speeds_[row], x);
    out.push_back({.stretch = at.stretch,
                   .bending = std::sqrt(at.bend) / speeds_[row],
                   .answer = answer(sections_[row], at.stretch, pressure)});
  }
  return out;
}

double Rod::volume(const VecX& x, double pressure) const {
  const std::vector<Sample> along = samples(x, pressure);
  double sum = 0;
  for (std::size_t row = 0; row < along.size(); ++row)
    if (sections_[row].hoop > 0)
      sum += lengths_[row] * along[row].stretch * pi * along[row].answer.radius * along[row].answer.radius;
  return sum;
}

std::vector<std::vector<int>> Rod::cliques() const {
  std::vector<std::vector<int>> out;
  for (int row = 0; row < stencils_.rows(); ++row)
    out.emplace_back(stencils_.node.begin() + stencils_.begin[row],
                     stencils_.node.begin() + stencils_.begin[row + 1]);
  return out;
}

}  // namespace calot
