#include "field/field_bytes.h"

#include <algorithm>

#include "body/inertia.h"
#include "field/bring_members.h"
#include "field/moving_bodies.h"
#include "field/moving_state.h"

namespace calot {
namespace {

/// Whether a body can have these details.
bool can_have(const Body& body, const std::vector<int>& details) {
  const ShellBody* shell = body.as_shell();
  if (details.empty() || shell == nullptr) return details.empty();
  const bool increase =
      std::adjacent_find(details.begin(), details.end(), std::greater_equal<>()) == details.end();
  return increase && details.front() >= shell->coarse_nodes() &&
         details.back() < shell->levels().nodes(shell->most_levels());
}

bool refine(const std::vector<std::vector<int>>& details, Field& field) {
  if (details.size() != field.organs.size()) return false;
  for (std::size_t k = 0; k < details.size(); ++k) {
    BodyPointer& body = field.organs[k].body;
    if (!can_have(*body, details[k])) return false;
    if (body->details() == details[k]) continue;
    Result<ShellBody> refined = body->as_shell()->with_details(details[k]);
    if (!refined) return false;
    body = std::make_shared<const ShellBody>(std::move(refined).value());
  }
  return true;
}

bool fits(const BodyState& state, const Body& body) {
  const Eigen::Index size = body.rest().size();
  const auto is_whole_or_none = [&](const VecX& x) { return x.size() == size || x.size() == 0; };
  const LiquidMotion& begin = state.motion.begin;
  return state.x.size() == size && is_whole_or_none(state.fading_load) && is_whole_or_none(begin.x) &&
         begin.velocity.size() == begin.x.size() && (state.motion.duration == 0 || begin.x.size() == size) &&
         (state.shares.empty() || state.shares.size() == body.details().size());
}

bool fits(const Organ& organ, std::size_t tools) {
  const auto points = static_cast<int>(organ.body->skin_rest().size());
  const auto contacts = static_cast<int>(organ.body->skin().triangles.size()) * contacts_each;
  const auto is_tool = [&](ToolIndex tool) {
    return tool.value >= 0 && tool.value < static_cast<int>(tools);
  };
  const auto is_point = [&](int point) { return point >= 0 && point < points; };
  const auto is_at = [&](const auto& held) { return is_tool(held.instrument) && is_point(held.skin_point); };
  return fits(organ.state, *organ.body) && std::all_of(organ.grips.begin(), organ.grips.end(), is_at) &&
         std::all_of(organ.leaving.begin(), organ.leaving.end(), is_at) &&
         std::all_of(organ.friction.points.begin(), organ.friction.points.end(),
                     [&](const RubbingPoint& point) { return point.point >= 0 && point.point < contacts; }) &&
         std::all_of(organ.openings.begin(), organ.openings.end(),
                     [&](const Opening& opening) { return is_point(opening.point); }) &&
         std::all_of(organ.unfelt.begin(), organ.unfelt.end(), is_tool);
}

bool fits(const Tissue& tissue) {
  const std::size_t strands = tissue.strands->strands().size();
  return fits(tissue.now.state, *tissue.body) && tissue.now.opened.size() == strands &&
         tissue.now.heated.size() == strands && tissue.now.divided.size() == strands;
}

/// Whether what was read of a group is of its bodies.
bool fits(const Group& group, const Field& field) {
  const Eigen::Index size = BodyParts(field).total();
  const std::vector<BlockMatrix>& own = group.patterns.own;
  if (!own.empty() && own.size() != moving_bodies(field)) return false;
  for (std::size_t k = 0; k < own.size(); ++k)
    if (own[k].size() != body_of(field, k).rest().size()) return false;
  return fit(group.work.sharp, field) &&
         (group.work.matrix.size() == 0 || group.work.matrix.size() == size) &&
         (group.missed.dx.size() == 0 || group.missed.dx.size() == size);
}

bool fits(const Field& field) {
  return std::all_of(field.organs.begin(), field.organs.end(),
                     [&](const Organ& organ) { return fits(organ, field.tools.size()); }) &&
         std::all_of(field.tissues.begin(), field.tissues.end(),
                     [](const Tissue& tissue) { return fits(tissue); }) &&
         fits(field.group, field);
}

/// How liquids flow in the parts of a motion that their bodies are in.
bool find_flows(Field& field) {
  for (Organ& organ : field.organs) {
    MotionPart& motion = organ.state.motion;
    motion.flow.reset();
    if (motion.duration == 0) continue;
    Result<MotionPart> part = motion_part(*organ.body, motion.begin, motion.duration);
    if (!part) return false;
    motion.flow = part->flow;
  }
  return true;
}

}  // namespace

void add_bytes_of(const Field& field, ByteWriter& out) {
  MemberWriter put{out};
  put(note_of(field), field.membership.roll, details_of(field));
  visit_moving(put, field);
}

void read_field(MemberReader& read, const OrganMaker& make, Field& field) {
  MembersNote members;
  std::vector<BodyRecord> roll;
  std::vector<std::vector<int>> details;
  read(members, roll, details);
  if (read.lacks()) return;
  if (!bring_members(members, roll, make, field) || !refine(details, field)) return read.refuse();
  visit_moving(read, field);
  if (read.lacks()) return;
  if (!fits(field) || !find_flows(field)) return read.refuse();
  keep_members(field);
}

}  // namespace calot
