#pragma once
// The paper's structural extensions (section 5.2): details of the finer levels around each place where an instrument
// comes near an organ. They are laid before it touches and taken away after it has left, so that the skin does not
// jump; while it slides they follow.

#include <string>
#include <vector>

#include "field/field.h"

namespace calot {

/// Details that each level adds to an extension: those nearest to its centre (the paper: P0 and P1', P2', P3' and
/// their neighbours).
inline constexpr int details_per_level = 12;
/// A shape that comes nearer than this gets its extension; one that goes further than the second loses it, m.
inline constexpr double extension_ahead = 3.0e-3, extension_behind = 5.0e-3;

/// Details of every level around the centres: odd nodes, increasing.
std::vector<int> details_around(const ShellBody& body, const std::vector<Extension>& extensions);

/// Lays, moves and takes away the organ's extensions for the tools where they stand, and brings it to rest again: what
/// is new begins held and what is left out goes when it has faded (detail_fading.h).
/// Where the organ finds no rest with other details it keeps those that it has, which the statistics count.
void follow_contacts(Field& field, Organ& organ, SolveStatistics& statistics);

}  // namespace calot
