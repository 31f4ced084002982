#include <fmt/format.h>

#include <stdexcept>

#include "acts/clearance.h"
#include "base/suggest.h"
#include "field/roll.h"
#include "group/vibration.h"
#include "motion/settle_field.h"
#include "motion/tool_loads.h"
#include "world/world_impl.h"

namespace calot {
namespace {

/// Names are checked where they come in: one that is unknown here is a defect of the program.
[[noreturn]] void unknown_name(const std::string& what, const std::string& name) {
  throw std::logic_error("no " + what + " is called '" + name + "'");
}

}  // namespace

const std::vector<RestShift>& World::rest_shifts() const { return impl_->rest_shifts; }
Vec3 World::up() const { return impl_->up; }
const Field& World::field() const { return impl_->field; }

Vec3 World::port_position(const std::string& port) const {
  for (const PortDefinition& p : impl_->scene.ports)
    if (p.name == port) return p.position;
  unknown_name("port", port);
}

namespace {

/// Where a landmark of an organ that went was last.
const SkinPlace& last_place(const Field& field, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const BodyRecord* record = dot == std::string::npos ? nullptr : gone_body(field, name.substr(0, dot));
  if (record == nullptr || !record->gone->landmarks.contains(name.substr(dot + 1)))
    unknown_name("landmark", name);
  return record->gone->landmarks.at(name.substr(dot + 1));
}

}  // namespace

Vec3 World::landmark(const std::string& name) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, name);
  if (!there) return last_place(impl_->field, name).at;
  const Organ& organ = impl_->field.organ(there->organ);
  return organ.body->landmark_place(there->skin_point, organ.state.x);
}

Vec3 World::landmark_normal(const std::string& name) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, name);
  if (!there) return last_place(impl_->field, name).normal;
  // Its places lie inside of it: what comes to them comes from above.
  if (std::holds_alternative<RigidShape>(impl_->field.organ(there->organ).definition.shape)) return up();
  return skin_normals(there->organ)[there->skin_point];
}

double World::clearance(ToolIndex instrument, OrganIndex organ) const {
  return calot::clearance(impl_->field.tool(instrument), impl_->field.organ(organ)).distance;
}

// m before a place: as thick as what a triangle is stretched between.
constexpr double looked_through = 2e-3;

double World::seen_area(const std::array<Vec3, 3>& corners) const {
  return calot::seen_area(impl_->look(), impl_->report.laparoscope.view,
                          impl_->scene.laparoscope.field_of_view, corners, looked_through);
}

bool World::sees(const Vec3& place, const std::string& through) const {
  return is_in_field(impl_->report.laparoscope.view, impl_->scene.laparoscope.field_of_view, place) &&
         impl_->look().sees_past_ground(place, looked_through, through);
}

bool World::sees(const std::string& landmark) const {
  const std::optional<OrganPoint> there = find_landmark(impl_->field.organs, landmark);
  const bool rigid =
      there && std::holds_alternative<RigidShape>(impl_->field.organ(there->organ).definition.shape);
  return sees(this->landmark(landmark),
              rigid ? impl_->field.organ(there->organ).definition.name : std::string());
}

const Laparoscope& World::laparoscope() const { return impl_->laparoscope; }

CriticalView World::critical_view(const CriticalViewQuestion& question) const {
  const HepatocysticTriangle triangle{landmark(question.neck), landmark(question.junction),
                                      landmark(question.hilum)};
  return calot::critical_view(impl_->field, triangle, impl_->look(), question);
}

const Tessellation& World::skin(OrganIndex organ) const { return impl_->field.organ(organ).body->skin(); }
std::vector<Vec3> World::skin_positions(OrganIndex organ) const {
  return impl_->field.organ(organ).body->skin_positions(impl_->field.organ(organ).state.x);
}
std::vector<Vec3> World::skin_normals(OrganIndex organ) const {
  return impl_->field.organ(organ).body->skin_normals(impl_->field.organ(organ).state.x);
}
const std::vector<Triangle>& World::drawn_triangles(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn_triangles();
}
const std::vector<Vec3>& World::drawn_rest(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn_rest();
}
DrawnSurface World::drawn(OrganIndex organ) const {
  return impl_->field.organ(organ).body->drawn(impl_->field.organ(organ).state.x);
}

Result<double> World::lowest_frequency(OrganIndex index) const {
  const Organ& organ = impl_->field.organ(index);
  const ShellBody* shell = organ.body->as_shell();
  if (shell == nullptr)
    return fail(
        FailureKind::simulation,
        fmt::format("'{}' is no hollow organ: its natural frequency is not known", organ.definition.name));
  const BodyMass mass(*shell, organ.state.x, organ.definition.wall.thickness, organ.definition.bile.density);
  return calot::lowest_frequency(*shell, contact_loads(impl_->field, organ, present_poses(impl_->field)),
                                 organ.state, mass);
}

Result<OrganIndex> World::organ(const std::string& name) const { return find_body(impl_->field, name); }
Result<OrganIndex> World::organ(const BodyHandle& handle) const { return find_body(impl_->field, handle); }
BodyHandle World::handle(OrganIndex organ) const { return handle_of(impl_->field, organ); }

Result<Vec3> World::place(const std::string& name) const {
  const std::size_t dot = name.rfind('.');
  if (find_landmark(impl_->field.organs, name)) return landmark(name);
  if (dot != std::string::npos && gone_body(impl_->field, name.substr(0, dot)) != nullptr)
    if (const Result<OrganIndex> there = organ(name.substr(0, dot)); !there) return there.failure();
  return fail(FailureKind::scenario, fmt::format("unknown landmark \"{}\"", name),
              suggestion(name, landmarks()));
}

std::vector<std::string> World::landmarks() const {
  std::vector<std::string> names;
  for (const Organ& organ : impl_->field.organs)
    for (const auto& [name, point] : organ.landmarks) names.push_back(organ.definition.name + "." + name);
  return names;
}

double World::deepest_penetration() const { return calot::deepest_penetration(impl_->field); }

}  // namespace calot
