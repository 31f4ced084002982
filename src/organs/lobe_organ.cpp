#include "anatomy/organ_frame.h"
#include "body/solid_body.h"
#include "geometry/lobe.h"
#include "organs/body_kinds.h"

namespace calot {
namespace {

/// m, between bed and gallbladder as drawn: they press on each other from nearer.
constexpr double bed_clearance = 2.0e-3;

LobeForm form_of(const LobeShape& shape) {
  LobeForm form;
  form.width = shape.width, form.depth = shape.depth;
  form.thickness = shape.thickness, form.edge = shape.edge, form.edge_angle = shape.edge_angle;
  form.edge_at = shape.bed_length - shape.overhang;
  form.bed_width = shape.bed_width;
  form.underside = 0.5 * shape.bed_width - shape.bed_depth;
  if (shape.bed_width <= 0) return form;
  form.bed_radius = [radius = radius_by_height(pear_profile(shape.bed_length, shape.bed_width))](double z) {
    const double of_gallbladder = radius(z);
    return of_gallbladder > 0 ? of_gallbladder + bed_clearance : 0.0;
  };
  return form;
}

std::map<std::string, Vec3> places_of(const OrganDefinition& definition) {
  const LobeForm form = form_of(std::get<LobeShape>(definition.shape));
  const Pose frame = organ_frame(definition);
  std::map<std::string, Vec3> places;
  for (const Landmark& landmark : landmark_rows())
    if (has_landmark(definition.shape, landmark))
      places[landmark.name] = frame * lobe_place(form, {0.5, landmark.along, 0.5 * (landmark.side + 1)});
  return places;
}

/// N/m per m^2: of its back, and around the landmarks that it is held at.
auto foundation_of(const LobeShape& shape, const std::vector<HeldRegion>& held, const BoxSurface& box,
                   const std::map<std::string, Vec3>& places) {
  return [hold = shape.hold, held, box, places](const Vec3& x, int triangle) {
    double stiffness = box.on_side(triangle, 1, 0) ? hold : 0.0;
    for (const HeldRegion& region : held)
      if (const auto at = places.find(region.landmark);
          at != places.end() && (x - at->second).norm() < region.radius)
        stiffness += region.stiffness;
    return stiffness;
  };
}

}  // namespace

Result<RestedOrgan> make_lobe(const OrganDefinition& definition, const OrganSetting& setting) {
  const auto& shape = std::get<LobeShape>(definition.shape);
  const Pose frame = organ_frame(definition);
  const LobeForm form = form_of(shape);
  const LobeCells cells = lobe_cells(form);
  SolidBody::Setup setup;
  setup.name = definition.name;
  setup.box = cells.surface;
  setup.control = lobe_mesh(form, cells);
  for (Vec3& p : setup.control.points) p = frame * p;
  const Result<LoopSurface> surface = LoopSurface::create(setup.control);
  if (!surface) return surface.failure();
  Result<std::vector<Vec3>> fitted = fit_to_limit(surface.value(), setup.control.points);
  if (!fitted) return fitted.failure();
  setup.control.points = std::move(fitted).value();
  setup.material = {shape.young, shape.poisson};
  setup.density = shape.density;
  setup.capsule = {shape.capsule, shape.capsule_slack};
  setup.up = setting.up;
  setup.sags = shape.sags;
  setup.landmarks = places_of(definition);
  setup.foundation = foundation_of(shape, definition.held, setup.box, setup.landmarks);
  return organ_as_drawn(definition, SolidBody::create(setup, setting.kept), setting);
}

Result<BodyPointer> released_lobe(const Organ& organ, const std::vector<HeldRegion>& left,
                                  std::size_t /*released*/) {
  const OrganDefinition& definition = organ.definition;
  const auto& shape = std::get<LobeShape>(definition.shape);
  const SolidBody& solid = *organ.body->as_solid();
  return BodyPointer(std::make_shared<const SolidBody>(solid.with_foundation(
      foundation_of(shape, left, lobe_cells(form_of(shape)).surface, places_of(definition)))));
}

}  // namespace calot
