#include "field/field_tissues.h"

#include <fmt/format.h>

#include "body/inertia.h"

namespace calot {

TissueMembers::TissueMembers(Field& field) : field_(field), loads_(field.tissues.size()) {
  for (std::size_t t = 0; t < loads_.size(); ++t) {
    const Tissue& tissue = field.tissues[t];
    if (tissue.now.state.motion.duration > 0)
      loads_[t].inertia = std::make_shared<const Inertia>(*tissue.body, tissue.now.state, 0.0);
  }
}

void TissueMembers::add_to(std::vector<Member>& members) {
  for (std::size_t t = 0; t < loads_.size(); ++t) {
    Tissue& tissue = field_.tissues[t];
    members.push_back({*tissue.body, loads_[t], tissue.search, tissue.now.state, nullptr});
  }
}

namespace {

/// What strands feel of the tools. Blades that close divide what is between them, and push none of it before them.
StrandTouch touch_of(const Field& field, const std::vector<InstrumentPose>& poses) {
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    const Tool& tool = field.tools[i];
    const bool cuts = tool.closes && instrument_row(tool.definition.type).jaws == JawUse::cut;
    const std::vector<Shape> parts = shapes_in_field(tool, poses[i]);
    for (std::size_t part = 0; part < parts.size(); ++part)
      shapes.push_back(cuts && part > 0 ? nowhere : contact_shape(parts[part]));
  }
  return {std::move(shapes), field.barrier};
}

}  // namespace

void add_strands(const Field& field, const std::vector<InstrumentPose>& poses,
                 std::vector<JoinPointer>& joins) {
  if (field.tissues.empty()) return;
  const StrandTouch touch = touch_of(field, poses);
  int nodes = static_cast<int>(field.organs.size());
  for (const Tissue& tissue : field.tissues) {
    tissue.strands->set_nodes(nodes++);
    tissue.strands->set_past(tissue.now.opened, tissue.now.state.motion.duration);
    tissue.strands->set_touch(touch);
    joins.push_back(tissue.strands);
  }
}

VecX place_strands(const Field& field) {
  if (field.tissues.empty()) return {};
  std::vector<GroupPlace> places;
  std::vector<double> all;
  const auto add = [&](const Body* body, const auto& x) {
    places.push_back({body, static_cast<int>(all.size()) / 3});
    all.insert(all.end(), x.begin(), x.end());
  };
  for (const Organ& organ : field.organs) add(organ.body.get(), organ.state.x);
  int nodes = static_cast<int>(places.size());
  for (const Tissue& tissue : field.tissues) add(tissue.body.get(), tissue.now.state.x);
  for (const Tissue& tissue : field.tissues) {
    tissue.strands->set_nodes(nodes++);
    tissue.strands->begin(places);
  }
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

VecX place_strands_and_tools(const Field& field) {
  std::vector<JoinPointer> joins;
  add_strands(field, present_poses(field), joins);
  return place_strands(field);
}

void grow_damage(Field& field) {
  const VecX x = place_strands(field);
  for (Tissue& tissue : field.tissues) {
    const StrandJoin& strands = *tissue.strands;
    const std::vector<double> strains = strands.strains(x);
    for (std::size_t i = 0; i < strains.size(); ++i)
      if (strains[i] > strands.strands()[i].strand.law.peak())
        tissue.now.opened[i] = std::max(tissue.now.opened[i], strains[i]);
  }
}

Result<bool> add_tissues(const AnatomyDefinition& anatomy, const Vec3& up, Field& field) {
  for (std::size_t i = 0; i < anatomy.tissue.size(); ++i) {
    Result<Tissue> made = make_tissue(anatomy.tissue[i], field.organs, up);
    if (!made) {
      Failure failure = made.failure();
      for (Problem& problem : failure.problems)
        problem.place.path.insert(0, fmt::format("scene.anatomy.tissue[{}]", i + 1));
      return failure;
    }
    field.tissues.push_back(std::move(made).value());
  }
  return true;
}

}  // namespace calot
