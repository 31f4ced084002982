#pragma once
// What the tissue does to the tools where they stand, and how deep they are in it.

#include <string>
#include <vector>

#include "field/field.h"
#include "tools/part_load.h"

namespace calot {

struct ToolLoad {
  Vec3 force = Vec3::Zero();   ///< N, of all parts
  Vec3 moment = Vec3::Zero();  ///< N m, about the trocar
  int touches = 0;             ///< of all parts
  std::string organ;           ///< the first organ, else tissue, that touches it, or empty
  PartLoads parts;             ///< by ToolPart
  std::array<Vec3, 2> on_jaws{Vec3::Zero(), Vec3::Zero()};  ///< N, of each jaw
};
std::vector<ToolLoad> tool_loads(const Field& field);

/// Adds a force (N) at a point (m) to what a tool's parts carry: to its shaft, or to its jaws and, near the `tip` (m), to
/// that. `touches`: the point counts, with its organ.
void add_load(const Tool& tool, const Vec3& tip, bool on_shaft, const Vec3& at, const Vec3& force,
              bool touches, const std::string& organ, PartLoads& parts);

/// Fails (scenario) when a tool starts inside an organ or among strands.
Result<bool> check_clear(const Field& field);

/// Whether no organ and no strand is met by a tool where it is.
bool touches_nothing(const Field& field, ToolIndex instrument);

/// Deepest point of any skin inside a tool as it is made, m, on the skin's triangles split into four along each edge.
double deepest_penetration(const Field& field, const Tool& tool);
double deepest_penetration(const Field& field);  ///< inside any

}  // namespace calot
