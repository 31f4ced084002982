#include "liquid/leak.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/between_jaws.h"
#include "field/grip.h"
#include "liquid/aspirate.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double drains_in = 1.0;      // s, for what a tube holds that nothing feeds (d)
constexpr double pulse = 0.3;          // of the pressure of blood, up and down (d)
constexpr double of_folds = 5e9;       // Pa s/m^3, of a cystic duct's: 15 mL a minute at 10 mmHg (d)
constexpr double gape = 0.5e-3;        // m, of a slit in a wall (d)
constexpr double least_slit = 1.0e-3;  // m: blades that stand on a wall have cut it
constexpr double begins = 1.0e-9, ends = 0.1e-9;  // m^3/s: a microlitre a second is a leak

Carries liquid_of(const Organ& organ) {
  const auto* tube = std::get_if<TubeShape>(&organ.definition.shape);
  return tube == nullptr ? Carries::bile : tube->carries;
}

double density_of(const Organ& organ) {
  return liquid_of(organ) == Carries::blood ? blood_density : organ.definition.bile.density;
}

double lumen_area(const RodBody& rod, double at) { return pi * std::pow(rod.lumen_radius(at), 2); }

/// m^3 in a tube at rest.
double held_by(const RodBody& rod) {
  const double first = lumen_area(rod, 0), last = lumen_area(rod, rod.last_point());
  return rod.length() * (first + std::sqrt(first * last) + last) / 3;
}

/// Where a joint is on a body, skin points from its start.
double place_on(const JointLinks& links, int side) {
  double sum = 0;
  for (const JointLinks::Link& link : links.links) {
    const CarriedPlace& place = side == 0 ? link.one : link.other;
    for (int point : place.points)
      sum += static_cast<double>(point) / static_cast<double>(place.points.size());
  }
  return sum / static_cast<double>(links.links.size());
}

/// What drives the liquid out of an opening.
struct Source {
  enum class Kind { organ, patient, rest } kind = Kind::rest;
  int organ = -1;   ///< whose filling it is
  TubeFeed feed;    ///< of the patient
  double area = 0;  ///< m^2, smallest on the way
};

/// Follows tubes from an opening to what feeds them.
class SourceSearch {
 public:
  explicit SourceSearch(const Field& field) : field_(field) {}

  Source of(int organ, const Opening& opening) {
    const RodBody* rod = rod_of(field_.organs[organ]);
    if (rod == nullptr) return {Source::Kind::organ, organ, {}, opening.area};
    const double from = opening.point, to = rod->last_point() - from;
    const double whole = lumen_area(*rod, from);
    visited_.assign(field_.organs.size(), 0);
    if (std::optional<Source> found = along(organ, from, to, whole)) {
      const OrganDefinition& tube = field_.organs[organ].definition;
      found->feed.resistance = feed_of(tube).resistance;
      if (found->kind == Source::Kind::organ)
        found->feed.resistance = std::get<TubeShape>(tube.shape).feed_resistance.value_or(of_folds);
      return *found;
    }
    // What it holds runs out if nothing shuts it, by the tightest place.
    return {Source::Kind::rest, organ, {}, whole * open_between(field_, organ, from, to)};
  }

 private:
  /// From a place on a tube to one of its ends.
  std::optional<Source> along(int organ, double from, double to, double area) {
    const Organ& tube = field_.organs[organ];
    const RodBody& rod = *rod_of(tube);
    visited_[organ] = 1;
    area = std::min(
        area, std::min(lumen_area(rod, from), lumen_area(rod, to)) * open_between(field_, organ, from, to));
    for (const Opening& opening : tube.openings)
      if (opening.point == to) return std::nullopt;
    for (const FieldJoint& joint : field_.membership.joints) {
      const JointLinks& links = joint.joint->links();
      const int side = links.bodies[0] == organ ? 0 : 1;
      if (links.bodies[side] != organ || !is_at(rod, links, side, to)) continue;
      if (std::optional<Source> found = beyond(links, 1 - side, liquid_of(tube), area)) return found;
      // It ends in something else that feeds it not.
      return std::nullopt;
    }
    if (tube.of_specimen) return std::nullopt;
    return Source{Source::Kind::patient, organ, feed_of(tube.definition), area};
  }

