#pragma once
// The leaf of peritoneum that covers a tissue towards the front (TissueDefinition::covered): one thin sheet over all of its
// strands and the tubes that they end on. It hangs and is drawn along as they are, and is open where they are torn. And
// leaves that lie over two tubes alone (LeafDefinition).

#include "render/scene.h"
#include "world/world.h"

namespace calot {

/// All leaves of a world as it is now; no triangles where there is none.
SceneMesh leaf_mesh(const World& world);

}  // namespace calot
