#include "motion/settle_field.h"

#include <algorithm>
#include <limits>

#include "field/field_tissues.h"
#include "field/grip.h"
#include "field/leaving.h"
#include "group/detail_fading.h"
#include "motion/body_rubbing.h"
#include "motion/rubbing.h"
#include "motion/step_budget.h"

namespace calot {

ContactLoads contact_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  ContactLoads out;
  out.barrier = field.barrier;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    for (const Shape& shape : shapes_in_field(field.tools[i], poses[i]))
      out.shapes.push_back(contact_shape(shape));
  for (ToolIndex tool : organ.unfelt)
    for (int jaw : {0, 1}) out.shapes[FieldShape::of_jaw(tool, jaw).index(field.tools.size())] = nowhere;
  out.broad.assign(out.shapes.size(), 0);
  for (const Ground& ground : field.ground) {
    out.shapes.push_back(contact_shape(ground.shape));
    out.broad.push_back(ground.broad);
  }
  out.grip = grip_springs(organ, field.tools, poses);
  out.friction = friction_load(field, organ, poses);
  if (const ShellBody* shell = organ.body->as_shell())
    out.detail_holds = detail_holds(*shell, organ.state.shares);
  out.load = organ.state.fading_load;
  return out;
}

ContactLoads solve_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  ContactLoads out = contact_loads(field, organ, poses);
  if (organ.state.motion.duration == 0) return out;
  const double retardation = organ.body->turns_as_a_whole() ? 0 : organ.definition.wall.retardation;
  out.leaving = leaving_springs(organ);
  out.inertia = std::make_shared<const Inertia>(*organ.body, organ.state, retardation);
  return out;
}

std::vector<ContactLoads> solve_loads(const Field& field, const std::vector<InstrumentPose>& poses) {
  std::vector<ContactLoads> out(field.organs.size());
  for_each_chunk(field.workers(), static_cast<int>(out.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    out[k] = solve_loads(field, field.organs[k], poses);
  });
  return out;
}

std::vector<Member> members_of(Field& field, const std::vector<ContactLoads>& loads) {
  std::vector<Member> out;
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    Organ& organ = field.organs[k];
    out.push_back({*organ.body, loads[k], organ.search, organ.state, field.assembly});
  }
  return out;
}

std::string member_name(const Field& field, int part) {
  const auto index = static_cast<std::size_t>(part);
  if (index < field.organs.size()) return field.organs[index].definition.name;
  return field.tissues[index - field.organs.size()].definition.name;
}

void count(const Field& field, const NewtonResult& result, SolveStatistics& statistics) {
  statistics.newton_iterations += result.iterations;
  statistics.factorisations += result.factorisations;
  statistics.shifts += result.shifts;
  statistics.assembly_s += result.assembly_s;
  statistics.factorisation_s += result.factorisation_s;
  statistics.solve_s += result.solve_s;
  statistics.contact_s += result.safety_s + result.sharp_s;
  for (std::size_t part = 0; part < result.furthest.size(); ++part)
    if (result.furthest[part] > 0)
      statistics.furthest[member_name(field, static_cast<int>(part))] += result.furthest[part];
}

std::vector<JoinPointer> all_joins(const Field& field, const std::vector<InstrumentPose>& poses) {
  std::vector<JoinPointer> out = field.group.joins;
  add_strands(field, poses, out);
  return out;
}

double largest_travel(const Field& field, const std::vector<InstrumentPose>& to) {
  double travel = 0;
  for (std::size_t i = 0; i < to.size(); ++i)
    travel = std::max(travel, travel_bound(field.tools[i], field.tools[i].pose, to[i]));
  return travel;
}

