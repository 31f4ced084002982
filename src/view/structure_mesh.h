#pragma once

#include "render/scene.h"
#include "view/structure_drawing.h"

namespace calot {

/// The structure on the skin: black threads and beads for the coarse elements and nodes, steel ones for those of
/// the extensions.
std::vector<SceneMesh> structure_meshes(const StructureDrawing& structure);

}  // namespace calot
