#pragma once
// What an instructor calls it when what should be kept is hurt: by the organ's InjuryDefinition, the place, and what
// else of the field has been hurt.

#include "field/field.h"

namespace calot {

/// A tube is divided or closed at a place (skin points from its start): what `usual`, one of its injury's `cut` and
/// `closed`, is called there and now. Empty: it is no injury.
std::string injury_at(const Field& field, const Organ& tube, const std::string& usual, double at);
/// The same wherever it is: of `unclipped`.
std::string injury_anywhere(const Field& field, const Organ& organ, const std::string& usual);

}  // namespace calot
