#pragma once

#include <vector>

#include "field/field.h"
#include "render/scene.h"

namespace calot {

/// The clips on a tube: two legs of wire, round at their ends, joined at the crown. None: none.
std::vector<SceneMesh> clip_meshes(const Organ& organ);

/// Those that fell, shut, flat on what they fell on.
std::vector<SceneMesh> fallen_clips(const Field& field);

/// The legs of the clip that a tool has between its jaws, which lie in their grooves; none where it carries none.
std::vector<SceneMesh> loaded_clip(const Tool& tool);

}  // namespace calot
