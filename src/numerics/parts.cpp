#include "numerics/parts.h"

#include <cmath>

namespace calot {
namespace {

auto coordinates(const VecX& v, const NodeRange& range) {
  return v.segment(3 * Eigen::Index{range.first}, 3 * Eigen::Index{range.size()});
}

}  // namespace

double largest_node(const Eigen::Ref<const VecX>& v) {
  double largest_squared = 0;
  for (int i = 0; i + 2 < v.size(); i += 3)
    // Not std::max, which would swallow a NaN.
    if (const double squared = v.segment<3>(i).squaredNorm(); !(squared <= largest_squared)) {
      largest_squared = squared;
      if (std::isnan(squared)) break;
    }
  return std::sqrt(largest_squared);
}

double largest_node(const Part& part, const VecX& v) {
  Worst worst;
  for (const NodeRange& range : {part.places, part.displacements})
    worst.take(largest_node(coordinates(v, range)), 0);
  return worst.value;
}

double largest_coordinate(const Part& part, const VecX& v) {
  double largest = 0;
  for (const NodeRange& range : {part.places, part.displacements})
    if (range.size() > 0) largest = std::max(largest, coordinates(v, range).lpNorm<Eigen::Infinity>());
  return largest;
}

double force_scale(double largest_internal, const Eigen::Ref<const VecX>& gradient) {
  return std::max(largest_internal, 1e-3 * largest_node(gradient));
}

void Worst::take(double next, int of) {
  if (std::isnan(value) || next <= value) return;
  value = next;
  index = of;
}

}  // namespace calot
