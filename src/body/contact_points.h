#pragma once
// Where an organ's skin is felt: at the points of one rule on each drawn triangle. Contact is with what is drawn, and its
// forces reach the control nodes by the weights of the triangle's corners (the paper's section 5.1: by the skin's).
//
// The points lie so close that a jaw's edge, 0.8 mm round, has rows of them under it wherever it is drawn: what it
// presses on is 0.3 mm wide. Fewer, and it climbs from row to row: drawn by 5 um at a time it felt jumps of 1.7 % of its
// force where a triangle's edge has six parts, of 0.8 % with these eight, of 0.5 % with twelve; with two, of 9 % (by
// 0.1 mm at a time).

#include <array>

#include "base/workers.h"
#include "collision/shapes.h"
#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

/// Equal parts that a triangle's edges are split in; a contact point is the middle of one of the triangles between.
inline constexpr int contact_parts = 8;
/// Contact points of a triangle: those of triangle t are t * contacts_each and the next; each stands for as much of it.
inline constexpr int contacts_each = contact_parts * contact_parts;

/// Weights of the corners in a triangle's contact points.
extern const std::array<Vec3, contacts_each> contact_rule;
inline const Vec3& contact_weights(int point) { return contact_rule[point % contacts_each]; }

/// Those of the points that are the middles of a triangle's four quarters: what is broad beside a triangle is felt by
/// these as well as by all, at a sixteenth of the cost.
extern const std::array<int, 4> broad_points;

/// No trial of a solver goes deeper than this below a contact shape, m: less than the thinnest of them has to its
/// middle, beyond which it would be pushed out on the wrong side.
inline constexpr double contact_guard = 0.3e-3;

/// Lower bounds on a triangle's distance from a shape: the plane that touches the distance, which is convex, at the
/// triangle's middle.
struct Nearness {
  double middle = 0;           ///< distance of the triangle's middle, m
  Vec3 slopes = Vec3::Zero();  ///< by how much more the plane is at each corner, m

  double of_all() const { return middle + slopes.minCoeff(); }
  double of(int point) const { return middle + contact_weights(point).dot(slopes); }
};

/// Contact points where the nodes are at x, quick where those of one triangle follow each other. All must outlive it.
class ContactPlaces {
 public:
  ContactPlaces(const Tessellation& skin, const VecX& x) : skin_(skin), x_(x) {}
  /// `radii`: one a skin point, of the surface around it, m; empty: the skin is the surface.
  ContactPlaces(const Tessellation& skin, const VecX& x, const std::vector<double>& radii)
      : skin_(skin), x_(x), radii_(radii.empty() ? nullptr : &radii) {}
  Vec3 at(int point);  ///< m
  double radius(int point) const {
    return radii_ == nullptr ? 0.0 : corner_radii(point / contacts_each).dot(contact_weights(point));
  }
  /// Columns, m.
  const Mat3& corners(int triangle);
  /// Of the surface around the triangle.
  Nearness nearness(int triangle, const Shape& shape);

 private:
  struct Corner {
    int row = -1;  ///< skin point
    Vec3 at;
  };
  const Vec3& corner(int row);
  Vec3 corner_radii(int triangle) const {
    const Triangle& t = skin_.triangles[triangle];
    return {(*radii_)[t[0]], (*radii_)[t[1]], (*radii_)[t[2]]};
  }

  const Tessellation& skin_;
  const VecX& x_;
  const std::vector<double>* radii_ = nullptr;
  std::array<Corner, 64> known_;  ///< the last ones looked at: neighbours share them
  int triangle_ = -1;
  Mat3 corners_ = Mat3::Zero();  ///< columns, m
};

/// Brings forces on contact points to the nodes (virtual work), those of one triangle at once where they follow each
/// other. The last ones with finish().
class ContactLoad {
 public:
  ContactLoad(const Tessellation& skin, VecX& nodes) : skin_(skin), nodes_(nodes) {}
  void add(int point, const Vec3& force);
  void finish();

 private:
  const Tessellation& skin_;
  VecX& nodes_;
  int triangle_ = -1;
  Mat3 sum_ = Mat3::Zero();  ///< a column a corner
};

/// The same for Hessians by the points' places; all with finish(), which `workers` may share, to the same bits.
class ContactStiffness {
 public:
  ContactStiffness(const Tessellation& skin, BlockMatrix& matrix, Workers* workers = nullptr)
      : skin_(skin), matrix_(matrix), workers_(workers) {}
  void add(int point, const Mat3& hessian);
  void finish();

 private:
  using Products = Eigen::Matrix<double, 1, 6>;  ///< of the corners' weights: 00, 10, 20, 11, 21, 22
  struct OfTriangle {
    int triangle = 0;
    Eigen::Matrix<double, 9, 6> sum = Eigen::Matrix<double, 9, 6>::Zero();  ///< a column a pair of corners
    Eigen::Matrix<double, 12, 12> by_corners() const;
  };
  const Tessellation& skin_;
  BlockMatrix& matrix_;
  Workers* workers_;
  std::vector<OfTriangle> sums_;
};

}  // namespace calot
