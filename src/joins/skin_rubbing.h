#pragma once
// Friction of the skins of two bodies of a group on each other (StickSlip), during one solve.
//
// A point of one skin is held in a frame that the other skin carries along where they meet: three points of a triangle.
// Energy depends on where the point is in that frame and on nothing else, so that what one skin does to the other sums to
// no force and no torque, however thick what lies between the points is (a duct's skin is its centreline).
//
// A line has no triangles and cannot be turned about itself. On a surface its points are held by the surface's triangles,
// whichever of the two is asked. Two lines that cross give a frame of their two directions; lines along each other roll:
// only what slides along them rubs (across).

#include <array>
#include <span>
#include <vector>

#include "collision/friction.h"
#include "fem/links.h"
#include "group/join.h"

namespace calot {

/// A skin point of a body of the group.
struct BodyPoint {
  int body = 0, row = 0;
  auto operator<=>(const BodyPoint&) const = default;
};
void visit_members(auto&& visit, MembersOf<BodyPoint> auto& point) {
  auto& [body, row] = point;
  visit(body, row);
}

/// What rubs: a skin point and the body that it presses on. There is one hold of each.
struct RubbingPair {
  BodyPoint point;
  int on = 0;  ///< body
  auto operator<=>(const RubbingPair&) const = default;
};
void visit_members(auto&& visit, MembersOf<RubbingPair> auto& pair) {
  auto& [point, on] = pair;
  visit(point, on);
}

/// By which points a hold's frame is found.
struct RubbingPlace {
  /// What is held; the frame's origin; what lies along its first axis from there; what lies in the plane of its first
  /// two axes, from the origin, or of `lines` from what is held.
  std::array<BodyPoint, 4> points{};
  bool lines = false;
  bool operator==(const RubbingPlace&) const = default;
};
void visit_members(auto&& visit, MembersOf<RubbingPlace> auto& place) {
  auto& [points, lines] = place;
  visit(points, lines);
}

struct SkinHold {
  RubbingPair pair;
  RubbingPlace place;
  /// How much motion across the frame's first axis counts, 0 to 1: 1 but of lines that run along each other.
  double across = 1;
  StickSlip hold;  ///< in the frame
};
void visit_members(auto&& visit, MembersOf<SkinHold> auto& held) {
  auto& [pair, place, across, hold] = held;
  visit(pair, place, across, hold);
}

/// The frame of four points, and where the first of them is in it.
struct RubbingFrame {
  Mat3 turn = Mat3::Identity();  ///< columns: its axes
  Vec3 at = Vec3::Zero();        ///< m; what lies across the first axis times `across`
  std::array<Mat3, 4> slopes{};  ///< of `at`, by the points
  double across = 1;
};

/// Where bodies stand among the nodes, and these are; both must outlive it.
class BodyPlaces {
 public:
  BodyPlaces(std::span<const GroupPlace> bodies, const VecX& x) : bodies_(bodies), x_(x) {}
  std::array<Vec3, 4> of(const RubbingPlace& place) const;  ///< m
  /// SkinHold::across of such a place.
  double across(const RubbingPlace& place) const;
  RubbingFrame frame(const RubbingPlace& place, double across) const;
  RubbingFrame frame(const SkinHold& hold) const { return frame(hold.place, hold.across); }

 private:
  std::span<const GroupPlace> bodies_;
  const VecX& x_;
};

/// The hold of a pair; null: there is none. `holds` are ordered by their pairs.
const SkinHold* find_hold(std::span<const SkinHold> holds, const RubbingPair& pair);

class SkinRubbing : public Join {
 public:
  /// Ordered by their pairs.
  explicit SkinRubbing(std::vector<SkinHold> holds) : holds_(std::move(holds)) {}

  void begin(std::span<const GroupPlace> bodies) const override {
    bodies_.assign(bodies.begin(), bodies.end());
  }
  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  bool lacking() const override { return lacking_; }
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;

 private:
  std::array<StencilPoint, 4> points_of(const RubbingPlace& place) const;

  std::vector<SkinHold> holds_;
  mutable std::vector<GroupPlace> bodies_;
  mutable bool lacking_ = false;
};

}  // namespace calot