namespace {

/// Renews what rubs on all organs; whether no normal force asks for another limit any more.
bool friction_agrees(Field& field, const std::vector<InstrumentPose>& poses, const std::vector<VecX>& before,
                     int round, std::vector<ContactLoads>& loads, std::vector<SkinHold>& rubbing) {
  const double share = round < relaxed_round ? 1.0 : 0.5;
  bool agrees = true;
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    agrees &= renew_friction(field, field.organs[k], poses, before[k], share, loads[k]) <= friction_tolerance;
  agrees &= renew_body_friction(field, before, share, rubbing) <= friction_tolerance;
  return agrees;
}

}  // namespace

NewtonSettings solver_settings(const Field& field, int iterations) {
  NewtonSettings out;
  out.tolerance = field.rough ? std::max(rough_tolerance, field.tolerance) : field.tolerance;
  if (field.rough) out.constraint_tolerance = 1e-3 * rough_tolerance;
  out.stop = [&field, left = iterations]() mutable { return field.stopped() || left-- <= 0; };
  return out;
}

namespace {

/// Organs and tissues as one group, with the tools at `poses`.
struct Solved {
  Solved(Field& field, const std::vector<InstrumentPose>& poses)
      : loads(loads_at(field, poses)), tissues(field), members(members_of(field, loads)) {
    tissues.add_to(members);
  }
  Solved(const Solved&) = delete;
  Solved& operator=(const Solved&) = delete;

  static std::vector<ContactLoads> loads_at(Field& field, const std::vector<InstrumentPose>& poses) {
    const double travel = largest_travel(field, poses);
    for (Organ& organ : field.organs) fade_details(travel, organ.state);
    return solve_loads(field, poses);
  }

  std::vector<ContactLoads> loads;  ///< one an organ
  TissueMembers tissues;
  std::vector<Member> members;
};

void note_balance(const NewtonResult& last, SolveStatistics& statistics) {
  statistics.balanced = last.converged();
  statistics.residual = last.converged() ? 0 : last.residual;
}

/// What rubs: renewed until the normal forces ask for no other limit, or held as it was found last.
enum class Rubbing { renewed, as_it_is };

NewtonResult settle_rubbing(Field& field, const std::vector<InstrumentPose>& poses,
                            const std::vector<VecX>& before, int max_iterations, SolveStatistics& statistics,
                            Rubbing rubs) {
  NewtonSettings settings = solver_settings(field, left_to_balance(field, statistics));
  settings.max_iterations = max_iterations;
  Solved solved(field, poses);
  Group& group = field.group;
  std::vector<SkinHold> rubbing = group.rubbing;
  NewtonResult total;
  for (int round = 0; round <= friction_rounds; ++round) {
    const std::vector<JoinPointer> joins = joins_with(all_joins(field, poses), rubbing);
    total.add(settle(solved.members, joins, group.patterns, settings, group.work, {.scheme = field.scheme}));
    ++statistics.solves;
    if (round > 0) ++statistics.friction_rounds;
    if (!total.converged() || rubs == Rubbing::as_it_is || !has_friction(field)) break;
    std::vector<FrictionLoad> used;
    for (const ContactLoads& of_organ : solved.loads) used.push_back(of_organ.friction);
    std::vector<SkinHold> used_between = rubbing;
    if (friction_agrees(field, poses, before, round, solved.loads, rubbing)) {
      // Where nothing moved, not even rounding may.
      const bool stayed = poses == present_poses(field);
      bool all_stayed = true;
      for (std::size_t k = 0; k < field.organs.size(); ++k) {
        if (stayed && field.organs[k].state.x == before[k]) continue;
        keep_friction(field, field.organs[k], poses, used[k]);
        all_stayed = false;
      }
      if (!all_stayed) keep_body_friction(field, std::move(used_between));
      break;
    }
    if (round == friction_rounds) total.status = NewtonStatus::iteration_limit;
  }
  count(field, total, statistics);
  note_balance(total, statistics);
  if (was_cut_short(field, total)) statistics.cut_short = true;
  return total;
}

}  // namespace

