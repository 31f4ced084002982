#include "fem/point_mass.h"

#include "fem/links.h"

namespace calot {

double PointMass::total() const {
  double sum = 0;
  for (double m : mass) sum += m;
  return sum;
}

double PointMass::energy(const StencilTable& table, const VecX& motion) const {
  double sum = 0;
  for (int r = 0; r < table.rows(); ++r)
    sum += 0.5 * mass[r] * blend(table, table.value, r, motion).squaredNorm();
  return sum;
}

void PointMass::add_product(const StencilTable& table, const VecX& motion, double scale, VecX& out) const {
  for (int r = 0; r < table.rows(); ++r)
    spread(table, r, scale * mass[r] * blend(table, table.value, r, motion), out);
}

void PointMass::add_hessian(const StencilTable& table, double scale, BlockMatrix& matrix) const {
  for (int r = 0; r < table.rows(); ++r)
    add_point_hessian(table, r, scale * mass[r] * Mat3::Identity(), matrix);
}

void PointMass::add_weight(const StencilTable& table, const Vec3& gravity, VecX& load) const {
  for (int r = 0; r < table.rows(); ++r) spread(table, r, mass[r] * gravity, load);
}

Vec3 PointMass::momentum(const StencilTable& table, const VecX& velocity) const {
  Vec3 sum = Vec3::Zero();
  for (int r = 0; r < table.rows(); ++r) sum += mass[r] * blend(table, table.value, r, velocity);
  return sum;
}

Vec3 PointMass::angular_momentum(const StencilTable& table, const VecX& x, const VecX& velocity) const {
  Vec3 sum = Vec3::Zero();
  for (int r = 0; r < table.rows(); ++r)
    sum += mass[r] * blend(table, table.value, r, x).cross(blend(table, table.value, r, velocity));
  return sum;
}

}  // namespace calot
