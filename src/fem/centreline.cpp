#include "fem/centreline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

constexpr int degree = 3;
using Weights = std::array<double, degree + 1>;

/// The p + 1 functions of degree p that are not zero in the knots' interval `span`, or their derivative of that order:
/// each of degree p - 1 rises in one and falls in another of degree p.
Weights basis(const std::vector<double>& knots, int span, double u, int p, int order) {
  Weights out{};
  if (p == 0) {
    out[0] = 1;
    return out;
  }
  const Weights lower = basis(knots, span, u, p - 1, std::max(order - 1, 0));
  for (int k = 0; k < p; ++k) {
    const double begin = knots[span - p + 1 + k], length = knots[span + 1 + k] - begin;
    const double rise = order > 0 ? p / length : (u - begin) / length;
    out[k + 1] += rise * lower[k];
    out[k] += (order > 0 ? -rise : 1 - rise) * lower[k];
  }
  return out;
}

/// The point of a polyline at a length along it; `ends` are the lengths at its points.
Vec3 point_at(const std::vector<Vec3>& polyline, const std::vector<double>& ends, double length) {
  const auto after = std::upper_bound(ends.begin(), ends.end(), length);
  if (after == ends.end()) return polyline.back();
  const auto i = after - ends.begin();
  return polyline[i - 1] + (length - ends[i - 1]) / (ends[i] - ends[i - 1]) * (polyline[i] - polyline[i - 1]);
}

}  // namespace

Centreline::Centreline(const std::vector<double>& breaks) : knots_(degree, breaks.front()) {
  knots_.insert(knots_.end(), breaks.begin(), breaks.end());
  knots_.insert(knots_.end(), degree, breaks.back());
}

Result<Centreline> Centreline::create(int nodes) {
  if (nodes < least_nodes)
    return fail(FailureKind::scenario, fmt::format("{} nodes are too few for a centreline", nodes),
                fmt::format("give it at least {}", least_nodes));
  std::vector<double> breaks;
  for (int k = 0; k <= nodes - degree; ++k) breaks.push_back(k);
  return Centreline(breaks);
}

int Centreline::span_at(double u) const {
  const auto first = knots_.begin() + degree + 1, last = knots_.end() - degree - 1;
  return static_cast<int>(std::upper_bound(first, last, u) - first);
}

Centreline Centreline::part(double first, double last) const {
  constexpr double rounding = 1e-9;  // a span so short would be nothing else
  std::vector<double> breaks{first};
  for (double knot : knots_)
    if (knot > breaks.back() + rounding && knot < last - rounding) breaks.push_back(knot);
  if (breaks.size() == 1) breaks.push_back(0.5 * (first + last));
  breaks.push_back(last);
  return Centreline(breaks);
}

double Centreline::to_knot(double u) const {
  double least = std::abs(u - knots_.front());
  for (double knot : knots_) least = std::min(least, std::abs(u - knot));
  return least;
}

VecX Centreline::in_part(const Centreline& part, const VecX& x) const {
  VecX out(Eigen::Index{3} * part.nodes());
  for (int i = 0; i < part.nodes(); ++i) {
    // Any span of the part that the node has a say in lies in one of this line's, whose blossom at the node's three
    // knots it is.
    const int within = std::clamp(i - degree / 2, 0, part.spans() - 1) + degree;
    const int span = span_at(0.5 * (part.knots_[within] + part.knots_[within + 1]));
    Eigen::Matrix<double, 3, degree + 1> points;
    for (int k = 0; k <= degree; ++k) points.col(k) = x.segment<3>(Eigen::Index{3} * (span + k));
    for (int level = 1; level <= degree; ++level)
      for (int k = degree; k >= level; --k) {
        const double begin = knots_[span + k], end = knots_[span + k + 1 - level + degree];
        const double share = (part.knots_[i + level] - begin) / (end - begin);
        points.col(k) = ((1 - share) * points.col(k - 1) + share * points.col(k)).eval();
      }
    out.segment<3>(Eigen::Index{3} * i) = points.col(degree);
  }
  return out;
}

StencilTable Centreline::stencils(const std::vector<double>& parameters) const {
  StencilTable out;
  for (double u : parameters) {
    const int first = span_at(u);
    for (int order = 0; order <= 2; ++order) {
      const Weights weights = basis(knots_, first + degree, u, degree, order);
      std::vector<double>& to = order == 0 ? out.value : order == 1 ? out.du : out.duu;
      to.insert(to.end(), weights.begin(), weights.end());
    }
    for (int k = 0; k <= degree; ++k) out.node.push_back(first + k);
    out.begin.push_back(static_cast<int>(out.node.size()));
  }
  return out;
}

RodQuadrature Centreline::quadrature() const {
  const double off = 0.5 / std::sqrt(3.0);
  std::vector<double> parameters, weights;
  for (int span = 0; span < spans(); ++span) {
    const double begin = knots_[span + degree], end = knots_[span + degree + 1];
    for (double side : {-off, off}) {
      parameters.push_back(0.5 * (begin + end) + (end - begin) * side);
      weights.push_back(0.5 * (end - begin));
    }
  }
  RodQuadrature out{stencils(parameters), weights, parameters};
  for (double& share : out.shares) share = (share - from()) / (to() - from());
  return out;
}

Result<VecX> Centreline::along(const std::vector<Vec3>& polyline) const {
  std::vector<double> ends{0};
  for (std::size_t i = 1; i < polyline.size(); ++i)
    ends.push_back(ends.back() + (polyline[i] - polyline[i - 1]).norm());
  if (!(ends.back() > 0) || !std::isfinite(ends.back()))
    return fail(FailureKind::scenario,
                fmt::format("a centreline of {} points has no length", polyline.size()),
                "give two different points or more");
  std::vector<Vec3> points;
  for (int i = 0; i < nodes(); ++i) {
    const double greville = (knots_[i + 1] + knots_[i + 2] + knots_[i + 3]) / 3;
    points.push_back(point_at(polyline, ends, (greville - from()) / (to() - from()) * ends.back()));
  }
  return to_coordinates(points);
}

}  // namespace calot
