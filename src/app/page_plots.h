#pragma once

#include <vector>

#include "page/page_data.h"
#include "session/exercise.h"
#include "session/trace.h"

namespace calot {

/// Forces on the instruments, ways of their tips, stretch of the walls: what there is of them.
std::vector<PagePlot> page_plots(const SceneDefinition& scene, const Traces& traces);

}  // namespace calot
