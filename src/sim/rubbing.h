#pragma once
// Where skin sticks to tools and to what carries the organs, from one equilibrium to the next.
//
// Each skin point that touches a shape with friction has an anchor that the shape carries along (StickSlip).
// It is made where the point was, beside the shape, at the equilibrium before the one in which they touch; it
// stays while the point sticks, so that nothing creeps however many equilibria follow, and slides along when
// Coulomb's limit is passed. Normal forces are lagged: an equilibrium is sought with those of the last, again
// with those found, and so on until they agree.

#include "sim/field.h"

namespace calot {

/// Tangential stiffness of a sticking area, Pa/m: at 5 kPa of shear it gives by 20 um, several times less
/// than shear through a wall of 2 mm and 100 kPa does, which the shell leaves out. A pressure, so that what
/// sticks does not depend on how many points stand for an area (d).
inline constexpr double stick_stiffness = 2.5e8;

/// Normal forces agree when they changed, summed over all points as vectors, by less than this share of their
/// sum in the last round.
inline constexpr double friction_tolerance = 1e-3;
/// Not agreed after these rounds, the motion is tried in smaller parts.
inline constexpr int friction_rounds = 15;

/// Whether anything rubs at all: else nothing of this costs anything.
bool has_friction(const Field& field);

/// The organ's rubbing points, as they were at the last equilibrium, for the tools at `poses`. What a tool
/// grips does not rub on it as well.
FrictionLoad friction_load(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses);

/// Replaces around.friction by what rubs at the organ's present state with its present normal forces; points
/// that did not rub at the last equilibrium have their anchors where they were at `before`, tools as
/// field.tools stand. The share by which normal forces changed, 0 when nothing rubs.
double renew_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                      const VecX& before, Surroundings& around);

/// Keeps a new equilibrium's rubbing points, anchors slid along where they slipped.
void keep_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                   const FrictionLoad& friction);

}  // namespace calot
