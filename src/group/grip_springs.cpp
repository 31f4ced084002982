#include "group/grip_springs.h"

#include "fem/links.h"

namespace calot {
namespace {

/// m of the way into a pad over which it comes to its full stiffness.
constexpr double onset = 20e-6;

/// Of a way into a pad, for a stiffness of 1: the second derivative is 0 before it, 1 beyond `onset`, and even between.
struct Press {
  double value, derivative, second;
};

Press press(double way) {
  if (way <= 0) return {0, 0, 0};
  if (way < onset) return {way * way * way / (6 * onset), way * way / (2 * onset), way / onset};
  const double beyond = way - 0.5 * onset;
  return {0.5 * beyond * beyond + onset * onset / 24, beyond, 1};
}

}  // namespace

GripSprings::Sample GripSprings::sample(std::size_t spring, const Vec3& at) const {
  const double k = stiffness[spring];
  const Vec3 way = at - target[spring];
  if (pad.empty()) return {0.5 * k * way.squaredNorm(), k * way, k * Mat3::Identity()};
  const Vec3& n = pad[spring];
  const double into = way.dot(n);
  const Press pressed = press(into);
  return {k * (0.5 * (way.squaredNorm() - into * into) + pressed.value),
          k * (way + (pressed.derivative - into) * n),
          k * (Mat3::Identity() + (pressed.second - 1) * n * n.transpose())};
}

double GripSprings::value(const StencilTable& table, const VecX& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) sum += sample(i, blend(table, table.value, row[i], x)).energy;
  return sum;
}

void GripSprings::add_gradient(const StencilTable& table, const VecX& x, VecX& gradient) const {
  for (std::size_t i = 0; i < row.size(); ++i)
    spread(table, row[i], sample(i, blend(table, table.value, row[i], x)).gradient, gradient);
}

void GripSprings::add_hessian(const StencilTable& table, const VecX& x, BlockMatrix& matrix) const {
  for (std::size_t i = 0; i < row.size(); ++i)
    add_point_hessian(table, row[i], sample(i, blend(table, table.value, row[i], x)).hessian, matrix);
}

}  // namespace calot
