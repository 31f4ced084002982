#include <algorithm>
#include <utility>

#include "anatomy/organ_frame.h"
#include "view/build_scene.h"
#include "view/surroundings.h"

namespace calot {
namespace {

/// The wall stands around the place below the organs where the ground is.
Vec3 foot_of(const AnatomyDefinition& anatomy, const Vec3& about) {
  const auto below = [&](const Vec3& point, const Vec3& normal) {
    const Vec3 n = normal.normalized();
    return Vec3(about - n * n.dot(about - point));
  };
  if (anatomy.support) return below(anatomy.support->point, anatomy.support->normal);
  const GroundDefinition& ground = anatomy.ground.front();
  return ground.type == GroundType::plane ? below(ground.point, ground.normal) : about;
}

/// It is the liver that is seen.
bool is_lobe(const OrganDefinition& organ) { return std::holds_alternative<LobeShape>(organ.shape); }

/// Where there is a lobe, what stays is usually bowel's peritoneum; else it stands for the liver.
Material material_of(const GroundDefinition& ground, bool lobe) {
  switch (ground.looks) {
    case GroundLooks::liver:
      return Material::capsule;
    case GroundLooks::bowel:
      return Material::bowel;
    case GroundLooks::fat:
      return Material::fat;
    case GroundLooks::peritoneum:
      return Material::peritoneum;
    case GroundLooks::board:
      return Material::board;
    case GroundLooks::plastic:
      return Material::plastic;
    case GroundLooks::usual:
      return lobe || ground.type == GroundType::plane ? Material::peritoneum : Material::liver;
  }
  return Material::peritoneum;
}

}  // namespace

std::vector<SceneMesh> still_meshes(const SceneDefinition& scene) {
  std::vector<SceneMesh> meshes;
  const auto add = [&](std::vector<SceneMesh> more) {
    for (SceneMesh& mesh : more) meshes.push_back(std::move(mesh));
  };
  const AnatomyDefinition& anatomy = scene.anatomy;
  if (anatomy.organs.empty()) return meshes;
  const auto hollow = std::find_if(anatomy.organs.begin(), anatomy.organs.end(),
                                   [](const OrganDefinition& organ) { return is_hollow(organ.shape); });
  const Vec3 about =
      organ_frame(hollow != anatomy.organs.end() ? *hollow : anatomy.organs.front()).translation();
  const bool liver = std::any_of(anatomy.organs.begin(), anatomy.organs.end(), is_lobe);
  for (const GroundDefinition& ground : anatomy.ground)
    meshes.push_back(ground_mesh(ground, about, material_of(ground, liver)));
  if (anatomy.support)
    meshes.push_back(
        plane_mesh(anatomy.support->point, anatomy.support->normal, about, Material::peritoneum));
  if (meshes.empty() && hollow != anatomy.organs.end()) {
    if (!liver) meshes.push_back(liver_mesh(*hollow));
    add(abdomen_meshes(*hollow));
  } else {
    const bool box = std::any_of(anatomy.ground.begin(), anatomy.ground.end(), [](const GroundDefinition& g) {
      return g.looks == GroundLooks::board || g.looks == GroundLooks::plastic;
    });
    meshes.push_back(cavity_wall(meshes.empty() ? about : foot_of(anatomy, about),
                                 box ? Material::board : Material::peritoneum));
  }
  return meshes;
}

}  // namespace calot
