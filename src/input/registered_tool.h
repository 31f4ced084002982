#pragma once
// One tool of elsewhere as an instrument of the field: what import and live motion share.

#include "input/registration.h"
#include "session/live.h"

namespace calot {

/// Its tip keeps its place relative to the trocar, turned by the registration's axes; roll comes from `across`, else stays.
/// The registration and its instrument must outlive it.
class RegisteredTool {
 public:
  /// `port` is the trocar in their frame and unit.
  RegisteredTool(const Registration& registration, const ForeignInstrument& tool, const Vec3& port,
                 const LiveInstrument& instrument);
  /// Of the next sample: roll is within half a turn of the last. It may be out of the instrument's reach.
  InstrumentPose pose(const ForeignSample& sample);
  /// Samples so far whose jaws were beyond closed or fully open, and are taken for that.
  int held_jaws() const { return held_jaws_; }

 private:
  double roll_of(const ForeignSample& sample, const InstrumentPose& pose) const;
  double jaw_of(const ForeignSample& sample);

  const Registration& registration_;
  const ForeignInstrument& tool_;
  Vec3 port_, trocar_;
  InstrumentGeometry geometry_;
  Mat3 axes_;
  double roll_ = 0;  ///< rad, the last one's
  int held_jaws_ = 0;
};

}  // namespace calot
