#include "geometry/winding.h"

#include <cmath>
#include <numbers>

namespace calot {

/// The sum of the solid angles under which the triangles are seen (van Oosterom and Strackee 1983).
double winding_number(const Vec3& p, const std::vector<Vec3>& points,
                      const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) {
    const Vec3 a = points[t[0]] - p, b = points[t[1]] - p, c = points[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double across = a.dot(b.cross(c));
    const double along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    sum += std::atan2(across, along);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace calot
