#include "world/sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/field.h"
#include "geometry/triangle_crossing.h"

namespace calot {

Sight::Sight(const Field& field, const Vec3& eye, const std::string& through) : eye_(eye) {
  for (const Organ& organ : field.organs) {
    if (organ.definition.name == through) continue;
    const std::vector<Vec3> places = organ.body->drawn(organ.state.x).positions;
    for (const Triangle& t : organ.body->drawn_triangles())
      triangles_.push_back({places[t[0]], places[t[1]], places[t[2]]});
  }
  for (const Tool& tool : field.tools)
    for (const Shape& shape : shapes_in_field(tool, tool.pose)) tools_.push_back(shape);
}

Sight Sight::within(const std::array<Vec3, 3>& corners) const {
  Corners sides;  // planes through the eye, normals to the inside
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3 - eye_;
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = (corners[k] - eye_).cross(corners[(k + 1) % 3] - eye_);
    sides[k] = side.dot(middle) < 0 ? Vec3(-side) : side;
  }
  Sight out = *this;
  // Not where all corners lie outside one side of what is looked through.
  std::erase_if(out.triangles_, [&](const Corners& t) {
    return std::any_of(sides.begin(), sides.end(), [&](const Vec3& side) {
      return std::all_of(t.begin(), t.end(), [&](const Vec3& p) { return side.dot(p - eye_) < 0; });
    });
  });
  return out;
}

bool Sight::sees(const Vec3& place, double margin) const {
  const Vec3 way = place - eye_;
  const double length = way.norm() - margin;
  if (!(length > 0)) return true;
  const Vec3 along = way.normalized();
  return std::none_of(triangles_.begin(), triangles_.end(),
                      [&](const Corners& t) {
                        const std::optional<double> at = met_at(t, eye_, along);
                        return at && *at > 0 && *at < length;
                      }) &&
         std::none_of(tools_.begin(), tools_.end(),
                      [&](const Shape& shape) { return is_met(shape, along, length); });
}

double Sight::first_organ(const Vec3& along, double from) const {
  double first = std::numeric_limits<double>::infinity();
  for (const Corners& t : triangles_)
    if (const std::optional<double> at = met_at(t, eye_, along); at && *at >= from)
      first = std::min(first, *at);
  return first;
}

/// On steps that are safe, as nothing is nearer than the distance.
bool Sight::is_met(const Shape& shape, const Vec3& along, double length) const {
  constexpr double touched = 1e-5;  // m
  for (double way = 0; way < length;) {
    const double free = signed_distance(shape, eye_ + way * along);
    if (free < touched) return true;
    way += free;
  }
  return false;
}

double seen_area(const Field& field, const LaparoscopePose& lens, double field_of_view,
                 const std::array<Vec3, 3>& corners, double margin) {
  const Vec3 area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const Sight sight = Sight(field, lens.position).within(corners);
  const double least_cosine = std::cos(0.5 * field_of_view);
  double sum = 0;
  for (const Vec3& weights : contact_rule) {
    const Vec3 place = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    const Vec3 along = (place - lens.position).normalized();
    if (along.dot(lens.direction) >= least_cosine && sight.sees(place, margin))
      sum += std::abs(area.dot(along));
  }
  return sum / static_cast<double>(contact_rule.size());
}

}  // namespace calot
