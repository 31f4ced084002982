#include "geometry/turn.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace calot {
namespace {

Eigen::Matrix3Xd cloud(Rng& rng, int count) {
  Eigen::Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = test::random_vector(rng, 1.0);
  return points;
}

Mat3 random_turn(Rng& rng) {
  return Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), test::random_vector(rng, 1.0).normalized()).matrix();
}

double misfit(const Mat3& turn, const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  Eigen::Matrix3Xd left = to - turn * from;
  left.colwise() -= Vec3(left.rowwise().mean());
  return left.squaredNorm();
}

TEST(BestTurn, FindsARigidMotionsTurn) {
  Rng rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3Xd from = cloud(rng, 20);
    const Mat3 turn = random_turn(rng);
    const Eigen::Matrix3Xd to = (turn * from).colwise() + test::random_vector(rng, 5.0);
    EXPECT_LT((best_turn(from, to) - turn).norm(), 1e-13);  // rounding
  }
}

TEST(BestTurn, IsARotationAndNoneNearItFitsBetter) {
  Rng rng(2);
  for (int trial = 0; trial < 50; ++trial) {
    // Every other one mirrored: the best orthogonal matrix would then be no rotation.
    Eigen::Matrix3Xd from = cloud(rng, 12), to = random_turn(rng) * from + 0.3 * cloud(rng, 12);
    if (trial % 2) to.row(1) *= -1;
    const Mat3 best = best_turn(from, to);
    EXPECT_LT((best.transpose() * best - Mat3::Identity()).norm(), 1e-13);
    EXPECT_NEAR(best.determinant(), 1, 1e-13);
    for (int k = 0; k < 20; ++k) {
      const Mat3 other = Eigen::AngleAxisd(0.01, test::random_vector(rng, 1.0).normalized()).matrix() * best;
      EXPECT_GT(misfit(other, from, to), misfit(best, from, to));
    }
  }
}

/// Squared distances of motions from a shift and the turn `spin` x place.
double misfit_of_spin(const Vec3& spin, const Eigen::Matrix3Xd& at, const Eigen::Matrix3Xd& motions) {
  Eigen::Matrix3Xd left = motions;
  for (Eigen::Index i = 0; i < at.cols(); ++i) left.col(i) -= spin.cross(Vec3(at.col(i)));
  left.colwise() -= Vec3(left.rowwise().mean());
  return left.squaredNorm();
}

TEST(BestSpin, NoneNearItFitsBetter) {
  Rng rng(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3Xd at = cloud(rng, 12), motions = cloud(rng, 12);
    const Vec3 best = best_spin(at, motions);
    EXPECT_GT(best.norm(), 1e-3);
    for (int k = 0; k < 20; ++k)
      EXPECT_GT(misfit_of_spin(best + 0.01 * test::random_vector(rng, 1.0).normalized(), at, motions),
                misfit_of_spin(best, at, motions));
  }
}

TEST(BestSpin, OfPointsOnALineOrInOneIsFinite) {
  Eigen::Matrix3Xd line(3, 3), motions(3, 3);
  line << 0, 1, 3, 0, 0, 0, 0, 0, 0;
  motions << 0, 0, 0, 0, 2, 6, 0, 0, 0;  // a turn by 2 about z
  EXPECT_LT((best_spin(line, motions) - Vec3(0, 0, 2)).norm(), 1e-8);
  EXPECT_EQ(best_spin(Eigen::Matrix3Xd::Ones(3, 4), motions.replicate(1, 2).leftCols(4)), Vec3::Zero());
}

TEST(Spread, GrowsWithThePointsAndDoesNotMindMotions) {
  Rng rng(3);
  const Eigen::Matrix3Xd points = cloud(rng, 30);
  const Eigen::Matrix3Xd moved = (2.5 * random_turn(rng) * points).colwise() + Vec3(4, 5, 6);
  EXPECT_NEAR(spread_of(moved) / spread_of(points), 2.5, 1e-13);
}

}  // namespace
}  // namespace calot
