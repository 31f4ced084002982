#pragma once
// How the organs of a scene come to rest together.

#include "base/kept_results.h"
#include "field/field.h"

namespace calot {

/// Hollow organs have come to rest alone: what is tied to them, or has no rest of its own, moves them on. Without
/// friction, whose anchors belong to shapes that the tools' will come before. The field has no tools yet. `kept` as of
/// World::create. Fails (scenario, at the organ) where no rest is found: where masses count, neither at once
/// nor by falling; simulation where a value is not finite.
Result<bool> come_to_rest(const SceneDefinition& scene, Field& field, KeptResults* kept);

}  // namespace calot