  /// Whether a joint is at that end of a tube: its own end is tied, or nearly that of another's side.
  static bool is_at(const RodBody& rod, const JointLinks& links, int side, double end) {
    const double away = std::abs(place_on(links, side) - end), last = rod.last_point();
    return side == 0 ? away < 0.5 * last : away < std::min(3.0, 0.3 * last);
  }

  std::optional<Source> beyond(const JointLinks& links, int side, Carries liquid, double area) {
    const int organ = links.bodies[side];
    const Organ& other = field_.organs[organ];
    if (liquid == Carries::bile && shell_of(other) != nullptr && other.body->liquid() != nullptr)
      return Source{Source::Kind::organ, organ, {}, area};
    const RodBody* rod = rod_of(other);
    if (rod == nullptr || liquid_of(other) != liquid || visited_[organ]) return std::nullopt;
    std::optional<Source> best;
    for (double end : {0.0, rod->last_point()})
      if (std::optional<Source> found = along(organ, place_on(links, side), end, area))
        if (!best || found->area > best->area) best = found;
    return best;
  }

  const Field& field_;
  std::vector<char> visited_;
};

struct Outlet {
  int organ = 0;
  std::size_t opening = 0;
  Source source;
  double pressure = 0;  ///< Pa, of an organ's filling at the opening, at the beginning
  double left = 0;      ///< m^3, leaves in the step
};

/// How much a hollow organ's volume grows with its pressure, m^3/Pa; 0: not known yet.
double compliance_of(const Field& field, int organ) {
  const NewtonWorkspace& work = field.group.work;
  int liquids = 0, before = 0;
  for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) {
    if (field.organs[k].body->liquid() == nullptr) continue;
    ++liquids;
    if (k < organ) ++before;
  }
  const int constraints = static_cast<int>(work.border.complement.rows());
  if (!work.factored || constraints == 0 || constraints % liquids != 0) return 0;
  // Each has its volume's, and then its inertia's.
  const Eigen::Index volume = before * (constraints / liquids);
  return std::max(0.0, work.border.complement(volume, volume));
}

/// A tool that draws out of an organ.
struct Draught {
  std::size_t tool = 0;
  int organ = 0;
  double pressure = 0;  ///< Pa, at its mouth, at the beginning
};

/// Whether a needle is in that opening.
bool is_plugged(const Field& field, const Organ& organ, const Opening& opening) {
  return std::any_of(field.tools.begin(), field.tools.end(), [&](const Tool& tool) {
    return tool.needle.record >= 0 && tool.needle.record == organ.record &&
           tool.needle.point == opening.point;
  });
}

/// Several openings share it.
struct Reservoir {
  int organ = 0;
  double compliance = 0;
  double taken = 0;  ///< m^3, in this step
  /// Pa, by how much its pressure has.
  double fallen() const { return compliance > 0 ? taken / compliance : 0; }
};

