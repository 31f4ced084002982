#include "acts/injury.h"

#include <algorithm>

#include "body/rod_body.h"
#include "field/roll.h"

namespace calot {
namespace {

/// Whether an organ has been divided, or a clip shuts it.
bool is_hurt(const Field& field, const std::string& name) {
  if (const BodyRecord* gone = gone_body(field, name); gone != nullptr && !gone->gone->pieces.empty())
    return true;
  return std::any_of(field.organs.begin(), field.organs.end(),
                     [&](const Organ& organ) { return organ.definition.name == name && organ.is_shut(); });
}

}  // namespace

std::string injury_anywhere(const Field& field, const Organ& organ, const std::string& usual) {
  if (usual.empty()) return {};
  for (const InjuryTogether& both : organ.definition.injury.together)
    if (is_hurt(field, both.with)) return both.called;
  return usual;
}

std::string injury_at(const Field& field, const Organ& tube, const std::string& usual, double at) {
  const double way = tube.body->as_tube()->way_to(at);
  const InjuryNearStart* nearest = nullptr;
  for (const InjuryNearStart& near : tube.definition.injury.near_start)
    if (way < near.within && (nearest == nullptr || near.within < nearest->within)) nearest = &near;
  return injury_anywhere(field, tube, usual.empty() || nearest == nullptr ? usual : nearest->called);
}

}  // namespace calot
