#pragma once
// What stands before the bytes of a world, so that none are taken for what they are not.

#include <string>
#include <string_view>

#include "anatomy/definitions.h"
#include "base/status.h"
#include "field/field.h"

namespace calot {

/// Of all of a scene and of its field as it begins at rest: what files hold that the scene only names is told by its nodes.
/// 64 hexadecimal digits.
std::string scene_digest(const SceneDefinition& scene, const Field& field);

/// `state`, of a world whose scene has this digest.
std::string with_header(const std::string& scene, const std::string& state);

struct SavedWorld {
  std::string_view scene, state;  ///< of the bytes
};
/// Fails (usage) where the bytes are no world's, another version's, cut off, longer or damaged.
Result<SavedWorld> saved_world(std::string_view bytes);

}  // namespace calot
