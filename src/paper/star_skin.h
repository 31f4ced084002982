#pragma once

#include "geometry/star_split.h"

namespace calot {

/// The paper's B-spline skin over a structure (section 5.3): the Loop surface controlled by the structure's
/// nodes, but at an extension by P0 and P1', P2', P3' in place of P1, P2, P3 (see star_control()). Each face
/// is split into parts^2 triangles; `at` counts faces of the control mesh, stencils name the structure's
/// nodes. Fails (scenario) when the nodes that are left control no surface.
Result<Tessellation> paper_skin(const StarMesh& structure, int parts);

}  // namespace calot
