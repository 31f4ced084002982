#pragma once
// The loose tissue of a plane between two organs: thin fibres from wall to wall, wavy while they are slack, straight and
// whiter the more they are stretched. Of a torn strand a fuzz is left on both walls.

#include "organs/tissue.h"
#include "render/scene.h"
#include "view/coarse_mesh.h"

namespace calot {

/// Meshes of Material::areolar and Material::cobweb.
struct AreolarMeshes {
  SceneMesh fibres, films;
};

/// Adds the fibres of a tissue and the films between them. `first_strand`: how many strands other tissues have, so that no
/// two look the same. Coarse: fewer fibres, of fewer pieces each, and neither links nor drops.
void add_areolar(const Tissue& tissue, const std::vector<Organ>& organs, std::size_t first_strand,
                 SceneDetail detail, AreolarMeshes& out);

}  // namespace calot
