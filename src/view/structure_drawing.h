#pragma once
// The elements and nodes of an organ's structure as they lie on its skin (the paper's figure 1): for a debug view.

#include <vector>

#include "body/shell_body.h"

namespace calot {

/// The edges of the elements on the present surface.
struct StructureDrawing {
  struct Line {
    std::vector<Vec3> points, normals;  ///< m; unit, outward
    int level = 0;                      ///< 0: of the coarse structure; else of the extension that split it
  };
  std::vector<Line> lines;
  std::vector<Vec3> coarse_nodes, details;  ///< m, where the nodes' functions are centred
};

StructureDrawing draw_structure(const ShellBody& body, const VecX& x);

}  // namespace calot
