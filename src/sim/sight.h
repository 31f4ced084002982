#pragma once
// What a laparoscope sees of the field.

#include <array>

#include "sim/laparoscope.h"

namespace calot {

struct Field;

/// How much of a triangle is seen from a lens whose round field is `field_of_view` rad across, m^2, across the line of
/// sight: a triangle seen from its edge is none. Rays go to 64 places on it; what stands before one within the last
/// `margin` m does not hide it (what the triangle is stretched between).
double seen_area(const Field& field, const LaparoscopePose& lens, double field_of_view,
                 const std::array<Vec3, 3>& corners, double margin);

}  // namespace calot