class Leaking {
 public:
  Leaking(Field& field, double duration) : field_(field), duration_(duration) {
    SourceSearch search(field);
    for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) {
      const Organ& organ = field.organs[k];
      for (std::size_t i = 0; i < organ.openings.size(); ++i) {
        Outlet outlet{k, i, search.of(k, organ.openings[i])};
        if (is_plugged(field, organ, organ.openings[i])) outlet.source.area = 0;
        if (outlet.source.kind == Source::Kind::organ) {
          const Organ& from = field.organs[outlet.source.organ];
          const Vec3 at = organ.body->skin_point(organ.openings[i].point, organ.state.x);
          outlet.pressure = shell_of(from)->bile()->pressure_at(at, from.state.datum_pressure);
          reservoir(outlet.source.organ);
        }
        outlets_.push_back(outlet);
      }
    }
    for (std::size_t i = 0; i < field.tools.size(); ++i) {
      const int from = punctured_organ(field, field.tools[i]);
      if (from < 0) continue;
      const Organ& organ = field.organs[from];
      const Vec3 mouth = organ.body->skin_point(field.tools[i].needle.point, organ.state.x);
      draughts_.push_back({i, from, shell_of(organ)->bile()->pressure_at(mouth, organ.state.datum_pressure)});
      reservoir(from);
    }
  }

  std::vector<WorldEvent> run() {
    constexpr double longest_part = 1e-3;
    const int parts = std::max(1, static_cast<int>(std::ceil(duration_ / longest_part - 1e-9)));
    const double part = duration_ / parts;
    for (int k = 0; k < parts; ++k) {
      for (Outlet& outlet : outlets_) let_out(outlet, field_.time - duration_ + (k + 0.5) * part, part);
      for (const Draught& draught : draughts_) draw(draught, part);
    }
    for (const Reservoir& from : reservoirs_) field_.organs[from.organ].state.volume -= from.taken;
    std::vector<WorldEvent> events;
    for (const Outlet& outlet : outlets_) note(outlet, events);
    return events;
  }

 private:
  Reservoir& reservoir(int organ) {
    for (Reservoir& known : reservoirs_)
      if (known.organ == organ) return known;
    return reservoirs_.emplace_back(Reservoir{organ, compliance_of(field_, organ)});
  }

  void draw(const Draught& draught, double part) {
    NeedleState& needle = field_.tools[draught.tool].needle;
    const InstrumentDefinition& definition = field_.tools[draught.tool].definition;
    const Organ& organ = field_.organs[draught.organ];
    Reservoir& from = reservoir(draught.organ);
    const double out = std::min(
        organ.state.volume - from.taken,
        drawn_by(definition, draught.pressure - from.fallen(), from.compliance, density_of(organ), part));
    from.taken += out;
    needle.drawn += out;
    needle.drawn_ever += out;
    if (out > 0) field_.spill.count_aspirated(organ.definition.name, out);
  }

  /// In a part of the step about `time`.
  void let_out(Outlet& outlet, double time, double part) {
    const Source& source = outlet.source;
    Organ& organ = field_.organs[outlet.organ];
    if (!(source.area > 0)) return;
    switch (source.kind) {
      case Source::Kind::organ: {
        Reservoir& from = reservoir(source.organ);
        const double left = field_.organs[source.organ].state.volume - from.taken;
        const double out =
            std::min(left, elastic_outflow(outlet.pressure - from.fallen(), from.compliance, source.area,
                                           density_of(organ), part, source.feed.resistance));
        from.taken += out;
        outlet.left += out;
        return;
      }
      case Source::Kind::patient: {
        const double beat = 2 * pi * field_.heart_rate / 60 * time;
        const bool pulses = liquid_of(organ) == Carries::blood;
        const double pressure = source.feed.pressure * (pulses ? 1 + pulse * std::sin(beat) : 1);
        const double out = part * fed_flow(source.feed, pressure, source.area, density_of(organ));
        field_.spill.given[static_cast<std::size_t>(liquid_of(organ))] += out;
        outlet.left += out;
        return;
      }
      case Source::Kind::rest: {
        const RodBody& rod = *rod_of(organ);
        const double full = held_by(rod),
                     share = source.area / lumen_area(rod, organ.openings[outlet.opening].point);
        const double left = organ.left_in.value_or(full);
        const double out = std::min(left, share * full * part / drains_in);
        organ.left_in = left - out;
        field_.spill.drained[static_cast<std::size_t>(liquid_of(organ))] += out;
        outlet.left += out;
        return;
      }
    }
  }

  void note(const Outlet& outlet, std::vector<WorldEvent>& events) {
    Organ& organ = field_.organs[outlet.organ];
    Opening& opening = organ.openings[outlet.opening];
    const Carries liquid = liquid_of(organ);
    const std::string& name = organ.definition.name;
    opening.rate = outlet.left / duration_;
    opening.drop += outlet.left;
    opening.lost += outlet.left;
    if (outlet.left > 0) field_.spill.count(name, liquid, outlet.left);
    if (!opening.leaks && opening.rate >= begins) {
      opening.leaks = true;
      const EventKind kind = liquid == Carries::blood ? EventKind::bleeding : EventKind::bile_leak;
      events.push_back({kind, 0, opening.cause, name, 60e6 * opening.rate,
                        organ.body->skin_point(opening.point, organ.state.x)});
    } else if (opening.leaks && opening.rate < ends) {
      opening.leaks = false;
      events.push_back({EventKind::leak_stopped, 0, {}, name, 1e6 * std::exchange(opening.lost, 0.0)});
    }
  }

  Field& field_;
  double duration_;
  std::vector<Outlet> outlets_;
  std::vector<Draught> draughts_;
  std::vector<Reservoir> reservoirs_;
};

}  // namespace

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

