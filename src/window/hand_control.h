#pragma once
// How a mouse, a keyboard or a gamepad moves instruments: one hand at a time, in the plane of the view.

#include <optional>
#include <vector>

#include "render/scene.h"
#include "session/live.h"

namespace calot {

/// What a device asks of the hand that is selected, since the last time it was asked.
struct HandMotion {
  Vec3 in_view = Vec3::Zero();                  ///< m: right, up and into the picture
  double roll = 0, jaw = 0;                     ///< rad: more
  bool activate = false;                        ///< the pedal is down
  bool next_hand = false, laparoscope = false;  ///< to the other hand; to the laparoscope, or back
  bool exchange = false;  ///< the next instrument that waits for the hand's port is to come in
  bool time_out = false, bail_out = false;  ///< the acts, no motion
  bool moves() const { return in_view != Vec3::Zero() || roll != 0 || jaw != 0; }
  HandMotion& operator+=(const HandMotion& other);
};

class HandControl {
 public:
  /// `poses` are where the instruments are, one each.
  HandControl(std::vector<LiveInstrument> instruments, const std::vector<InstrumentPose>& poses);

  int selected() const { return on_laparoscope_ ? laparoscope() : hand_; }
  int laparoscope() const { return static_cast<int>(instruments_.size()) - 1; }
  /// Moves the selected hand; the others stay where they were left. Jaws stop where they are closed or fully open. Where
  /// the tip would be out of reach it stays, and `out_of_reach` says so.
  void move(const HandMotion& motion, const SceneCamera& camera);
  /// The same of the laparoscope, selected or not: somebody else holds it.
  void move_laparoscope(const HandMotion& motion, const SceneCamera& camera);
  bool out_of_reach() const { return out_of_reach_; }
  /// Where instruments are now, one each, and which wait outside. Hands pass over those; whose instrument was exchanged
  /// holds the one that came in, from where it is, and so does one whose instrument was drawn back for another
  /// (`drawn`).
  void see(const std::vector<InstrumentPose>& poses, const std::vector<char>& waits,
           const std::vector<char>& drawn);
  /// For the mailbox: asks for the next instrument that waits for the selected hand's port; none: there is none.
  std::optional<LiveInput> exchange() const;
  /// Of the closed jaws, m.
  Vec3 tip(int instrument) const;
  /// What goes as far in the view as the selected hand's device does, m: its tip. The laparoscope turns by what is as far
  /// before it as its port is behind, so that the picture goes with the pointer.
  Vec3 grasped(const SceneCamera& camera) const;
  /// For the mailbox, of the selected hand.
  LiveInput input() const;
  /// The same of one that was let go by selecting another: it no longer acts.
  LiveInput held(int instrument) const;

 private:
  void move(int instrument, const HandMotion& motion, const SceneCamera& camera);
  bool waits(int instrument) const { return waits_[static_cast<std::size_t>(instrument)] != 0; }
  /// The next instrument after the hand's that goes through its port, itself the last.
  int next_of_port() const;

  std::vector<LiveInstrument> instruments_;  ///< the laparoscope is the last
  std::vector<InstrumentPose> poses_;
  std::vector<char> waits_, drawn_;  ///< one an instrument
  int hand_ = 0;
  bool on_laparoscope_ = false, out_of_reach_ = false;
  InstrumentAction action_ = InstrumentAction::none;  ///< that is asked of the hand selected
};

/// m at the depth of `place` that a pixel of the picture covers at its middle; `field` is the round field's diameter, px.
double metres_a_pixel(const SceneCamera& camera, const Vec3& place, double field);

}  // namespace calot
