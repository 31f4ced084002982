#pragma once
// The table that scene(p) returns, as definitions.

#include <filesystem>

#include "anatomy/definitions.h"
#include "anatomy/field_check.h"
#include "script/value.h"

namespace calot {

/// Where a scenario's mesh files may lie: its own folder first, then the project's assets.
struct MeshFolders {
  std::filesystem::path scenario, assets;
};

/// What is unfit becomes problems below "scene" and keeps its default. Limits are left to validate().
SceneDefinition read_scene(FieldCheck& check, const Value& scene, const MeshFolders& folders);

/// One organ as a list of the anatomy has it, at `path`; a shape of a mesh file is sought in these folders.
OrganDefinition read_organ(FieldCheck& check, const Value& organ, const std::string& path,
                           const MeshFolders& folders);

}  // namespace calot
