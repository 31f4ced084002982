#pragma once
// The peritoneum that spans a tissue, to look at: on either side of its strands a thin sheet from skin to skin, through
// the outermost of them. It hangs as they do, and is open beside those that are torn.

#include "render/scene.h"
#include "sim/world.h"

namespace calot {

/// All sheets of a world as they are now; no triangles where there is no tissue.
SceneMesh veil_mesh(const World& world);

}  // namespace calot
