#pragma once
// What a needle draws out of a hollow organ: bile, until the wall is slack.
//
// A needle that draws, with its tip pushed on the wall of what holds a liquid, goes through it. Its sharp end then
// counts as inside for as long as it draws and stands within its depth of where it went in; what touches stays outside
// and still presses on the wall. What it leaves is a pinhole, which is plugged while it is in.
//
// The bore draws by Hagen and Poiseuille, and by Torricelli at its mouth: with p the pressure inside, there, and p_s the
// suction's, both over the pressure outside, p - p_s = R Q + rho / 2 (Q / (Cd A))^2, R = 128 mu L / (pi d^4). But no
// suction makes a slack wall give more than its own pressure drives into the mouth: below the pressure outside the wall
// is drawn over it and shuts it (a Starling resistor). So Q is at most Cd A sqrt(2 p / rho), and ends at p = 0.

#include "field/field.h"

namespace calot {

/// m, from where it went in to the tip (d): so far its sharp end reaches beyond what touches.
inline constexpr double needle_depth = 10e-3;
inline constexpr double bile_viscosity = 1.5e-3;  ///< Pa s (c)

/// Of a round bore, Pa s/m^3.
double bore_resistance(double bore, double length, double viscosity);

/// m^3 that a needle draws out of an elastic organ in `time` s: `pressure` (Pa) at its mouth at the beginning,
/// `compliance` in m^3/Pa (0: the pressure stays). Of the second order in the time.
double drawn_by(const InstrumentDefinition& needle, double pressure, double compliance, double density,
                double time);

/// The organ that a tool is in; none: it is in none.
std::optional<OrganIndex> punctured_organ(const Field& field, const Tool& tool);

/// Lets needles in and out by what they are asked to do, where they are now. Adds the events puncture, aspirated and
/// empty_aspiration.
void puncture(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events);

}  // namespace calot
