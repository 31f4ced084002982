// The organ's whole energy, contact included, and the measure of who is inside whom.

#include "group/equilibrium.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <limits>

#include "field_rig.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// `shape_at` the way out at which its distance to the nearest skin point is `gap`.
Shape at_gap(const std::vector<Vec3>& skin, double gap, const std::function<Shape(double way)>& shape_at) {
  double way = 0;
  for (int round = 0; round < 60; ++round) {
    double nearest = 1;
    const Shape shape = shape_at(way);
    for (const Vec3& p : skin) nearest = std::min(nearest, signed_distance(shape, p));
    way += gap - nearest;
  }
  return shape_at(way);
}

/// A ball deformed at random, with a plane, a shaft and a jaw half the range of contact from its skin, a gripped point,
/// two that rub, springs on its details and a load.
struct Touched {
  Field field;
  Organ& organ;
  ContactLoads around;
  VecX x;

  /// With `levels` the ball has extensions where it is touched.
  explicit Touched(std::uint64_t seed, int levels = 0)
      : field(test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ(), {}, levels)), organ(field.organs[0]) {
    Rng rng(seed);
    if (levels > 0) {
      const std::vector<Vec3>& rest = organ.body->skin_rest();
      const auto far = [&](const Vec3& along) {
        int best = 0;
        for (int i = 0; i < static_cast<int>(rest.size()); ++i)
          if (rest[i].dot(along) > rest[best].dot(along)) best = i;
        return best;
      };
      test::extend(field, {far(Vec3(1, 0.2, 0.3)), far(Vec3(-0.3, 1, 0.2)), far(Vec3(0.1, -1, 0.4))});
    }
    x = organ.state.x;
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += rng.uniform(-0.3e-3, 0.3e-3);
    const std::vector<Vec3> skin = organ.body->skin_positions(x), out = organ.body->skin_normals(x);
    const auto highest = [&](const Vec3& along) {
      int best = 0;
      for (int i = 0; i < static_cast<int>(skin.size()); ++i)
        if (skin[i].dot(along) > skin[best].dot(along)) best = i;
      return best;
    };
    constexpr double gap = 0.5 * contact_barrier.range;
    const int a = highest(Vec3(1, 0.2, 0.3)), b = highest(Vec3(-0.3, 1, 0.2)),
              c = highest(Vec3(0.1, -1, 0.4));
    around.shapes.push_back(
        Plane{skin[a] + gap * Vec3(1, 0.2, 0.3).normalized(), -Vec3(1, 0.2, 0.3).normalized()});
    const Vec3 side = out[b].unitOrthogonal();
    around.shapes.push_back(at_gap(skin, gap, [&](double way) -> Shape {
      const Vec3 axis = skin[b] + way * out[b];
      return Capsule{axis - 30e-3 * side, axis + 30e-3 * side, 2.5e-3};
    }));
    Pose jaw = Pose::Identity();
    const Vec3 across = out[c].unitOrthogonal();  // not by FromTwoVectors, whose templates take six seconds
    jaw.linear() << across, out[c].cross(across), out[c];
    around.shapes.push_back(at_gap(skin, gap, [&](double way) -> Shape {
      jaw.translation() = skin[c] + way * out[c];
      return RoundedBox{jaw, {2e-3, 6e-3, 1.2e-3}, 0.8e-3};
    }));
    around.grip.row = {highest(Vec3::UnitZ())};
    around.grip.target = {skin[around.grip.row[0]] + Vec3(0.2e-3, -0.1e-3, 0.3e-3)};
    around.grip.stiffness = {1e3};
    // One that sticks and one that slides.
    ContactPlaces places(organ.body->skin(), x);
    const auto hold = [&](int row, int shape, double away) {
      const int point = contact_beside(row);
      around.friction.points.push_back({point, shape, {places.at(point) + away * side, out[row], 0.1, 1e3}});
    };
    hold(a, 0, 20e-6);
    hold(b, 1, 0.4e-3);
    for (std::size_t i = 0; i < organ.body->details().size(); ++i)
      around.detail_holds.push_back(rng.uniform(0, 1e3));
    around.load = VecX::Zero(x.size());
    for (double& force : around.load) force = rng.uniform(-0.1, 0.1);
  }
  /// A contact point of a triangle that has the skin point for a corner.
  int contact_beside(int row) const {
    const std::vector<Triangle>& triangles = organ.body->skin().triangles;
    const auto has = [&](const Triangle& t) { return std::find(t.begin(), t.end(), row) != t.end(); };
    const auto found = std::find_if(triangles.begin(), triangles.end(), has);
    return static_cast<int>(found - triangles.begin()) * contacts_each;
  }
  BodyProblem problem() {
    return {*organ.body, around, gather_pairs(*organ.body, x, around, 0.0), organ.state};
  }
};

