// What presses on a body, apart from the rest of it: the same forces, and their own derivatives.

#include "group/pressed_laws.h"

#include <gtest/gtest.h>

#include "group/body_problem.h"
#include "group_rig.h"

namespace calot {
namespace {

constexpr double radius = 20e-3;

/// A ball, pressed by a bar from above and held by pads at some of its points.
struct PressedBall {
  BodyPointer body = test::soft_ball(Vec3::Zero(), radius);
  ContactLoads loads;
  VecX x = body->rest();
  std::vector<ContactPair> pairs;

  explicit PressedBall(std::uint64_t seed) {
    Rng rng(seed);
    x += test::random_coordinates(rng, static_cast<int>(x.size()), 0.1e-3);
    const Vec3 above(0, 0, radius + 3e-3 - 0.1e-3);
    loads.shapes = {Capsule{above - Vec3(5e-3, 0, 0), above + Vec3(5e-3, 0, 0), 3e-3}};
    loads.barrier.range = 0.4e-3;
    const std::vector<Vec3> skin = body->skin_positions(x);
    for (int row = 3; row < 60; row += 19) {
      loads.grip.row.push_back(row);
      loads.grip.pad.push_back(skin[row].normalized());
      // Some are pressed, within the first 20 um of the pad and beyond, others drawn off it.
      loads.grip.target.push_back(skin[row] + rng.uniform(-60e-6, 20e-6) * skin[row].normalized());
      loads.grip.stiffness.push_back(2e3);
    }
    pairs = gather_pairs(*body, x, loads, 0.0);
  }
  std::vector<Touch> touches(const VecX& at) const { return touches_of(*body, at, loads, pairs, 1.0); }
  PressedLaws laws(const VecX& step, double least) const {
    const std::vector<Touch> before = touches(x), after = touches(x + step);
    return PressedLaws(*body, loads, pairs, {x, step, before, after}, least,
                       pressed_tangents(*body, loads, before, x, false));
  }
};

VecX gradient_of(const PressedLaws& laws, const VecX& x) {
  VecX out = VecX::Zero(x.size());
  laws.add_gradient(x, out);
  return out;
}

TEST(PressedLaws, GradientAndHessianAreTheDerivativesOfTheirEnergy) {
  for (std::uint64_t seed : {1, 2, 3}) {
    const PressedBall ball(seed);
    ASSERT_GT(ball.touches(ball.x).size(), 3u);
    const VecX squeeze = -0.01 * ball.x;
    const PressedLaws laws = ball.laws(squeeze, 0);
    ASSERT_FALSE(laws.none());
    const VecX gradient = gradient_of(laws, ball.x);
    ASSERT_GT(gradient.norm(), 1e-3);
    BlockMatrix hessian = ball.body->pattern().blank(), tangents = hessian;
    laws.add_hessian(ball.x, false, hessian);
    laws.add_tangents(tangents);
    Rng rng(10 + seed);
    const VecX d = test::random_coordinates(rng, static_cast<int>(ball.x.size()), 1.0);
    constexpr double h = 1e-8;  // m: what bends over micrometres
    EXPECT_NEAR((laws.value(ball.x + h * d) - laws.value(ball.x - h * d)) / (2 * h), gradient.dot(d),
                1e-6 * gradient.norm() * d.norm());
    const VecX by_gradient =
        (gradient_of(laws, ball.x + h * d) - gradient_of(laws, ball.x - h * d)) / (2 * h);
    ASSERT_GT(by_gradient.norm(), 0);
    EXPECT_LT((hessian.multiply(d) - by_gradient).norm(), 1e-5 * by_gradient.norm());
    // The tangents that a factor has are those where it was made.
    EXPECT_LT((tangents.multiply(d) - hessian.multiply(d)).norm(), 1e-12 * by_gradient.norm());
  }
}

TEST(PressedLaws, AreOnlyThoseThatAStepBends) {
  const PressedBall ball(1);
  EXPECT_TRUE(ball.laws(VecX::Zero(ball.x.size()), 1e-12).none());
  VecX up = VecX::Zero(ball.x.size());
  for (Eigen::Index i = 2; i < up.size(); i += 3) up[i] = 0.3e-3;
  const PressedLaws all = ball.laws(up, 1e-9), some = ball.laws(up, 0.05);
  std::vector<char> of_all(ball.x.size() / 3, 0), of_some = of_all;
  all.mark_nodes(of_all);
  some.mark_nodes(of_some);
  const auto count = [](const std::vector<char>& marks) { return std::count(marks.begin(), marks.end(), 1); };
  EXPECT_GT(count(of_some), 0);
  EXPECT_LT(count(of_some), count(of_all));
  EXPECT_LT(count(of_all), ball.x.size() / 3);
  EXPECT_TRUE(ball.laws(up, 1e9).none());
  // Nodes that are not marked feel nothing of them.
  const VecX gradient = gradient_of(all, ball.x + up);
  for (std::size_t node = 0; node < of_all.size(); ++node)
    if (of_all[node] == 0) {
      EXPECT_EQ(gradient.segment<3>(3 * static_cast<Eigen::Index>(node)), Vec3::Zero());
    }
}

TEST(PressedLaws, ConvexPartHasNoNegativeEigenvalue) {
  const PressedBall ball(2);
  const PressedLaws laws = ball.laws(-0.01 * ball.x, 0);
  BlockMatrix whole = ball.body->pattern().blank(), convex = whole;
  laws.add_hessian(ball.x, false, whole);
  laws.add_hessian(ball.x, true, convex);
  const auto smallest = [](const BlockMatrix& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(test::dense(matrix), Eigen::EigenvaluesOnly)
        .eigenvalues()
        .minCoeff();
  };
  EXPECT_LT(smallest(whole), -1e-3);
  EXPECT_GT(smallest(convex), 1e-9 * smallest(whole));
}

TEST(PressedLaws, TangentsOfPlacesThatABodyDoesNotHaveAreRefused) {
  const PressedBall ball(1);
  const auto triangles = static_cast<int>(ball.body->skin().triangles.size());
  EXPECT_TRUE(fits({0, 0, contacts_each * triangles - 1}, *ball.body));
  EXPECT_FALSE(fits({0, 0, contacts_each * triangles}, *ball.body));
  EXPECT_TRUE(fits({0, -1, 0}, *ball.body));
  EXPECT_FALSE(fits({0, -1, static_cast<int>(ball.body->skin_rest().size())}, *ball.body));
  EXPECT_FALSE(fits({0, -2, 0}, *ball.body));
  EXPECT_FALSE(fits({0, 0, -1}, *ball.body));
}

}  // namespace
}  // namespace calot
