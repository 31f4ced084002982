#include "field/roll.h"

#include <fmt/format.h>

#include "base/suggest.h"

namespace calot {

void note_departure(Field& field, const Organ& organ, Departure departure) {
  const std::vector<Vec3> at = organ.body->skin_positions(organ.state.x),
                          normals = organ.body->skin_normals(organ.state.x);
  for (const auto& [name, point] : organ.landmarks)
    departure.landmarks[name] = {organ.body->landmark_place(point, organ.state.x), normals[point]};
  field.membership.roll[organ.record].gone = std::move(departure);
}

const BodyRecord* gone_body(const Field& field, const std::string& name) {
  const BodyRecord* found = nullptr;
  for (const BodyRecord& record : field.membership.roll)
    if (record.name == name && record.gone) found = &record;
  return found;
}

Failure gone(const BodyRecord& record) {
  const Departure& how = *record.gone;
  return fail(FailureKind::scenario, fmt::format("{} {} at {:.2f} s", record.name, how.how, how.time),
              how.pieces.empty() ? "ask for it before it goes"
                                 : fmt::format("its pieces are {} and {}", how.pieces[0], how.pieces[1]));
}

Result<OrganIndex> find_body(const Field& field, const std::string& name) {
  std::vector<std::string> names;
  for (const Organ& organ : field.organs) {
    if (organ.definition.name == name) return OrganIndex(names.size());
    names.push_back(organ.definition.name);
  }
  if (const BodyRecord* record = gone_body(field, name)) return gone(*record);
  return fail(FailureKind::scenario, fmt::format("unknown organ \"{}\"", name), suggestion(name, names));
}

Result<OrganIndex> find_body(const Field& field, const BodyHandle& handle) {
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    if (handle_of(field, OrganIndex(k)) == handle) return OrganIndex(k);
  const std::vector<BodyRecord>& roll = field.membership.roll;
  const auto index = static_cast<std::size_t>(handle.record);
  if (index < roll.size() && roll[index].life == handle.life && roll[index].gone) return gone(roll[index]);
  return fail(FailureKind::scenario, "this organ is not there: the field was set back to before it came",
              "ask for it anew, by its name");
}

BodyHandle handle_of(const Field& field, OrganIndex organ) {
  const int record = field.organ(organ).record;
  return {record, field.membership.roll[record].life};
}

}  // namespace calot
