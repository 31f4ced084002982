#pragma once
// Contact between the skins of two bodies of a group (collision/skin_contact.h), so that organs, ducts and what lies
// around them press on each other and never pass.
//
// Points of both skins are kept off the other, each for half its area, by a barrier of the gap. It is the one that keeps
// an organ's own walls apart: skin points stand 1 mm apart, so a range as short as that of contact with shapes (0.09 mm,
// where contact points lie eight times as close) would leave places between the points to which nothing answers. Nor is
// it soft at the end: no state has skins in each other, and no step takes them there.
//
// Of two surfaces edges may cross where no point is near (two boxes'); they are kept apart beside, as those of one skin
// are (self_edge_barrier): bodies that lie on each other press by their points alone. What is thick is as far from its
// line between points as at them (line_clearance()).
//
// A rod is met by its centreline, as thick all along as where it is thickest; its section does not give way here.

#include "collision/skin_contact.h"
#include "collision/skin_edges.h"
#include "group/join.h"
#include "joins/met_skin.h"
#include "joins/skin_rubbing.h"

namespace calot {

/// Near a joint two bodies do not press on each other: nothing of either skin counts that was as near to `place` at rest
/// as `within`, m.
struct JoinedPlace {
  Vec3 place = Vec3::Zero();
  double within = 0;
};
void visit_members(auto&& visit, MembersOf<JoinedPlace> auto& joined) {
  auto& [place, within] = joined;
  visit(place, within);
}

/// What a point of one skin is pressed by, and the frame in which it may rub.
struct SkinPress {
  RubbingPair pair;
  RubbingPlace place;
  Vec3 force = Vec3::Zero();  ///< N, on the point
  double area = 0;            ///< m^2 that it stands for
};

/// How two bodies are in each other.
struct SkinOverlap {
  double depth = 0;           ///< m, the deepest found of some hundred points
  Vec3 place = Vec3::Zero();  ///< m, there
};

class SkinJoin : public Join {
 public:
  /// `bodies`: their places in the group.
  SkinJoin(const Body& one, const Body& other, std::array<int, 2> bodies,
           std::span<const JoinedPlace> joined = {});

  const SkinJoin* skins() const override { return this; }
  void begin(std::span<const GroupPlace> bodies) const override;
  bool idle(std::span<const SkinBounds> bodies) const override;
  void find(const VecX& x) const override { found_at(x); }
  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  bool add_convexity(const VecX& x, BlockMatrix& matrix) const override;
  bool lacking() const override { return lacking_; }
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;
  double safe_share(const VecX& x, const VecX& step, double share) const override;

  const std::array<int, 2>& bodies() const { return bodies_; }
  /// All that presses at x, in the group's numbering; found once for a state. Valid until the next call.
  const std::vector<SkinTouch>& touching(const VecX& x) const { return found_at(x).touches; }
  /// And all edges that do, those of the first body first.
  const std::vector<EdgeTouch>& crossing(const VecX& x) const { return found_at(x).crossings; }
  /// All that presses at x, summed over what each point touches; ordered by skin, then point. What an edge does counts
  /// as that of its end next to where it is met.
  std::vector<SkinPress> pressing(const VecX& x) const;
  /// The smallest gap of the two skins at x, m, or as far as is looked (0.8 mm): 0 or less where they are in each other.
  double gap(const VecX& x) const;
  /// Where their skins cross at x, or one is inside the other; `hollow`: whether each may hold another inside, as a
  /// gallbladder a stone. None: they are beside each other, or may be where they are joined.
  std::optional<SkinOverlap> overlap(const VecX& x, const std::array<bool, 2>& hollow) const;
  /// N, of the first body on the other.
  Vec3 force(const VecX& x) const;
  /// Searches done so far: what that costs is no part of any result.
  int searches() const { return searches_; }

