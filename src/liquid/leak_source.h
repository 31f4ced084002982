#pragma once
// What drives liquid out of an opening, and how wide its way there is (leak.h has the laws).

#include "body/rod_body.h"
#include "field/field.h"
#include "liquid/outflow.h"

namespace calot {

inline constexpr double blood_density = 1060;  ///< kg/m^3

/// What drives the liquid out of an opening.
struct LeakSource {
  enum class Kind { organ, patient, rest } kind = Kind::rest;
  OrganIndex organ;  ///< whose filling it is
  TubeFeed feed;     ///< of the patient
  double area = 0;   ///< m^2, smallest on the way
};
/// Follows the tubes that an opening of an organ is fed by, joint by joint, to what feeds them.
LeakSource source_of(const Field& field, OrganIndex organ, const Opening& opening);

/// What an organ holds: a tube what it carries, all else bile.
Carries liquid_of(const Organ& organ);

/// Cross-section of a tube's lumen at rest, m^2, at a place: skin points from its start.
double lumen_area(const RodBody& rod, double at);
/// What a tube holds at rest, m^3.
double lumen_volume(const RodBody& rod);

/// As its definition has it; else what it carries, and of an artery its width, say.
TubeFeed feed_of(const OrganDefinition& tube);

/// m^2, what a tube leaves open at its tightest between two of its places (skin points from its start): its lumen, or less
/// where clips and jaws are on it.
double open_between(const Field& field, OrganIndex organ, double one, double other);

}  // namespace calot
