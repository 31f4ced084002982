#include "tools/tool_meeting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "group/body_problem.h"
#include "tools/part_path.h"

namespace calot {

ToolMeeting::ToolMeeting(const Side& one, const Side& other, const Barrier& barrier)
    : sides_{one, other},
      points_{tool_points(one.tool->geometry), tool_points(other.tool->geometry)},
      barrier_(barrier) {}

template <class Use>
void ToolMeeting::for_near(const VecX& x, double reach, const Use& use) const {
  const std::array<PosedTool, 2> tools{PosedTool(*sides_[0].tool, unknowns(0, x)),
                                       PosedTool(*sides_[1].tool, unknowns(1, x))};
  for (int side = 0; side < 2; ++side) {
    const PosedTool &own = tools[side], &other = tools[1 - side];
    for (int part = 0; part < shapes_per_tool; ++part) {
      const Shape shape = contact_shape(other.shapes[part]);
      const Eigen::AlignedBox3d near = box_around(shape, reach);
      for_points_near(own, points_[side], shape, near, reach,
                      [&](const ToolPoint& point, const Vec3& at, const PosedPart& carrier) {
                        use(side, point, at, carrier, other.parts[part], shape, part);
                      });
    }
  }
}

double ToolMeeting::value(const VecX& x) const {
  double sum = 0;
  for_near(x, barrier_.range,
           [&](int, const ToolPoint& point, const Vec3& at, const PosedPart&, const PosedPart&,
               const Shape& shape, int) {
             sum += 0.5 * point.area * barrier_.sample(signed_distance(shape, at) - point.radius).energy;
           });
  return sum;
}

void ToolMeeting::add_gradient(const VecX& x, VecX& gradient) const {
  for_near(x, barrier_.range,
           [&](int side, const ToolPoint& point, const Vec3& at, const PosedPart& own, const PosedPart& other,
               const Shape& shape, int) {
             const DistanceSlope d = distance_slope(shape, at);
             const Vec3 pull =
                 0.5 * point.area * barrier_.sample(d.distance - point.radius).derivative * d.gradient;
             gradient.segment<6>(Eigen::Index{3} * sides_[side].first_node) +=
                 own.slopes(at).transpose() * pull;
             gradient.segment<6>(Eigen::Index{3} * sides_[1 - side].first_node) -=
                 other.slopes(at).transpose() * pull;
           });
}

void ToolMeeting::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  std::array<ToolMatrix, 2> own_sum{ToolMatrix::Zero(), ToolMatrix::Zero()};
  ToolMatrix mixed = ToolMatrix::Zero();  // rows of the first side
  // Pressed harder than any balance is they would rather slide around each other than part.
  const double hardest = barrier_.sample(barrier_.soft_share * barrier_.range).derivative;
  for_near(x, barrier_.range,
           [&](int side, const ToolPoint& point, const Vec3& at, const PosedPart& own, const PosedPart& other,
               const Shape& shape, int) {
             const DistanceSlope d = distance_slope(shape, at);
             const BarrierSample b = barrier_.sample(d.distance - point.radius);
             const double share = 0.5 * point.area;
             const double pressed = std::max(b.derivative, hardest);
             const Vec3 pull = share * pressed * d.gradient;
             const Mat3 bend = share * (b.second * d.gradient * d.gradient.transpose() +
                                        pressed * distance_hessian(shape, at, d));
             const PointAndToolMatrix carried = other.carried_hessian(at, pull, bend);
             const Eigen::Matrix<double, 3, 6> by_own = own.slopes(at);
             own_sum[side] += by_own.transpose() * bend * by_own + own.curvature(at, pull);
             own_sum[1 - side] += carried.bottomRightCorner<6, 6>();
             const ToolMatrix across = by_own.transpose() * carried.topRightCorner<3, 6>();
             if (side == 0)
               mixed += across;
             else
               mixed += across.transpose();
           });
  const auto add = [&](int row_node, int column_node, const Mat3& block) {
    if (row_node >= column_node)
      matrix.add(row_node, column_node, block);
    else
      matrix.add(column_node, row_node, block.transpose());
  };
  for (int side = 0; side < 2; ++side) {
    const int node = sides_[side].first_node;
    matrix.add(node, node, own_sum[side].topLeftCorner<3, 3>());
    matrix.add(node + 1, node, own_sum[side].bottomLeftCorner<3, 3>());
    matrix.add(node + 1, node + 1, own_sum[side].bottomRightCorner<3, 3>());
  }
  for (int i = 0; i < tool_nodes; ++i)
    for (int j = 0; j < tool_nodes; ++j)
      add(sides_[0].first_node + i, sides_[1].first_node + j, mixed.block<3, 3>(3 * i, 3 * j));
}

void ToolMeeting::add_cliques(const VecX& /*x*/, bool /*close*/,
                              std::vector<std::vector<int>>& cliques) const {
  std::vector<int> nodes;
  for (const Side& side : sides_)
    for (int k = 0; k < tool_nodes; ++k) nodes.push_back(side.first_node + k);
  std::sort(nodes.begin(), nodes.end());
  cliques.push_back(std::move(nodes));
}

