#pragma once
// Pins that mark places in a picture.

#include <vector>

#include "render/scene.h"

namespace calot {

/// A pin at each place, m, that stands out towards an eye, m, to half of the way: its head is seen whatever is around the
/// place.
std::vector<SceneMesh> pin_meshes(const std::vector<Vec3>& places, const Vec3& eye);

}  // namespace calot
