#include "session/step_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"

namespace calot {
namespace {

constexpr int organ_columns = 4;

std::string organ_header(const std::string& organ) {
  return fmt::format(",{0}.pressure_Pa,{0}.volume_mL,{0}.energy_J,{0}.max_stretch", organ);
}

/// Empty fields where there is none of that name.
std::string organ_fields(const StepReport& report, const std::string& name) {
  for (const OrganState& state : report.organs)
    if (state.name == name)
      return fmt::format(",{},{},{},{}", state.pressure, state.volume / units::mL, state.energy,
                         state.max_stretch);
  return std::string(organ_columns, ',');
}

}  // namespace

Result<StepTable> StepTable::create(const std::string& path, const SceneDefinition& scene) {
  StepTable table;
  table.path_ = path;
  table.out_.open(path, std::ios::trunc);
  std::string header = "time_s";
  for (const InstrumentDefinition& instrument : scene.instruments) {
    header += fmt::format(
        ",{0}.force_N,{0}.jaws_force_N,{0}.shaft_force_N,{0}.handle_force_N,{0}.jaw_deg,{0}.grip_points",
        instrument.name);
  }
  for (const OrganDefinition& organ : scene.anatomy.organs) {
    header += organ_header(organ.name);
    table.organs_.push_back(organ.name);
  }
  table.of_scene_ = table.organs_.size();
  table.out_ << header << ",substeps,newton_iterations\n";
  if (!table.out_) {
    return fail(FailureKind::usage, fmt::format("cannot write {}", path),
                "choose another folder with -o DIR");
  }
  return table;
}

bool StepTable::widen(const std::vector<std::string>& organs) {
  std::string header, line, more;
  for (const std::string& organ : organs) header += organ_header(organ);
  out_.close();
  std::ifstream in(path_);
  for (bool first = true; std::getline(in, line); first = false)
    more += line + (first ? header : std::string(organ_columns * organs.size(), ',')) + '\n';
  in.close();
  out_.open(path_, std::ios::trunc);
  out_ << more << std::flush;
  organs_.insert(organs_.end(), organs.begin(), organs.end());
  return static_cast<bool>(out_);
}

bool StepTable::write(const StepReport& report) {
  std::vector<std::string> fresh;
  for (const OrganState& organ : report.organs)
    if (std::find(organs_.begin(), organs_.end(), organ.name) == organs_.end()) fresh.push_back(organ.name);
  if (!fresh.empty() && !widen(fresh)) return false;
  std::string row = fmt::format("{}", report.time);
  for (const InstrumentState& state : report.instruments) {
    row += fmt::format(",{},{},{},{},{},{}", state.force.norm(), state.load_on(ToolPart::jaws).force.norm(),
                       state.load_on(ToolPart::shaft).force.norm(), state.handle_force.norm(),
                       state.pose.jaw / units::deg, state.grip_points);
  }
  for (std::size_t k = 0; k < of_scene_; ++k) row += organ_fields(report, organs_[k]);
  row += fmt::format(",{},{}", report.statistics.substeps, report.statistics.newton_iterations);
  for (std::size_t k = of_scene_; k < organs_.size(); ++k) row += organ_fields(report, organs_[k]);
  // Flushed row by row: a process that is stopped loses nothing.
  out_ << row << std::endl;
  return static_cast<bool>(out_);
}

}  // namespace calot
