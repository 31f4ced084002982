#pragma once
// Which organs lie elsewhere at the start than they are drawn.

#include "world/world.h"

namespace calot {

/// A line for each organ that came to rest further from where it is drawn than AnatomyDefinition::rest_within.
std::vector<std::string> rest_remarks(const World& world);

}  // namespace calot
