#pragma once
// A scene as the arrays that the graphics library draws.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/lens.h"
#include "render/scene.h"

namespace calot {

/// A run of indices with one material.
struct ScenePart {
  Material material = Material::gallbladder;
  std::size_t first = 0, count = 0;
  std::shared_ptr<const VesselMap> vessels;
};

inline constexpr std::size_t floats_each = 10;  ///< of a point

struct SceneArrays {
  std::vector<float> vertices;         ///< place relative to the camera, normal, rest position, share burnt
  std::vector<std::uint32_t> indices;  ///< triangles
  ScenePart mask;                      ///< its points are in clip space already
  std::vector<ScenePart> parts;        ///< one a mesh
};

/// Why a scene cannot be drawn (arrays that do not fit each other, numbers that are not finite); empty when
/// it can.
std::string scene_problem(const Scene& scene);

/// The mask is a ring just in front of the lens over what the round field never shows: nothing is shaded
/// there.
SceneArrays scene_arrays(const Scene& scene, const Lens& lens, int width, int height);

}  // namespace calot
