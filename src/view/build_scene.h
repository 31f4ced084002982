#pragma once

#include <optional>
#include <vector>

#include "render/scene.h"
#include "view/coarse_mesh.h"
#include "view/instrument_parts.h"
#include "view/jaw_mould.h"
#include "world/world.h"

namespace calot {

/// What the laparoscope would see. Keeps what does not change from step to step; build one for a world.
class SceneBuilder {
 public:
  explicit SceneBuilder(const World& world, SceneDetail detail = SceneDetail::full);
  /// To be told of every step, drawn or not: a picture shows something of the way to it (view/jaw_mould.h).
  void follow(const World& world) { moulds_.follow(world); }
  /// The picture of the world's present state. The laparoscope is where it was moved to, else where it stood at rest: a
  /// camera held still, not one glued to the moving organ.
  Scene build(const World& world) const;

 private:
  SceneDetail detail_;
  std::vector<SceneMesh> still_;  // liver and surroundings, or the support
  /// All that does not move of an organ: material, rest positions, triangles, vessels.
  static SceneMesh organ_mesh(const World& world, OrganIndex organ);
  struct OrganMesh {
    SceneMesh mesh;
    std::optional<std::vector<int>> kept;  // of its skin's points; none: it has them all
  };
  // Of the scene's own.
  std::vector<OrganMesh> organs_;
  std::vector<InstrumentModel> instruments_;
  JawMoulds moulds_;
};

/// A builder used once.
Scene build_scene(const World& world);

/// What stands still around a scene's organs.
std::vector<SceneMesh> still_meshes(const SceneDefinition& scene);

}  // namespace calot
