#pragma once
// Areas of a wall.

#include "fem/shell.h"

namespace calot::test {

/// m^2.
inline double rest_area(const Shell& shell) {
  double sum = 0;
  for (double area : shell.point_areas()) sum += area;
  return sum;
}

}  // namespace calot::test
