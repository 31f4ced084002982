// A solid in pieces that turn: derivatives, rigid motions, and what condensation leaves of the whole.

#include "fem/framed_solid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "numerics/dense_cholesky.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/solids.h"

namespace calot {
namespace {

constexpr ElasticSolid liver{6e3, 0.45};

FramedSolid reduced(const test::BentBox& box) {
  return FramedSolid(box.rest, reduce(box.mesh, box.rest, liver).value().parts);
}

VecX gradient_of(const FramedSolid& solid, const VecX& x) {
  VecX out = VecX::Zero(x.size());
  solid.add_gradient(x, out);
  return out;
}

/// Turned, bent by half a radian and dented.
VecX thrown(const VecX& rest, std::uint64_t seed) {
  Rng rng(seed);
  VecX x = rest;
  for (int i = 0; i < x.size(); i += 3) {
    const double turn = 0.5 * x[i + 1] / 70e-3;
    x.segment<3>(i) = (Eigen::AngleAxisd(turn, Vec3::UnitX()) * Vec3(x.segment<3>(i))).eval();
  }
  x += test::random_coordinates(rng, static_cast<int>(x.size()), 0.3e-3);
  return test::moved(test::random_motion(rng, 0.1), x);
}

TEST(FramedSolid, GradientAndHessianAreTheDerivativesOfOneEnergy) {
  const test::BentBox box = test::bent_box({1, 2, 1}, 2, test::wedge);
  const FramedSolid solid = reduced(box);
  ASSERT_EQ(solid.parts().pieces.size(), 2u);
  for (std::uint64_t seed : {1, 2}) {
    const VecX x = thrown(box.rest, seed);
    const VecX g = gradient_of(solid, x);
    EXPECT_GT(solid.value(x), 1e-4);
    const auto value = [&](const VecX& y) { return solid.value(y); };
    const auto gradient = [&](const VecX& y) { return gradient_of(solid, y); };
    // Widths of 1e-2 m: differences are wrong by (1e-6 / 1e-2)^2 and by rounding.
    EXPECT_LT(test::relative_error(g, test::difference_gradient(value, x, 1e-6)), 1e-6);
    BlockMatrix h(box.mesh.nodes, solid.cliques());
    solid.add_hessian(x, h);
    EXPECT_LT(test::relative_error(test::dense(h), test::difference_hessian(gradient, x, 1e-6)), 1e-6);
  }
}

TEST(FramedSolid, RigidMotionsCostNothingAndChangeNoEnergy) {
  Rng rng(3);
  const test::BentBox box = test::bent_box({1, 2, 1}, 2, test::wedge);
  const FramedSolid solid = reduced(box);
  const VecX x = thrown(box.rest, 4), f = gradient_of(solid, x);
  const double energy = solid.value(x);
  for (int trial = 0; trial < 5; ++trial) {
    const Pose motion = test::random_motion(rng, 0.1);
    EXPECT_LT(solid.value(test::moved(motion, box.rest)), 1e-16 * energy);
    const VecX there = test::moved(motion, x);
    EXPECT_NEAR(solid.value(there), energy, 1e-9 * energy);
    EXPECT_LT(test::relative_error(gradient_of(solid, there), test::turned(motion.linear(), f)), 1e-8);
    for (const Mat3& frame : solid.frames(test::moved(motion, box.rest)))
      EXPECT_LT((frame - motion.linear()).norm(), 1e-10);
  }
  EXPECT_LT(test::net_force(f).norm(), 1e-10 * f.norm());
  EXPECT_LT(test::net_torque(x, f, Vec3::Zero()).norm(), 1e-10 * f.norm() * x.norm());
}

TEST(FramedSolid, WithAllFramesEqualTheCondensedStaticsAreThoseOfTheWhole) {
  const test::BentBox box = test::bent_box({2, 4, 2}, 4, test::wedge);
  const FramedSolid solid = reduced(box);
  ASSERT_EQ(solid.parts().pieces.size(), 4u);
  // To first order about rest no frame turns: the Hessian there is the sum of the pieces' stiffnesses.
  Eigen::MatrixXd condensed = Eigen::MatrixXd::Zero(box.rest.size(), box.rest.size());
  for (const FramedSolid::Stiffness& s : solid.parts().stiffness) {
    const std::vector<int>&rows = solid.parts().pieces[s.one].nodes,
          &columns = solid.parts().pieces[s.other].nodes;
    for (std::size_t a = 0; a < rows.size(); ++a)
      for (std::size_t b = 0; b < columns.size(); ++b) {
        const Mat3 block =
            s.block.block<3, 3>(3 * static_cast<Eigen::Index>(a), 3 * static_cast<Eigen::Index>(b));
        condensed.block<3, 3>(3 * rows[a], 3 * columns[b]) += block;
        if (s.one != s.other) condensed.block<3, 3>(3 * columns[b], 3 * rows[a]) += block.transpose();
      }
  }
  BlockMatrix h(box.mesh.nodes, solid.cliques());
  solid.add_hessian(box.rest, h);
  EXPECT_LT(test::relative_error(test::dense(h), condensed), 1e-10);
  const Eigen::MatrixXd whole = test::whole_stiffness(box.mesh.tets, box.points, liver);
  // Its back is held, loads act on the kept nodes.
  std::vector<Eigen::Index> of_whole, of_kept;
  for (int p = 0; p < box.grid.points(); ++p)
    if (box.grid.place(p)[1] > 0)
      for (int c = 0; c < 3; ++c) of_whole.push_back(3 * p + c);
  for (std::size_t k = 0; k < box.kept.size(); ++k)
    if (box.grid.place(box.kept[k])[1] > 0)
      for (int c = 0; c < 3; ++c) of_kept.push_back(3 * static_cast<Eigen::Index>(k) + c);
  Rng rng(5);
  const VecX load = test::random_coordinates(rng, static_cast<int>(of_kept.size()), 1.0);
  VecX on_whole = VecX::Zero(whole.rows());
  for (std::size_t i = 0; i < of_kept.size(); ++i)
    on_whole[3 * box.kept[static_cast<std::size_t>(of_kept[i] / 3)] + of_kept[i] % 3] =
        load[static_cast<Eigen::Index>(i)];
  const auto solved = [](Eigen::MatrixXd stiffness, const VecX& of) {
    EXPECT_TRUE(cholesky_in_place(stiffness));
    return cholesky_solve(stiffness, of);
  };
  const VecX exact = solved(whole(of_whole, of_whole), on_whole(of_whole));
  VecX moved = VecX::Zero(whole.rows());
  moved(of_whole) = exact;
  const VecX found = solved(condensed(of_kept, of_kept), load);
  double worst = 0;
  for (std::size_t i = 0; i < of_kept.size(); ++i)
    worst = std::max(
        worst, std::abs(found[static_cast<Eigen::Index>(i)] -
                        moved[3 * box.kept[static_cast<std::size_t>(of_kept[i] / 3)] + of_kept[i] % 3]));
  EXPECT_LT(worst, 1e-10 * exact.cwiseAbs().maxCoeff());
}

TEST(FramedSolid, ABarUnderTensionStretchesByHookesLawAndThinsByPoissons) {
  const auto bar = [](const Vec3& s) { return Vec3(20e-3 * s.x(), 60e-3 * s.y(), 20e-3 * s.z()); };
  const test::BentBox box = test::bent_box({1, 3, 1}, 3, bar);
  const FramedSolid solid = reduced(box);
  constexpr double strain = 0.01;
  VecX x = box.rest;
  for (int i = 0; i < x.size(); i += 3) {
    x[i] *= 1 - liver.poisson * strain, x[i + 2] *= 1 - liver.poisson * strain;
    x[i + 1] *= 1 + strain;
  }
  const double volume = 20e-3 * 20e-3 * 60e-3;
  EXPECT_NEAR(solid.value(x), 0.5 * liver.young * strain * strain * volume, 1e-9 * solid.value(x));
  Vec3 pull = Vec3::Zero();
  const VecX f = gradient_of(solid, x);
  for (int i = 0; i < x.size(); i += 3)
    if (box.rest[i + 1] > 59e-3) pull += f.segment<3>(i);
  const double expected = liver.young * strain * 20e-3 * 20e-3;
  EXPECT_LT((pull - expected * Vec3::UnitY()).norm(), 1e-9 * expected);
}

TEST(FramedSolid, APieceInsideOutIsNotAdmissible) {
  const test::BentBox box = test::bent_box({1, 2, 1}, 2, test::wedge);
  VecX x = box.rest;
  for (int i = 0; i < x.size(); i += 3) x[i] = -x[i];
  EXPECT_FALSE(std::isfinite(reduced(box).value(x)));
  const test::BentBox folded =
      test::bent_box({1, 2, 1}, 1, [](const Vec3& s) { return Vec3(s.x(), s.y(), -s.z()); });
  EXPECT_EQ(reduce(folded.mesh, folded.rest, liver).failure().kind, FailureKind::scenario);
}

// As strands do that stand alone. Frames that turn one by one then find the least energy ever more slowly, or another one.
TEST(FramedSolid, HoweverFarAPlaceIsDrawnOutItsEnergyIsFiniteAndItsForceTheSlope) {
  const test::BentBox box = test::bent_box({2, 4, 2}, 4, test::wedge);
  const FramedSolid solid = reduced(box);
  const VecX x = thrown(box.rest, 6);
  const Vec3 out = Vec3(0.2, 0.3, 1).normalized();
  double before = 0;
  for (double way = 0; way < 100e-3; way += 2e-3) {
    const auto drawn = [&](double by) {
      VecX at = x;
      at.tail<3>() += by * out;
      return at;
    };
    const double energy = solid.value(drawn(way));
    ASSERT_TRUE(std::isfinite(energy)) << way;
    if (way > 0) EXPECT_GT(energy, before) << way;
    before = energy;
    const VecX g = gradient_of(solid, drawn(way));
    constexpr double step = 1e-6;  // m; differences are wrong by (1e-6 / 1e-2)^2 and by rounding
    const double slope = (solid.value(drawn(way + step)) - solid.value(drawn(way - step))) / (2 * step);
    EXPECT_NEAR(g.tail<3>().dot(out), slope, 1e-6 * g.norm()) << way;
  }
}

TEST(Tetrahedron, ItsRuleIntegratesProductsOfItsFunctionsExactly) {
  const std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(2e-2, 0, 1e-3), Vec3(1e-3, 3e-2, 0),
                                    Vec3(0, 2e-3, 1e-2)};
  std::array<Vec3, 10> points;
  for (int k = 0; k < 4; ++k) points[k] = corners[k];
  constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (int e = 0; e < 6; ++e) points[4 + e] = 0.5 * (corners[edges[e][0]] + corners[edges[e][1]]);
  const double volume =
      (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0])) / 6;
  const Eigen::Matrix<double, 10, 10> products = tet_products(points);
  // The closed forms of a quadratic tetrahedron's mass: 6, 1, -4, -6, 32, 16 and 8 of 420.
  EXPECT_NEAR(products(0, 0), 6 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(0, 1), 1 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(0, 4), -4 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(0, 5), -6 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(4, 4), 32 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(4, 5), 16 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products(4, 9), 8 * volume / 420, 1e-12 * volume);
  EXPECT_NEAR(products.sum(), volume, 1e-12 * volume);
}

}  // namespace
}  // namespace calot
