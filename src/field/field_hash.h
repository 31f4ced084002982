#pragma once
// A field's state in one number, by every bit that later steps depend on.

#include <cstdint>

#include "field/field.h"

namespace calot {

/// Of all that its bytes have (field_bytes.h) but the roll's history; after keep_members().
std::uint64_t hash_of(const Field& field);

}  // namespace calot
