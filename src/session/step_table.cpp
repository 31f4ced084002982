#include "session/step_table.h"

#include <fmt/format.h>

#include "base/units.h"

namespace calot {

Result<StepTable> StepTable::create(const std::string& path, const SceneDefinition& scene) {
  StepTable table;
  table.out_.open(path, std::ios::trunc);
  std::string header = "time_s";
  for (const InstrumentDefinition& instrument : scene.instruments) {
    header += fmt::format(",{0}.tip_force_N,{0}.handle_force_N,{0}.jaw_deg,{0}.grip_points", instrument.name);
  }
  for (const OrganDefinition& organ : scene.anatomy.organs) {
    header += fmt::format(",{0}.pressure_Pa,{0}.volume_mL,{0}.energy_J,{0}.max_stretch", organ.name);
  }
  table.out_ << header << ",substeps,newton_iterations\n";
  if (!table.out_) {
    return fail(FailureKind::usage, fmt::format("cannot write {}", path),
                "choose another folder with -o DIR");
  }
  return table;
}

bool StepTable::write(const StepReport& report) {
  std::string row = fmt::format("{}", report.time);
  for (const InstrumentState& state : report.instruments) {
    row += fmt::format(",{},{},{},{}", state.tip_force.norm(), state.handle_force.norm(),
                       state.pose.jaw / units::deg, state.grip_points);
  }
  for (const OrganState& state : report.organs) {
    row += fmt::format(",{},{},{},{}", state.pressure, state.volume / units::mL, state.energy,
                       state.max_stretch);
  }
  // Flushed row by row: a process that is stopped loses nothing.
  out_ << row << fmt::format(",{},{}", report.statistics.substeps, report.statistics.newton_iterations)
       << std::endl;
  return static_cast<bool>(out_);
}

}  // namespace calot
