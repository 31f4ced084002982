#pragma once
// What jaws do as they open, close and are pulled, and which events that is.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// Notes which tissue tears.
class TearWatch {
 public:
  /// Looks at what is torn now.
  explicit TearWatch(const Field& field) { look(field); }
  /// What was torn since it looked last adds the events tear and parted.
  void judge(Field& field, std::vector<WorldEvent>& events) const;
  /// What has been divided since then tore nothing.
  void look(const Field& field);

 private:
  std::vector<int> torn_;  ///< strands, one a tissue
};

/// Tools whose jaws are to open (targets: one a tool), or are not to press on, let go what they hold.
/// Where masses count all let go what was drawn off their pads in the last step, too. Adds release. Fails (simulation) where
/// what is let go finds no rest.
Result<bool> let_go(Field& field, const std::vector<InstrumentPose>& targets, std::vector<WorldEvent>& events,
                    SolveStatistics& statistics);

/// Folds that are pulled or turned harder than their pads hold slide; one that has left a pad is lost. `slipped_before`, one a
/// tool: it slid in the last step, too. Adds slip, release and clip_dropped. Fails (simulation) where a fold finds no
/// rest.
Result<bool> let_slip(Field& field, const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                      SolveStatistics& statistics);

/// Does what closing jaws do at one of their stops (closing_stops()): blades divide what is between them; other jaws take
/// hold of skin at their pads, and stop where a fold fills them. Adds the events of it. Fails as close_blades() and
/// release() do.
Result<bool> close_jaws(Field& field, ToolIndex instrument, TearWatch& tears, std::vector<WorldEvent>& events,
                        SolveStatistics& statistics);

/// After a step: what tissue that stopped the jaws is to both pads. Adds grasp, slip and release.
void judge_clasps(Field& field, const std::vector<char>& slipped_before, std::vector<WorldEvent>& events);

}  // namespace calot
