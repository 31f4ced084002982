#pragma once
// Contact of two skins, whatever they are of: surfaces of triangles, and lines with a radius about them (a duct, a
// vessel, a thread).
//
// Each point of one skin, a ball of that skin's radius, is kept off the simplices of the other, swept by the other's
// radius, by a potential of the gap: the distance less both radii. The simplices count as parts (collision/
// surface_parts.h), so that the sum depends neither on how a skin is cut nor leaps where the nearest place passes from
// one to the next. Both skins' points are kept off the other, each for half its area. A force and what answers it lie on
// one line, and share out by the weights of the nearest point: they sum to no force and no torque.
//
// A line whose section gives way has for its radius what is left of it when it is pressed flat, and a potential that
// begins as much further out: what it costs is the caller's, by the gap.
//
// What no point sees is how far two lines, or a line and a surface, can approach each other between a line's points.
// There the nearest place lies across the segment, and its next point, half a spacing h along it, is as far off as
// sqrt(distance^2 + h^2 / 4): so where the points keep their gaps
//     distance^2 > (sum of radii)^2 - h^2 / 4        (line_clearance())
// and lines whose points stand no further apart than their radius stay apart by 0.86 of it, and more from each other
// (0.97 of the sum, if they are equally thick). Stretched to less than twice they still cannot pass.
// Nor does a point see the edges of two surfaces that cross beside it: see collision/skin_edges.h.

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/workers.h"
#include "collision/barrier.h"
#include "collision/simplex_distance.h"
#include "collision/surface_parts.h"

namespace calot {

using Segment = std::array<int, 2>;

/// Items in groups of groups, by where they are at rest. The first node is the root; children follow their parent.
struct ItemTree {
  struct Node {
    int first = 0, last = 0;  ///< of `order`
    int left = -1, right = -1;
  };
  std::vector<Node> nodes;
  std::vector<int> order;

  ItemTree(const std::vector<Vec3>& centres, std::vector<int> items);
};

/// What does not change of a skin that others meet. Corners of triangles and segments are increasing, and a corner of a
/// triangle is none of a segment.
class ContactSkin {
 public:
  /// `rest`: its points, m; `areas`: m^2 that each counts for: half of what it stands for where both skins meet by their
  /// points, and 0 of a point that is only a corner. Corners may be given in any order.
  ContactSkin(const std::vector<Vec3>& rest, std::vector<Triangle> triangles, std::vector<Segment> segments,
              double radius, std::vector<double> areas);

  double radius() const { return radius_; }  ///< m, about all of it
  double area(int point) const { return areas_[point]; }
  /// Triangles first, then segments.
  int simplices() const { return static_cast<int>(triangles_.size() + segments_.size()); }
  bool is_triangle(int simplex) const { return simplex < static_cast<int>(triangles_.size()); }
  const Triangle& triangle(int simplex) const { return triangles_[simplex]; }
  const Segment& segment(int simplex) const { return segments_[simplex - triangles_.size()]; }
  std::span<const int> corners(int simplex) const {
    return is_triangle(simplex) ? std::span<const int>(triangle(simplex))
                                : std::span<const int>(segment(simplex));
  }
  const ItemTree& point_tree() const { return point_tree_; }  ///< of points with an area
  const ItemTree& simplex_tree() const { return simplex_tree_; }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Segment> segments_;
  double radius_;
  std::vector<double> areas_;
  ItemTree point_tree_, simplex_tree_;
};

/// A skin where it is, and how it is to move.
struct PlacedSkin {
  const ContactSkin* skin = nullptr;
  const std::vector<Vec3>* points = nullptr;   ///< m
  const std::vector<Vec3>* motions = nullptr;  ///< m; none: it stays
};

/// A point of one skin and a simplex of another; skins by their places in the list that was asked about.
struct SkinPair {
  int skin = 0, point = 0, other = 0, simplex = 0;
  auto operator<=>(const SkinPair&) const = default;
};

/// Which pairs are looked for: those with a gap below `reach`, m, and those that could lose more than the share `lost`
/// (0 to 1) of their gap on their way; of both none that stays further apart than `nearer`, m.
struct SkinReach {
  double reach = 0, lost = 1, nearer = std::numeric_limits<double>::infinity();
};
/// All of them, in increasing order.
std::vector<SkinPair> skin_pairs(std::span<const PlacedSkin> skins, const SkinReach& looked_for,
                                 Workers* workers = nullptr);

/// A point of one skin and a part of another that press on each other.
struct SkinTouch {
  int skin = 0, point = 0, other = 0;
  SurfacePart part;   ///< corners are points of the other skin
  FlatSample sample;  ///< of the point's centre
  double gap = 0;     ///< m: the distance less both radii
  double area = 0;    ///< m^2 that it counts for; negative where the part counts so
};

/// All touches with a gap below `range`, in the order of the pairs, which must hold all with such a gap and be
/// increasing.
std::vector<SkinTouch> skin_touches(std::span<const PlacedSkin> skins, std::span<const SkinPair> pairs,
                                    double range);

/// Derivatives of area * potential(gap) by the point and up to three corners, N and N/m; `at_gap` is the potential
/// there. What belongs to corners that are not there is 0. The gap must not be as small as minus the radii.
Eigen::Matrix<double, 12, 1> touch_gradient(const SkinTouch& touch, const BarrierSample& at_gap);
Eigen::Matrix<double, 12, 12> touch_hessian(const SkinTouch& touch, std::span<const Vec3> corners,
                                            const BarrierSample& at_gap);
/// The places of the touch's corners, m: those of its part.
std::array<Vec3, 3> touch_corners(const SkinTouch& touch, const std::vector<Vec3>& other_points);

/// The largest share found (0 to 1) of all motions for which every one of the pairs keeps the share `keep` (0 to 1) of
/// its gap all the way; 0 where a gap is closed already or anything is not finite. The pairs must hold those that could lose 1 - keep of it.
double safe_share(std::span<const PlacedSkin> skins, std::span<const SkinPair> pairs, double keep);

/// How near the middle of a line whose points stand `spacing` apart can come to another line's middle, or to a surface,
/// while the gaps of its points are open: m; 0 where nothing keeps them from passing.
double line_clearance(double sum_of_radii, double spacing);

}  // namespace calot
