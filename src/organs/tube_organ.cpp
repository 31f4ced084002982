#include "body/rod_body.h"
#include "organs/body_kinds.h"

namespace calot {

Result<RestedOrgan> make_tube(const OrganDefinition& definition, const OrganSetting& setting) {
  const auto& shape = std::get<TubeShape>(definition.shape);
  RodBody::Setup setup;
  setup.name = definition.name;
  setup.points = shape.points;
  setup.radius = shape.radius;
  setup.end_radius = shape.end_radius;
  setup.radii = shape.radii;
  setup.wall = definition.wall.thickness;
  setup.shear_modulus = definition.wall.shear_modulus;
  setup.pressure = shape.pressure;
  setup.density = definition.wall.density;
  if (setup.density > 0) setup.liquid_density = definition.bile.density;  // without weight neither has any
  setup.nodes = shape.nodes;
  setup.up = setting.up;
  for (const Landmark& landmark : landmark_rows())
    if (has_landmark(shape, landmark)) setup.landmarks[landmark.name] = landmark.along;
  for (const HeldRegion& region : definition.held)
    if (const auto at = setup.landmarks.find(region.landmark); at != setup.landmarks.end())
      setup.held.push_back({at->second, region.radius, region.stiffness});
  return organ_as_drawn(definition, RodBody::create(setup), setting);
}

Result<BodyPointer> released_tube(const Organ& organ, const std::vector<HeldRegion>& /*left*/,
                                  std::size_t released) {
  return BodyPointer(std::make_shared<const RodBody>(organ.body->as_tube()->without_held(released)));
}

}  // namespace calot
