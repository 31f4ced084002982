#pragma once
// Where a laparoscope is, and what it sees.

#include <array>

#include "anatomy/definitions.h"

namespace calot {

struct Field;

struct LaparoscopePose {
  Vec3 position = Vec3::Zero();                        ///< m, of the lens
  Vec3 direction = Vec3::UnitY(), up = Vec3::UnitZ();  ///< unit
};
/// Of a laparoscope through `port` that looks at `target` from `distance`. An angled optic looks down (posteriorly) from its
/// shaft by `angle`, in the vertical plane through port and target, so the shaft runs above the line of sight; the horizon is
/// level (screen up is as much +z as it can be, screen right is the patient's left). Where the port is too near for that
/// (within about `distance`), the tip lies on the line through port and target, at `distance`, with the optic's angle left
/// out.
LaparoscopePose laparoscope_pose(const LaparoscopeDefinition& scope, const Vec3& port, const Vec3& target);

/// How much of a triangle is seen from `eye`, m^2, across the line of sight: a triangle seen from its edge is none. Rays go to
/// 64 places on it; what stands before one within the last `margin` m does not hide it (what the triangle is stretched
/// between).
double seen_area(const Field& field, const Vec3& eye, const std::array<Vec3, 3>& corners, double margin);

}  // namespace calot
