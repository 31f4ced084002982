#pragma once
// Motion that was recorded elsewhere, as its files hold it: in their frame, units and rate. How it becomes a recording:
// input/registration.h.

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "geometry/types.h"
#include "tools/instrument.h"

namespace calot {

enum class MotionFormat {
  csv,       ///< a row for each time and instrument, columns by name
  jigsaws,   ///< 76 numbers a row: both masters and both slaves of a da Vinci, 19 each
  sequence,  ///< the header of a sequence file (.mha, .mhd) of Plus or 3D Slicer: a transform for each frame
};
const std::vector<std::string>& motion_format_names();  ///< in the order of the formats

/// What the columns of a CSV file are called.
struct CsvColumns {
  std::string time = "time", instrument = "instrument";
  std::string tip_x = "tip_x", tip_y = "tip_y", tip_z = "tip_z";
  std::string dir_x = "dir_x", dir_y = "dir_y", dir_z = "dir_z";  ///< along the shaft towards the tip
  std::string pitch = "pitch", yaw = "yaw", insertion = "insertion", roll = "roll", jaw = "jaw";
};

/// One instrument in such a file, and how it is registered.
struct ForeignInstrument {
  std::string name;  ///< of the exercise
  std::string
      source;  ///< csv: the instrument column's text; jigsaws: one of jigsaws_arms(); sequence: the transform's name
  /// Their place of the trocar, in their frame and unit; none: where all shafts come nearest to (needs directions).
  std::optional<Vec3> port;
  Vec3 tip = Vec3::Zero();      ///< of the tool's own frame, their unit: the instrument's tip
  Vec3 along = Vec3::UnitZ();   ///< of the tool's own frame: the shaft, towards the tip
  Vec3 across = Vec3::UnitX();  ///< the same: the plane in which the jaws open
  std::string jaw;  ///< sequence: the name of the frame field with the jaws' opening; may be empty
  std::optional<double> jaw_closed, jaw_open;  ///< their values of closed and fully open jaws; none: an angle
  Place place;
};

struct ForeignSample {
  int row = 0;                          ///< line of the file, or number of the frame
  double time = 0;                      ///< their unit
  Vec3 tip = Vec3::Zero();              ///< their unit and frame
  std::optional<Vec3> along, across;    ///< unit, their frame
  std::optional<InstrumentPose> pivot;  ///< pitch, yaw and insertion, in their units; instead of the tip
  std::optional<double> roll, jaw;      ///< their units
};

/// But for what few digits leave.
bool is_rotation(const Mat3& r);
/// Tip and directions of a tool whose frame has this origin and these axes.
void set_frame(ForeignSample& sample, const ForeignInstrument& tool, const Mat3& axes, const Vec3& origin);

struct ForeignMotion {
  std::string file;
  bool framed = false;  ///< its rows are frames, not lines
  std::vector<std::vector<ForeignSample>>
      tracks;  ///< [instrument of the registration], as they stand in the file
  std::vector<std::string> notes;
};

/// "master_left", "master_right", "slave_left", "slave_right": the columns' order.
const std::vector<std::string>& jigsaws_arms();

struct Registration;

/// Fails (usage) with every row that is broken, by its number, of the first hundred.
Result<ForeignMotion> read_foreign_motion(const std::string& path, const Registration& registration);

}  // namespace calot
