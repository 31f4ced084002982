#include "lua/motion.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

/// Integral of 3 x^2 - 2 x^3 from 0 to x: half of the ramp's distance at x = 1.
double ramp_share(double x) { return x * x * x - x * x * x * x / 2; }

}  // namespace

Travel::Travel(double distance, double speed, double ramp)
    : distance_(distance), speed_(std::min(speed, distance / ramp)), ramp_(ramp) {
  if (distance_ > 0) duration_ = distance_ / speed_ + ramp_;
}

double Travel::share(double t) const {
  if (duration_ <= 0) return 1;  // there is no way to go
  if (t <= 0) return 0;
  if (t >= duration_) return 1;
  const double left = duration_ - t;
  if (t < ramp_) return speed_ * ramp_ * ramp_share(t / ramp_) / distance_;
  if (left < ramp_) return 1 - speed_ * ramp_ * ramp_share(left / ramp_) / distance_;
  return speed_ * (t - ramp_ / 2) / distance_;
}

InstrumentPath::InstrumentPath(const Vec3& trocar, const InstrumentPose& start,
                               const InstrumentGeometry& geometry)
    : trocar_(trocar), geometry_(geometry), to_roll_(start.roll), to_jaw_(start.jaw) {
  InstrumentPose closed = start;
  closed.jaw = 0;
  to_tip_ = tip_position(trocar, closed, geometry);
  roll_.from = roll_.to = Vec3(start.roll, 0, 0);
  jaw_.from = jaw_.to = Vec3(start.jaw, 0, 0);
}

void InstrumentPath::move(double time, const Vec3& tip, double speed) {
  if (!moves_.empty() && moves_.back().start + moves_.back().travel.duration() <= time) moves_.clear();
  if (!moves_.empty()) time = moves_.back().start + moves_.back().travel.duration();
  moves_.push_back({time, Travel((tip - to_tip_).norm(), speed), to_tip_, tip});
  to_tip_ = tip;
  busy_until_ = std::max(busy_until_, time + moves_.back().travel.duration());
}

void InstrumentPath::rotate(double time, double roll, double speed) {
  roll_ = {time, Travel(std::abs(roll - to_roll_), speed), Vec3(to_roll_, 0, 0), Vec3(roll, 0, 0)};
  to_roll_ = roll;
  busy_until_ = std::max(busy_until_, time + roll_.travel.duration());
}

/// A travel of two ramps and nothing between takes just `duration`.
void InstrumentPath::set_jaw(double time, double jaw, double duration) {
  const double distance = std::abs(jaw - to_jaw_);
  jaw_ = {time, Travel(distance, 2 * distance / duration, duration / 2), Vec3(to_jaw_, 0, 0),
          Vec3(jaw, 0, 0)};
  to_jaw_ = jaw;
  busy_until_ = std::max(busy_until_, time + jaw_.travel.duration());
}

double InstrumentPath::scalar(const Segment& segment, double time) const {
  return segment.from.x() + (segment.to.x() - segment.from.x()) * segment.travel.share(time - segment.start);
}

Vec3 InstrumentPath::tip_at(double time) const {
  Vec3 tip = moves_.empty() ? to_tip_ : moves_.front().from;
  for (const Segment& move : moves_) {
    if (time < move.start) break;
    tip = move.from + (move.to - move.from) * move.travel.share(time - move.start);
  }
  return tip;
}

void InstrumentPath::halt(double time) {
  to_tip_ = tip_at(time);
  moves_.clear();
  busy_until_ = std::min(busy_until_, time);
}

InstrumentPose InstrumentPath::pose(double time) const {
  InstrumentPose pose = pose_reaching(trocar_, tip_at(time), scalar(roll_, time), 0, geometry_);
  pose.jaw = scalar(jaw_, time);
  return pose;
}

Vec3 closed_tip(const Vec3& trocar, const Vec3& tip, double jaw, const InstrumentGeometry& geometry) {
  InstrumentPose pose = pose_reaching(trocar, tip, 0, jaw, geometry);
  pose.jaw = 0;
  return tip_position(trocar, pose, geometry);
}

}  // namespace calot