 private:
  /// One of the two.
  struct Side {
    const Body* body = nullptr;
    Eigen::Index first = 0;    ///< coordinate
    std::vector<int> details;  ///< that it had
    double radius = 0;         ///< m, about its skin
    MetSkin met;
    std::vector<double> areas;
    std::vector<char> counts;  ///< triangles of its skin that are met
    std::vector<int> around;   ///< a triangle at each point
    // Near the other at patches_x_, and a few that were before:
    std::vector<int> patches, rows;
    std::optional<ContactSkin> skin;
    std::vector<int> triangles;  ///< of the body's skin, one a simplex
    // Which of these patches has it, one a simplex, a skin point and an edge (a patch of several, where it is of several):
    std::vector<int> patch_of_simplex, patch_of_point, patch_of_edge;
    std::optional<SurfaceEdges> edges;  ///< of all that is met of its skin; only of two surfaces
    ItemTree edge_tree{{}, {}};         ///< of those on the patches
    std::vector<Vec3> at, way;          ///< m, of the points that were looked up last; room
    std::vector<int> looked;            ///< when each was, by looks_
  };
  using Parts = std::array<VecX, 2>;  ///< of the group's coordinates: either body's
  Parts parts_of(const VecX& x) const;
  Side side_of(const Body& body, std::span<const JoinedPlace> joined) const;
  /// How all points of each patch near the other body move.
  using PatchMoves = std::array<std::vector<SkinMoves>, 2>;
  PatchMoves patch_moves(const Parts& dx) const;
  /// Bound on how much any two of the skins' points move against each other by dx, m; those of two patches.
  double approach(const Parts& dx) const;
  static double approach(const PatchMoves& moves, int one, int other) {
    return approach_of(moves[0][static_cast<std::size_t>(one)], moves[1][static_cast<std::size_t>(other)]);
  }
  /// Whether all that is nearer than `need` (m, of two patches, or the largest of any) at x is among what was looked for at `from` as far as
  /// `reach`, m.
  template <class Need>
  bool remembered(const Parts& x, const Parts& from, double reach, const Need& need,
                  double largest_need) const;
  void gather_patches(const Parts& x) const;
  Eigen::AlignedBox3d box_of_points(int k, int patch, const Parts& x) const;  ///< with what is about them
  /// Sees to it that the patches hold all that has gaps below `need`.
  void refresh_patches(const Parts& x, double need) const;
  /// And pairs_ all pairs, at most close_reach.
  void refresh_pairs(const Parts& x, double need) const;
  void find_pairs(const Parts& x) const;
  /// Likewise edges_, at most as far as patches are remembered.
  void refresh_edges(const Parts& x, double need) const;
  void find_edges(const Parts& x, double reach) const;
  /// Pairs that may have gaps below `need` at x, at most close_reach; their points are looked up. Valid until the next
  /// call.
  const std::vector<SkinPair>& pairs_below(const Parts& x, double need) const;
  /// Likewise edges.
  const std::vector<EdgesNear>& edges_below(const Parts& x, double need) const;
  /// The same of what is remembered, nearer than `need` of two patches.
  template <class Need>
  const std::vector<SkinPair>& choose_pairs(const Parts& x, const Need& need) const;
  template <class Need>
  const std::vector<EdgesNear>& choose_edges(const Parts& x, const Need& need) const;
  /// Places, or motions, of all points near the other body, or of those of some pairs.
  void look_up(const Parts& x, bool motions) const;
  void look_up(const Parts& x, bool motions, std::span<const SkinPair> pairs) const;
  void look_up(const Parts& x, bool motions, std::span<const EdgesNear> pairs) const;
  void look_up(const Parts& x, bool motions, int skin, std::span<const int> points) const;
  /// Whether the places of all points near the other body were looked up last, and here.
  bool all_are_at(const Parts& x) const;
  std::array<PlacedSkin, 2> placed(bool motions) const;
  std::array<PlacedEdges, 2> placed_edges(bool motions) const;
  bool are_surfaces() const { return sides_[0].radius + sides_[1].radius == 0; }
  double gap_of(const SkinPair& pair) const;  ///< where its points were looked up last
  double edge_distance(const EdgesNear& pair) const;
  double safe_part(const Parts& x, const Parts& step) const;
  /// `whole`: moves of a step of which this is a share.
  double safe_edges(const Parts& x, const Parts& step, const PatchMoves& whole, double share_of_whole) const;
  bool active() const { return sides_[0].body != nullptr; }
  void take_patches(Side& side) const;
  std::vector<int> keep_patches(Side& side, const std::vector<int>& near) const;
  StencilPoint stencil_point(int skin, int row) const;
  /// As touch_hessian(), of a touch at x.
  Eigen::Matrix<double, 12, 12> touch_matrix(const SkinTouch& touch, const Parts& x,
                                             const BarrierSample& at_gap) const;
  std::array<StencilPoint, 4> points_of(const SkinTouch& touch) const;
  std::array<StencilPoint, 4> points_of(const EdgeTouch& touch) const;
  RubbingPlace rubbing_place(const SkinPair& pair) const;
  std::vector<SkinPress> points_pressing(const VecX& x) const;
  struct Crossing;
  void find_crossings(const Parts& x, Crossing& out) const;
  std::optional<SkinOverlap> deepest_inside(const Crossing& crossing, int k, bool hollow) const;

  std::array<int, 2> bodies_;
  mutable Workers* workers_ = nullptr;  ///< of the solve
  mutable std::array<Side, 2> sides_;
  mutable bool patches_known_ = false, near_ = false;  ///< and whether there are any
  mutable bool pairs_known_ = false, edges_known_ = false, lacking_ = false;
  mutable Parts patches_x_, pairs_x_, edges_x_;
  mutable Parts at_x_;  ///< see all_are_at(); empty: nowhere
  /// Patches of either that are near each other, by their places among those of their side, and how far apart, m, at
  /// patches_x_.
  struct NearPatches {
    int one = 0, other = 0;
    double apart = 0;
  };
  mutable std::vector<NearPatches> near_patches_;
  mutable double patches_reach_ = 0, edges_reach_ = 0;
  mutable std::vector<SkinPair> pairs_, chosen_;
  mutable std::vector<double> gaps_;  ///< m, of pairs_ at pairs_x_
  mutable std::vector<EdgesNear> edges_, chosen_edges_;
  mutable int looks_ = 0;
  mutable int searches_ = 0;
  struct Touching {
    Parts x;
    std::vector<SkinTouch> touches;
    std::vector<EdgeTouch> crossings;
  };
  const Touching& found_at(const VecX& x) const;
  mutable std::array<Touching, 2> found_;  ///< where a step began and where it is tried
  mutable std::size_t newest_ = 0;
};

}  // namespace calot
