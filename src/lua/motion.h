#pragma once
// How an instrument travels: in time only, so that the path does not depend on the step.

#include <vector>

#include "tools/instrument.h"

namespace calot {

/// One travel from 0 to `distance` that starts and stops smoothly: the speed rises and falls as 3 x^2 - 2 x^3
/// within `ramp` seconds and is constant between; a distance too short for that keeps the ramps and never
/// reaches the speed. Distance in any unit, speed in that unit per s.
class Travel {
 public:
  Travel() = default;
  Travel(double distance, double speed, double ramp = 0.2);
  double duration() const { return duration_; }
  /// Share of the distance covered at time t: 0 before the start, 1 after the end.
  double share(double t) const;

 private:
  double distance_ = 0, speed_ = 0, ramp_ = 0, duration_ = 0;
};

/// What the demo commands of one instrument: the tip of its closed jaws, roll and jaw angle over time.
class InstrumentPath {
 public:
  InstrumentPath(const Vec3& trocar, const InstrumentPose& start, const InstrumentGeometry& geometry);

  const Vec3& trocar() const { return trocar_; }
  const InstrumentGeometry& geometry() const { return geometry_; }
  /// Where the path leads once all motions have ended.
  const Vec3& tip() const { return to_tip_; }
  double roll() const { return to_roll_; }
  double jaw() const { return to_jaw_; }
  /// End of the last motion, s.
  double busy_until() const { return busy_until_; }

  // Motions; each begins at `time` (or after the moves of the tip already given) and they may overlap. m,
  // rad, s.
  void move(double time, const Vec3& tip, double speed);
  void rotate(double time, double roll, double speed);
  void set_jaw(double time, double jaw, double duration);

  /// Ends the moves of the tip where they are at `time`.
  void halt(double time);

  InstrumentPose pose(double time) const;

 private:
  struct Segment {
    double start = 0;
    Travel travel;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  };
  double scalar(const Segment& segment, double time) const;
  Vec3 tip_at(double time) const;

  Vec3 trocar_;
  InstrumentGeometry geometry_;
  std::vector<Segment> moves_;  ///< in order, one after the other
  Segment roll_, jaw_;          ///< in x
  Vec3 to_tip_;
  double to_roll_, to_jaw_, busy_until_ = 0;
};

/// The tip of the jaws once closed, for jaws open by `jaw` whose tip is at `tip`.
Vec3 closed_tip(const Vec3& trocar, const Vec3& tip, double jaw, const InstrumentGeometry& geometry);

}  // namespace calot