double open_between(const Field& field, int index, double one, double other) {
  constexpr double shut = 0.02;  // as of a clip (clips.cpp)
  const Organ& organ = field.organs[index];
  const RodBody& rod = *rod_of(organ);
  const auto [low, high] = std::minmax(one, other);
  double open = 1;
  for (const Clip& clip : organ.clips)
    if (clip.at >= low && clip.at <= high) open = std::min(open, clip.opening);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    if (!has_jaws(field.tools[i].definition.type)) continue;
    for (const TubeBetween& tube : tubes_between(field, static_cast<int>(i))) {
      if (tube.organ != index || tube.at < low || tube.at > high) continue;
      // Jaws that hold it have pressed it flat, to the angle that they stop at.
      if (field.tools[i].jaws_rest() && grip_count(organ, static_cast<int>(i)) > 0) open = 0;
      const double lumen = 2 * rod.lumen_radius(tube.at);
      const double left = (tube.gap - 2 * rod.setup().wall) / lumen;
      open = std::min(open, left < shut ? 0.0 : left);
    }
  }
  return open;
}

std::vector<WorldEvent> leak(Field& field, double duration) {
  const bool any = std::any_of(field.organs.begin(), field.organs.end(),
                               [](const Organ& organ) { return !organ.openings.empty(); }) ||
                   std::any_of(field.tools.begin(), field.tools.end(),
                               [](const Tool& tool) { return tool.needle.record >= 0; });
  if (!any) return {};
  return Leaking(field, duration).run();
}

void perforate(Field& field, int instrument) {
  for (Organ& organ : field.organs) {
    if (shell_of(organ) == nullptr || organ.body->liquid() == nullptr) continue;
    Vec3 sum = Vec3::Zero();
    double low = 1, high = -1;  // m, along the jaws
    std::vector<int> held;
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      held.push_back(grip.skin_point);
      sum += organ.body->skin_rest()[grip.skin_point];
      low = std::min(low, grip.local.z());
      high = std::max(high, grip.local.z());
    }
    if (held.empty()) continue;
    const Vec3 middle = sum / static_cast<double>(held.size());
    const auto nearer = [&](int a, int b) {
      return (organ.body->skin_rest()[a] - middle).norm() < (organ.body->skin_rest()[b] - middle).norm();
    };
    Opening hole;
    hole.point = *std::min_element(held.begin(), held.end(), nearer);
    hole.area = gape * std::max(least_slit, high - low);
    hole.cause = field.tools[instrument].definition.name;
    organ.openings.push_back(hole);
  }
}

void perforate(Organ& organ, const Vec3& at, const std::string& instrument) {
  constexpr double burnt = 3e-6;  // m^2, 2 mm across (d)
  if (shell_of(organ) == nullptr || organ.body->liquid() == nullptr) return;
  Opening hole;
  hole.point = nearest_of(organ.body->skin_positions(organ.state.x), at);
  hole.area = burnt;
  hole.cause = instrument;
  organ.openings.push_back(hole);
}

}  // namespace calot
