// Walls of one organ against each other: its energy, its forces, and what it keeps from crossing.

#include "group/self_contact.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "field_rig.h"
#include "geometry/self_touch.h"
#include "rig.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// A ball of skin pressed flat between two fields of springs, its bile free to leave.
struct Pinched {
  Field field;
  Organ& organ;
  ContactLoads around;
  Vec3 middle = Vec3::Zero();

  explicit Pinched(bool contact)
      : field(test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ())), organ(field.organs[0]) {
    organ.search.own.active = contact;
    const std::vector<Vec3>& rest = organ.body->skin_rest();
    for (const Vec3& p : rest) middle += p / static_cast<double>(rest.size());
    organ.state.datum_pressure = 0;
    const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
    for (int row = 0; row < static_cast<int>(skin.size()); ++row) {
      if (std::abs(skin[row].x() - middle.x()) < 18e-3) continue;
      around.grip.row.push_back(row);
      around.grip.target.push_back(skin[row]);
      around.grip.stiffness.push_back(5.0);
    }
  }
  /// Each side's springs pull to a plane this far on its own side of the middle, in even parts.
  bool press(double to, int parts) {
    const std::vector<Vec3> from = around.grip.target;
    for (int k = 1; k <= parts; ++k) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        const double side = organ.body->skin_rest()[around.grip.row[i]].x() > middle.x() ? 1 : -1;
        const double goal = middle.x() + side * to;
        around.grip.target[i].x() = from[i].x() + (goal - from[i].x()) * k / parts;
      }
      const NewtonResult result = settle({*organ.body, around, organ.search, organ.state}, {},
                                         field.group.work, {.fixed_pressures = true});
      if (!result.converged()) return false;
    }
    return true;
  }
  std::size_t crossings() const {
    return touching_pairs({organ.body->skin_positions(organ.state.x), organ.body->skin().triangles}, 0.0)
        .size();
  }
};

/// Least distance of parts of the wall that are no neighbours, m, up to `most`.
double nearest_pair(const SkinNet& net, const Organ& organ, const VecX& x, double most) {
  const std::vector<Vec3> skin = organ.body->skin_positions(x);
  double out = most;
  const SkinMotion still{skin, nullptr, out, 1};
  for (const SelfPair& p : near_pairs(net, still, near_groups(net, still))) out = std::min(out, p.distance);
  return out;
}

/// The skin point that is farthest at rest in a direction.
int farthest(const Organ& organ, const Vec3& along) {
  const std::vector<Vec3>& rest = organ.body->skin_rest();
  int best = 0;
  for (int i = 0; i < static_cast<int>(rest.size()); ++i)
    if (rest[i].dot(along) > rest[best].dot(along)) best = i;
  return best;
}

/// The ball dented from both sides until its walls come within `gap`, and shaken.
VecX dented(const Organ& organ, double gap) {
  const VecX& start = organ.body->rest();
  const Vec3 middle(0, 0, 20e-3);
  Rng rng(3);
  const VecX shake = test::random_coordinates(rng, static_cast<int>(start.size()), 2e-5);
  const auto at = [&](double depth) {
    VecX x = start + shake;
    for (int i = 0; i < organ.body->coarse_nodes(); ++i) {
      const Vec3 arm = start.segment<3>(3 * i) - middle;
      const double off_axis = (arm.y() * arm.y() + arm.z() * arm.z()) / (14e-3 * 14e-3);
      x[3 * i] -= depth * std::exp(-off_axis) * arm.x();
    }
    return x;
  };
  const SkinNet net(*organ.body);
  const int right = farthest(organ, Vec3::UnitX()), left = farthest(organ, -Vec3::UnitX());
  double low = 0, high = 5;
  for (int k = 0; k < 25; ++k) {
    const double depth = 0.5 * (low + high);
    const VecX x = at(depth);
    const bool apart = organ.body->skin_point(right, x).x() > organ.body->skin_point(left, x).x() &&
                       nearest_pair(net, organ, x, 1.1 * gap) > gap;
    (apart ? low : high) = depth;
  }
  return at(low);
}

