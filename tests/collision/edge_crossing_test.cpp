// The energy of crossing edges: against its formula, differences, and where it ends.

#include "collision/edge_crossing.h"

#include <gtest/gtest.h>

#include <limits>

#include "collision/simplex_distance.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

constexpr double length = 2e-3;
const Barrier barrier{0.4e-3, 20e3};
const EdgeCrossing crossing{barrier, EdgeCrossing::parallel_bound(length, length, barrier.range)};

VecX stacked(const EdgePair& e) {
  VecX x(12);
  for (int k = 0; k < 4; ++k) x.segment<3>(3 * k) = e[k];
  return x;
}
EdgePair ends_of(const VecX& x) {
  return {x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)};
}

/// Edges 2 mm long that cross near the origin at an angle, at the shares s and t of them and at this distance.
EdgePair crossed(Rng& rng, double angle, double distance, double s, double t) {
  const Vec3 u = length * Vec3::UnitX(), v = length * Vec3(std::cos(angle), std::sin(angle), 0);
  const EdgePair flat{-s * u, (1 - s) * u, -t * v + distance * Vec3::UnitZ(),
                      (1 - t) * v + distance * Vec3::UnitZ()};
  return ends_of(test::moved(test::random_motion(rng, 0), stacked(flat)));
}

TEST(EdgeCrossing, EnergyIsTheBarrierFadedAtEndsAndBetweenParallels) {
  Rng rng(1);
  const double d = 0.1e-3, whole = barrier.sample(d).energy;
  ASSERT_GT(whole, 1);
  const auto energy = [&](double angle, double s, double t) {
    const EdgePair e = crossed(rng, angle, d, s, t);
    EXPECT_NEAR(crossing.sample(e).energy, crossing.energy(e), 1e-12 * whole);
    return crossing.energy(e);
  };
  // Rounding of places against their distance of 0.1 mm.
  EXPECT_NEAR(energy(1.0, 0.5, 0.5), whole, 1e-11 * whole);
  EXPECT_NEAR(energy(1.0, 0.25, 0.5), 0.5625 * whole, 1e-11 * whole);
  EXPECT_NEAR(energy(1.0, 0.25, 0.9), 0.5625 * 0.1296 * whole, 1e-11 * whole);
  const double half = std::asin(std::sqrt(0.5) * barrier.range / length);  // c is half its bound
  EXPECT_NEAR(energy(half, 0.5, 0.5), 0.5 * whole, 1e-10 * whole);
  EXPECT_NEAR(energy(1.01 * std::asin(barrier.range / length), 0.5, 0.5), whole, 1e-10 * whole);
  EXPECT_EQ(energy(0, 0.5, 0.5), 0);
  EXPECT_EQ(crossing.energy(crossed(rng, 1.0, 0.41e-3, 0.5, 0.5)), 0);
}

/// The pair of a point and a triangle has these: no energy, force or stiffness of it may be counted here.
TEST(EdgeCrossing, WhereAnEndIsNearestNothingCounts) {
  Rng rng(2);
  int met = 0;
  for (int trial = 0; trial < 500; ++trial) {
    EdgePair e;
    for (Vec3& end : e) end = test::random_vector(rng, 0.4e-3);
    const NearestOfEdges nearest = nearest_of_edges(e);
    if (nearest.distance >= barrier.range) continue;
    const EdgeCrossing::Sample sample = crossing.sample(e);
    if (nearest.meet == EdgesMeet::between_ends) {
      ++met;
      EXPECT_GT(sample.energy, 0);
      continue;
    }
    EXPECT_EQ(crossing.energy(e), 0);
    EXPECT_EQ(sample.energy, 0);
    EXPECT_TRUE(sample.gradient.isZero(0));
    EXPECT_TRUE(sample.hessian.isZero(0));
  }
  EXPECT_GT(met, 50);
}