NewtonResult settle_group(Field& field, const std::vector<InstrumentPose>& poses,
                          const std::vector<VecX>& before, int max_iterations, SolveStatistics& statistics) {
  return settle_rubbing(field, poses, before, max_iterations, statistics, Rubbing::renewed);
}

NewtonResult bring_along(Field& field, const std::vector<InstrumentPose>& poses,
                         SolveStatistics& statistics) {
  constexpr double taken_along = 200e-6;  // m
  NewtonSettings settings = solver_settings(field, left_to_begin(field, statistics));
  settings.max_iterations = 1;
  Solved solved(field, poses);
  Group& group = field.group;
  const NewtonResult result =
      settle(solved.members, joins_with(all_joins(field, poses), group.rubbing), group.patterns, settings,
             group.work, {.scheme = field.scheme, .gets_nowhere = taken_along});
  ++statistics.solves;
  count(field, result, statistics);
  note_balance(result, statistics);
  return result;
}

bool was_cut_short(const Field& field, const NewtonResult& result) {
  return result.status == NewtonStatus::stopped && !field.stopped();
}

bool may_end_so(const Field& field, const NewtonResult& result) {
  const bool no_balance =
      result.status == NewtonStatus::stalled || result.status == NewtonStatus::iteration_limit;
  return was_cut_short(field, result) || (field.step_time > 0 && no_balance);
}

namespace {

NewtonResult settle_where_it_is(Field& field, SolveStatistics& statistics, Rubbing rubs = Rubbing::renewed) {
  return settle_rubbing(field, present_poses(field), present_places(field), NewtonSettings{}.max_iterations,
                        statistics, rubs);
}

}  // namespace

Result<bool> settle_field(Field& field, const std::string& when, SolveStatistics& statistics) {
  const NewtonResult result = settle_where_it_is(field, statistics);
  if (result.converged() || was_cut_short(field, result)) return true;
  return solve_failure(result, member_name(field, result.part), when);
}

namespace {

/// Of a scene that has no rest.
Failure no_rest(const Field& field, const NewtonResult& result, const std::string& when) {
  const Failure out = no_rest_failure(result, member_name(field, result.part), when);
  const auto part = static_cast<std::size_t>(result.part);
  return part < field.organs.size() ? at_organ(out, part) : out;
}

}  // namespace

Result<bool> settle_at_rest(Field& field, SolveStatistics& statistics) {
  const NewtonResult result = settle_where_it_is(field, statistics);
  if (result.converged()) return true;
  return no_rest(field, result, "at rest");
}

Result<bool> settle_in_step(Field& field, const std::string& when, SolveStatistics& statistics) {
  const NewtonResult result = settle_where_it_is(field, statistics);
  if (result.converged()) return true;
  if (!may_end_so(field, result)) return solve_failure(result, member_name(field, result.part), when);
  statistics.cut_short = true;
  return true;
}

void end_in_balance(Field& field, SolveStatistics& statistics) {
  field.rough = false;
  const GroupSnapshot before = snapshot(field);
  const NewtonResult result = settle_where_it_is(field, statistics, Rubbing::as_it_is);
  if (result.converged() || was_cut_short(field, result)) return;
  restore(field, before);
  statistics.cut_short = true;
}

Result<bool> sink_field(Field& field, SolveStatistics& statistics) {
  const NewtonSettings settings = solver_settings(field, std::numeric_limits<int>::max());
  std::vector<ContactLoads> loads;
  for (const Organ& organ : field.organs) loads.push_back(contact_loads(field, organ, present_poses(field)));
  Group& group = field.group;
  std::vector<Member> members = members_of(field, loads);
  TissueMembers tissues(field);
  tissues.add_to(members);
  const NewtonResult result =
      sink(members, all_joins(field, present_poses(field)), group.patterns, settings, group.work);
  ++statistics.solves;
  count(field, result, statistics);
  if (!result.converged()) return no_rest(field, result, "as it sank to rest");
  return true;
}

}  // namespace calot
