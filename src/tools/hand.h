#pragma once
// The hand that holds an instrument: a spring from the commanded pose to the tool's own that gives way at the hand's
// strength, and the same for the jaws. Stiff where little acts, so that a tool is where it is commanded to be; beyond, the
// tool stays behind its command, and what stops it feels no more than the hand can do.
//
// Each spring has the energy F s (sqrt(1 + |u|^2 / s^2) - 1), s = F / stiffness: convex, smooth, F at most.
//   - the tip's way from where it is commanded, in all three directions together, to first order about the command;
//   - roll;
//   - the jaws' angle, as the gap between the pads at pad_lever from the hinge.
// Jaws have stops beside: they neither pass through each other nor open further than they are made to.

#include "tools/posed_part.h"

namespace calot {

/// Force and pinch are those of an instrument's definition; the others are uncalibrated.
struct HandStrength {
  double stiffness = 60e3;  ///< N/m at the tip and between the pads: 1 N moves a tip by 0.017 mm
  double force = InstrumentDefinition().hand_force;  ///< N, at the tip, whatever its direction
  double roll_arm =
      roll_lever;  ///< m, at which the same stiffness and force act about the shaft: 0.2 N m at most
  double pinch = InstrumentDefinition().pinch_force;  ///< N, of each pad
  double pad_lever = 10e-3;                           ///< m from the hinge, where that is
};
/// Of the tool's definition, its pinch in the middle of its pads.
HandStrength hand_of(const Tool& tool);

class Hand {
 public:
  Hand(const Tool& tool, const InstrumentPose& command, const HandStrength& strength);

  const InstrumentPose& command() const { return command_; }
  /// What the tool lags behind its command, as unknowns (m).
  ToolVector lag(const ToolVector& q) const { return q - goal_; }

  struct Sample {
    double energy = 0;                         ///< J
    ToolVector gradient = ToolVector::Zero();  ///< N, by the unknowns: minus what the hand does
    ToolMatrix hessian = ToolMatrix::Zero();   ///< N/m, positive semidefinite
  };
  Sample sample(const ToolVector& q) const;

  /// What the hand does there: never more than its strength.
  struct Effort {
    double tip = 0;    ///< N
    double roll = 0;   ///< N m, about the shaft, towards the command
    double pinch = 0;  ///< N, of each pad, closing
  };
  Effort effort(const ToolVector& q) const;

 private:
  InstrumentPose command_;
  HandStrength strength_;
  ToolVector goal_;
  Vec3 tip_ways_;  ///< of the tip by the first three unknowns, each across the others
  double gap_;     ///< between the pads, by the jaw's unknown
  bool has_jaws_;
  double open_;  ///< the jaw's unknown, fully open, m
};

}  // namespace calot