/// With details on both dented sides.
Field ball_with_details() {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ(), {}, 2);
  Organ& organ = field.organs[0];
  test::extend(field, {farthest(organ, Vec3(1, 0.1, 0.1)), farthest(organ, Vec3(-1, 0.1, -0.1))});
  return field;
}

TEST(SelfContact, GradientAndHessianAreSlopesAndForcesBalance) {
  Field field = ball_with_details();
  const ShellBody& body = *field.organs[0].body->as_shell();
  const VecX x = dented(field.organs[0], 0.15e-3);
  SelfContact own;
  const std::vector<SelfTouch> touches = own.touching(body, x);
  std::array<int, 4> kinds{};
  for (const SelfTouch& touch : touches) ++kinds[touch.part.corners];
  EXPECT_GT(kinds[2], 0);
  EXPECT_GT(kinds[3], 0);
  VecX g = VecX::Zero(x.size());
  own.add_gradient(body, x, g);
  ASSERT_GT(g.norm(), 0.01);
  // Rounding of places a few cm from the origin against distances of 0.1 mm.
  // Details are displacements: a force on the whole is one on its places.
  EXPECT_LT(test::net_force(g.head(3 * static_cast<Eigen::Index>(body.coarse_nodes()))).norm(),
            1e-12 * g.lpNorm<1>());
  EXPECT_GT(g.tail(3 * static_cast<Eigen::Index>(body.details().size())).norm(), 1e-3 * g.norm());
  std::optional<BlockMatrix> wider = own.new_pattern(body, x, body.pattern());
  ASSERT_TRUE(wider);
  EXPECT_FALSE(own.new_pattern(body, x, *wider)) << "it serves";
  BlockMatrix& h = *wider;
  h.set_zero();
  own.add_hessian(body, x, h);
  EXPECT_FALSE(own.lacking());
  BlockMatrix narrow = body.pattern();
  own.add_hessian(body, x, narrow);
  EXPECT_TRUE(own.lacking());
  const auto gradient_at = [&](const VecX& at) {
    VecX out = VecX::Zero(at.size());
    own.add_gradient(body, at, out);
    return out;
  };
  Rng rng(5);
  for (int k = 0; k < 5; ++k) {
    const VecX d = test::random_coordinates(rng, static_cast<int>(x.size()), 1.0);
    constexpr double step = 1e-9;  // m: a hundred-thousandth of the distances, so few parts change within it
    const double by_value = (own.value(body, x + step * d) - own.value(body, x - step * d)) / (2 * step);
    const VecX by_gradient = (gradient_at(x + step * d) - gradient_at(x - step * d)) / (2 * step);
    EXPECT_NEAR(g.dot(d), by_value, 1e-5 * g.norm() * d.norm());
    EXPECT_LT((h.multiply(d) - by_gradient).norm(), 1e-4 * by_gradient.norm());
  }
}

/// Least distance of edges that are no neighbours, m, up to `most`.
double nearest_edges(const SkinNet& net, const Organ& organ, const VecX& x, double most) {
  const std::vector<Vec3> skin = organ.body->skin_positions(x);
  const double around = std::hypot(most, net.edges.longest);
  const SkinMotion still{skin, nullptr, around, 1};
  const std::vector<SelfPair> pairs = near_pairs(net, still, near_groups(net, still));
  double out = most;
  for (const EdgesNear& e : edges_at(net, pairs, {skin, nullptr, most, 1})) out = std::min(out, e.distance);
  return out;
}

/// Dented until edges cross with less than `gap` between them.
VecX crossed(const Organ& organ, const SkinNet& net, double gap) {
  for (double points = 3 * gap; points > 0.1 * gap; points *= 0.9) {
    VecX x = dented(organ, points);
    if (nearest_edges(net, organ, x, gap) < gap) return x;
  }
  return {};
}

