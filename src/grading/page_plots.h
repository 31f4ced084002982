#pragma once

#include <vector>

#include "page/page_data.h"
#include "session/exercise.h"
#include "session/trace.h"

namespace calot {

/// Forces on the instruments, ways of their tips, stretch of the walls: what there is of them. Forces have the figures by
/// which the score judges them; those on the jaws also what the steps asked for, and the instruments' limits.
std::vector<PagePlot> page_plots(const ExerciseDefinition& exercise, const Progress& progress,
                                 const Traces& traces);

}  // namespace calot
