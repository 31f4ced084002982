#pragma once
// What closing blades divide.
//
// A duct or a vessel is divided where it passes between the blades as soon as both touch it: it is cut rather than
// squeezed. Its pieces do not feel the blades until they have come clear of them, as what is cut lies on their flat
// sides. Strands are divided where an edge passes them. Walls are not divided: blades that close
// on one stand on it, and say so (jaw_acts.h).

#include "field/field.h"

namespace calot {

/// At one of the angles at which jaws may take hold, with blade `instrument` where it is. Adds the events cut and
/// cut_unclipped. In statics the pieces have come to rest; fails (simulation) where they cannot, or (resource) where the
/// field has no room for more organs.
Result<bool> close_blades(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events,
                          SolveStatistics& statistics);

/// Tubes feel the jaws again that they have come clear of.
void feel_again(Field& field);

}  // namespace calot
