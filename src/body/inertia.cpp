#include "body/inertia.h"

#include <cmath>

#include "numerics/parts.h"

namespace calot {
namespace {

bool slow(const Body& body, const LiquidMotion& motion, double duration) {
  const double limit = rest_acceleration * duration;
  return body.largest_motion(motion.velocity) < limit && motion.centroid.norm() < limit;
}

}  // namespace

LiquidMotion present_motion(const Body& body, const BodyState& state) {
  const MotionPart& part = state.motion;
  const LiquidMotion still{state.x, VecX::Zero(state.x.size()), Vec3::Zero()};
  if (part.duration == 0) return still;
  LiquidMotion out = still;
  out.velocity = (state.x - part.begin.x) / part.duration;
  if (const Liquid* liquid = body.liquid())
    out.centroid = (liquid->centroid(state.x, state.volume) - liquid->centroid(part.begin.x, state.volume)) /
                   part.duration;
  return slow(body, out, part.duration) && slow(body, part.begin, part.duration) ? still : out;
}

bool stands_still(const LiquidMotion& motion) {
  return motion.velocity.isZero(0) && motion.centroid.isZero(0);
}

Result<MotionPart> motion_part(const Body& body, const LiquidMotion& begin, double duration) {
  MotionPart out{begin, duration};
  if (body.liquid() == nullptr) return out;
  Result<FlowModes> flow = body.flow(begin.x);
  if (!flow) return flow.failure();
  out.flow = std::make_shared<const FlowModes>(std::move(flow).value());
  return out;
}

Inertia::Inertia(const Body& body, const BodyState& state, double retardation)
    : body_(body),
      begin_(state.motion.begin.x),
      predicted_(begin_ + state.motion.duration * state.motion.begin.velocity),
      by_time_squared_(1 / (state.motion.duration * state.motion.duration)),
      retarded_(retardation, state.motion.duration, begin_),
      constant_(body.pattern()) {
  if (const BlockMatrix* mass = body.mass()) {
    mass_.emplace(*mass);
    constant_.add(mass->entries(), by_time_squared_ / retarded_.hessian_factor());
  }
  if (const Liquid* liquid = body.liquid())
    liquid_.emplace(
        liquid->mass(*state.motion.flow, state.volume, state.motion.begin, state.motion.duration));
}

double Inertia::value(const VecX& x) const {
  const double own = retarded_.value_factor() * body_.value(retarded_.lead(x));
  if (!std::isfinite(own) || !mass_) return own;
  const VecX off = x - predicted_;
  return own + 0.5 * by_time_squared_ * off.dot(mass_->multiply(off));
}

double Inertia::add_gradient(const VecX& x, VecX& gradient) const {
  double largest = 0;
  body_.add_gradient(retarded_.lead(x), gradient, largest);
  if (!mass_) return largest;
  const VecX force = by_time_squared_ * mass_->multiply(x - predicted_);
  gradient += force;
  return std::max(largest, largest_node(force));
}

void Inertia::hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const {
  matrix.assign(constant_);
  body_.add_hessian(retarded_.lead(x), matrix, assembly);
  matrix.scale(retarded_.hessian_factor());
}

VecX Inertia::multipliers(const VecX& x) const {
  return liquid_ ? VecX(-liquid_->constraint_values(x).cwiseQuotient(liquid_->compliances())) : VecX();
}

}  // namespace calot
