#include "field/change_bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/suggest.h"
#include "field/grip.h"
#include "field/join_bodies.h"
#include "field/members_note.h"
#include "field/renumbering.h"
#include "field/roll.h"

namespace calot {

std::optional<Failure> check_room(const Field& field, int more_nodes) {
  if (field.organs.size() + 1 > most_organs)
    return fail(FailureKind::scenario, fmt::format("there are {} organs already", field.organs.size()),
                "remove some that are of no use any more");
  for (const Organ& organ : field.organs) more_nodes += organ.body->coarse_nodes();
  if (more_nodes > most_nodes)
    return fail(FailureKind::scenario, fmt::format("the organs would have {} control nodes", more_nodes),
                fmt::format("they may have {} together: give them fewer", most_nodes));
  return std::nullopt;
}

void finish_change(Field& field) {
  renew_joins(field);
  field.group.forget_bodies();
  field.group.missed = {};
  keep_members(field);
}

namespace {

/// Whether a tool holds some of an organ, or both of its jaws rub on it.
bool jaws_rest_on(const Organ& organ, ToolIndex instrument, std::size_t tools) {
  if (grip_count(organ, instrument) > 0) return true;
  const auto rubs = [&](int jaw) {
    const int shape = FieldShape::of_jaw(instrument, jaw).index(tools);
    return std::any_of(organ.friction.points.begin(), organ.friction.points.end(),
                       [&](const RubbingPoint& point) { return point.shape == shape; });
  };
  return rubs(0) && rubs(1);
}

}  // namespace

Result<bool> remove_body(Field& field, OrganIndex organ, const std::string& why, double time) {
  const int index = organ.value;
  if (field.organs.size() == 1)
    return fail(FailureKind::scenario, fmt::format("{} is the last organ", quoted(field.organs[0])),
                "leave one in the field");
  note_departure(field, field.organs[index], {time, why.empty() ? "was removed" : "was removed: " + why});
  std::vector<int> now;
  for (int k = 0; k < static_cast<int>(field.organs.size()); ++k) now.push_back(k < index ? k : k - 1);
  now[index] = -1;
  const Organ gone = std::move(field.organs[index]);
  field.organs.erase(field.organs.begin() + index);
  Renumbering(now).apply(field);
  for (int i = 0; i < static_cast<int>(field.tools.size()); ++i) {
    const ToolIndex tool{i};
    const auto rests = [&](const Organ& organ) { return jaws_rest_on(organ, tool, field.tools.size()); };
    if (rests(gone) && std::none_of(field.organs.begin(), field.organs.end(), rests))
      field.tool(tool).jaw_stopped = field.tool(tool).pressing = false;
  }
  finish_change(field);
  return true;
}

namespace {

/// Of the body that would join.
std::optional<Failure> check_free(const Field& field, const Organ& fresh) {
  for (const Organ& organ : field.organs) {
    VecX x(fresh.state.x.size() + organ.state.x.size());
    x << fresh.state.x, organ.state.x;
    const SkinJoin join(*fresh.body, *organ.body, {0, 1});
    join.begin(
        std::array{GroupPlace{fresh.body.get(), 0}, GroupPlace{organ.body.get(), fresh.body->nodes()}});
    if (std::optional<Problem> problem = overlap_problem(join, fresh, organ, x))
      return Failure{FailureKind::scenario, {std::move(*problem)}};
  }
  for (const Tool& tool : field.tools)
    for (const Shape& shape : shapes_in_field(tool, tool.pose))
      for (std::size_t p = 0; p < fresh.body->skin_rest().size(); ++p) {
        const double radius = fresh.body->is_line() ? fresh.body->skin_radii()[p] : 0.0;
        if (signed_distance(shape, fresh.body->skin_point(static_cast<int>(p), fresh.state.x)) > radius)
          continue;
        return fail(FailureKind::scenario,
                    fmt::format("{} would begin inside instrument '{}'", quoted(fresh), tool.definition.name),
                    "move it away, or the instrument");
      }
  return std::nullopt;
}

}  // namespace

Result<OrganIndex> add_body(Field& field, const OrganDefinition& definition, const OrganMaker& make) {
  for (const Organ& organ : field.organs)
    if (organ.definition.name == definition.name)
      return fail(FailureKind::scenario, fmt::format("there is {} already", quoted(organ)),
                  "give it another name", {"", 0, ".name"});
  Result<RestedOrgan> made = make(definition);
  if (!made) return made.failure();
  if (std::optional<Failure> failure = check_room(field, made->organ.body->coarse_nodes())) return *failure;
  if (std::optional<Failure> failure = check_free(field, made->organ)) return *failure;
  made->organ.origin.added = definition;
  field.enrol(made->organ);
  field.organs.push_back(std::move(made->organ));
  finish_change(field);
  return OrganIndex(field.organs.size() - 1);
}

Result<bool> release_body(Field& field, OrganIndex organ, const std::string& held) {
  if (Result<bool> released = release_held(field.organ(organ), held); !released) return released;
  finish_change(field);
  return true;
}

Result<bool> add_tissue(Field& field, const TissueDefinition& definition) {
  int strands = definition.strands;
  for (const Tissue& tissue : field.tissues) {
    strands += static_cast<int>(tissue.strands->strands().size());
    if (tissue.definition.name == definition.name)
      return fail(FailureKind::scenario, fmt::format("there is a tissue '{}' already", definition.name),
                  "give it another name", {"", 0, ".name"});
  }
  if (strands > most_strands)
    return fail(FailureKind::scenario, fmt::format("the tissues would have {} strands together", strands),
                fmt::format("give them at most {}", most_strands), {"", 0, ".strands"});
  Result<Tissue> made = make_tissue(definition, field.organs, field.up);
  if (!made) return made.failure();
  field.tissues.push_back(std::move(made).value());
  finish_change(field);
  return true;
}

Result<bool> remove_tissue(Field& field, const std::string& name, double time) {
  const auto is_it = [&](const Tissue& tissue) { return tissue.definition.name == name; };
  std::vector<std::string> names;
  for (const Tissue& tissue : field.tissues) names.push_back(tissue.definition.name);
  if (std::erase_if(field.tissues, is_it) == 0) {
    if (const BodyRecord* record = gone_body(field, name)) return gone(*record);
    return fail(FailureKind::scenario, fmt::format("there is no tissue '{}'", name), suggestion(name, names));
  }
  field.membership.roll.push_back({name, ++field.lives, Departure{time, "was removed"}});
  finish_change(field);
  return true;
}

Result<bool> tie_bodies(Field& field, const JointDefinition& joint) {
  if (Result<bool> tied = add_joint(joint, false, field); !tied) return tied;
  finish_change(field);
  return true;
}

Result<bool> untie_bodies(Field& field, OrganIndex one, OrganIndex other) {
  const auto ties = [&](const FieldJoint& joint) {
    const std::array<int, 2>& bodies = joint.joint->links().bodies;
    return bodies == std::array{one.value, other.value} || bodies == std::array{other.value, one.value};
  };
  if (std::erase_if(field.membership.joints, ties) == 0)
    return fail(FailureKind::scenario, fmt::format("{} and {} are not tied to each other",
                                                   quoted(field.organ(one)), quoted(field.organ(other))));
  finish_change(field);
  return true;
}

void keep_members(Field& field) {
  FieldMembers now{field.organs,
                   field.tissues,
                   field.group.joins,
                   field.viewed,
                   field.membership,
                   field.members ? field.members->world : std::make_shared<const int>(0),
                   0};
  for (Organ& organ : now.organs) {
    const bool meets_itself = organ.search.own.active;
    organ.search = {};
    organ.search.own.active = meets_itself;
    organ.looked_at.reset();
  }
  WordHash hash;
  MemberWriter{hash}(note_of(field));
  now.hash = hash.value();
  field.members = std::make_shared<const FieldMembers>(std::move(now));
}

void restore_members(Field& field, const std::shared_ptr<const FieldMembers>& members) {
  if (field.members == members) return;
  field.members = members;
  field.organs = members->organs;
  field.tissues = members->tissues;
  field.group.forget_bodies();
  field.group.joins = members->joins;
  field.viewed = members->viewed;
  field.membership = members->membership;
}

}  // namespace calot
