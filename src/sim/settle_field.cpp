#include "sim/settle_field.h"

#include "sim/detail_fading.h"
#include "sim/grip.h"
#include "sim/rubbing.h"

namespace calot {

ContactLoads contact_loads(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  ContactLoads out;
  out.barrier = field.barrier;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    for (const Shape& shape : instrument_shapes(field.tools[i].trocar, poses[i], field.tools[i].geometry))
      out.shapes.push_back(contact_shape(shape));
  if (field.support) out.shapes.push_back(contact_shape(*field.support));
  out.grip = grip_links(organ, field.tools, poses);
  out.friction = friction_load(field, organ, poses);
  out.detail_holds = detail_holds(organ.body, organ.state.shares);
  out.load = organ.state.fading_load;
  return out;
}

void count(const NewtonResult& result, SolveStatistics& statistics) {
  statistics.newton_iterations += result.iterations;
  statistics.assembly_s += result.assembly_s;
  statistics.factorisation_s += result.factorisation_s;
  statistics.solve_s += result.solve_s;
  statistics.contact_s += result.safety_s;
}

namespace {

double largest_travel(const Field& field, const std::vector<InstrumentPose>& to) {
  double travel = 0;
  for (std::size_t i = 0; i < to.size(); ++i)
    travel = std::max(travel, travel_bound(field.tools[i], field.tools[i].pose, to[i]));
  return travel;
}

}  // namespace

NewtonResult settle_organ(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                          const VecX& before, int max_iterations, SolveStatistics& statistics) {
  NewtonSettings settings;
  settings.tolerance = field.tolerance;
  settings.max_iterations = max_iterations;
  fade_details(largest_travel(field, poses), organ.state);
  ContactLoads around = contact_loads(field, organ, poses);
  NewtonResult total;
  for (int round = 0; round <= friction_rounds; ++round) {
    total.add(
        settle(organ.body, around, settings, organ.work, organ.search, organ.state, false, field.scheme));
    if (!total.converged() || !has_friction(field)) break;
    const FrictionLoad used = around.friction;
    const double share = round < relaxed_round ? 1.0 : 0.5;
    if (renew_friction(field, organ, poses, before, share, around) <= friction_tolerance) {
      // Where nothing moved, not even rounding may.
      if (organ.state.x != before || poses != present_poses(field)) keep_friction(field, organ, poses, used);
      break;
    }
    if (round == friction_rounds) total.status = NewtonStatus::iteration_limit;
  }
  count(total, statistics);
  return total;
}

Result<bool> settle_field(Field& field, const std::string& when, SolveStatistics& statistics) {
  for (Organ& organ : field.organs) {
    const VecX before = organ.state.x;
    const NewtonResult result =
        settle_organ(field, organ, present_poses(field), before, NewtonSettings{}.max_iterations, statistics);
    if (!result.converged()) return solve_failure(result, organ.definition.name, when);
  }
  return true;
}

}  // namespace calot
