#pragma once
// Instruments on a strand (fem/strand.h): its two straight pieces, a to m and m to b, are felt at points that lie so close
// that no part passes between two of them, by the barrier that skins are felt by (collision/barrier.h), without friction.
//
// A strand is as thick as its radius in the middle and swells from nothing at its ends: there what touches it touches the
// skin that it ends on.

#include <span>
#include <vector>

#include "collision/barrier.h"
#include "fem/strand.h"

namespace calot {

/// How instruments feel a strand.
struct StrandThread {
  double radius = 0;  ///< m, in the middle; 0: not at all
  double area = 0;    ///< m^2 that a point stands for in the middle
  int points = 0;     ///< on each piece
};
void visit_members(auto&& visit, MembersOf<StrandThread> auto& thread) {
  auto& [radius, area, points] = thread;
  visit(radius, area, points);
}
StrandThread strand_thread(const StrandLaw& law, double radius);

/// A piece of a strand: its ends, m, or how they move.
using StrandPiece = std::array<Vec3, 2>;
inline StrandPiece piece_of(const StrandVector& places, int piece) {
  return {places.segment<3>(3 * piece), places.segment<3>(3 * piece + 3)};
}

/// Where a strand meets a shape.
struct StrandContact {
  int shape = 0, piece = 0;
  double share = 0;        ///< of the piece's way
  Vec3 at = Vec3::Zero();  ///< m
  double area = 0;         ///< m^2
  DistanceSlope slope;     ///< of the strand's surface
  double radius = 0;       ///< m, of that
  BarrierSample answer;
  Vec3 force_on_shape() const { return area * answer.derivative * slope.gradient; }  ///< N
};

/// The instruments' shapes where they stand during a solve.
class StrandTouch {
 public:
  StrandTouch() = default;
  /// `shapes`: contact shapes (contact_search.h).
  StrandTouch(std::vector<Shape> shapes, const Barrier& barrier);

  bool none() const { return shapes_.empty(); }
  const std::vector<Shape>& shapes() const { return shapes_; }
  /// All that press, ordered by shape, then along the strand.
  void find(const StrandThread& thread, const StrandVector& places, std::vector<StrandContact>& out) const;

  double value(const StrandThread& thread, const StrandVector& places) const;           ///< J
  StrandVector gradient(const StrandThread& thread, const StrandVector& places) const;  ///< N
  StrandMatrix hessian(const StrandThread& thread, const StrandVector& places) const;   ///< N/m
  /// What the shapes' curvature takes off that, positive semidefinite.
  StrandMatrix convexity(const StrandThread& thread, const StrandVector& places) const;
  /// By a contact's point, N/m.
  Mat3 hessian_at(const StrandContact& contact) const;

  /// The largest part of `share` of a motion on which no piece comes nearer to what no trial may reach (core_of()) than it
  /// may.
  double safe_share(const StrandThread& thread, const StrandVector& places, const StrandVector& motion,
                    double share) const;

 private:
  template <class Use>
  void for_contacts(const StrandThread& thread, const StrandVector& places, const Use& use) const;
  /// Sum of at(contact), by the contacts' points, as a matrix of the strand's places.
  template <class At>
  StrandMatrix sum_at_contacts(const StrandThread& thread, const StrandVector& places, const At& at) const;

  std::vector<Shape> shapes_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< around them and the barrier's range
  Barrier barrier_;
};

/// Where a straight piece is nearest to a shape.
struct NearestOnPiece {
  double share = 0;  ///< of its way, 0 to 1
  DistanceSlope slope;
};
NearestOnPiece nearest_on_piece(const Shape& shape, const StrandPiece& piece);

/// The largest share (0 to 1) of the straight motions of a piece's ends on which it keeps `keep` of its distance from a
/// shape that stays; 0 where it is inside.
double safe_share(const StrandPiece& piece, const StrandPiece& motion, const Shape& shape, double keep);

}  // namespace calot
