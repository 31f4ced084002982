#pragma once
// Hands that give way: from where tools are commanded to be to where they come in a step, before the organs answer.
//
// A hand brings its tool to the command as long as the tissue presses the tip by less than the hand's strength
// (InstrumentDefinition::hand_force, N). Beyond it the tip gives way along the force, so that the force stays at the
// strength. How far it has to give way follows from how the force grew with the way in the last step (N/m, a secant): after
// a step of motion the force may be off by as much as that secant is.
// In the same way a hand turns its tool about the shaft up to a torque of its strength times HandStrength::roll_arm, N m.
// Tools that meet press on each other by the contact barrier (tool_meeting.h) against the springs of their hands (hand.h),
// solved together: each gives way until both hands carry the force. Ground stops a tool in the same way
// (ground_meeting.h). What touches neither comes exactly to where its hand takes it.

#include "field/field.h"

namespace calot {

/// The force at the tip (N) of the same moment about the trocar as a load's; zero for a tip in its trocar, but along the
/// shaft.
Vec3 force_at_tip(const Tool& tool, const Vec3& force, const Vec3& moment);

/// Where tools come by the end of a step, one a tool, as commands and last states are. Waiting tools stay. Keeps each
/// tool's command and what other tools and ground press it with. Where tools that meet find no balance they come a part of
/// their way, or stay.
std::vector<InstrumentPose> bring_tools(Field& field, const std::vector<InstrumentPose>& commands,
                                        const std::vector<InstrumentState>& last);

/// Sets each tool's drag: what its port's seal drags at it after a step of `duration` s. `before`: the states at the step's
/// begin, of which there may be none.
void feel_ports(std::vector<Tool>& tools, const std::vector<InstrumentState>& before, double duration);

/// Sets each tool's tissue_stiffness, stiffness_across and roll_stiffness: how the tissue's force on the tip and its torque
/// about the shaft grew in a step, for the next one. The states are those at the step's begin, if any, and end; a tip that went less than
/// 1 um, or a tool that rolled by less than 0.4 mrad, keeps what it felt before.
void feel_stiffness(std::vector<Tool>& tools, const std::vector<InstrumentState>& before,
                    const std::vector<InstrumentState>& now);

/// The name of a tool that another one is in or as near to as contact reaches, where both are; empty: none. Not of those
/// that wait.
std::string tool_met(const Field& field, ToolIndex instrument);

/// Fails (scenario) where tools that do not wait meet, or are in ground, at the start.
Result<bool> check_apart(const Field& field);

}  // namespace calot