namespace {

/// m: the energy of what is pressed together so deep keeps it from going on, in smaller steps than the tools are thick.
constexpr double deeper = contact_guard, look_each = 1e-3;

template <class Holds>
bool on_all_of_way(double share, double travel, const Holds& holds) {
  const int looks = 1 + static_cast<int>(travel / look_each);
  for (int k = 1; k <= looks; ++k)
    if (!holds(share * k / looks)) return false;
  return true;
}

/// How two tools that may meet go, each from one pose to another.
struct MeetingWay {
  std::array<const Tool*, 2> tools{};
  std::array<InstrumentPose, 2> from, to;
  double travel = 0;  ///< m, of both together at most
  InstrumentPose pose(int side, double share) const { return interpolate(from[side], to[side], share); }
  double travel_until(double share) const {
    double sum = 0;
    for (int side = 0; side < 2; ++side) sum += travel_bound(*tools[side], from[side], pose(side, share));
    return sum;
  }

  /// Both tools after a share of it.
  struct Look {
    std::array<std::vector<PosedPart>, 2> parts;
    std::array<std::vector<Shape>, 2> cores;
  };
  /// Many points are looked at after the same shares.
  const Look& look(double share) const {
    const auto [found, fresh] = seen_.try_emplace(share);
    for (int side = 0; fresh && side < 2; ++side) {
      const InstrumentPose there = pose(side, share);
      for (int part = 0; part < shapes_per_tool; ++part)
        found->second.parts[side].emplace_back(*tools[side], there, part);
      for (const Shape& shape : PosedTool(*tools[side], tool_coordinates(there)).shapes)
        found->second.cores[side].push_back(core_of(contact_shape(shape)));
    }
    return found->second;
  }

  /// That of a tool's part, until a share of it.
  const PartPath& path(int side, int part, double share) const {
    KnownPath& known = paths_[side][part];
    if (!known.path || known.share != share) {
      known.path.emplace(*tools[side], part, from[side], pose(side, share));
      known.share = share;
    }
    return *known.path;
  }

 private:
  struct KnownPath {
    std::optional<PartPath> path;
    double share = 0;
  };
  mutable std::map<double, Look> seen_;
  mutable std::array<std::array<KnownPath, shapes_per_tool>, 2> paths_;
};

/// The share of the way, `share` at most, on which a point of tool `side` that is inside the core of the other's `part`
/// goes no deeper; `gap`: its signed distance from the core before, m. Jaws that turned on what they hold may have come
/// into the other tool.
double share_no_deeper(const MeetingWay& way, int side, const ToolPoint& point, int part, double gap,
                       double share) {
  const auto stays = [&](double at_share) {
    const MeetingWay::Look& then = way.look(at_share);
    const Vec3 there = then.parts[side][point.part].frame() * point.local;
    return signed_distance(offset(then.cores[1 - side][part], point.radius), there) >= gap - deeper;
  };
  while (share > 0 && !on_all_of_way(share, way.travel, stays)) share = share > 1e-6 ? 0.5 * share : 0;
  return share;
}

/// The share of the way, `share` at most, that keeps a point of tool `side`, at `at` (m) before, off the core of the
/// other's `part`, `gap` (m, above 0) away before. The point's own way is bent; what it may stray from the chord falls
/// with the square of the share.
double share_kept_off(const MeetingWay& way, int side, const ToolPoint& point, const Vec3& at, int part,
                      const Shape& core, double gap, double share) {
  const Tool& own = *way.tools[side];
  for (int halvings = 0; halvings < 60; ++halvings) {
    const InstrumentPose own_end = way.pose(side, share);
    const double bend = point_bend(own, way.from[side], own_end, at);
    if (bend > 0.25 * gap) {
      share *= 0.5;
      continue;
    }
    const Vec3 motion = way.look(share).parts[side][point.part].frame() * point.local - at;
    const PartPath& path = way.path(1 - side, part, share);
    return share * path.share_apart(offset(core, bend), at, motion, contact_keep);
  }
  return 0;
}

}  // namespace

double ToolMeeting::safe_share(const VecX& x, const VecX& step, double share) const {
  MeetingWay way;
  for (int side = 0; side < 2; ++side) {
    way.tools[side] = sides_[side].tool;
    way.from[side] = pose_at(unknowns(side, x));
    way.to[side] = pose_at(unknowns(side, x) + unknowns(side, step));
  }
  way.travel = way.travel_until(share);
  if (way.travel == 0) return share;
  const double reach = way.travel / (1 - contact_keep);
  for_near(x, reach,
           [&](int side, const ToolPoint& point, const Vec3& at, const PosedPart&, const PosedPart&,
               const Shape& shape, int part) {
             const Shape core = offset(core_of(shape), point.radius);
             const double gap = signed_distance(core, at);
             if ((1 - contact_keep) * gap > way.travel) return;
             const double before = share;
             share = gap <= 0 ? share_no_deeper(way, side, point, part, gap, share)
                              : share_kept_off(way, side, point, at, part, core, gap, share);
             // What is left of the way reaches fewer points.
             if (share < before) way.travel = way.travel_until(share);
           });
  return share;
}

Vec3 ToolMeeting::force(const VecX& x) const {
  Vec3 sum = Vec3::Zero();
  for_near(x, barrier_.range,
           [&](int side, const ToolPoint& point, const Vec3& at, const PosedPart&, const PosedPart&,
               const Shape& shape, int) {
             const DistanceSlope d = distance_slope(shape, at);
             const double push = -0.5 * point.area * barrier_.sample(d.distance - point.radius).derivative;
             sum += (side == 0 ? -push : push) * d.gradient;
           });
  return sum;
}

double ToolMeeting::gap(const VecX& x, double most) const {
  double least = most;
  for_near(
      x, most,
      [&](int, const ToolPoint& point, const Vec3& at, const PosedPart&, const PosedPart&, const Shape& shape,
          int) { least = std::min(least, signed_distance(shape, at) - point.radius - contact_inset); });
  return least;
}

}  // namespace calot
