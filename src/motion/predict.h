#pragma once
// What a part of the tools' motion makes the organs do, to first order, and how much of that is safe.

#include "field/field.h"
#include "tools/step_report.h"

namespace calot {

/// What the organs answer to a part of a motion.
struct Prediction {
  VecX first_order, dx;                    ///< m, 3 a node; dx with what the last answer missed
  VecX first_order_pressures, dpressures;  ///< Pa, one an organ
  double travel = 0;                       ///< of the tool that travels most, m
  double share = 1;                        ///< that can be believed, and is safe
  bool loaded = false;                     ///< whether the tools' motion or its own moves any organ
  bool fresh = true;                       ///< by a tangent of where the organs are
};

/// Answer of the organs to tools that move from `from` to `to` (one pose a tool), and the share of it that is safe.
/// With `fresh` the tangent is factorised anew, else the last factor serves if there is one: an answer of that which is not
/// safe all the way is none, with a share of 0. Fails (simulation) where the tangent answers nothing that can be believed.
Result<Prediction> predict(Field& field, const std::vector<InstrumentPose>& from,
                           const std::vector<InstrumentPose>& to, bool fresh, SolveStatistics& statistics);

/// The tools' motion while organs stay. Near the load at which a fold gives way the tangent is all but singular, and no
/// part of its answer can be believed: that says nothing of the room that there is, and the solve finds where organs
/// go.
Prediction of_tools_alone(Field& field, const std::vector<InstrumentPose>& from,
                          const std::vector<InstrumentPose>& to, SolveStatistics& statistics);

/// What the answer to a part of a motion missed, once the organs are in equilibrium. `share` of it was gone.
MissedMotion missed_by(const Prediction& answer, double share, const GroupSnapshot& before,
                       const Field& field, int by_last_factor);

/// Whether the last factor answered the last motion well: a new one takes as long as three iterations.
bool factor_serves(const Group& group);

}  // namespace calot
