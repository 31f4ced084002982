#pragma once
// A tube swept along a line of points, to be drawn: its triangles stay, its places and normals follow the line.

#include <array>
#include <span>

#include "base/status.h"
#include "geometry/types.h"

namespace calot {

/// The cross-section at a point of the line: a circle, or an ellipse where the tube is pressed flat.
struct TubeSection {
  double radius = 0;     ///< half-axis across `pressed`, m
  double flattened = 0;  ///< half-axis along it, m; the radius where the section is round
  /// Direction in which the section is flattened, of any length; only its part across the line counts, and its sign
  /// does not. Without one the section is round.
  Vec3 pressed = Vec3::Zero();
};

/// How a tube ends: rounded off, or cut across: its wall has curled outward there and shows what it is hollow by.
struct TubeEnd {
  bool cut = false;
  double lumen = 0;  ///< of a cut one, as a share of its section; 0: it is solid
};

/// Directions across a line at each of its points: they turn with the tangent and not about it (rotation minimizing
/// frames by double reflection, Wang et al. 2008, ACM Trans. Graph. 27(1):2, doi 10.1145/1330511.1330513); the tangents
/// make it of second order. No curvature is asked for: straight lines and turns of the bend are as good as any.
struct LineFrame {
  Vec3 tangent, side;  ///< unit, across each other
  Vec3 up() const { return tangent.cross(side); }
};
/// `first` is the side at the first point; its part across the line must not vanish. Tangents are those of the parabola
/// through a point and its neighbours; a point without a way to the next takes the tangent before it, and a line
/// without any length has x.
std::vector<LineFrame> parallel_frames(std::span<const Vec3> line, const Vec3& first);

/// The frames of a line that has moved from where its were `rest`: the first turns with its tangent by the least turn,
/// so that the whole follows the motion without a leap unless the line's beginning points back.
std::vector<LineFrame> parallel_frames(std::span<const Vec3> line, const LineFrame& rest);

/// A closed surface: rings of the sections, and at both ends round caps (as far out as the smaller half-axis) or cut
/// edges with a lumen that ends inside.
/// The vertices of a ring follow the frames however the section is pressed: what is painted on it does not turn.
class TubeMesh {
 public:
  /// Of as many sectors (at least 3) about a line at rest of at least two points. Fails (scenario) otherwise, and
  /// where the line has no direction at its beginning.
  static Result<TubeMesh> create(std::span<const Vec3> rest, int sectors);

  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< outward
  int vertices() const { return points_ * sectors_ + 2 * (cap_rings_ * sectors_ + 1); }
  /// Vertex k of the ring at a point of the line; k counts from the frame's side towards its up().
  int vertex(int point, int k) const { return point * sectors_ + k; }

  struct Surface {
    std::vector<Vec3> positions;  ///< m
    std::vector<Vec3> normals;    ///< unit, outward
  };
  /// As many points and sections as the line at rest has points; `ends`: at its start and its end. The same inputs give
  /// the same bits.
  void place(std::span<const Vec3> line, std::span<const TubeSection> sections, Surface& out,
             const std::array<TubeEnd, 2>& ends = {}) const;

 private:
  void join_rings(int before, int after);
  void place_cap(const LineFrame& frame, const Vec3& end, const TubeSection& section, double outward,
                 const TubeEnd& kind, int first, Surface& out) const;
  Vec3 around(const LineFrame& frame, int k) const { return cosine_[k] * frame.side + sine_[k] * frame.up(); }

  int points_ = 0, sectors_ = 0, cap_rings_ = 0;
  LineFrame rest_;                     ///< at the first point
  std::vector<double> cosine_, sine_;  ///< of each sector
  std::vector<Triangle> triangles_;
};

}  // namespace calot
