#include "sim/field.h"

#include "sim/grip.h"

namespace calot {

std::vector<InstrumentPose> present_poses(const Field& field) {
  std::vector<InstrumentPose> poses;
  for (const Tool& tool : field.tools) poses.push_back(tool.pose);
  return poses;
}

Surroundings surroundings(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses) {
  Surroundings out;
  out.barrier = field.barrier;
  for (std::size_t i = 0; i < field.tools.size(); ++i)
    for (Shape& shape : instrument_shapes(field.tools[i].trocar, poses[i], field.tools[i].geometry))
      out.shapes.push_back(std::move(shape));
  if (field.support) out.shapes.push_back(*field.support);
  out.grip = grip_links(organ, field.tools, poses);
  return out;
}

void count(const NewtonResult& result, SolveStatistics& statistics) {
  statistics.newton_iterations += result.iterations;
  statistics.assembly_s += result.assembly_s;
  statistics.factorisation_s += result.factorisation_s;
  statistics.solve_s += result.solve_s;
  statistics.contact_s += result.safety_s;
}

NewtonResult settle_organ(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                          int max_iterations, SolveStatistics& statistics) {
  NewtonSettings settings;
  settings.tolerance = field.tolerance;
  settings.max_iterations = max_iterations;
  const NewtonResult result =
      settle(organ.body, surroundings(field, organ, poses), settings, organ.work, organ.search, organ.state);
  count(result, statistics);
  return result;
}

Result<bool> settle_field(Field& field, const std::string& when, SolveStatistics& statistics) {
  for (Organ& organ : field.organs) {
    const NewtonResult result =
        settle_organ(field, organ, present_poses(field), NewtonSettings{}.max_iterations, statistics);
    if (!result.converged()) return solve_failure(result, organ.definition.name, when);
  }
  return true;
}

}  // namespace calot
