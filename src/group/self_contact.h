#pragma once
// Contact of an organ's skin with itself, so that walls squeezed flat or folded do not pass through each other.
//
// Each skin point is kept off the triangles of the same skin that are no neighbours of it on the wall, by a barrier of the
// distance itself: inner and outer faces meet alike, as no side is asked for. Points of both walls are kept off the
// other, each for half, so wall presses on wall as an instrument does.
// A force and what answers it lie on one line and share out by the weights of the nearest point: what the wall does
// to itself sums to no force and no torque.
//
// Where the skin's points stand wider apart than the barrier's range (0.4 mm; they may by up to half a jaw's width) sharp
// folds meet with no point near: their edges are kept apart beside (collision/edge_crossing.h), within a quarter of that
// range, so that walls that lie on each other press by their points alone.

#include <cmath>
#include <optional>

#include "collision/barrier.h"
#include "collision/simplex_distance.h"
#include "collision/skin_edges.h"
#include "collision/surface_parts.h"
#include "fem/links.h"
#include "group/self_search.h"

namespace calot {

/// How walls press on each other: over less than the 0.7 mm that jaws leave between the two skins of a fold they hold
/// (what holds them there is the grip). Its core acts where a few points carry all of a crumpled fold: the logarithm's
/// energy grows by next to nothing there, so no step was too long for it. Walls came to 0.01 nm, from where rounding decides
/// each step, and the field stood still for good; with the core they stay some nm apart and find out.
inline constexpr Barrier self_barrier{
    .range = 0.4e-3, .stiffness = 20e3, .core = 5e-6, .core_stiffness = 4e6};
/// How far pairs of what meets so are remembered, m.
inline constexpr double close_reach = 0.8e-3;
/// Walls that are nearer than the first of these may touch in the next solve, and are coupled in its matrix; beyond
/// the second they are not any more.
inline constexpr double couple_below = 1.25 * self_barrier.range, uncouple_above = 1.5 * self_barrier.range;

/// Of edges that cross. Ten times as stiff: a few of them carry what lies in a sharp fold, and as soft as points they met at
/// 1 nm, from where each solve began far from balance (a held fold turned by 240 degrees took 43 s, now 20). And steep:
/// near an edge's end, where the pair fades, a pressure by 1 / distance let a drawn fold come to 1e-13 m. No solve
/// found out from there, as rounding decided its steps, and the field stood still for good.
inline constexpr Barrier self_edge_barrier{
    .range = 0.25 * self_barrier.range, .stiffness = 10 * self_barrier.stiffness, .steep = true};
/// Of these: couple_below and uncouple_above in proportion.
constexpr double edges_couple(double of_points) {
  return of_points * (self_edge_barrier.range / self_barrier.range);
}

/// A skin point and a part of the skin that press on each other.
struct SelfTouch {
  int skin_point = 0;
  SurfacePart part;
  FlatSample sample;
  double area = 0;  ///< m^2 that it counts for; negative where the part counts so
};

/// Finds what is near and remembers it until other things could have come near; what it remembers is no part of any
/// result. For one organ.
class SelfContact {
 public:
  /// Without contact where false: to show what it does.
  bool active = true;
  /// Threads that search, while there are some; null: the caller's alone.
  Workers* workers = nullptr;

  /// All that touches at x, ordered by skin point, then part; found once for a state. Valid until the next call.
  const std::vector<SelfTouch>& touching(const Body& body, const VecX& x) {
    return found_at(body, x).touches;
  }
  /// And all edges that cross in range, ordered.
  const std::vector<EdgeTouch>& crossing(const Body& body, const VecX& x) {
    return found_at(body, x).crossings;
  }
  /// Energy (J) and derivatives.
  double value(const Body& body, const VecX& x);
  void add_gradient(const Body& body, const VecX& x, VecX& gradient);
  /// Couplings that the matrix' pattern does not hold are left out: Newton then converges more slowly.
  void add_hessian(const Body& body, const VecX& x, BlockMatrix& matrix);
  /// As ConstrainedEnergy's, of the same couplings: how distances curve times the pressure. Edges' own curvature stays.
  bool add_convexity(const Body& body, const VecX& x, BlockMatrix& matrix);
  /// Whether the last add_hessian() left some out.
  bool lacking() const { return lacking_; }

