#pragma once
// A solid's reduction, kept from one start of the program to the next: it hangs on nothing but the solid at rest, and is
// half of the time to set up a field with a lobe.

#include <optional>
#include <string_view>

#include "base/kept_results.h"
#include "fem/solid_reduction.h"

namespace calot {

/// As reduce(): the one that was kept of this solid, bit for bit, else a new one, which is kept. `kept` null: a new one.
Result<ReducedSolid> kept_or_reduced(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid,
                                     KeptResults* kept);

/// A digest of all that reduce() is a function of: 64 hexadecimal digits.
std::string reduction_key(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid);

/// Every number by its bits.
std::string to_bytes(const ReducedSolid& reduced);
/// None where they are none of a solid of so many kept nodes.
std::optional<ReducedSolid> reduced_solid_of(std::string_view bytes, int nodes);

}  // namespace calot
