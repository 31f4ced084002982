#include "sim/field.h"

namespace calot {

std::vector<InstrumentPose> present_poses(const Field& field) {
  std::vector<InstrumentPose> poses;
  for (const Tool& tool : field.tools) poses.push_back(tool.pose);
  return poses;
}

}  // namespace calot
