#include "field/field.h"

namespace calot {

std::optional<OrganIndex> organ_of_record(const Field& field, int record) {
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    if (field.organs[k].record == record) return OrganIndex(k);
  return std::nullopt;
}

std::optional<OrganIndex> organ_called(const Field& field, const std::string& name) {
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    if (field.organs[k].definition.name == name) return OrganIndex(k);
  return std::nullopt;
}

std::vector<InstrumentPose> present_poses(const Field& field) {
  std::vector<InstrumentPose> poses;
  for (const Tool& tool : field.tools) poses.push_back(tool.pose);
  return poses;
}

std::vector<VecX> present_places(const Field& field) {
  std::vector<VecX> out;
  for (const Organ& organ : field.organs) out.push_back(organ.state.x);
  return out;
}

namespace {

std::string injury_of(const GroundDefinition& ground) {
  if (!ground.injury.empty()) return ground.injury;
  if (ground.looks == GroundLooks::bowel) return "bowel injured";
  return ground.looks == GroundLooks::liver ? "liver injured" : std::string();
}

}  // namespace

std::vector<Ground> ground_of(const AnatomyDefinition& anatomy) {
  std::vector<Ground> out;
  for (const GroundDefinition& g : anatomy.ground) {
    Shape shape = Plane{g.point, g.normal.normalized()};
    if (g.type == GroundType::capsule) shape = Capsule{g.point, g.to, g.radius};
    if (g.type == GroundType::box)
      shape = RoundedBox{Pose(Eigen::Translation3d(g.point)), 0.5 * g.size, g.radius};
    out.push_back({g.name, shape, g.friction, true, injury_of(g), g.thrust_limit});
  }
  if (const std::optional<SupportDefinition>& support = anatomy.support)
    out.push_back({"support", Plane{support->point, support->normal.normalized()}, support->friction, false});
  return out;
}

void Field::add(RestedOrgan made) {
  organs.push_back(std::move(made.organ));
  organs.back().origin.of_scene = static_cast<int>(organs.size()) - 1;
  enrol(organs.back());
  group.forget_bodies();
  group.missed = {};
  if (organs.size() == 1) group.work = std::move(made.work);
}

void Field::enrol(Organ& organ) {
  organ.record = static_cast<int>(membership.roll.size());
  membership.roll.push_back({organ.definition.name, ++lives, {}});
}

GroupSnapshot snapshot(const Field& field) {
  const Group& group = field.group;
  GroupSnapshot out{{}, {}, group.work.keep(), {{}, group.patterns.joined}, group.missed, group.rubbing};
  for (const Organ& organ : field.organs) out.organs.push_back(snapshot(organ));
  for (const Tissue& tissue : field.tissues) out.tissues.push_back(tissue.now);
  for (const BlockMatrix& own : group.patterns.own) out.patterns.own.push_back(own.pattern_only());
  return out;
}

void restore(Field& field, const GroupSnapshot& snapshot) {
  for (std::size_t k = 0; k < field.organs.size(); ++k) restore(field.organs[k], snapshot.organs[k]);
  for (std::size_t t = 0; t < field.tissues.size(); ++t) field.tissues[t].now = snapshot.tissues[t];
  Group& group = field.group;
  group.work.restore(snapshot.factor);
  group.missed = snapshot.missed;
  group.rubbing = snapshot.rubbing;
  group.patterns.joined = snapshot.patterns.joined;
  group.patterns.own.resize(snapshot.patterns.own.size(), BlockMatrix(0, {}));
  for (std::size_t k = 0; k < group.patterns.own.size(); ++k)
    if (!group.patterns.own[k].same_pattern(snapshot.patterns.own[k]))
      group.patterns.own[k] = snapshot.patterns.own[k].blank();
}

}  // namespace calot
