#include <utility>

#include "anatomy/organ_frame.h"
#include "view/build_scene.h"
#include "view/surroundings.h"

namespace calot {

std::vector<SceneMesh> still_meshes(const SceneDefinition& scene) {
  std::vector<SceneMesh> meshes;
  const auto add = [&](std::vector<SceneMesh> more) {
    for (SceneMesh& mesh : more) meshes.push_back(std::move(mesh));
  };
  if (scene.anatomy.organs.empty()) return meshes;
  const OrganDefinition& organ = scene.anatomy.organs.front();
  if (scene.anatomy.support) {
    add(support_meshes(*scene.anatomy.support, organ.neck));
  } else {
    meshes.push_back(liver_mesh(organ));
    add(abdomen_meshes(organ));
  }
  return meshes;
}

}  // namespace calot
