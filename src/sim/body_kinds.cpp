#include "sim/body_kinds.h"

#include <fmt/format.h>

namespace calot {

const std::vector<BodyKind>& body_kinds() {
  static const std::vector<BodyKind> kinds = {{"pear", make_hollow_organ}, {"sphere", make_hollow_organ},
                                              {"obj", make_hollow_organ},  {"tube", make_tube},
                                              {"rigid", make_rigid_organ}, {"lobe", make_lobe}};
  return kinds;
}

Result<RestedOrgan> make_organ(const OrganDefinition& definition, const ContactLoads& loads, const Vec3& up,
                               double tolerance, int levels, FillingLimits* limits) {
  return body_kinds()[definition.shape.index()].make(definition, {loads, up, tolerance, levels, limits});
}

std::optional<Failure> check_clear_of_ground(const Body& body, const ContactLoads& loads) {
  for (const Shape& shape : loads.shapes)
    for (std::size_t row = 0; row < body.skin_rest().size(); ++row) {
      const double radius = body.skin_radii().empty() ? 0 : body.skin_radii()[row];
      const double distance = signed_distance(shape, body.skin_rest()[row]) - radius;
      if (distance > 0) continue;
      return fail(FailureKind::scenario,
                  fmt::format("organ '{}' starts {:.2g} mm inside the {}", body.name(),
                              1e3 * (contact_inset - distance),
                              std::holds_alternative<Plane>(shape) ? "supporting plane" : "ground"),
                  "move the organ up or the plane down", {"", 0, "scene.anatomy.support.point"});
    }
  return std::nullopt;
}

}  // namespace calot
