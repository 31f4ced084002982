#include "world/sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/field.h"
#include "geometry/triangle_crossing.h"

namespace calot {
namespace {

/// Triangles of a patch of skin follow each other, so that many lie near by.
constexpr std::size_t boxed = 32;

}  // namespace

void Sight::Drawn::find_boxes() {
  boxes.assign((triangles.size() + boxed - 1) / boxed, {});
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Vec3& corner : corners(triangles[t])) boxes[t / boxed].extend(corner);
}

Sight::Sight(const Field& field, const Vec3& eye) : eye_(eye) {
  organs_.resize(field.organs.size());
  for_each_chunk(field.workers(), static_cast<int>(organs_.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    const Organ& organ = field.organs[k];
    Drawn& drawn = organs_[k];
    drawn.organ = organ.definition.name;
    drawn.places = organ.body->drawn_positions(organ.state.x);
    drawn.triangles = organ.body->drawn_triangles();
    drawn.find_boxes();
  });
  for (const Tool& tool : field.tools)
    for (const Shape& shape : shapes_in_field(tool, tool.pose)) tools_.push_back(shape);
  for (const Ground& ground : field.ground) ground_.push_back(ground.shape);
}

Sight Sight::from(const Vec3& eye, const std::string& through) const {
  Sight out = *this;
  out.eye_ = eye;
  std::erase_if(out.organs_, [&](const Drawn& drawn) { return drawn.organ == through; });
  return out;
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
  for (Drawn& drawn : out.organs_) {
    std::erase_if(drawn.triangles, [&](const Triangle& triangle) {
      const Corners t = drawn.corners(triangle);
      return std::any_of(sides.begin(), sides.end(), [&](const Vec3& side) {
        return std::all_of(t.begin(), t.end(), [&](const Vec3& p) { return side.dot(p - eye_) < 0; });
      });
    });
    drawn.find_boxes();
  }
  return out;
}

namespace {

/// Whether a way of some length, m, along a unit direction meets a box.
bool meets(const Eigen::AlignedBox3d& box, const Vec3& from, const Vec3& along, double length) {
  const Eigen::Array3d inverse =
      along.array().inverse();  // infinite across an axis: then it is inside or never
  const Eigen::Array3d one = (box.min() - from).array() * inverse,
                       other = (box.max() - from).array() * inverse;
  double enters = 0, leaves = length;
  for (int k = 0; k < 3; ++k) {
    if (along[k] == 0 && (from[k] < box.min()[k] || from[k] > box.max()[k])) return false;
    if (along[k] == 0) continue;
    enters = std::max(enters, std::min(one[k], other[k]));
    leaves = std::min(leaves, std::max(one[k], other[k]));
  }
  return enters <= leaves;
}

}  // namespace

bool Sight::sees(const Vec3& place, double margin, const std::string& through) const {
  const Vec3 way = place - eye_;
  const double length = way.norm() - margin;
  if (!(length > 0)) return true;
  const Vec3 along = way.normalized();
  for (const Drawn& organ : organs_) {
    if (organ.organ == through) continue;
    for (std::size_t box = 0; box < organ.boxes.size(); ++box) {
      if (!meets(organ.boxes[box], eye_, along, length)) continue;
      const std::size_t end = std::min(organ.triangles.size(), (box + 1) * boxed);
      for (std::size_t t = box * boxed; t < end; ++t)
        if (const std::optional<double> at = met_at(organ.corners(organ.triangles[t]), eye_, along);
            at && *at > 0 && *at < length)
          return false;
    }
  }
  return !is_met(tools_, place, margin);
}

bool Sight::sees_past_ground(const Vec3& place, double margin, const std::string& through) const {
  return !is_met(ground_, place, margin) && sees(place, margin, through);
}

double Sight::first_organ(const Vec3& along, double from) const {
  double first = std::numeric_limits<double>::infinity();
  for (const Drawn& organ : organs_)
    for (const Triangle& t : organ.triangles)
      if (const std::optional<double> at = met_at(organ.corners(t), eye_, along); at && *at >= from)
        first = std::min(first, *at);
  return first;
}

/// On steps that are safe, as nothing is nearer than the distance.
bool Sight::is_met(const std::vector<Shape>& shapes, const Vec3& place, double margin) const {
  constexpr double touched = 1e-5;  // m
  const Vec3 way = place - eye_, along = way.normalized();
  const double length = way.norm() - margin;
  for (const Shape& shape : shapes)
    for (double gone = 0; gone < length;) {
      const double free = signed_distance(shape, eye_ + gone * along);
      if (free < touched) return true;
      gone += free;
    }
  return false;
}

double seen_area(const Sight& from_lens, const LaparoscopePose& lens, double field_of_view,
                 const std::array<Vec3, 3>& corners, double margin) {
  const Vec3 area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const Sight sight = from_lens.within(corners);
  double sum = 0;
  for (const Vec3& weights : contact_rule) {
    const Vec3 place = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    if (is_in_field(lens, field_of_view, place) && sight.sees(place, margin))
      sum += std::abs(area.dot((place - lens.position).normalized()));
  }
  return sum / static_cast<double>(contact_rule.size());
}

}  // namespace calot