TEST(EdgeCrossing, GradientAndHessianAreSlopesNearlyParallelToo) {
  Rng rng(3);
  for (double angle : {1.5, 0.7, 0.3, 0.1, 0.03, 1e-2, 3e-3, 1e-3}) {
    for (int trial = 0; trial < 8; ++trial) {
      const double d = rng.uniform(0.05e-3, 0.3e-3), s = rng.uniform(0.1, 0.9), t = rng.uniform(0.1, 0.9);
      const EdgePair e = crossed(rng, angle, d, s, t);
      const EdgeCrossing::Sample at = crossing.sample(e);
      const auto value = [](const VecX& x) { return crossing.energy(ends_of(x)); };
      const auto gradient = [](const VecX& x) { return VecX(crossing.sample(ends_of(x)).gradient); };
      // The energy changes over distances, over what turns one edge into the other's direction, and over what moves
      // the nearest places by tilting the normal. Steps are 1e-4 of these: off by 1e-8 of third derivatives, some tens of
      // the first, and by rounding of 2e-19 m against steps down to 2e-12 m.
      const double beside = angle * length, step = 1e-4 * std::min({d, beside, beside * beside / d});
      const double off = angle < 1e-2 ? 2e-5 : 2e-6;
      const VecX by_value = test::difference_gradient(value, stacked(e), step);
      const Eigen::MatrixXd by_gradient = test::difference_hessian(gradient, stacked(e), step);
      EXPECT_LT((at.gradient - by_value).norm(), off * by_value.norm()) << angle;
      EXPECT_LT((at.hessian - by_gradient).norm(), off * by_gradient.norm()) << angle;
      EXPECT_GT(at.energy, 0);
      EXPECT_GT(at.gradient.norm(), at.energy / length);
      EXPECT_GT(at.hessian.norm(), at.energy / (length * length));
      EXPECT_LT((at.hessian - at.hessian.transpose()).norm(), 1e-9 * at.hessian.norm()) << angle;
    }
  }
}

TEST(EdgeCrossing, ForcesBalanceWithoutATorque) {
  Rng rng(4);
  for (double angle : {1.2, 0.02}) {
    const EdgePair e = crossed(rng, angle, 0.1e-3, 0.3, 0.6);
    const VecX force = crossing.sample(e).gradient;
    ASSERT_GT(force.norm(), 1);
    // Rounding against the angle.
    EXPECT_LT(test::net_force(force).norm(), 1e-11 * force.norm());
    EXPECT_LT(test::net_torque(stacked(e), force, e[0]).norm(), 1e-11 * force.norm() * length);
  }
}

/// In any direction from parallel, so the gradient there is one: 0.
TEST(EdgeCrossing, TheGradientEndsAndTheHessianStaysBoundedAtParallels) {
  Rng rng(7);
  double before = 0, bend_before = 0;
  for (double angle : {3e-2, 3e-3, 3e-4}) {
    double slope = 0, bend = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const EdgeCrossing::Sample at =
          crossing.sample(crossed(rng, angle, 0.1e-3, rng.uniform(0.1, 0.9), rng.uniform(0.1, 0.9)));
      slope = std::max(slope, at.gradient.norm());
      bend = std::max(bend, at.hessian.norm());
    }
    if (before > 0) {
      EXPECT_LT(slope, 0.02 * before);  // as the square of the angle
      EXPECT_LT(bend, 2 * bend_before);
    }
    before = slope;
    bend_before = bend;
  }
  EXPECT_GT(before, 0);
}

TEST(EdgeCrossing, FadingPushesEdgesAlongTheSkinLessThanTheBarrierParts) {
  Rng rng(8);
  double most = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double angle = std::pow(10.0, rng.uniform(-3, 0)), d = rng.uniform(0.02e-3, 0.35e-3);
    const EdgePair e = crossed(rng, angle, d, rng.uniform(0, 1), rng.uniform(0, 1));
    const Vec3 normal = nearest_of_edges(e).normal;
    const EdgeCrossing::Slope gradient = crossing.sample(e).gradient;
    for (int k = 0; k < 4; ++k) {
      const Vec3 force = gradient.segment<3>(3 * k);
      most = std::max(most, (force - force.dot(normal) * normal).norm() / -barrier.sample(d).derivative);
    }
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LT(most, 1);
}

