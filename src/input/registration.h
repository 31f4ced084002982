#pragma once
// How motion from elsewhere is laid into an exercise's field, each instrument by its trocar.

#include "input/foreign_motion.h"
#include "session/exercise.h"
#include "session/live.h"
#include "session/recording.h"

namespace calot {

struct Registration {
  int version = 1;
  std::string exercise;  ///< the id of what it is for
  MotionFormat format = MotionFormat::csv;
  double unit = 1, angle_unit = 1, time_unit = 1;  ///< theirs in m, rad, s
  double time_step = 0;                            ///< s between rows, of files without times
  /// Their x, y and z axis in the patient's frame: a rotation.
  Vec3 x_axis = Vec3::UnitX(), y_axis = Vec3::UnitY(), z_axis = Vec3::UnitZ();
  double longest_gap = 0.25;  ///< s: what is further apart is not joined by a straight line
  CsvColumns columns;
  std::vector<ForeignInstrument> instruments;
  Place place;  ///< the file
};

/// What of it does not fit the exercise: its id, its instruments.
std::vector<Problem> problems_with(const Registration& registration, const ExerciseDefinition& exercise);

/// What of it does not fit motion that comes while the exercise runs: its id, its instruments (the laparoscope may be one,
/// and who is missing does not move), a trocar's place that is to be found.
std::vector<Problem> live_problems_with(const Registration& registration, const ExerciseDefinition& exercise);
/// Of senders that know the field: mm in the patient's frame, each tool called as its instrument.
Registration direct_registration(const std::string& exercise, const std::vector<LiveInstrument>& instruments);

/// A recording of poses without states: each instrument's tip keeps its place relative to the trocar, turned by the axes;
/// roll comes from `across`. Resampled to the exercise's rate by straight lines. Instruments begin in their trocars and go
/// in at lead_in_speed. `notes` say what was estimated, left out or beyond a limit. Fails (usage) with the rows that are
/// out of reach, out of order, or too far apart.
struct ImportedRecording {
  Recording recording;
  std::vector<std::string> notes;
};
inline constexpr double lead_in_speed = 0.1;  // m/s
Result<ImportedRecording> to_recording(const ForeignMotion& motion, const Registration& registration,
                                       const ExerciseDefinition& exercise);

/// Writes it whole. Fails (usage) where it cannot be written.
std::optional<Failure> write_recording(const std::string& path, const Recording& recording);

}  // namespace calot