TEST(SelfContact, EdgesThatCrossPressOnEachOther) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const ShellBody& body = *organ.body->as_shell();
  const SkinNet net(body);
  const VecX x = crossed(organ, net, 0.5 * self_edge_barrier.range);
  ASSERT_GT(x.size(), 0);
  SelfContact own;
  ASSERT_FALSE(own.crossing(body, x).empty());
  VecX g = VecX::Zero(x.size());
  own.add_gradient(body, x, g);
  EXPECT_LT(test::net_force(g).norm(), 1e-12 * g.lpNorm<1>());
  EXPECT_LT(test::net_torque(x, g, Vec3(0, 0, 20e-3)).norm(), 1e-12 * body.size() * g.lpNorm<1>());
  std::optional<BlockMatrix> h = own.new_pattern(body, x, body.pattern());
  ASSERT_TRUE(h);
  h->set_zero();
  own.add_hessian(body, x, *h);
  EXPECT_FALSE(own.lacking());
  Rng rng(6);
  for (int k = 0; k < 3; ++k) {
    const VecX d = test::random_coordinates(rng, static_cast<int>(x.size()), 1.0);
    constexpr double step = 1e-10;  // m: a hundred-thousandth of the distances
    VecX ahead = VecX::Zero(x.size()), behind = ahead;
    own.add_gradient(body, x + step * d, ahead);
    own.add_gradient(body, x - step * d, behind);
    EXPECT_NEAR(g.dot(d), (own.value(body, x + step * d) - own.value(body, x - step * d)) / (2 * step),
                1e-4 * g.norm() * d.norm());
    const VecX bend = (ahead - behind) / (2 * step);
    EXPECT_LT((h->multiply(d) - bend).norm(), 1e-3 * bend.norm());
  }
}

/// A motion of each side towards the other, m a unit.
VecX closing(const Body& body) {
  VecX out = VecX::Zero(3 * Eigen::Index{body.nodes()});
  for (int i = 0; i < body.nodes(); ++i) out[3 * i] = body.rest()[3 * i] > 0 ? -1 : 1;
  return out;
}

/// At 10 mm a step, half a metre a second, and in steps as short as solvers make them.
TEST(SelfContact, NoStepTakesCrossingEdgesThroughEachOther) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const SkinNet net(*organ.body);
  const VecX x = crossed(organ, net, 0.05e-3);
  ASSERT_GT(x.size(), 0);
  const double before = nearest_edges(net, organ, x, 1e-3);
  const VecX step = closing(*organ.body);
  for (double length : {0.1e-3, 10e-3}) {
    const double share = SelfContact().safe_share(*organ.body, x, length * step, 0.2, 1.0);
    EXPECT_LT(share, 1.0) << length;
    for (int k = 1; k <= 4; ++k)
      EXPECT_GE(nearest_edges(net, organ, x + 0.25 * k * share * length * step, 1e-3),
                0.2 * 0.2 * before * (1 - 1e-6))
          << length << ", at most two parts of a way take their share";
  }
}

TEST(SelfContact, ForcesOnTheSkinHaveNoMoment) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const ShellBody& body = *field.organs[0].body->as_shell();
  const VecX x = dented(field.organs[0], 0.15e-3);
  SelfContact own;
  VecX g = VecX::Zero(x.size());
  own.add_gradient(body, x, g);
  ASSERT_GT(g.norm(), 0.01);
  EXPECT_LT(test::net_torque(x, g, Vec3(0, 0, 20e-3)).norm(), 1e-12 * body.size() * g.lpNorm<1>());
}

/// What is remembered decides nothing: neither what touches nor how far a step may go.
TEST(SelfContact, MemoryLeavesNoTrace) {
  CALOT_SLOW_WHEN_SANITIZED("walls pressed on each other");
  Field field = ball_with_details();
  const Organ& organ = field.organs[0];
  const VecX near = dented(organ, 0.15e-3), far = dented(organ, 3e-3);
  SelfContact kept;
  bool touched = false, parted = false, cut = false;
  for (int k = 0; k <= 16; ++k) {
    const double s = 0.5 - 0.5 * std::cos(0.7 * k);
    const VecX x = far + s * (near - far), step = (k % 2 ? 1.2 : 0.02) * (near - x);
    SelfContact fresh;
    const double value = fresh.value(*organ.body, x);
    EXPECT_EQ(kept.value(*organ.body, x), value);
    touched |= value != 0;
    parted |= value == 0;
    const double share = SelfContact().safe_share(*organ.body, x, step, 0.2, 1.0);
    EXPECT_EQ(kept.safe_share(*organ.body, x, step, 0.2, 1.0), share);
    cut |= share < 1;
  }
  EXPECT_TRUE(touched);
  EXPECT_TRUE(parted);
  EXPECT_TRUE(cut);
}

