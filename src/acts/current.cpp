#include "acts/current.h"

#include <algorithm>

#include "acts/burn.h"
#include "acts/clearance.h"
#include "base/units.h"
#include "body/rod_body.h"
#include "field/field_tissues.h"

namespace calot {
namespace {

/// Current that still flows when what was cut gives way is let go of within this, s: no sooner is it an error.
constexpr double dry_limit = 0.25;

bool is_active(const Tool& tool) { return tool.action == InstrumentAction::activate; }

/// A strand that current flows through.
struct Heated {
  std::size_t tissue, strand;
  bool operator==(const Heated&) const = default;
};

/// Of each tool, once each.
std::vector<std::vector<Heated>> heated_strands(const Field& field) {
  std::vector<std::vector<Heated>> out(field.tools.size());
  if (std::none_of(field.tools.begin(), field.tools.end(), is_active)) return out;
  const VecX x = place_strands_and_tools(field);
  for (std::size_t t = 0; t < field.tissues.size(); ++t)
    field.tissues[t].strands->for_contacts(x, [&](std::size_t strand, const StrandContact& contact) {
      const FieldShape which = field.shape(contact.shape);
      const Tool& tool = field.tool(which.tool);
      if (!is_active(tool) || !conducts(tool.geometry, which.part)) return;
      const Heated one{t, strand};
      std::vector<Heated>& of_tool = out[which.tool.value];
      if (std::find(of_tool.begin(), of_tool.end(), one) == of_tool.end()) of_tool.push_back(one);
    });
  return out;
}

/// Whether it is divided by what it takes, J.
bool heat(Tissue& tissue, std::size_t strand, double energy) {
  const PlacedStrand& placed = tissue.strands->strands()[strand];
  if (tissue.torn(strand)) return false;  // another instrument has divided it
  tissue.now.heated[strand] += energy;
  if (tissue.now.heated[strand] < tissue.definition.divide_energy * placed.area) return false;
  tissue.divide(strand);
  return true;
}

/// Where a shut clip's legs are: from their ends to what joins them, m.
std::array<Vec3, 2> ends_of(const Organ& organ, const Clip& clip) {
  const RodBody& rod = *organ.body->as_tube();
  const Vec3 middle = rod.place_at(clip.at, organ.state.x);
  const Vec3 legs = rod.frame_at(clip.at, organ.state.x) * clip.legs;
  return {middle + clip.reach * legs, middle + (clip.reach - clip_row(clip.size).leg) * legs};
}

/// The organ whose clip is touched by what current flows through, and where.
std::optional<std::pair<const Organ*, Vec3>> touched_clip(const Field& field,
                                                          const std::vector<Shape>& shapes) {
  constexpr double half = 0.6e-3;  // m, half as thick as a shut clip, and as near as touches
  constexpr int looks = 8;         // along the legs: less than 1.5 mm apart
  for (const Organ& organ : field.organs)
    for (const Clip& clip : organ.clips) {
      const auto [from, to] = ends_of(organ, clip);
      for (int k = 0; k <= looks; ++k)
        if (const Vec3 at = from + static_cast<double>(k) / looks * (to - from);
            std::any_of(shapes.begin(), shapes.end(),
                        [&](const Shape& shape) { return signed_distance(shape, at) < half; }))
          return {{&organ, at}};
    }
  return std::nullopt;
}

/// Current in or near what it should be kept from: raised when it begins.
void judge_neighbours(const Field& field, Tool& tool, std::vector<WorldEvent>& events) {
  const bool active = is_active(tool);
  const std::vector<Shape> shapes = active ? working_shapes(tool) : std::vector<Shape>{};
  const auto clip = active ? touched_clip(field, shapes) : std::nullopt;
  if (clip && !tool.on_clip)
    events.push_back({EventKind::activation_on_clip, 0, tool.definition.name, clip->first->definition.name, 0,
                      clip->second, EventCause::current});
  tool.on_clip = clip.has_value();
  const Organ* kept = nullptr;
  Clearance nearest{std::numeric_limits<double>::infinity()};
  for (const Organ& organ : field.organs) {
    if (!active || organ.definition.keep_clear == 0) continue;
    const std::optional<Clearance> found = clearance_within(shapes, organ, organ.definition.keep_clear);
    if (!found || found->distance >= nearest.distance) continue;
    kept = &organ;
    nearest = *found;
  }
  if (kept != nullptr && !tool.beside_kept)
    events.push_back({EventKind::activation_beside, 0, tool.definition.name, kept->definition.name,
                      nearest.distance / units::mm, nearest.place, EventCause::current});
  tool.beside_kept = kept != nullptr;
}

/// Current that flows while its instrument touches nothing: raised once it has for too long.
void judge_dry(Tool& tool, const ToolLoad& load, double duration, std::vector<WorldEvent>& events) {
  if (!is_active(tool) || load.touches > 0 || tool.ground.touches()) {
    tool.dry = 0;
  } else if (tool.dry < dry_limit) {
    tool.dry = std::min(tool.dry + duration, dry_limit);
    if (tool.dry == dry_limit) events.push_back({EventKind::dry_activation, 0, tool.definition.name, {}, 0});
  }
}

/// Strands take `energy` (J) evenly; those that have taken enough are divided.
void heat_strands(Field& field, const std::string& instrument, const std::vector<Heated>& strands,
                  double energy, std::vector<WorldEvent>& events) {
  std::vector<double> areas(field.tissues.size(), 0.0);
  for (const Heated& one : strands) {
    Tissue& tissue = field.tissues[one.tissue];
    if (heat(tissue, one.strand, energy / static_cast<double>(strands.size())))
      areas[one.tissue] += tissue.strands->strands()[one.strand].area;
  }
  for (std::size_t t = 0; t < areas.size(); ++t) {
    if (areas[t] == 0) continue;
    const Tissue& tissue = field.tissues[t];
    const std::string& name = tissue.definition.name;
    events.push_back({EventKind::divided, 0, instrument, name, areas[t] / (units::mm * units::mm),
                      std::nullopt, EventCause::current});
    if (tissue.torn() == static_cast<int>(tissue.now.opened.size()))
      events.push_back({EventKind::parted, 0, {}, name, 0, std::nullopt, EventCause::current});
  }
}

/// Shares what a tool's current brings, J, among the walls that it reaches and the strands that it touches.
void share_out(Field& field, const Tool& tool, const std::vector<Heated>& strands, double energy,
               std::vector<WorldEvent>& events) {
  const std::string& name = tool.definition.name;
  const std::vector<ReachedWall> walls = reached_walls(field, working_shapes(tool));
  double sum = strands.empty() ? 0.0 : 1.0;
  for (const ReachedWall& wall : walls) sum += wall.weight();
  const double whole = energy / std::max(1.0, sum);
  for (const ReachedWall& wall : walls) burn(wall, name, whole * wall.weight(), events);
  heat_strands(field, name, strands, whole, events);
}

}  // namespace

std::vector<WorldEvent> apply_current(Field& field, const std::vector<ToolLoad>& loads, double duration) {
  std::vector<WorldEvent> events;
  const std::vector<std::vector<Heated>> heated = heated_strands(field);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    judge_dry(tool, loads[i], duration, events);
    judge_neighbours(field, tool, events);
    if (is_active(tool)) share_out(field, tool, heated[i], tool.definition.power * duration, events);
  }
  return events;
}

}  // namespace calot
