// What a stroke with current hurts follows from its distances to the skins around it (acts/burn.h).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acts/burn.h"
#include "acts/current.h"
#include "base/units.h"
#include "group/contact_search.h"
#include "organs/body_kinds.h"
#include "rig.h"

namespace calot {
namespace {

constexpr double power = 30, duration = 0.04;  // W, s: 1.2 J a step
constexpr double mm = units::mm;

/// Parts that an electrode's end is moved by between two organs.
struct Between {
  Vec3 middle, towards_first, along;  ///< m; unit, across the way; unit, along the electrode
};

/// Organs as they came to rest alone, and one electrode that nothing stops.
struct Heated {
  Field field;
  std::vector<WorldEvent> events;

  explicit Heated(const std::vector<OrganDefinition>& organs) {
    for (const OrganDefinition& organ : organs)
      field.add(make_organ(organ, {}, Vec3::UnitZ(), 1e-6).value());
    Tool& tool = field.tools.emplace_back();
    tool.definition = default_instrument(InstrumentType::bipolar_electrode);
    tool.definition.name = "hook";
    tool.definition.power = power;
    tool.geometry = instrument_geometry(tool.definition.type);
    tool.action = InstrumentAction::activate;
  }
  Tool& tool() { return field.tools[0]; }
  /// Its shaft comes `along`, its tip is there.
  void put(const Vec3& tip, const Vec3& along) {
    tool().trocar = tip - 0.1 * along;
    tool().pose = pose_reaching(tool().trocar, tip, 0, 0, tool().geometry);
  }
  /// Its tip straight above a skin point of an organ.
  void put_above(std::size_t organ, int point, double gap) {
    const Organ& on = field.organs[organ];
    const Vec3 out = on.body->skin_normals(on.state.x)[static_cast<std::size_t>(point)];
    put(on.body->skin_point(point, on.state.x) + gap * out, -out);
  }
  void act(int steps = 1) {
    for (int k = 0; k < steps; ++k)
      for (const WorldEvent& event : apply_current(field, std::vector<ToolLoad>(1), duration))
        events.push_back(event);
  }
  double taken(std::size_t organ) const {
    double sum = 0;
    for (const Burn& burn : field.organs[organ].burns) sum += burn.energy;
    return sum;
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const WorldEvent& event) { return event.kind == kind; }));
  }
  /// From what current flows through to an organ's skin, m, on its triangles split into 64 along each edge.
  double distance(std::size_t organ) const {
    constexpr int parts = 64;
    const Tool& tool = field.tools[0];
    const Shape end = instrument_shapes(tool.trocar, tool.pose, tool.geometry)[2];
    const Organ& on = field.organs[organ];
    const std::vector<Vec3> skin = on.body->skin_positions(on.state.x);
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : on.body->skin().triangles) {
      const double longest = std::max({(skin[t[1]] - skin[t[0]]).norm(), (skin[t[2]] - skin[t[0]]).norm()});
      if (signed_distance(end, skin[t[0]]) > longest + 1e-3) continue;
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
          least = std::min(least, signed_distance(end, (i * skin[t[0]] + j * skin[t[1]] +
                                                        (parts - i - j) * skin[t[2]]) /
                                                           parts));
    }
    return least;
  }
};

OrganDefinition lobe(double width = 120e-3) {
  OrganDefinition organ;
  organ.name = "liver";
  organ.shape = LobeShape{.width = width, .bed_width = 0, .bed_depth = 0};
  return organ;
}


TEST(Burns, Gaps) {
  for (double width : {80e-3, 120e-3, 300e-3}) {
    Heated h({lobe(width)});
    std::printf("%g gap %g mm, points %zu\n", width, h.field.organs[0].body->widest_skin_gap() / mm, h.field.organs[0].body->skin_rest().size());
    for (auto& [name, p] : h.field.organs[0].landmarks) std::printf("  %s %d\n", name.c_str(), p);
  }
  Heated h({test::bedded_ball()});
  std::printf("ball gap %g mm\n", h.field.organs[0].body->widest_skin_gap() / mm);
}

}  // namespace
}  // namespace calot
