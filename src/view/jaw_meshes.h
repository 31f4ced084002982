#pragma once
// Instruments whose jaws are solid steel, as they are drawn. Nothing drawn lies outside instrument_shapes().

#include <vector>

#include "render/scene.h"
#include "sim/instrument.h"

namespace calot {

/// Slim jaws that taper and bow to one side, ribbed where they meet.
std::vector<SceneMesh> dissector_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                        const InstrumentGeometry& geometry);
/// Two blades that meet in an edge.
std::vector<SceneMesh> scissors_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                       const InstrumentGeometry& geometry);
/// Two straight jaws with a groove that a clip's leg lies in.
std::vector<SceneMesh> applier_meshes(const Vec3& trocar, const InstrumentPose& pose,
                                      const InstrumentGeometry& geometry);

}  // namespace calot
