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

Centreline::Centreline(int spans) : spans_(spans) {
  for (int k = -degree; k <= spans + degree; ++k) knots_.push_back(std::clamp(k, 0, spans));
}

Result<Centreline> Centreline::create(int nodes) {
  if (nodes < least_nodes)
    return fail(FailureKind::scenario, fmt::format("{} nodes are too few for a centreline", nodes),
                fmt::format("give it at least {}", least_nodes));
  return Centreline(nodes - degree);
}

StencilTable Centreline::stencils(const std::vector<double>& parameters) const {
  StencilTable out;
  for (double u : parameters) {
    const int first = std::clamp(static_cast<int>(std::floor(u)), 0, spans_ - 1);
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
  std::vector<double> parameters;
  for (int span = 0; span < spans_; ++span)
    for (double side : {-off, off}) parameters.push_back(span + 0.5 + side);
  RodQuadrature out{stencils(parameters), std::vector<double>(parameters.size(), 0.5), parameters};
  for (double& share : out.shares) share /= spans_;
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
    points.push_back(point_at(polyline, ends, greville / spans_ * ends.back()));
  }
  return to_coordinates(points);
}

}  // namespace calot