  /// The largest part of `share` of the step on which no point and triangle, and no two edges, lose more than 1 - keep of their
  /// distance; of a long step, gone in parts, in none of these.
  double safe_share(const Body& body, const VecX& x, const VecX& step, double keep, double share);
  /// The pattern that a matrix needs to hold the couplings of what is near at x, or the body's own once that has moved
  /// apart; none: `present` serves.
  std::optional<BlockMatrix> new_pattern(const Body& body, const VecX& x, const BlockMatrix& present);

 private:
  /// Sees to it that near_ holds all pairs nearer than `need` at x, and those at edges nearer than `need_edges`. Returns
  /// how much of their distance its pairs may have lost since it was gathered, m.
  double refresh(const Body& body, const VecX& x, double need, double need_edges);
  void forget_pairs() { near_.clear(), edges_near_.clear(); }
  /// Half of the longest edge at rest, stretched by a quarter: how far a point may be beside edges that meet, m.
  double beside_edges(const Body& body) { return 0.625 * net(body).edges.longest; }
  /// Of each touch second * slope slope' + derivative * the distance's Hessian of what `answer` says at its distance.
  template <class Answer>
  std::vector<PointsStiffness> touches_stiffness(const Body& body, const VecX& x, const Answer& answer);
  /// What is safe of a step, gone in so many parts: what may meet on any of them is found at once.
  double safe_in_parts(const Body& body, const VecX& x, const VecX& step, double keep, int parts);
  /// What is safe of a step no longer than groups are remembered.
  double safe_part(const Body& body, const VecX& x, const VecX& step, double keep);
  /// What these leave of the motion `way_` from `at_`.
  double least_share(const std::vector<SelfPair>& pairs, const std::vector<EdgesNear>& crossing,
                     double keep) const;
  /// Bound on how much any two skin points have come nearer since groups_x_, m.
  double since_groups(const Body& body, const VecX& x);
  /// That groups_ holds all groups with points nearer than `need` at x, at most group_reach.
  void refresh_groups(const Body& body, const VecX& x, double need);
  /// Whether walls are nearer than this (at most close_reach) at x.
  bool any_nearer(const Body& body, const VecX& x, double distance);
  /// Places (at x) or motions of the skin points in rows_; the others mean nothing.
  void look_up(const Body& body, const VecX& x, std::vector<Vec3>& points) const;
  /// The same of those in `rows`.
  static void look_up(const Body& body, const VecX& x, std::span<const int> rows, std::vector<Vec3>& points);
  /// The skin points of pairs and edges, increasing.
  std::vector<int> rows_of(std::span<const SelfPair> pairs, std::span<const EdgesNear> crossing) const;
  const SkinNet& net(const Body& body);
  std::vector<SelfTouch> find_touching(const Body& body, const VecX& x);
  std::vector<EdgeTouch> find_crossing(const Body& body, const VecX& x);

  /// What touched at the last two states that were asked for: where a step began and where it is tried.
  struct Touching {
    VecX x;
    std::vector<int> details;
    std::vector<SelfTouch> touches;
    std::vector<EdgeTouch> crossings;
  };
  const Touching& found_at(const Body& body, const VecX& x);
  std::array<Touching, 2> found_;
  std::size_t newest_ = 0;
  std::optional<SkinNet> net_;
  // Groups of points that were near at groups_x_, their points and those of the triangles around them, and all nodes
  // that these hang on.
  bool groups_known_ = false;
  VecX groups_x_;
  std::vector<int> groups_details_;
  // since_groups() where it was asked last; empty: not yet.
  VecX aged_x_;
  double aged_ = 0;
  std::vector<GroupPair> groups_;
  std::vector<int> rows_, nodes_;
  // Pairs among these that were near at pairs_x_.
  bool pairs_known_ = false;
  VecX pairs_x_;
  std::vector<SelfPair> near_;
  double nearest_ = 0;  ///< m, of these pairs
  std::vector<EdgesNear> edges_near_;
  double nearest_edges_ = 0;                  ///< m, of these
  double pairs_reach_ = 0, edges_reach_ = 0;  ///< m, how near all are remembered
  bool lacking_ = false;
  std::vector<Vec3> at_, way_, nearing_;  ///< room for look_up()
};

}  // namespace calot