TEST(SelfContact, NoStepTakesWallsThroughEachOther) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const VecX x = dented(organ, 1.5e-3);
  const SkinNet net(*organ.body);
  const double before = nearest_pair(net, organ, x, 2e-3);
  const VecX step = closing(*organ.body);
  for (double length : {1e-3, 2e-3, 5e-3, 50e-3}) {
    const double share = SelfContact().safe_share(*organ.body, x, length * step, 0.2, 1.0);
    const double after = nearest_pair(net, organ, x + share * length * step, 2e-3);
    EXPECT_LT(share, 1.0) << length;
    EXPECT_GT(share * length, 0.2 * before) << length;
    // At most two parts of a way take their share of the last millimetre.
    EXPECT_GE(after, 0.2 * 0.2 * before * (1 - 1e-6)) << length;
  }
}

/// A turn of the whole, half a radian a step and more, neither holds walls up nor hides how they come nearer.
TEST(SelfContact, NoStepTakesWallsThroughEachOtherWhileTheWholeTurns) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const VecX x = dented(organ, 1.5e-3);
  const SkinNet net(*organ.body);
  const double before = nearest_pair(net, organ, x, 2e-3);
  VecX turning = VecX::Zero(x.size());
  const Vec3 spin(0.3, -0.4, 0.5), pivot(0.1, 0, 0);
  for (int i = 0; i < organ.body->nodes(); ++i)
    turning.segment<3>(3 * i) = spin.cross(x.segment<3>(3 * i) - pivot);
  EXPECT_EQ(SelfContact().safe_share(*organ.body, x, turning, 0.2, 1.0), 1.0);
  for (double length : {1e-3, 5e-3, 50e-3}) {
    const VecX step = length * closing(*organ.body) + turning;
    const double share = SelfContact().safe_share(*organ.body, x, step, 0.2, 1.0);
    EXPECT_LT(share, 1.0) << length;
    EXPECT_GT(share * length, 0.2 * before) << length;
    EXPECT_GE(nearest_pair(net, organ, x + share * step, 2e-3), 0.2 * 0.2 * before * (1 - 1e-6)) << length;
  }
}

/// Of points and triangles one by one: those that lose more than most of their distance on a long way, all of which are
/// found by looking for what may meet on the whole of it at once.
TEST(SelfContact, AllThatMeetsOnALongWayIsFoundAtOnce) {
  CALOT_SLOW_WHEN_SANITIZED("each point beside each triangle");
  constexpr double keep = 0.2;
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  const Organ& organ = field.organs[0];
  const VecX x = dented(organ, 1.5e-3);
  const SkinNet net(*organ.body);
  const std::vector<Vec3> skin = organ.body->skin_positions(x);
  for (double length : {1e-3, 2e-3}) {
    const VecX step = length * closing(*organ.body);
    std::vector<Vec3> way;
    for (int row = 0; row < static_cast<int>(skin.size()); ++row)
      way.push_back(organ.body->skin_point(row, step));
    const SkinMotion moving{skin, &way, 0, 0, 1 - keep};
    std::set<std::pair<int, int>> found;
    for (const SelfPair& pair : near_pairs(net, moving, near_groups(net, moving)))
      found.emplace(pair.skin_point, pair.triangle);
    int meet = 0, missed = 0;
    for (int p = 0; p < static_cast<int>(skin.size()); p += 29)
      for (int t = 0; t < static_cast<int>(net.triangles.size()); ++t) {
        const Triangle& corners = net.triangles[t];
        constexpr double sure = 15e-3;  // m: what is further apart cannot lose so much
        if ((skin[p] - skin[corners[0]]).norm() > sure || net.neighbours(p, t)) continue;
        if (safe_share(skin[p], way[p], corners_of(corners, skin), corners_of(corners, way), keep) == 1.0)
          continue;
        ++meet;
        missed += found.count({p, t}) == 0;
      }
    EXPECT_GT(meet, 10) << length;
    EXPECT_EQ(missed, 0) << length;
    const std::size_t all = skin.size() * net.triangles.size();
    EXPECT_LT(found.size(), all / 10) << length << ": else nothing is looked for";
  }
}

