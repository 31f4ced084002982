#include "liquid/leak_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/between_jaws.h"
#include "field/grip.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double of_folds = 5e9;  // Pa s/m^3, of a cystic duct's: 15 mL a minute at 10 mmHg (d)

/// Where a joint is on a tube, skin points from its start: at the first place that it ties, on the tube.
double place_on(const JointLinks& links, int side, const RodBody& rod) {
  const JointLinks::Link& first = links.links.front();
  const CarriedPlace& place = side == 0 ? first.one : first.other;
  double at = 0;
  for (std::size_t i = 0; i < place.points.size(); ++i) at += place.weights[i] * place.points[i];
  return std::clamp(at, 0.0, rod.last_point());
}

/// Follows tubes from an opening to what feeds them.
class SourceSearch {
 public:
  explicit SourceSearch(const Field& field) : field_(field) {}

  LeakSource of(OrganIndex organ, const Opening& opening) {
    const RodBody* rod = field_.organ(organ).body->as_tube();
    if (rod == nullptr) return {LeakSource::Kind::organ, organ, {}, opening.area};
    const double from = opening.point, last = rod->last_point();
    const bool hole = from > 0 && from < last;
    const double whole = hole ? std::min(opening.area, lumen_area(*rod, from)) : lumen_area(*rod, from);
    std::optional<LeakSource> found;
    // A hole is fed from both sides, by the wider way.
    for (const double to : hole ? std::vector<double>{0, last} : std::vector<double>{last - from}) {
      visited_.assign(field_.organs.size(), 0);
      const std::optional<LeakSource> here = along(organ, from, to, whole);
      if (here && (!found || here->area > found->area)) found = here;
    }
    if (found) {
      const OrganDefinition& tube = field_.organ(organ).definition;
      found->feed.resistance = feed_of(tube).resistance;
      if (found->kind == LeakSource::Kind::organ)
        found->feed.resistance = std::get<TubeShape>(tube.shape).feed_resistance.value_or(of_folds);
      return *found;
    }
    // What it holds runs out if nothing shuts it, by the tightest place.
    const double open =
        hole ? std::max(open_between(field_, organ, from, 0), open_between(field_, organ, from, last))
             : open_between(field_, organ, from, last - from);
    return {LeakSource::Kind::rest, organ, {}, std::min(whole, open)};
  }

 private:
  /// From a place on a tube to one of its ends.
  std::optional<LeakSource> along(OrganIndex organ, double from, double to, double area) {
    const Organ& tube = field_.organ(organ);
    const RodBody& rod = *tube.body->as_tube();
    visited_[organ.value] = 1;
    area = std::min(area, open_between(field_, organ, from, to));
    for (const Opening& opening : tube.openings)
      if (opening.point == to) return std::nullopt;
    for (const FieldJoint& joint : field_.membership.joints) {
      const JointLinks& links = joint.joint->links();
      const int side = links.bodies[0] == organ.value ? 0 : 1;
      if (links.bodies[side] != organ.value || !is_at(rod, links, side, to)) continue;
      if (std::optional<LeakSource> found = beyond(links, 1 - side, liquid_of(tube), area)) return found;
      // It ends in another body, from which nothing flows into it.
      return std::nullopt;
    }
    if (tube.of_specimen) return std::nullopt;
    return LeakSource{LeakSource::Kind::patient, organ, feed_of(tube.definition), area};
  }

  /// Whether a joint is at that end of a tube: its own end is tied, or nearly that of another's side.
  static bool is_at(const RodBody& rod, const JointLinks& links, int side, double end) {
    const double away = std::abs(place_on(links, side, rod) - end), last = rod.last_point();
    return side == 0 ? away < 0.5 * last : away < std::min(3.0, 0.3 * last);
  }

  std::optional<LeakSource> beyond(const JointLinks& links, int side, Carries liquid, double area) {
    const OrganIndex organ(links.bodies[side]);
    const Organ& other = field_.organ(organ);
    if (liquid == Carries::bile && other.body->liquid() != nullptr)
      return LeakSource{LeakSource::Kind::organ, organ, {}, area};
    const RodBody* rod = other.body->as_tube();
    if (rod == nullptr || liquid_of(other) != liquid || visited_[organ.value]) return std::nullopt;
    std::optional<LeakSource> best;
    for (double end : {0.0, rod->last_point()})
      if (std::optional<LeakSource> found = along(organ, place_on(links, side, *rod), end, area))
        if (!best || found->area > best->area) best = found;
    return best;
  }

  const Field& field_;
  std::vector<char> visited_;
};

}  // namespace

Carries liquid_of(const Organ& organ) {
  const auto* tube = std::get_if<TubeShape>(&organ.definition.shape);
  return tube == nullptr ? Carries::bile : tube->carries;
}

double lumen_area(const RodBody& rod, double at) { return pi * std::pow(rod.lumen_radius(at), 2); }

double lumen_volume(const RodBody& rod) {
  double sum = 0;
  const int last = static_cast<int>(rod.last_point());
  for (int k = 0; k < last; ++k) {
    const double here = lumen_area(rod, k), next = lumen_area(rod, k + 1);
    sum += (rod.way_to(k + 1) - rod.way_to(k)) * (here + std::sqrt(here * next) + next) / 3;
  }
  return sum;
}

LeakSource source_of(const Field& field, OrganIndex organ, const Opening& opening) {
  return SourceSearch(field).of(organ, opening);
}

TubeFeed feed_of(const OrganDefinition& tube) {
  const auto& shape = std::get<TubeShape>(tube.shape);
  TubeFeed out{1e3, 2e10};  // bile (d): the bile duct's 10 cm of water
  if (shape.carries == Carries::blood) {
    // Blood loses as much pressure on its way as along 35 mm of such a tube (d), by Poiseuille's law.
    constexpr double viscosity = 3.5e-3, length = 35e-3;
    const double radius = std::max(shape.start_radius() - tube.wall.thickness, 0.1e-3);
    out = {12e3, 8 * viscosity * length / (pi * std::pow(radius, 4))};
  }
  return {shape.feed_pressure.value_or(out.pressure), shape.feed_resistance.value_or(out.resistance)};
}

double open_between(const Field& field, OrganIndex index, double one, double other) {
  const Organ& organ = field.organ(index);
  const RodBody& rod = *organ.body->as_tube();
  const auto [low, high] = std::minmax(one, other);
  double open = std::min(lumen_area(rod, low), lumen_area(rod, high));
  for (int point = static_cast<int>(std::ceil(low)); point < high; ++point)
    open = std::min(open, lumen_area(rod, point));
  for (const Clip& clip : organ.clips)
    if (clip.at >= low && clip.at <= high) open = std::min(open, clip.opening * lumen_area(rod, clip.at));
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    if (!has_jaws(field.tools[i].definition.type)) continue;
    for (const TubeBetween& tube : tubes_between(field, ToolIndex(i))) {
      if (tube.organ != index || tube.at < low || tube.at > high) continue;
      // Jaws that hold it have pressed it flat, to the angle that they stop at.
      if (field.tools[i].jaws_rest() && grip_count(organ, ToolIndex(i)) > 0) open = 0;
      const double share = open_share((tube.gap - 2 * rod.setup().wall) / (2 * rod.lumen_radius(tube.at)));
      open = std::min(open, share * lumen_area(rod, tube.at));
    }
  }
  return open;
}

}  // namespace calot
