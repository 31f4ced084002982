#pragma once
// Where the strands of a tissue begin and end: evenly over the part of one organ's surface that faces another near by.

#include "anatomy/definitions.h"
#include "joins/skin_place.h"
#include "organs/organ.h"

namespace calot {

struct StrandPlace {
  CarriedPlace one, other;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< m, on the skins
  double gap = 0;                               ///< m, between the surfaces
  double way = 0;                               ///< m, between the places: longer by what lies within rods
  double area = 0;                              ///< m^2 of the first one's rest surface that it stands for
};

/// Where a place on an organ lies at rest, as a share of its way: a tube's length, else from its neck to its fundus.
double share_along(const Organ& organ, const CarriedPlace& place);

/// As many as the definition asks for, or as the place has room for. Fails (scenario), with a path from the tissue,
/// where the two surfaces are nowhere nearer than definition.within.
Result<std::vector<StrandPlace>> strand_places(const TissueDefinition& definition, const Organ& one,
                                               const Organ& other);

}  // namespace calot
