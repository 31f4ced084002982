#pragma once

#include "geometry/tri_mesh.h"

namespace calot {

/// Flips edges of a closed mesh where that brings points nearer to five, six or seven triangles, as long as
/// no angle falls below `least_angle` (rad) by it.
void even_valences(TriMesh& mesh, double least_angle);

}  // namespace calot