/// Largest change of the gradient from one place to the next of a way, against its largest size.
double largest_jump(const std::function<EdgePair(double)>& way, int steps) {
  EdgeCrossing::Slope before = crossing.sample(way(0)).gradient;
  double jump = 0, size = 0;
  for (int k = 1; k <= steps; ++k) {
    const EdgeCrossing::Slope now = crossing.sample(way(static_cast<double>(k) / steps)).gradient;
    jump = std::max(jump, (now - before).norm());
    size = std::max(size, now.norm());
    before = now;
  }
  EXPECT_GT(size, 0);
  return jump / size;
}

TEST(EdgeCrossing, TheGradientIsContinuousThroughParallelsAndPastEnds) {
  const double d = 0.1e-3;
  const auto at = [&](double angle, double s, double t, double apart) {
    Rng rng(5);
    return crossed(rng, angle, apart, s, t);
  };
  const auto turning = [&](double share) { return at(0.1 * (share - 0.5), 0.4, 0.7, d); };
  const auto sliding = [&](double share) { return at(0.8, 1.4 * share - 0.2, 0.5, d); };
  const auto leaving = [&](double share) { return at(0.8, 0.3, 0.5, 0.5e-3 * (0.1 + share)); };
  // Of ways on which the gradient rises and falls a few times, each step is a few times its share: half the steps'
  // length is half the jump, which a jump would not be.
  for (const auto& [name, way] : {std::pair<const char*, std::function<EdgePair(double)>>{"turning", turning},
                                  {"sliding", sliding},
                                  {"leaving", leaving}}) {
    const double coarse = largest_jump(way, 2000), fine = largest_jump(way, 8000);
    EXPECT_LT(coarse, 0.02) << name;
    EXPECT_LT(fine, 0.3 * coarse) << name;
  }
}

/// What keeps skins from passing once the pair of edges has faded.
TEST(EdgeCrossing, WhereEdgesFadeAnEndIsNear) {
  Rng rng(6);
  int faded = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const double angle = std::pow(10.0, rng.uniform(-4, 0)), d = rng.uniform(0.001e-3, 0.3e-3);
    const double s = rng.uniform(0.001, 0.999), t = rng.uniform(0.001, 0.999);
    const EdgePair e = crossed(rng, angle, d, s, t);
    const double share = std::min(std::min(s, 1 - s), std::min(t, 1 - t)) * length * std::sin(angle);
    double end = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k)
      end = std::min(end, nearest_point(e[k], {e.data() + (k < 2 ? 2 : 0), 2}).distance);
    EXPECT_LE(end, std::sqrt(d * d + share * share) * (1 + 1e-9) + 1e-15);
    if (crossing.energy(e) > 0.1 * barrier.sample(d).energy) continue;
    ++faded;
    EXPECT_LT(end, barrier.range);
  }
  EXPECT_GT(faded, 100);
}

/// Beyond that they would come so near that a solver's steps are rounding: 1e-16 of the places, times what presses.
TEST(EdgeCrossing, SteepOnesThatHaveNearlyFadedCarryANewtonAtTenNanometres) {
  Rng rng(9);
  constexpr double area = 0.2e-6, near_end = 6e-4, distance = 10e-9;  // as a drawn fold's have been found
  const EdgePair e = crossed(rng, 1.2, distance, near_end, 0.13);
  const auto force = [&](bool steep) {
    const EdgeCrossing law{{0.1e-3, 200e3, 0, steep}, crossing.parallel_below};
    const EdgeCrossing::Slope gradient = law.sample(e).gradient;
    return area * (gradient.segment<3>(0) + gradient.segment<3>(3)).norm();
  };
  EXPECT_LT(force(false), 0.01);
  EXPECT_GT(force(true), 1);
}

TEST(EdgeCrossing, EdgesThatTouchAreNoStateToAccept) {
  const double half = 0.5 * length;
  const EdgePair touching{Vec3(-half, 0, 0), Vec3(half, 0, 0), Vec3(0, -half, 0), Vec3(0, half, 0)};
  EXPECT_EQ(crossing.energy(touching), std::numeric_limits<double>::infinity());
  EXPECT_EQ(crossing.sample(touching).energy, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(crossing.sample(touching).gradient.isZero(0));
}

}  // namespace
}  // namespace calot
