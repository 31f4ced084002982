#pragma once
// What is seen of the field from a place: by a laparoscope, or by who asks what lies behind.

#include <array>
#include <string>
#include <vector>

#include "collision/shapes.h"
#include "tools/laparoscope.h"

namespace calot {

struct Field;

/// What may stand between an eye and places around it, as it is now: organs as they are drawn, and instruments.
class Sight {
 public:
  Sight(const Field& field, const Vec3& eye);
  /// Of the same field, from another place. `through`: an organ that hides nothing there; empty: none.
  Sight from(const Vec3& eye, const std::string& through) const;
  /// The same without what lies outside of the cone from the eye through a triangle, m: quicker for places in it.
  Sight within(const std::array<Vec3, 3>& corners) const;

  const Vec3& eye() const { return eye_; }
  /// Whether nothing is met on the way to a place, m, but for the last `margin` m of it.
  /// `through`: an organ that hides nothing; empty: none.
  bool sees(const Vec3& place, double margin, const std::string& through = {}) const;
  /// The same with the ground around the organs in the way, too.
  bool sees_past_ground(const Vec3& place, double margin, const std::string& through = {}) const;
  /// How far from the eye, m, an organ is met first on the way along a unit direction, `from` m away at least; infinite
  /// where none is.
  double first_organ(const Vec3& along, double from) const;

 private:
  using Corners = std::array<Vec3, 3>;

  struct Drawn {
    std::string organ;
    std::vector<Vec3> places;  ///< m
    std::vector<Triangle> triangles;
    std::vector<Eigen::AlignedBox3d> boxes;  ///< around each `boxed` triangles that follow each other
    void find_boxes();
    Corners corners(const Triangle& t) const { return {places[t[0]], places[t[1]], places[t[2]]}; }
  };
  bool is_met(const std::vector<Shape>& shapes, const Vec3& place, double margin) const;
  Vec3 eye_;
  std::vector<Drawn> organs_;
  std::vector<Shape> tools_, ground_;
};

/// How much of a triangle is seen from a lens whose round field is `field_of_view` rad across, m^2, across the line of
/// sight, which begins at the lens: a triangle seen from its edge is none. Rays go to 64 places on it; what stands before one
/// within the last `margin` m does not hide it (what the triangle is stretched between).
double seen_area(const Sight& from_lens, const LaparoscopePose& lens, double field_of_view,
                 const std::array<Vec3, 3>& corners, double margin);

}  // namespace calot
