#include "sim/current.h"

#include <algorithm>

#include "base/units.h"
#include "sim/field_tissues.h"

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
      const std::size_t index = static_cast<std::size_t>(contact.shape) / shapes_per_tool;
      const Tool& tool = field.tools[index];
      if (!is_active(tool) || !conducts(tool.geometry, contact.shape % shapes_per_tool)) return;
      const Heated one{t, strand};
      std::vector<Heated>& of_tool = out[index];
      if (std::find(of_tool.begin(), of_tool.end(), one) == of_tool.end()) of_tool.push_back(one);
    });
  return out;
}

/// Whether it is divided by what it takes, J.
bool heat(Tissue& tissue, std::size_t strand, double energy) {
  const PlacedStrand& placed = tissue.strands->strands()[strand];
  const StrandLaw& law = placed.strand.law;
  double &heated = tissue.now.heated[strand], &opened = tissue.now.opened[strand];
  if (law.torn(opened)) return false;  // another instrument has divided it
  heated += energy;
  if (heated < tissue.definition.divide_energy * placed.area) return false;
  opened = std::max(opened, law.peak() + law.tail());
  return true;
}

}  // namespace

std::vector<WorldEvent> apply_current(Field& field, double duration) {
  std::vector<WorldEvent> events;
  const std::vector<std::vector<Heated>> heated = heated_strands(field);
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    if (!is_active(tool) || tool.touched) {
      tool.dry = 0;
    } else if (tool.dry < dry_limit) {
      tool.dry = std::min(tool.dry + duration, dry_limit);
      if (tool.dry == dry_limit)
        events.push_back({EventKind::dry_activation, 0, tool.definition.name, {}, 0});
    }
    std::vector<double> areas(field.tissues.size(), 0.0);
    for (const Heated& one : heated[i]) {
      Tissue& tissue = field.tissues[one.tissue];
      if (heat(tissue, one.strand, tool.definition.power * duration / static_cast<double>(heated[i].size())))
        areas[one.tissue] += tissue.strands->strands()[one.strand].area;
    }
    for (std::size_t t = 0; t < areas.size(); ++t) {
      if (areas[t] == 0) continue;
      const Tissue& tissue = field.tissues[t];
      const std::string& name = tissue.definition.name;
      events.push_back(
          {EventKind::divided, 0, tool.definition.name, name, areas[t] / (units::mm * units::mm)});
      if (tissue.torn() == static_cast<int>(tissue.now.opened.size()))
        events.push_back({EventKind::parted, 0, {}, name, 0});
    }
  }
  return events;
}

}  // namespace calot
