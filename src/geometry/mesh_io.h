#pragma once

#include <string>

#include "geometry/tri_mesh.h"

namespace calot {

/// Reads the v and f records of a Wavefront OBJ file; polygons are cut into fans; coordinates are multiplied
/// by `scale` (1e-3 for a file in millimetres). Errors name file and line, the first 20 of them. A file of more
/// than 8 MiB is refused unread.
Result<TriMesh> read_obj(const std::string& path, double scale);

}  // namespace calot
