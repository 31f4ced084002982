#include "liquid/aspirate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/units.h"
#include "joins/skin_place.h"
#include "liquid/outflow.h"

namespace calot {
namespace {

using std::numbers::pi;

/// m, from the tip to a wall that it goes through (d): at a slant of more than 50 degrees the round end that touches
/// keeps the tip further off.
constexpr double pushed_on = 0.4e-3;

struct PushedOn {
  std::optional<OrganIndex> organ;
  int point = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< m
};

/// The organ whose surface is nearest to a place, within `reach`, and its nearest skin point.
PushedOn pushed_on_by(const Field& field, const Vec3& place, double reach) {
  PushedOn best;
  for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) {
    const Body& body = *field.organs[k].body;
    const SkinFinder finder(body, body.skin_positions(field.organs[k].state.x));
    const NearestSkin near = finder.nearest(place, reach + body.thickest());
    const double distance = near.distance - near.radius;
    if (near.place.points.empty() || distance > reach || distance >= best.distance) continue;
    const std::vector<double>& weights = near.place.weights;
    const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
    best = {OrganIndex(k), near.place.points[static_cast<std::size_t>(heaviest)], distance};
  }
  return best;
}

Vec3 tip_of(const Tool& tool) { return tip_position(tool.trocar, tool.pose, tool.geometry); }

bool still_in(const Field& field, const Tool& tool, bool draws) {
  const std::optional<OrganIndex> organ = punctured_organ(field, tool);
  if (!organ || !draws) return false;
  const Organ& in = field.organ(*organ);
  return (in.body->skin_point(tool.needle.point, in.state.x) - tip_of(tool)).norm() <= needle_depth;
}

void go_in(Organ& organ, int point, Tool& tool) {
  tool.needle.record = organ.record;
  tool.needle.point = point;
  tool.needle.drawn = 0;
  const double hole = tool.definition.pinhole;
  const auto same = [&](const Opening& one) {
    return one.point == point && one.cause == tool.definition.name;
  };
  // Once more through its own hole makes no other.
  if (hole <= 0 || std::any_of(organ.openings.begin(), organ.openings.end(), same)) return;
  Opening left;
  left.point = point;
  left.area = 0.25 * pi * hole * hole;
  left.cause = tool.definition.name;
  organ.openings.push_back(left);
}

}  // namespace

double bore_resistance(double bore, double length, double viscosity) {
  return 128 * viscosity * length / (pi * std::pow(bore, 4));
}

double drawn_by(const InstrumentDefinition& needle, double pressure, double compliance, double density,
                double time) {
  const double mouth = 0.25 * pi * needle.bore * needle.bore;
  const double resistance = bore_resistance(needle.bore, needle.bore_length, bile_viscosity);
  const double by_suction =
      elastic_outflow(pressure + needle.suction, compliance, mouth, density, time, resistance);
  return std::min(by_suction, elastic_outflow(pressure, compliance, mouth, density, time));
}

std::optional<OrganIndex> punctured_organ(const Field& field, const Tool& tool) {
  if (tool.needle.record < 0) return std::nullopt;
  return organ_of_record(field, tool.needle.record);
}

void puncture(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    if (!has_action(tool.definition.type, InstrumentAction::aspirate)) continue;
    const bool draws = !actions.empty() && actions[i] == InstrumentAction::aspirate;
    const std::string& name = tool.definition.name;
    NeedleState& needle = tool.needle;
    if (needle.record >= 0 && !still_in(field, tool, draws)) {
      const BodyRecord& was = field.membership.roll[static_cast<std::size_t>(needle.record)];
      events.push_back({EventKind::aspirated, 0, name, was.name, needle.drawn / units::mL});
      needle.record = -1;
      needle.drawn = 0;
    }
    const bool was_empty = std::exchange(needle.empty, false);
    if (!draws || needle.record >= 0) continue;
    const PushedOn wall = pushed_on_by(field, tip_of(tool), pushed_on);
    Organ* organ = wall.organ ? &field.organ(*wall.organ) : nullptr;
    if (organ != nullptr && organ->body->liquid() != nullptr) {
      go_in(*organ, wall.point, tool);
      events.push_back({EventKind::puncture, 0, name, organ->definition.name});
      continue;
    }
    needle.empty = true;
    if (!was_empty)
      events.push_back({EventKind::empty_aspiration, 0, name, organ ? organ->definition.name : ""});
  }
}

}  // namespace calot
