#include "body/rigid_body.h"
#include "organs/body_kinds.h"

namespace calot {

Result<RestedOrgan> make_rigid_organ(const OrganDefinition& definition, const OrganSetting& setting) {
  const auto& shape = std::get<RigidShape>(definition.shape);
  constexpr double spacing = 1.5e-3;  // m: contact points lie between
  return organ_as_drawn(
      definition,
      RigidBody::create({definition.name, rounded_box(shape.size, shape.rounding, shape.centre, spacing),
                         shape.density, shape.stiffness, setting.up, landmarks_of(definition.shape)}),
      setting);
}

}  // namespace calot
