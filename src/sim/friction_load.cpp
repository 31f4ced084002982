#include "sim/friction_load.h"

#include <algorithm>
#include <tuple>

#include "fem/links.h"

namespace calot {

const RubbingPoint* FrictionLoad::find(int shape, int row) const {
  const auto at = std::lower_bound(points.begin(), points.end(), std::tie(shape, row),
                                   [](const RubbingPoint& point, const std::tuple<int, int>& key) {
                                     return std::tie(point.shape, point.row) < key;
                                   });
  return at != points.end() && at->shape == shape && at->row == row ? &*at : nullptr;
}

double FrictionLoad::value(const StencilTable& table, const VecX& x) const {
  double sum = 0;
  for (const RubbingPoint& point : points)
    sum += point.hold.sample(blend(table, table.value, point.row, x)).energy;
  return sum;
}

void FrictionLoad::add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const {
  for (const RubbingPoint& point : points)
    spread(table, point.row, point.hold.sample(blend(table, table.value, point.row, x)).gradient, gradient);
}

void FrictionLoad::add_hessian(const StencilTable& table, const VecX& x, BlockMatrix& matrix) const {
  for (const RubbingPoint& point : points)
    add_point_hessian(table, point.row, point.hold.sample(blend(table, table.value, point.row, x)).hessian,
                      matrix);
}

}  // namespace calot
