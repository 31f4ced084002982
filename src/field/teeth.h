#pragma once
// Where jaws have teeth, and what for.

#include "field/field.h"

namespace calot {

/// Whether a tool's pads hold by friction.
bool has_teeth(const Tool& tool);
/// Whether teeth sink into an organ, and so take its skin along (grip.h); they rub on what is hard.
bool is_bitten(const Organ& organ);

/// Whether a place in a jaw's frame lies before its pad, however far away.
bool before_pad(const Vec3& local, const InstrumentGeometry& geometry);

/// Share of its teeth that a jaw rubs with where it is touched at such a place with such a normal, out of the jaw, in the
/// jaw's frame: all before the pad's middle, none beside it or where its edge faces aside; continuous, as friction could
/// not agree with what presses where it jumped.
double teeth_share(const Vec3& local, const Vec3& normal, const InstrumentGeometry& geometry);

}  // namespace calot
