#pragma once
// Where a straight line goes through a triangle.

#include <optional>

#include "geometry/types.h"

namespace calot {

/// How many times `way` from `from` the line meets a triangle, by Moeller and Trumbore 1997; none: it goes past it, or
/// lies in its plane.
inline std::optional<double> met_at(const std::array<Vec3, 3>& t, const Vec3& from, const Vec3& way) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], p = way.cross(ac);
  const double volume = ab.dot(p);
  if (volume == 0) return std::nullopt;
  const Vec3 there = from - t[0], q = there.cross(ab);
  const double b = there.dot(p) / volume, c = way.dot(q) / volume;
  if (!(b >= 0 && c >= 0 && b + c <= 1)) return std::nullopt;
  return ac.dot(q) / volume;
}

}  // namespace calot
