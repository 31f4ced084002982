#pragma once
// Connective tissue to look at: fat in lobules along its strands, or fibres (areolar_mesh.h), which hang where the strands
// do and part where they tear: what is left draws back to both ends and curls up.

#include "render/scene.h"
#include "view/coarse_mesh.h"
#include "world/world.h"

namespace calot {

/// All tissue of a world as it is now, a mesh a material; none where there is none. Coarse: a quarter of the triangles a
/// lobule, and for the rest the same.
std::vector<SceneMesh> tissue_meshes(const World& world, SceneDetail detail = SceneDetail::full);

}  // namespace calot
