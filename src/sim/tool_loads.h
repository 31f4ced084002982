#pragma once
// What the tissue does to the tools where they stand, and how deep they are in it.

#include <array>
#include <string>
#include <vector>

#include "sim/field.h"

namespace calot {

/// On one part of a tool: 0 the shaft, 1 and 2 the jaws (1: the tip of a rod without jaws).
struct PartLoad {
  Vec3 contact = Vec3::Zero();  ///< N, of what presses and rubs
  Vec3 grip = Vec3::Zero();     ///< N, of what its pad holds
  double pressing = 0;          ///< N, sum of the lengths of what presses
  Vec3 place =
      Vec3::Zero();    ///< m, middle of what touches or is held; each point counts for the force it carries
  double carried = 0;  ///< N, the sum of those forces
  int touches = 0;     ///< contact points in range and skin points held
  int organ = -1;      ///< the first that touches it
};

struct ToolLoad {
  Vec3 force = Vec3::Zero();   ///< N, of all parts
  Vec3 moment = Vec3::Zero();  ///< N m, about the trocar
  int touches = 0;             ///< of all parts
  std::string organ;           ///< the first organ that touches it, or empty
  std::array<PartLoad, shapes_per_tool> parts;
};
std::vector<ToolLoad> tool_loads(const Field& field);

/// Fails (scenario) when a tool starts inside an organ.
Result<bool> check_clear(const Field& field);

/// Deepest point of any skin inside a tool as it is made, m, on the skin's triangles split into four along each edge.
double deepest_penetration(const Field& field);

}  // namespace calot
