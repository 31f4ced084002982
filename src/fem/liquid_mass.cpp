#include "fem/liquid_mass.h"

#include <cmath>

namespace calot {

LiquidMass::LiquidMass(const Bile& bile, FlowModes modes, double density, double volume,
                       const LiquidMotion& start, double h)
    : bile_(bile), modes_(std::move(modes)), density_(density), volume_(volume), h_(h) {
  begin_ = centroid(start.x);
  predicted_centroid_ = begin_ + h * start.centroid;
  predicted_flow_ = modes_.columns.transpose() * (start.x + h * start.velocity);
}

VecX LiquidMass::constraint_values(const VecX& x) const {
  VecX out(constraints);
  out.head<3>() = centroid(x) - predicted_centroid_;
  out.tail<FlowModes::count>() = modes_.columns.transpose() * x - predicted_flow_;
  return out;
}

Eigen::MatrixXd LiquidMass::constraint_gradients(const VecX& x) const {
  Eigen::MatrixXd out(x.size(), constraints);
  out.leftCols<3>() = bile_.moment_gradients(x) / volume_;
  out.rightCols<FlowModes::count>() = modes_.columns;
  return out;
}

VecX LiquidMass::compliances() const {
  VecX out(constraints);
  out.head<3>().setConstant(h_ * h_ / mass());
  out.tail<FlowModes::count>().setConstant(h_ * h_ / density_);
  return out;
}

VecX LiquidMass::constraint_scales() const {
  const double length = std::cbrt(volume_);
  VecX out(constraints);
  out.head<3>().setConstant(length);
  out.tail<FlowModes::count>().setConstant(std::sqrt(volume_) * length);
  return out;
}

double LiquidMass::kinetic_energy(const VecX& velocity, const Vec3& of_centroid) const {
  return 0.5 * mass() * of_centroid.squaredNorm() +
         0.5 * density_ * (modes_.columns.transpose() * velocity).squaredNorm();
}

}  // namespace calot
