#pragma once
// Random vectors.

#include "base/rng.h"
#include "geometry/types.h"

namespace calot::test {

/// In the cube of that half edge.
inline Vec3 random_vector(Rng& rng, double reach) {
  return {rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-reach, reach)};
}

}  // namespace calot::test