TEST(Equilibrium, GradientIsTheSlopeOfTheWholeEnergyAndHessianItsOwnSlope) {
  CALOT_SLOW_WHEN_SANITIZED("differences of every coordinate");
  for (std::uint64_t seed : {1, 2, 3, 4}) {
    Touched touched(seed, seed <= 2 ? 0 : static_cast<int>(seed) - 2);
    if (seed > 2) {
      ASSERT_GT(touched.organ.body->details().size(), 24u);
    }
    ASSERT_GT(contact_forces(*touched.organ.body, touched.x, touched.around,
                             gather_pairs(*touched.organ.body, touched.x, touched.around, 0.0))
                  .size(),
              5u);
    const BodyProblem problem = touched.problem();
    ContactLoads otherwise = touched.around;
    otherwise.detail_holds.clear();
    otherwise.load.resize(0);
    const BodyProblem of_others(*touched.organ.body, otherwise,
                                gather_pairs(*touched.organ.body, touched.x, otherwise, 0.0),
                                touched.organ.state);
    double held = -touched.around.load.dot(touched.x);
    for (std::size_t i = 0; i < touched.around.detail_holds.size(); ++i) {
      const Eigen::Index at = 3 * (touched.organ.body->coarse_nodes() + static_cast<Eigen::Index>(i));
      held += 0.5 * touched.around.detail_holds[i] * touched.x.segment<3>(at).squaredNorm();
    }
    EXPECT_NEAR(problem.value(touched.x) - of_others.value(touched.x), held, 1e-9 * std::abs(held));
    VecX gradient, internal;
    problem.gradient(touched.x, gradient, internal);
    VecX with_constraint, internal_too, volume, volume_alone;
    Eigen::MatrixXd of_volume, of_volume_alone;
    problem.gradient_and_constraint(touched.x, with_constraint, internal_too, volume, of_volume);
    problem.constraint(touched.x, volume_alone, of_volume_alone);
    EXPECT_EQ(volume, volume_alone);
    EXPECT_EQ(with_constraint, gradient);
    EXPECT_EQ(internal_too, internal);
    EXPECT_EQ(of_volume, of_volume_alone);
    BlockMatrix hessian = touched.organ.body->pattern();
    problem.hessian(touched.x, VecX::Zero(1), hessian);
    Rng rng(10 + seed);
    VecX d(touched.x.size());
    for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = rng.uniform(-1, 1);
    const auto gradient_at = [&](double share) {
      VecX g, scale;
      problem.gradient(touched.x + share * d, g, scale);
      return g;
    };
    // A step of 1e-4 of the gap: central differences are off by its square; of the value, by its rounding
    // too.
    constexpr double h = 5e-9;
    const double by_value =
        (problem.value(touched.x + 2 * h * d) - problem.value(touched.x - 2 * h * d)) / (4 * h);
    EXPECT_NE(by_value, 0.0);
    EXPECT_NEAR(gradient.dot(d), by_value, 1e-6 * gradient.norm() * d.norm());
    const VecX by_gradient = (gradient_at(h) - gradient_at(-h)) / (2 * h);
    EXPECT_GT(by_gradient.norm(), 0.0);
    EXPECT_LT((hessian.multiply(d) - by_gradient).norm(), 1e-7 * by_gradient.norm());
  }
}

