#include "paper/star_skin.h"

#include "skin/subdivision.h"

namespace calot {

Result<Tessellation> paper_skin(const StarMesh& structure, int parts) {
  const StarControl control = star_control(structure);
  const Result<LoopSurface> surface = LoopSurface::create(control.mesh);
  if (!surface) return surface.failure();
  Tessellation skin = surface->tessellate(parts);
  for (int& node : skin.stencils.node) node = control.node[node];
  return skin;
}

}  // namespace calot
