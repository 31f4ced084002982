#include "numerics/retardation.h"

#include <gtest/gtest.h>

#include "spring_net.h"

namespace calot {
namespace {

using test::Net;

/// A net's energy as an energy that adds.
struct Adding {
  const Net& net;

  double value(const VecX& x) const { return net.value(x); }
  void add_gradient(const VecX& x, VecX& gradient) const {
    VecX g;
    double internal = 0;
    net.gradient(x, g, internal);
    gradient += g;
  }
  void add_hessian(const VecX& x, BlockMatrix& matrix) const {
    BlockMatrix own = matrix.blank();
    net.hessian(x, 0, own);
    matrix.add(own.entries());
  }
};

TEST(Retardation, ItsDerivativesAreThoseOfItsEnergy) {
  const Net net(false);
  const Adding energy{net};
  Rng rng(1);
  const VecX begin = net.rest() + test::random_coordinates(rng, 18, 0.1),
             x = begin + test::random_coordinates(rng, 18, 0.1);
  for (double tau : {0.0, 0.013, 0.08}) {
    const Retardation retarded(tau, 0.02, begin);
    const auto slope = [&](const VecX& y) {
      VecX out = VecX::Zero(y.size());
      retarded.add_gradient(energy, y, out);
      return out;
    };
    EXPECT_LT(test::relative_error(slope(x),
                                   test::difference_gradient(
                                       [&](const VecX& y) { return retarded.value(energy, y); }, x, 1e-5)),
              1e-7);
    BlockMatrix matrix = net.workspace().matrix;
    matrix.add(0, 0, Mat3::Constant(7));  // overwritten
    retarded.hessian(energy, x, matrix);
    EXPECT_LT(test::relative_error(test::dense(matrix), test::difference_hessian(slope, x, 1e-5)), 1e-7);
    // The forces at x + tau dx/dt.
    VecX ahead = VecX::Zero(x.size());
    energy.add_gradient(x + tau * (x - begin) / 0.02, ahead);
    EXPECT_LT((slope(x) - ahead).norm(), 1e-13 * ahead.norm());
    EXPECT_NEAR(retarded.value(energy, begin), net.value(begin) / (1 + tau / 0.02), 1e-14);
  }
}

TEST(Retardation, RestIsWhereItWasAndATranslationIsNotDamped) {
  Net loose(false);
  loose.ground = 0;
  loose.load.setZero();
  const Adding energy{loose};
  Rng rng(2);
  const VecX begin = loose.rest() + test::random_coordinates(rng, 18, 0.1);
  const Retardation retarded(0.05, 0.02, begin);
  VecX at_rest = VecX::Zero(18), still = at_rest, moved = at_rest, x = begin;
  energy.add_gradient(begin, still);
  retarded.add_gradient(energy, begin, at_rest);
  EXPECT_EQ(at_rest, still);
  for (int i = 0; i < 18; i += 3) x.segment<3>(i) += Vec3(0.3, -0.2, 0.7);
  retarded.add_gradient(energy, x, moved);
  EXPECT_GT(still.norm(), 0.1);
  EXPECT_LT((moved - still).norm(), 1e-13 * still.norm() * 10);  // 10: how far it went, ahead of itself
}

}  // namespace
}  // namespace calot
