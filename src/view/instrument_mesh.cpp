#include "view/instrument_mesh.h"

#include "view/electrode_mesh.h"
#include "view/grasper_mesh.h"
#include "view/hook_mesh.h"
#include "view/jaw_meshes.h"
#include "view/needle_mesh.h"
#include "view/semm_mesh.h"
#include "view/surfaces.h"

namespace calot {

InstrumentModel instrument_model(InstrumentType type) {
  const InstrumentGeometry geometry = instrument_geometry(type);
  switch (type) {
    case InstrumentType::bipolar_electrode:
      return electrode_model(geometry);
    case InstrumentType::semm_forceps:
      return semm_model(geometry);
    case InstrumentType::atraumatic_grasper:
      return grasper_model(geometry);
    case InstrumentType::maryland_dissector:
      return dissector_model(geometry);
    case InstrumentType::l_hook:
      return hook_model(geometry);
    case InstrumentType::scissors:
      return scissors_model(geometry);
    case InstrumentType::clip_applier:
      return applier_model(geometry);
    case InstrumentType::aspiration_needle:
      return needle_model(geometry);
  }
  return {};
}

std::vector<SceneMesh> posed(const InstrumentModel& model, const Vec3& trocar, const InstrumentPose& pose) {
  const auto moved = [](SceneMesh mesh, const Pose& motion) {
    move(mesh, motion);
    return mesh;
  };
  const Pose hinge = hinge_frame(trocar, pose, model.geometry);
  SceneMesh steel = moved(model.shaft.steel, hinge), insulation = moved(model.shaft.insulation, hinge);
  for (int jaw = 0; jaw < 2; ++jaw) {
    const InstrumentPart& part = model.jaws[static_cast<std::size_t>(jaw)];
    const Pose frame = jaw_frame(trocar, pose, model.geometry, jaw);
    append(steel, moved(part.steel, frame));
    append(insulation, moved(part.insulation, frame));
  }
  return {std::move(steel), std::move(insulation)};
}

}  // namespace calot
