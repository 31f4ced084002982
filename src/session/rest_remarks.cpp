#include "session/rest_remarks.h"

#include <fmt/format.h>

#include "base/units.h"

namespace calot {

std::vector<std::string> rest_remarks(const World& world) {
  const AnatomyDefinition& anatomy = world.scene().anatomy;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < anatomy.organs.size(); ++i) {
    const RestShift& shift = world.rest_shifts()[i];
    if (shift.distance <= anatomy.rest_within) continue;
    const std::string& name = anatomy.organs[i].name;
    const std::string where =
        shift.landmark.empty() ? "" : fmt::format(", furthest near {}.{}", name, shift.landmark);
    out.push_back(fmt::format("{} came to rest {:.1f} mm from where it is drawn{} (rest_within: {:.0f} mm)",
                              name, shift.distance / units::mm, where, anatomy.rest_within / units::mm));
  }
  return out;
}

}  // namespace calot
