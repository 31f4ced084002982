#include "world/definition_digest.h"

#include "anatomy/definition_members.h"
#include "base/digest.h"

namespace calot {

std::string rest_key(const SceneDefinition& scene, const Field& field) {
  Digest digest;
  MemberWriter put{digest};
  put(std::string("rest state"), scene.anatomy, scene.solver);
  for (const Organ& organ : field.organs)
    put(organ.body->rest(), organ.body->skin().triangles, organ.body->skin_rest(), organ.state.x,
        organ.state.datum_pressure, organ.state.volume);
  for (const Tissue& tissue : field.tissues) put(tissue.body->rest(), tissue.now.state.x, tissue.now.opened);
  return digest.hex();
}

}  // namespace calot
