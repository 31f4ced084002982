#include "liquid/leak.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "body/rod_body.h"
#include "group/group_problem.h"
#include "liquid/aspirate.h"
#include "liquid/leak_source.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double drains_in = 1.0;                 // s, for what a tube holds that nothing feeds (d)
constexpr double pulse = 0.3;                     // of the pressure of blood, up and down (d)
constexpr double begins = 1.0e-9, ends = 0.1e-9;  // m^3/s: a microlitre a second is a leak

double density_of(const Organ& organ) {
  return liquid_of(organ) == Carries::blood ? blood_density : organ.definition.bile.density;
}

struct Outlet {
  OrganIndex organ;
  std::size_t opening = 0;
  LeakSource source;
  double pressure = 0;  ///< Pa, of an organ's filling at the opening, at the beginning
  double left = 0;      ///< m^3, leaves in the step
};

/// How much a hollow organ's volume grows with its pressure, m^3/Pa; 0: the field has no factor yet that knows.
double compliance_of(const Field& field, OrganIndex organ) {
  const NewtonWorkspace& work = field.group.work;
  std::vector<int> counts;
  for (const Organ& each : field.organs)
    counts.push_back(constraints_of(*each.body, each.state.motion.duration > 0));
  const int all = std::accumulate(counts.begin(), counts.end(), 0);
  if (!work.factored || work.border.complement.rows() != all) return 0;
  const Eigen::Index volume = volume_constraints(counts)[static_cast<std::size_t>(organ.value)];
  return std::max(0.0, work.border.complement(volume, volume));
}

/// A tool that draws out of an organ.
struct Draught {
  std::size_t tool = 0;
  OrganIndex organ;
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
  OrganIndex organ;
  double compliance = 0;
  double taken = 0;  ///< m^3, in this step
  /// Pa, by how much its pressure has.
  double fallen() const { return compliance > 0 ? taken / compliance : 0; }
};

class Leaking {
 public:
  Leaking(Field& field, double duration) : field_(field), duration_(duration) {
    for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) {
      const Organ& organ = field.organs[k];
      for (std::size_t i = 0; i < organ.openings.size(); ++i) {
        Outlet outlet{OrganIndex(k), i, source_of(field, OrganIndex(k), organ.openings[i])};
        if (is_plugged(field, organ, organ.openings[i])) outlet.source.area = 0;
        if (outlet.source.kind == LeakSource::Kind::organ) {
          const Organ& from = field.organ(outlet.source.organ);
          const Vec3 at = organ.body->skin_point(organ.openings[i].point, organ.state.x);
          outlet.pressure = from.body->liquid()->pressure_at(at, from.state.datum_pressure);
          reservoir(outlet.source.organ);
        }
        outlets_.push_back(outlet);
      }
    }
    for (std::size_t i = 0; i < field.tools.size(); ++i) {
      const std::optional<OrganIndex> from = punctured_organ(field, field.tools[i]);
      if (!from) continue;
      const Organ& organ = field.organ(*from);
      const Vec3 mouth = organ.body->skin_point(field.tools[i].needle.point, organ.state.x);
      draughts_.push_back({i, *from, organ.body->liquid()->pressure_at(mouth, organ.state.datum_pressure)});
      reservoir(*from);
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
    for (const Reservoir& from : reservoirs_) field_.organ(from.organ).state.volume -= from.taken;
    std::vector<WorldEvent> events;
    for (const Outlet& outlet : outlets_) note(outlet, events);
    return events;
  }

 private:
  Reservoir& reservoir(OrganIndex organ) {
    for (Reservoir& known : reservoirs_)
      if (known.organ == organ) return known;
    return reservoirs_.emplace_back(Reservoir{organ, compliance_of(field_, organ)});
  }

  void draw(const Draught& draught, double part) {
    NeedleState& needle = field_.tools[draught.tool].needle;
    const InstrumentDefinition& definition = field_.tools[draught.tool].definition;
    const Organ& organ = field_.organ(draught.organ);
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
    const LeakSource& source = outlet.source;
    Organ& organ = field_.organ(outlet.organ);
    if (!(source.area > 0)) return;
    switch (source.kind) {
      case LeakSource::Kind::organ: {
        Reservoir& from = reservoir(source.organ);
        const double left = field_.organ(source.organ).state.volume - from.taken;
        const double out =
            std::min(left, elastic_outflow(outlet.pressure - from.fallen(), from.compliance, source.area,
                                           density_of(organ), part, source.feed.resistance));
        from.taken += out;
        outlet.left += out;
        return;
      }
      case LeakSource::Kind::patient: {
        const double beat = 2 * pi * field_.heart_rate / 60 * time;
        const bool pulses = liquid_of(organ) == Carries::blood;
        const double pressure = source.feed.pressure * (pulses ? 1 + pulse * std::sin(beat) : 1);
        const double out = part * fed_flow(source.feed, pressure, source.area, density_of(organ));
        field_.spill.given[static_cast<std::size_t>(liquid_of(organ))] += out;
        outlet.left += out;
        return;
      }
      case LeakSource::Kind::rest: {
        const RodBody& rod = *organ.body->as_tube();
        const double full = lumen_volume(rod),
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
    Organ& organ = field_.organ(outlet.organ);
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

std::vector<WorldEvent> leak(Field& field, double duration) {
  const bool any = std::any_of(field.organs.begin(), field.organs.end(),
                               [](const Organ& organ) { return !organ.openings.empty(); }) ||
                   std::any_of(field.tools.begin(), field.tools.end(),
                               [](const Tool& tool) { return tool.needle.record >= 0; });
  if (!any) return {};
  return Leaking(field, duration).run();
}

}  // namespace calot
