#pragma once
// Where skin sticks to tools and to what carries the organs, from one equilibrium to the next.
//
// Each skin point that touches a shape with friction has an anchor that the shape carries along (StickSlip).
// It is made where the point was, beside the shape, at the equilibrium before the one in which they touch; it
// stays while the point sticks, so that nothing creeps however many equilibria follow, and slides along when
// Coulomb's limit is passed. Normal forces are lagged: an equilibrium is sought with those of the last, again
// with those found, and so on until they agree.

#include "field/field.h"

namespace calot {

/// Tangential stiffness of a sticking area, Pa/m: at 20 kPa of shear it gives by 20 um, several times less
/// than shear through a wall of 2 mm and 100 kPa does, which the shell leaves out. Contact is thin, so a rounded edge
/// presses by tens of kPa: a softer hold would give by more than points slide before they leave it. A pressure, so that
/// what sticks does not depend on how many points stand for an area (d).
inline constexpr double stick_stiffness = 1e9;

/// Normal forces agree when they changed, summed over all points as vectors, by less than this share of their
/// sum in the last round; a sum of friction's limits below `least_friction` (N) is taken for that.
inline constexpr double friction_tolerance = 1e-3;
inline constexpr double least_friction = 0.05;
/// From the round `relaxed_round` on limits go half the way only: points that come and go settle then.
inline constexpr int relaxed_round = 4;
/// Not agreed after these rounds, the motion is tried in smaller parts.
inline constexpr int friction_rounds = 15;

/// Whether anything rubs at all: else nothing of this costs anything.
bool has_friction(const Field& field);

/// The organ's rubbing points of the last equilibrium, their anchors and normals carried along to the tools' `poses`. Jaws
/// that hold a part of the organ are left out: there the grip's own limit counts (holding_limit() in acts/grip_slip.h).
/// Teeth rub by pad_friction on what they do not sink into (teeth.h).
FrictionLoad friction_load(const Field& field, const Organ& organ, const std::vector<InstrumentPose>& poses);

/// Replaces around.friction by what rubs at the organ's present state with its present normal forces; points
/// that did not rub at the last equilibrium have their anchors where they were at `before`, tools as
/// field.tools stand. Limits change by `share` (1: wholly) of what their normal forces ask for. Returns the
/// change asked for, as friction_tolerance judges it.
double renew_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                      const VecX& before, double share, ContactLoads& around);

/// Keeps a new equilibrium's rubbing points, anchors slid along where they slipped.
void keep_friction(const Field& field, Organ& organ, const std::vector<InstrumentPose>& poses,
                   const FrictionLoad& friction);

}  // namespace calot
