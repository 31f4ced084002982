#pragma once
// The pads of an instrument's jaws: what they press on, and what they hold by friction alone.
//
// Closing jaws stop where what is between them carries their pinch, and turn as that gives way or pushes them open
// (close_within_pinch.h), whatever it is that carries it. What both pads press on then is held as far as friction goes:
// of a wedge of half-angle a, pressed by N of each pad, a pull of 2 N (friction cos a - sin a), and nothing where
// tan a >= friction. Teeth sink into walls and ducts and take their skin along (grip.h), which slides beyond that limit
// (grip_slip.h); on what is hard they rub (rubbing.h).

#include <array>
#include <optional>

#include "field/field.h"

namespace calot {

/// Share of its pinch by which what presses on jaws that tissue has stopped may be off: so is what they hold. Felt
/// weights differ by a tenth.
inline constexpr double pinch_tolerance = 0.02;

/// N, by which all that touches a tool's jaws presses them apart, each across its pad: the mean of both, as one hand
/// closes both.
double pressed_apart(const Field& field, ToolIndex instrument);

/// What both pads press on that their teeth do not sink into.
struct Clasped {
  OrganIndex organ;
  std::array<double, 2> pressed{};  ///< N, of each pad across itself
  std::array<double, 2> area{};     ///< m^2, of the skin that touches each
  std::array<Vec3, 2> along{Vec3::Zero(),
                            Vec3::Zero()};  ///< N, of the skin on each pad, by friction; patient's frame
};
/// The first organ between a tool's pads that both press on; none: what is there is held by one at most.
std::optional<Clasped> clasped(const Field& field, ToolIndex instrument);

/// Pa, mean, of the pads on what they hold: their pinch on its area; 0: they hold nothing that has one.
double pad_pressure(const Field& field, ToolIndex instrument);

/// Name of the organ of which a tool's pads hold something between them, by their teeth or by friction alone; empty:
/// none.
std::string between_pads(const Field& field, ToolIndex instrument);

}  // namespace calot
