#include "view/instrument_mesh.h"

#include "view/electrode_mesh.h"
#include "view/grasper_mesh.h"
#include "view/hook_mesh.h"
#include "view/jaw_meshes.h"
#include "view/needle_mesh.h"
#include "view/semm_mesh.h"

namespace calot {

std::vector<SceneMesh> instrument_meshes(InstrumentType type, const Vec3& trocar,
                                         const InstrumentPose& pose) {
  const InstrumentGeometry geometry = instrument_geometry(type);
  switch (type) {
    case InstrumentType::bipolar_electrode:
      return electrode_meshes(trocar, pose, geometry);
    case InstrumentType::semm_forceps:
      return semm_meshes(trocar, pose, geometry);
    case InstrumentType::atraumatic_grasper:
      return grasper_meshes(trocar, pose, geometry);
    case InstrumentType::maryland_dissector:
      return dissector_meshes(trocar, pose, geometry);
    case InstrumentType::l_hook:
      return hook_meshes(trocar, pose, geometry);
    case InstrumentType::scissors:
      return scissors_meshes(trocar, pose, geometry);
    case InstrumentType::clip_applier:
      return applier_meshes(trocar, pose, geometry);
    case InstrumentType::aspiration_needle:
      return needle_meshes(trocar, pose, geometry);
  }
  return {};
}

}  // namespace calot
