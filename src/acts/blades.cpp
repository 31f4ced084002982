#include "acts/blades.h"

#include <algorithm>

#include "acts/clips.h"
#include "acts/injury.h"
#include "body/rod_body.h"
#include "field/between_jaws.h"
#include "field/divide_body.h"
#include "field/grip.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

void slide_out(Organ& organ, ToolIndex instrument) {
  organ.unfelt.insert(std::lower_bound(organ.unfelt.begin(), organ.unfelt.end(), instrument), instrument);
}

/// What is too short to be divided, or has a clip there, slides out of the blades.
Result<bool> divide_tube(Field& field, ToolIndex instrument, const TubeBetween& tube,
                         std::vector<WorldEvent>& events) {
  Organ& whole = field.organ(tube.organ);
  const std::string name = whole.definition.name;
  const Vec3 at = whole.body->as_tube()->place_at(tube.at, whole.state.x);
  const double share = whole.body->as_tube()->share_at(tube.at);
  const std::string cut = injury_at(field, whole, whole.definition.injury.cut, tube.at);
  const std::string leaking = injury_anywhere(field, whole, whole.definition.injury.unclipped);
  if (!can_be_divided(whole, share) || !free_of_clips(whole, share, 0, "divided")) {
    slide_out(whole, instrument);
    return false;
  }
  const Result<Division> done = divide_body(field, tube.organ, share, field.time);
  if (!done) return done.failure();
  const std::string& tool = field.tool(instrument).definition.name;
  for (OrganIndex piece : {done->patient, done->specimen}) {
    slide_out(field.organ(piece), instrument);
    for (Opening& opening : field.organ(piece).openings)
      if (opening.cause.empty()) opening.cause = tool;
  }
  events.push_back({EventKind::cut, 0, tool, name, done->share, at, EventCause::blades});
  const Organ& left = field.organ(done->patient);
  const bool unclipped = !left.of_specimen && !left.is_shut();
  if (unclipped)
    events.push_back({EventKind::cut_unclipped, 0, tool, name, done->share, at, EventCause::blades});
  if (!cut.empty()) events.push_back({EventKind::injury, 0, tool, name, 0, at, EventCause::blades, cut});
  if (unclipped && !leaking.empty())
    events.push_back({EventKind::injury, 0, tool, name, 0, at, EventCause::blades, leaking});
  return true;
}

/// Of the strands of a tissue those that an edge passes before the blades are looked at again. Returns how many.
int cut_strands(const Field& field, const Tool& tool, Tissue& tissue) {
  const std::vector<StrandLine> lines = strand_lines(tissue, field.organs);
  int cut = 0;
  for (std::size_t i = 0; i < tissue.now.opened.size(); ++i) {
    if (tissue.torn(i)) continue;
    const StrandLine& line = lines[i];
    if (!is_passed(tool, line.from, line.by, grip_grid) && !is_passed(tool, line.by, line.to, grip_grid))
      continue;
    tissue.divide(i);
    ++cut;
  }
  return cut;
}

}  // namespace

Result<bool> close_blades(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events,
                          SolveStatistics& statistics) {
  bool divided = false;
  Tool& tool = field.tool(instrument);
  for (bool more = true; std::exchange(more, false);)
    for (const TubeBetween& tube : tubes_between(field, instrument)) {
      if (tube.gap > 2 * tube.radius) continue;
      const Result<bool> cut = divide_tube(field, instrument, tube, events);
      if (!cut) return cut.failure();
      divided |= cut.value();
      more = true;  // organs have other places now
      break;
    }
  for (Tissue& tissue : field.tissues) {
    const int cut = cut_strands(field, tool, tissue);
    if (cut == 0) continue;
    const double all = static_cast<double>(tissue.now.opened.size());
    tool.has_cut = true;
    events.push_back({EventKind::cut, 0, tool.definition.name, tissue.definition.name, cut / all,
                      std::nullopt, EventCause::blades});
    if (tissue.torn() == static_cast<int>(tissue.now.opened.size()))
      events.push_back(
          {EventKind::parted, 0, {}, tissue.definition.name, 0, std::nullopt, EventCause::blades});
  }
  tool.has_cut |= divided;
  if (!divided || field.step_time > 0) return divided;
  if (Result<bool> rested = settle_in_step(field, "after it was cut", statistics); !rested)
    return rested.failure();
  return true;
}

void feel_again(Field& field) {
  constexpr double clear = 0.5e-3;  // m, beyond where contact begins
  for (Organ& organ : field.organs) {
    if (organ.unfelt.empty()) continue;
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    const std::vector<double>& radii = organ.body->skin_radii();
    std::erase_if(organ.unfelt, [&](ToolIndex instrument) {
      const Tool& tool = field.tool(instrument);
      const std::vector<Shape> shapes = instrument_shapes(tool.trocar, tool.pose, tool.geometry);
      for (std::size_t p = 0; p < skin.size(); ++p)
        for (int part : {1, 2})
          if (signed_distance(shapes[part], skin[p]) < radii[p] + clear) return false;
      return true;
    });
  }
}

}  // namespace calot
