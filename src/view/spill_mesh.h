#pragma once
// Bile and blood that have left the organs, to look at: drops that fall and films that lie.

#include "render/scene.h"
#include "world/world.h"

namespace calot {

/// One of each liquid that is there.
std::vector<SceneMesh> spill_meshes(const World& world);

}  // namespace calot
