#pragma once
// The middle line of a duct or a vessel: a cubic B-spline over an open knot vector (Piegl and Tiller, The NURBS Book, 2nd
// ed., sections 2.2 and 2.3), which begins at its first control node and ends at its last. The knots of a whole line are
// uniform; a part of it that was divided has those of the whole between its ends, and is the same curve.

#include <vector>

#include "base/status.h"
#include "geometry/stencil.h"

namespace calot {

/// Where a rod's energy is sampled.
struct RodQuadrature {
  StencilTable stencils;        ///< a row a point: value, and du and duu by the line's parameter
  std::vector<double> weights;  ///< length of each row, in that parameter
  std::vector<double> shares;   ///< of the way along, 0 to 1: a section may depend on it
};

class Centreline {
 public:
  /// Control nodes of the shortest line. One span of four would stretch in a way that its two quadrature points miss.
  static constexpr int least_nodes = 5;

  /// Fails (scenario) with fewer nodes than that.
  static Result<Centreline> create(int nodes);

  int nodes() const { return spans() + 3; }
  int spans() const { return static_cast<int>(knots_.size()) - 7; }
  /// The parameter runs from from() to to(): of a whole line from 0, a span each unit.
  double from() const { return knots_.front(); }
  double to() const { return knots_.back(); }

  /// Its part between two parameters, first < last, where its knots are kept; one within a single span has one more.
  Centreline part(double first, double last) const;
  /// Coordinates of a part's nodes for which it is the same curve as this line with its nodes at x (Ramshaw 1989,
  /// "Blossoms are polar forms", Comput. Aided Geom. Des. 6(4):323-358): fixed blends of these, so velocities too.
  VecX in_part(const Centreline& part, const VecX& x) const;

  /// How far a parameter is from the nearest knot.
  double to_knot(double u) const;

  /// A row of four nodes for each parameter in [from(), to()]; its derivatives are du and duu, the others empty. A line
  /// that is held at its end node and at the direction to the next one is clamped.
  StencilTable stencils(const std::vector<double>& parameters) const;

  /// Two Gauss points a span, exact to degree 3: all of a straight line's bending (degree 2), not of its stretch (4).
  /// Of a cantilever as thick as a duct, bent to a right angle, eight spans put the tip 1.3e-4 of the length off; three
  /// points 1.5e-5, for half as much work again. A thread a hundred times thinner locks less with two: four spans are
  /// 2 % off, with three points 13 %.
  RodQuadrature quadrature() const;

  /// 3 * nodes() coordinates (m) of the line along a polyline: each node where its Greville abscissa lies by length.
  /// Such a line never swings out beyond the polyline, keeps its ends and their directions, rounds its corners, and
  /// cuts a bend by h^2 / 6 of its curvature, h the length of a span (Schoenberg's approximation: de Boor, A Practical
  /// Guide to Splines, ch. XI). Equal spans of a straight line are equally long. Fails (scenario) where there is no
  /// length.
  Result<VecX> along(const std::vector<Vec3>& polyline) const;

 private:
  /// Of spans between these parameters, increasing.
  explicit Centreline(const std::vector<double>& breaks);
  /// The span of a parameter.
  int span_at(double u) const;

  std::vector<double> knots_;
};

}  // namespace calot
