#pragma once
// Organs, tools and what carries them.

#include <optional>
#include <vector>

#include "sim/organ.h"
#include "sim/step_report.h"
#include "sim/tool.h"

namespace calot {

/// What the laparoscope looks at from near by.
struct ViewedPlace {
  int organ = 0, skin_point = 0;
};

struct Field {
  std::vector<Organ> organs;
  std::vector<Tool> tools;
  std::optional<Plane> support;
  double support_friction = 0;  ///< Coulomb's
  Barrier barrier = contact_barrier;
  double tolerance = 1e-6;
  std::optional<ViewedPlace> viewed;
  ExtensionScheme scheme = ExtensionScheme::condensed;
};

std::vector<InstrumentPose> present_poses(const Field& field);

}  // namespace calot
