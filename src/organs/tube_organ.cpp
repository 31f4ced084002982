#include <cmath>

#include "body/rod_body.h"
#include "organs/body_kinds.h"

namespace calot {

std::map<std::string, int> tube_landmarks(const OrganShape& shape, const Body& body) {
  std::map<std::string, int> out;
  const int last = static_cast<int>(body.skin_rest().size()) - 1;
  for (const Landmark& landmark : landmark_rows())
    if (has_landmark(shape, landmark))
      out[landmark.name] = static_cast<int>(std::lround(landmark.along * last));
  return out;
}

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
  for (const HeldRegion& region : definition.held)
    for (const Landmark& landmark : landmark_rows())
      if (region.landmark == landmark.name && has_landmark(shape, landmark))
        setup.held.push_back({landmark.along, region.radius, region.stiffness});
  Result<RestedOrgan> made = organ_as_drawn(definition, RodBody::create(setup), setting);
  if (made) made->organ.landmarks = tube_landmarks(definition.shape, *made->organ.body);
  return made;
}

}  // namespace calot