TEST(SelfContact, NothingIsActiveInAnOrdinaryGrasp) {
  CALOT_SLOW_WHEN_SANITIZED("walls pressed on each other");
  test::FundusField grasped(test::grasper_scene());
  Organ& organ = grasped.field.organs[0];
  for (const auto& [depth, jaw] :
       {std::pair{15e-3, test::open_jaw}, {-4e-3, test::open_jaw}, {-4e-3, 0.0}, {4e-3, 0.0}}) {
    ASSERT_EQ(grasped.reach(depth, jaw), "");
    EXPECT_TRUE(organ.search.own.touching(*organ.body, organ.state.x).empty());
  }
  ASSERT_TRUE(grasped.field.tools[0].jaw_stopped);
  EXPECT_EQ(grasped.field.group.work.matrix.entries().size(), organ.body->pattern().entries().size());
}

/// A slack ball that closed jaws press down on from above until its wall comes to the wall that the bed holds.
struct PressedThrough {
  Field field;
  Organ& organ;
  std::string why;

  explicit PressedThrough(bool contact)
      : field(test::make_field(slack(), 1e-6, Vec3::UnitZ())), organ(field.organs[0]) {
    organ.search.own.active = contact;
    test::add_grasper(field, Vec3(40e-3, 20e-3, 150e-3));
    for (double height : {50e-3, 12e-3, -2e-3})
      if (why.empty()) why = test::move_tip(field, Vec3(0, 0, height), 0.0);
  }
  static OrganDefinition slack() {
    OrganDefinition organ = test::held_ball();
    organ.bile.fill_volume = 22e-6;
    return organ;
  }
  std::size_t crossings() const {
    return touching_pairs({organ.body->skin_positions(organ.state.x), organ.body->skin().triangles}, 0.0)
        .size();
  }
};

TEST(SelfContact, AnInstrumentPressesWallOnWallNotThroughIt) {
  CALOT_SLOW_WHEN_SANITIZED("walls pressed on each other");
  const PressedThrough without(false), with(true);
  ASSERT_EQ(without.why + with.why, "");
  EXPECT_GT(without.crossings(), 50u);
  EXPECT_EQ(with.crossings(), 0u);
  EXPECT_FALSE(with.organ.search.own.touching(*with.organ.body, with.organ.state.x).empty());
  // What the walls do to each other counts in no tool's load: that is what the bed answers, with the bile's weight.
  const Vec3 weight = -test::bile_weight(with.organ) * Vec3::UnitZ();
  const Vec3 left_over = test::bed_force(with.organ) + weight - test::tool_force(with.field);
  EXPECT_LT(left_over.norm(), 1e-4 * test::tool_force(with.field).norm());
}

TEST(SelfContact, WallsSqueezedFlatDoNotPassThroughEachOther) {
  CALOT_SLOW_WHEN_SANITIZED("walls pressed on each other");
  Pinched without(false), with(true);
  for (Pinched* pinched : {&without, &with}) ASSERT_TRUE(pinched->press(0, 10));
  EXPECT_GT(without.crossings(), 100u);
  EXPECT_EQ(with.crossings(), 0u);
  EXPECT_GT(with.organ.search.own.touching(*with.organ.body, with.organ.state.x).size(), 100u);
  // Apart again, the matrix is the body's own.
  ASSERT_TRUE(with.press(5e-3, 2));
  EXPECT_EQ(with.field.group.work.matrix.entries().size(), with.organ.body->pattern().entries().size());
}

}  // namespace
}  // namespace calot
