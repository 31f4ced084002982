#include "window/hand_control.h"

#include <algorithm>
#include <cmath>

#include "render/lens.h"

namespace calot {
namespace {

constexpr double least_depth = 25e-3;  // m from the trocar: the jaws and a little more
constexpr double most_roll = 50;       // rad

}  // namespace

HandMotion& HandMotion::operator+=(const HandMotion& other) {
  in_view += other.in_view;
  roll += other.roll;
  jaw += other.jaw;
  activate = activate || other.activate;
  next_hand = next_hand || other.next_hand;
  laparoscope = laparoscope || other.laparoscope;
  exchange = exchange || other.exchange;
  time_out = time_out || other.time_out;
  bail_out = bail_out || other.bail_out;
  return *this;
}

HandControl::HandControl(std::vector<LiveInstrument> instruments, const std::vector<InstrumentPose>& poses)
    : instruments_(std::move(instruments)), poses_(poses), waits_(poses.size(), 0), drawn_(waits_) {}

void HandControl::see(const std::vector<InstrumentPose>& poses, const std::vector<char>& waits,
                      const std::vector<char>& drawn) {
  for (std::size_t i = 0; i < waits.size(); ++i)
    if (waits[i] != waits_[i] || drawn[i] || drawn_[i]) poses_[i] = poses[i];
  waits_ = waits;
  drawn_ = drawn;
  for (std::size_t k = 0; k < waits.size() && this->waits(hand_); ++k) hand_ = next_of_port();
}

int HandControl::next_of_port() const {
  const auto hand = static_cast<std::size_t>(hand_);
  const std::size_t tools = instruments_.size() - 1;  // without the laparoscope
  std::size_t next = (hand + 1) % tools;
  while (instruments_[next].definition.port != instruments_[hand].definition.port) next = (next + 1) % tools;
  return static_cast<int>(next);
}

std::optional<LiveInput> HandControl::exchange() const {
  const int coming = next_of_port();
  if (!waits(coming)) return std::nullopt;
  LiveInput input = held(coming);
  input.action = InstrumentAction::exchange;
  return input;
}

Vec3 HandControl::tip(int instrument) const {
  const auto i = static_cast<std::size_t>(instrument);
  InstrumentPose closed = poses_[i];
  closed.jaw = 0;
  return tip_position(instruments_[i].trocar, closed, instruments_[i].geometry);
}

Vec3 HandControl::grasped(const SceneCamera& camera) const {
  if (!on_laparoscope_) return tip(hand_);
  return camera.position + poses_.back().insertion * camera.direction.normalized();
}

void HandControl::move(const HandMotion& motion, const SceneCamera& camera) {
  if (motion.laparoscope) on_laparoscope_ = !on_laparoscope_;
  if (motion.next_hand && !on_laparoscope_) {
    do hand_ = (hand_ + 1) % laparoscope();
    while (waits(hand_));
  }
  if (motion.next_hand) on_laparoscope_ = false;
  move(selected(), motion, camera);
  action_ = motion.activate && !on_laparoscope_
                ? main_action(instruments_[static_cast<std::size_t>(hand_)].definition.type)
                : InstrumentAction::none;
}

void HandControl::move_laparoscope(const HandMotion& motion, const SceneCamera& camera) {
  move(laparoscope(), motion, camera);
}

void HandControl::move(int which, const HandMotion& motion, const SceneCamera& camera) {
  const auto i = static_cast<std::size_t>(which);
  const LiveInstrument& instrument = instruments_[i];
  InstrumentPose& pose = poses_[i];
  if (motion.in_view != Vec3::Zero()) {
    const Vec3 wanted = tip(which) + camera_axes(camera).transpose() * motion.in_view;
    const double depth = (wanted - instrument.trocar).norm();
    out_of_reach_ = depth < least_depth || depth > instrument.geometry.max_insertion;
    if (!out_of_reach_) {
      const double jaw = pose.jaw;
      pose = pose_reaching(instrument.trocar, wanted, pose.roll, 0, instrument.geometry);
      pose.jaw = jaw;
    }
  }
  pose.jaw = std::clamp(pose.jaw + motion.jaw, 0.0, instrument.geometry.jaw_opening);
  pose.roll = std::clamp(pose.roll + motion.roll, -most_roll, most_roll);
}

LiveInput HandControl::input() const {
  LiveInput input = held(selected());
  input.action = action_;
  return input;
}

LiveInput HandControl::held(int instrument) const {
  LiveInput input;
  input.instrument = instrument;
  input.pose = poses_[static_cast<std::size_t>(instrument)];
  return input;
}

double metres_a_pixel(const SceneCamera& camera, const Vec3& place, double field) {
  const double depth = std::max(5e-3, camera.direction.normalized().dot(place - camera.position));
  return 2 * depth * std::tan(0.5 * camera.field_of_view) / field;
}

}  // namespace calot