TEST(Equilibrium, ConvexityTakesAwayWhatContactCurvesBy) {
  Touched touched(1, 0);
  const BodyProblem problem = touched.problem();
  BlockMatrix hessian = touched.organ.body->pattern();
  problem.hessian(touched.x, VecX::Zero(1), hessian);
  const Eigen::MatrixXd before = test::dense(hessian);
  ASSERT_TRUE(problem.add_convexity(touched.x, hessian));
  const VecX added =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(test::dense(hessian) - before, Eigen::EigenvaluesOnly)
          .eigenvalues();
  EXPECT_GT(added.maxCoeff(), 1);  // N/m
  EXPECT_GT(added.minCoeff(), -1e-9 * added.maxCoeff());
  const auto pairs = gather_pairs(*touched.organ.body, touched.x, touched.around, 0.0);
  TouchMemory memory;
  for (const Touch& touch : memory.at(*touched.organ.body, touched.x, touched.around, pairs, 0.0)) {
    const Mat3 left = contact_hessian(touched.around, touch) - contact_bend(touched.around, touch);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(left).eigenvalues().minCoeff(), -1e-9 * left.norm());
  }
}

TEST(Equilibrium, EveryPointThatCanTouchIsGatheredWhereverTheSkinGoes) {
  Touched touched(4);
  const ShellBody& body = *touched.organ.body->as_shell();
  const std::vector<ContactPair> pairs = gather_pairs(body, touched.x, touched.around, 0.0);
  ContactPlaces places(body.skin(), touched.x);
  std::size_t gathered = 0, near = 0;
  for (int shape = 0; shape < 3; ++shape)
    for (int triangle = 0; triangle < static_cast<int>(body.skin().triangles.size()); ++triangle) {
      double nearest = 1;  // m
      for (int point = triangle * contacts_each; point < (triangle + 1) * contacts_each; ++point)
        nearest = std::min(nearest, signed_distance(touched.around.shapes[shape], places.at(point)));
      const bool found =
          gathered < pairs.size() && pairs[gathered].shape == shape && pairs[gathered].triangle == triangle;
      if (found) {
        EXPECT_LE(pairs[gathered].distance, nearest + 1e-15);  // m, rounding
      }
      gathered += found;
      if (nearest >= touched.around.barrier.range + contact_margin) continue;
      EXPECT_TRUE(found) << "triangle " << triangle << ", shape " << shape;
      ++near;
    }
  EXPECT_EQ(gathered, pairs.size()) << "each once, in order";
  EXPECT_GT(near, 100u);
  EXPECT_LT(static_cast<double>(gathered), 1.05 * static_cast<double>(near))
      << "bounds are near what they bound";
}

TEST(Equilibrium, ATrianglesNearnessBoundsTheDistanceOfItsPoints) {
  Touched touched(9);
  ContactPlaces places(touched.organ.body->skin(), touched.x);
  double widest = 0;  // of the bounds that matter, m
  for (const Shape& shape : touched.around.shapes)
    for (int triangle = 0; triangle < static_cast<int>(touched.organ.body->skin().triangles.size());
         ++triangle) {
      const Nearness near = places.nearness(triangle, shape);
      for (int point = triangle * contacts_each; point < (triangle + 1) * contacts_each; ++point) {
        const double distance = signed_distance(shape, places.at(point));
        EXPECT_LE(near.of_all(), near.of(point));
        EXPECT_LE(near.of(point), distance + 1e-15);  // m, rounding
        if (distance < contact_barrier.range) widest = std::max(widest, distance - near.of(point));
      }
    }
  EXPECT_GT(widest, 0);
  // An edge 0.8 mm round falls away from its tangent plane by 0.2 mm within half a triangle.
  EXPECT_LT(widest, 0.25e-3);
}

