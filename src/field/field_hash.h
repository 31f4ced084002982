#pragma once
// A field's state in one number, by every bit that later steps depend on.

#include <cstdint>

#include "field/field.h"

namespace calot {

/// Of a factor, which later steps begin with, only what it makes of the constraints' gradients.
std::uint64_t hash_of(const Field& field);

}  // namespace calot
