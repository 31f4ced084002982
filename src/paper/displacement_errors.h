#pragma once
// How far one body's displacements are from another's, as the comparison states it.

#include <vector>

#include "geometry/types.h"

namespace calot {

/// Points nearer than this to a loaded place count as near it, m.
inline constexpr double near_contact = 10e-3;

/// Length of the largest.
double largest_of(const std::vector<Vec3>& displacements);

/// Distances from the reference's displacements, in % of its largest: in the mean, in the mean of the points near a
/// contact (0 where there is none), at most.
struct DisplacementErrors {
  double mean_pct = 0, contact_pct = 0, max_pct = 0;
};
/// `near`: of each point.
DisplacementErrors displacement_errors(const std::vector<Vec3>& displacements,
                                       const std::vector<Vec3>& reference, const std::vector<bool>& near);

}  // namespace calot