TEST(Equilibrium, ABodyThatIsFarFromItsRestIsNotHeldUpByTheMarginOfItsPairs) {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  Organ& organ = field.organs[0];
  const VecX rest = organ.state.x;
  constexpr double far = 40e-3;  // m, of which the first solve may go contact_margin
  for (Eigen::Index z = 2; z < rest.size(); z += 3) organ.state.x[z] += far;
  ContactLoads around;
  around.shapes = {Plane{Vec3(0, 0, -1), Vec3::UnitZ()}};
  const NewtonResult back = settle({*organ.body, around, organ.search, organ.state}, {}, field.group.work);
  ASSERT_TRUE(back.converged());
  EXPECT_LT(back.iterations, far / contact_margin / 1.5);
  EXPECT_LT((organ.state.x - rest).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_EQ(organ.search.margin, contact_margin) << "the next solve depends on no other";
}

TEST(Equilibrium, TheSearchThatRemembersFindsTheSamePairsAsOneThatDoesNot) {
  CALOT_SLOW_WHEN_SANITIZED("hundreds of searches");
  Touched touched(6);
  ContactSearch search;
  Rng rng(7);
  std::size_t found = 0;
  for (int step = 0; step < 60; ++step) {
    // Skin and shapes drift by up to 1 mm a step, far beyond what is remembered.
    for (Eigen::Index i = 0; i < touched.x.size(); ++i) touched.x[i] += rng.uniform(-0.2e-3, 0.2e-3);
    const Vec3 drift = test::random_vector(rng, 1e-3);
    std::get<Capsule>(touched.around.shapes[1]).a += drift;
    std::get<RoundedBox>(touched.around.shapes[2]).pose.translation() += drift;
    const double extra = step % 3 * 1e-3;
    const std::vector<ContactPair> all = gather_pairs(*touched.organ.body, touched.x, touched.around, extra);
    const std::vector<ContactPair> some = search.pairs(*touched.organ.body, touched.x, touched.around, extra);
    // Bounds may bring in some from beyond the reach, in the same order.
    ASSERT_GE(some.size(), all.size()) << "step " << step;
    std::size_t i = 0;
    for (const ContactPair& pair : some) {
      ContactPlaces places(touched.organ.body->skin(), touched.x);
      const double distance = places.nearness(pair.triangle, touched.around.shapes[pair.shape]).of_all();
      EXPECT_LE(pair.distance, distance + 1e-15);
      if (pair.distance < ContactSearch::exact) {
        EXPECT_EQ(pair.distance, distance);
      }
      if (i < all.size() && pair.triangle == all[i].triangle && pair.shape == all[i].shape) ++i;
    }
    EXPECT_EQ(i, all.size()) << "step " << step;
    found += all.size();
  }
  EXPECT_GT(found, 10000u);
}

TEST(Equilibrium, TheSearchDoesNotRememberWhatItSawOfAStateThatIsNoNumber) {
  Touched touched(8);
  const std::size_t all = gather_pairs(*touched.organ.body, touched.x, touched.around, 0.0).size();
  ASSERT_GT(all, 100u);
  ContactSearch search;
  const VecX broken = VecX::Constant(touched.x.size(), std::numeric_limits<double>::quiet_NaN());
  search.pairs(*touched.organ.body, broken, touched.around, 0.0);
  EXPECT_EQ(search.pairs(*touched.organ.body, touched.x, touched.around, 0.0).size(), all);
  search.pairs(*touched.organ.body, broken, touched.around, 0.0);
  EXPECT_EQ(search.pairs(*touched.organ.body, touched.x, touched.around, 0.0).size(), all);
}

TEST(Equilibrium, PenetrationIsSeenBetweenTheSkinsPointsToo) {
  Touched touched(5);
  Field& field = touched.field;
  const std::vector<Vec3> skin = touched.organ.body->skin_positions(touched.organ.state.x);
  const Triangle& t = touched.organ.body->skin().triangles[500];
  const Vec3 middle = (skin[t[0]] + skin[t[1]] + skin[t[2]]) / 3.0;
  const Vec3 out = (skin[t[1]] - skin[t[0]]).cross(skin[t[2]] - skin[t[0]]).normalized();
  test::add_grasper(field, middle + 100e-3 * out);
  Tool& tool = field.tools[0];
  for (double depth : {-0.1e-3, 0.05e-3, 0.3e-3}) {
    tool.pose = pose_reaching(tool.trocar, middle - depth * out, 0.0, 0.0);
    const double found = deepest_penetration(field);
    if (depth < 0) {
      EXPECT_EQ(found, 0.0);
    } else {
      // The tip is the jaws' rounded end: what it leaves out at the nearest sample is below 0.02 mm.
      EXPECT_NEAR(found, depth, 0.02e-3);
    }
  }
}

}  // namespace
}  // namespace calot
