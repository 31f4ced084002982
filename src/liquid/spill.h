#pragma once
// What has left the organs or an instrument, on its way and where it lies: clips that fell, drops that fall, and a film on skins and on the ground that
// runs down and gathers in the lowest places.
//
// A drop falls freely from its opening until it meets the skin of an organ or the ground (tubes let it pass: it would
// run off them); there it spreads to a film. The film has a volume at each point of the surface. By points it flows to
// where it stands lower, as fast as a liquid sheet of its thickness runs (rho g h^2 / 3 mu), but for what sticks to the
// surface, and it wets a dry point only once it stands high enough. Where it hangs it drops off, and
// drips where it is too thick to hang.
// Nothing of this acts on the organs. A film that lies still is not looked at again until more lands on it or what
// carries it moves.

#include "field/field.h"

namespace calot {

/// Moves all of it on by `duration` s, and makes drops of what hangs on openings. Returns how often it looked at what a
/// film does in a part of the step: never at films that lie still.
int spill(Field& field, double duration);

}  // namespace calot
