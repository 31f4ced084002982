#pragma once
// Where an organ's skin is felt: at the points that are drawn and, between them, in the middles of the drawn
// triangles' edges. So contact is with what is drawn, and sinks in between half as far apart: a quarter as deep.

#include <array>
#include <functional>
#include <vector>

#include "geometry/stencil.h"

namespace calot {

/// Contact points: first the skin's, with the same numbers, then one a `middles`.
struct ContactPoints {
  std::vector<std::array<int, 2>> middles;  ///< the two skin points that each lies between
  std::vector<int> face;                    ///< control face that each contact point is counted with
  std::vector<double> areas;                ///< of the skin that each stands for, m^2: together all of it
};

/// Of a skin that splits each of `faces` control faces evenly, points at `rest`, m.
ContactPoints contact_points(const Tessellation& skin, int faces, const std::vector<Vec3>& rest);

/// Rows (positions only) of all contact points, from those of the skin's points.
StencilTable contact_stencils(const ContactPoints& points, const StencilTable& skin);
/// The same where only rows on faces that `reached` picks differ from `before`.
StencilTable contact_stencils(const ContactPoints& points, const StencilTable& skin,
                              const StencilTable& before, const std::function<bool(int face)>& reached);

}  // namespace calot
