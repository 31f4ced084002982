#include "numerics/newton.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spring_net.h"

namespace calot {
namespace {

using test::Net;
using test::residual;

TEST(Newton, NetUsedHereHasExactDerivatives) {
  const Net net(true);
  Rng rng(2);
  const VecX x = net.rest() + test::random_coordinates(rng, 18, 0.1);
  const auto lagrangian = [&](const VecX& y) { return net.value(y) - 0.7 * net.constraint_value(y); };
  EXPECT_LT(test::relative_error(residual(net, x, 0.7), test::difference_gradient(lagrangian, x, 1e-5)),
            1e-8);
  NewtonWorkspace work = net.workspace();
  net.hessian(x, 0.7, work.matrix);
  const auto gradient = [&](const VecX& y) { return residual(net, y, 0.7); };
  EXPECT_LT(test::relative_error(test::dense(work.matrix), test::difference_hessian(gradient, x, 1e-5)),
            1e-8);
}

TEST(Newton, FindsTheStationaryPointOfANonlinearEnergy) {
  for (bool constrained : {false, true}) {
    Net net(constrained);
    net.volume *= 1.2;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    const NewtonResult result = solve_equilibrium(net, {}, work, x, multiplier);
    ASSERT_TRUE(result.converged()) << to_text(result.status);
    EXPECT_GT(result.iterations, 1);
    // The tolerance is relative to the load; a stationary point that is a minimum: energy rises around it.
    const double scale = net.load.lpNorm<Eigen::Infinity>();
    EXPECT_LT(residual(net, x, multiplier).norm(), 1e-5 * scale);
    EXPECT_LE(result.residual, 1e-6);
    EXPECT_LE(result.increment, 1e-6);
    EXPECT_GT((x - net.rest()).norm(), 1e-3);
    if (constrained) {
      EXPECT_NE(multiplier, 0);
      continue;
    }
    Rng rng(3);
    for (int trial = 0; trial < 20; ++trial)
      EXPECT_GT(net.value(x + test::random_coordinates(rng, 18, 1e-2)), net.value(x));
  }
}

/// A node in two valleys along each axis: x^4 / 4 + x^2 / 20, which is convex, less x^2 / 2.
class Valleys : public ConstrainedEnergy {
 public:
  bool knows_convexity = true;
  mutable int asked = 0;  ///< for it

  std::vector<Part> parts() const override { return {{{0, 1}, {}, 1}}; }
  int constraints() const override { return 0; }
  double value(const VecX& x) const override {
    return (x.array().pow(4) / 4 - 0.45 * x.array().square()).sum();
  }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient = x.array().cube() - 0.9 * x.array();
    largest_internal = VecX::Ones(1);
  }
  void hessian(const VecX& x, const VecX&, BlockMatrix& matrix) const override {
    matrix.set_zero();
    matrix.add(0, 0, Vec3(3 * x.array().square() - 0.9).asDiagonal());
  }
  bool add_convexity(const VecX&, BlockMatrix& matrix) const override {
    ++asked;
    if (knows_convexity) matrix.add(0, 0, Mat3::Identity());
    return knows_convexity;
  }
  void constraint(const VecX&, VecX&, Eigen::MatrixXd&) const override {}
  VecX constraint_values(const VecX&) const override { return {}; }
  VecX constraint_scales() const override { return {}; }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

  NewtonResult settle(VecX& x) const {
    NewtonWorkspace work{BlockMatrix(1, std::vector<std::vector<int>>{{0}})};
    VecX none;
    return solve_equilibrium(*this, {}, work, x, none);
  }
};

TEST(Newton, AConcaveTermIsMadeConvexBeforeAnythingIsShifted) {
  Valleys known, unknown;
  unknown.knows_convexity = false;
  const VecX ridge = Vec3(0.1, -0.2, 0.15), valley = std::sqrt(0.9) * Vec3(1, -1, 1);
  VecX x = ridge, by_shifts = ridge;
  const NewtonResult result = known.settle(x), shifted = unknown.settle(by_shifts);
  ASSERT_TRUE(result.converged()) << to_text(result.status);
  ASSERT_TRUE(shifted.converged()) << to_text(shifted.status);
  EXPECT_LT((x - valley).norm(), 1e-6);
  EXPECT_LT((by_shifts - valley).norm(), 1e-6);
  EXPECT_GT(known.asked, 0);
  EXPECT_EQ(result.shifts, 0);
  EXPECT_GT(shifted.shifts, 0);
  // Two matrices fail at most of each three.
  EXPECT_LE(result.factorisations, result.iterations + (result.iterations + 1) / 2);
}

TEST(Newton, AShiftBeginsWhereTheLastOneEnded) {
  Valleys unknown;
  unknown.knows_convexity = false;
  VecX x = Vec3::Constant(1e-3);
  const NewtonResult result = unknown.settle(x);
  ASSERT_TRUE(result.converged());
  // From 1e-4 of the stiffness on it takes seven shifts to pass what is concave there, each time.
  EXPECT_GT(result.shifts, 7);
  EXPECT_LT(result.shifts, 7 + 3 * result.iterations);
}

/// A node on a ridge along x that is stiff across it, with x + y kept. It notes where matrices are asked for.
class Ridge : public ConstrainedEnergy {
 public:
  explicit Ridge(double kept) : kept_(kept) {}
  struct Asked {
    VecX x;
    double multiplier;
  };
  mutable std::vector<Asked> asked;

  std::vector<Part> parts() const override { return {{{0, 1}, {}, 1}}; }
  int constraints() const override { return 1; }
  double value(const VecX& x) const override {
    return 0.1 * (std::pow(x[0], 4) / 4 - x[0] * x[0] / 2) + 0.03 * x[1] * x[1] + x[2] * x[2] / 2;
  }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient = Vec3(0.1 * (std::pow(x[0], 3) - x[0]), 0.06 * x[1], x[2]);
    largest_internal = VecX::Constant(1, 1e-5);  // all are far from balance
  }
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override {
    asked.push_back({x, multipliers[0]});
    matrix.set_zero();
    matrix.add(0, 0, Vec3(0.1 * (3 * x[0] * x[0] - 1), 0.06, 1).asDiagonal());
  }
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override {
    values = constraint_values(x);
    gradients = along();
  }
  VecX constraint_values(const VecX& x) const override { return VecX::Constant(1, x[0] + x[1] - kept_); }
  VecX constraint_scales() const override { return VecX::Ones(1); }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

  /// What balances the forces at a place best, less the multiplier there.
  double missing(const Asked& there) const {
    VecX force, largest;
    gradient(there.x, force, largest);
    return (force - there.multiplier * along()).dot(along()) / along().squaredNorm();
  }

 private:
  static Vec3 along() { return {1, 1, 0}; }
  double kept_;
};

TEST(Newton, FarFromBalanceAShiftedMatrixChangesAMultiplierByNoMoreThanForcesAsk) {
  for (const Vec3& start : {Vec3(0.01, 0.01 / 0.6, 0), Vec3(0.01, 0.3, 0.2), Vec3(0.05, -0.2, 0)}) {
    const Ridge ridge(start.head<2>().sum());
    NewtonWorkspace work{BlockMatrix(1, std::vector<std::vector<int>>{{0}})};
    VecX x = start, multipliers = VecX::Zero(1);
    const NewtonResult result = solve_equilibrium(ridge, {}, work, x, multipliers);
    ASSERT_TRUE(result.converged()) << to_text(result.status);
    EXPECT_GT(result.shifts, 0);
    EXPECT_NEAR(multipliers[0], 0.06 * x[1], 1e-6);
    ASSERT_GT(ridge.asked.size(), 1u);
    const Ridge::Asked &first = ridge.asked[0], &second = ridge.asked[1];
    EXPECT_LE(std::abs(second.multiplier - first.multiplier), 2 * std::abs(ridge.missing(first)) + 1e-12);
  }
}

TEST(Newton, InBalanceToRoundingIsConverged) {
  for (bool constrained : {false, true}) {
    Net net(constrained);
    NewtonSettings tight;
    tight.tolerance = 1e-12;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    ASSERT_TRUE(solve_equilibrium(net, tight, work, x, multiplier).converged());
    // One step is too long to be the last and ends where none gets any further.
    Rng rng(6);
    for (double off : {1e-8, 1e-9, 1e-10, 1e-11}) {
      VecX from = x + test::random_coordinates(rng, 18, off);
      double pressure = multiplier;
      NewtonWorkspace fresh = net.workspace();
      const NewtonResult result = solve_equilibrium(net, tight, fresh, from, pressure);
      EXPECT_TRUE(result.converged()) << off << ' ' << to_text(result.status);
      EXPECT_LE(result.increment, tight.tolerance);
      EXPECT_LT((from - x).norm(), 1e-11);
    }
  }
}

TEST(Newton, WhereCoordinatesAreTooCoarseForTheToleranceNoneIsNearerToBalance) {
  for (bool constrained : {false, true}) {
    Net net(constrained);
    net.ground = 1e10;  // times what coordinates are rounded to, 1e-16 m: 1e-5 of the load
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    const NewtonResult result = solve_equilibrium(net, {}, work, x, multiplier);
    EXPECT_TRUE(result.converged()) << to_text(result.status);
    EXPECT_GT(result.residual, NewtonSettings{}.tolerance);
    EXPECT_GT((x - net.rest()).norm(), 1e-12);
    const VecX left = residual(net, x, multiplier);
    for (Eigen::Index k = 0; k < x.size(); ++k)
      for (double way : {-1.0, 1.0}) {
        if (net.rest()[k] == 0) continue;  // near the origin coordinates are as fine as one likes
        VecX beside = x;
        for (int steps = 0; steps < 3; ++steps) beside[k] = std::nextafter(beside[k], 10 * way);
        EXPECT_GT(std::abs(residual(net, beside, multiplier)[k]), std::abs(left[k])) << k;
      }
  }
}

TEST(Newton, ConstraintIsKeptToItsTolerance) {
  Net net(true);
  const double unstressed = net.volume;
  for (double growth : {0.8, 1.0, 1.3}) {
    net.volume = growth * unstressed;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    const NewtonResult result = solve_equilibrium(net, {}, work, x, multiplier);
    ASSERT_TRUE(result.converged()) << to_text(result.status);
    EXPECT_LT(std::abs(net.constraint_value(x)), 1e-10 * unstressed);
    EXPECT_LE(result.constraint_error, 1e-10);
  }
}

TEST(Newton, AWholeStepEndsWhereTheConstraintHolds) {
  Net net(true);
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  ASSERT_TRUE(solve_equilibrium(net, {}, work, x, multiplier).converged());
  net.volume *= 1.0001;
  VecX gradient;
  const double missed = net.constraint(x, gradient);
  VecX step = work.factor.solve(VecX(-residual(net, x, multiplier)));
  work.border.keep(VecX::Constant(1, missed), step);
  EXPECT_GT(std::abs(net.constraint_value(x + step)), 1e-9 * net.constraint_scale())
      << "its tangent leaves more";
  NewtonSettings one;
  one.max_iterations = 1;
  const NewtonResult result = solve_equilibrium(net, one, work, x, multiplier);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT(std::abs(net.constraint_value(x)), one.constraint_tolerance * net.constraint_scale());
}

TEST(Newton, MultiplierIsTheRateOfEnergyByTheConstraint) {
  Net net(true);
  const double unstressed = net.volume, h = 1e-4 * unstressed;
  NewtonSettings tight;
  tight.tolerance = 1e-10;
  const auto solve = [&](double volume, double& multiplier) {
    net.volume = volume;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    EXPECT_TRUE(solve_equilibrium(net, tight, work, x, multiplier).converged());
    return net.value(x);
  };
  double here = 0, other = 0;
  solve(1.2 * unstressed, here);
  const double rate = (solve(1.2 * unstressed + h, other) - solve(1.2 * unstressed - h, other)) / (2 * h);
  EXPECT_NEAR(rate, here, 1e-5 * std::abs(here));  // central difference with a step of 1e-4
}

TEST(Newton, ResidualFallsWithItsSquareOnceNear) {
  // From one iterate to the next with a fresh factor each: residual' <= C residual^2.
  Net net(true);
  net.volume *= 1.05;
  VecX x = net.rest();
  double multiplier = 0;
  std::vector<double> residuals;
  for (int step = 0; step < 8; ++step) {
    NewtonWorkspace work = net.workspace();  // nothing to reuse: a full Newton step
    NewtonSettings one;
    one.max_iterations = 1;
    one.tolerance = 1e-30;  // never met: exactly one step is taken
    solve_equilibrium(net, one, work, x, multiplier);
    residuals.push_back(residual(net, x, multiplier).norm() + std::abs(net.constraint_value(x)));
  }
  int squared = 0;
  for (std::size_t k = 1; k < residuals.size(); ++k) {
    if (residuals[k - 1] > 1e-2 || residuals[k - 1] < 1e-7) continue;  // far, or its square is rounding
    EXPECT_LT(residuals[k], 50 * residuals[k - 1] * residuals[k - 1]);
    ++squared;
  }
  EXPECT_GE(squared, 1);
  EXPECT_LT(residuals.back(), 1e-12);
}

TEST(Newton, KeptFactorLeadsToTheSamePoint) {
  Net net(true);
  NewtonSettings tight;
  tight.tolerance = 1e-9;
  NewtonWorkspace kept = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  ASSERT_TRUE(solve_equilibrium(net, tight, kept, x, multiplier).converged());
  net.load *= 1.01;  // a small step further: the factor may serve
  VecX with_kept = x, with_fresh = x;
  double kept_multiplier = multiplier, fresh_multiplier = multiplier;
  NewtonWorkspace fresh = net.workspace();
  const NewtonResult chord = solve_equilibrium(net, tight, kept, with_kept, kept_multiplier);
  ASSERT_TRUE(chord.converged());
  ASSERT_TRUE(solve_equilibrium(net, tight, fresh, with_fresh, fresh_multiplier).converged());
  EXPECT_GT(chord.chords, 0);
  EXPECT_EQ(chord.by_last_factor, chord.iterations);
  EXPECT_LT((with_kept - with_fresh).norm(), 1e-8);
  EXPECT_NEAR(kept_multiplier, fresh_multiplier, 1e-8);
}

TEST(Newton, SolvedProblemIsLeftBitIdentical) {
  const Net net(true);
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  ASSERT_TRUE(solve_equilibrium(net, {}, work, x, multiplier).converged());
  const VecX solved = x;
  const double pressure = multiplier;
  const NewtonResult again = solve_equilibrium(net, {}, work, x, multiplier);
  EXPECT_TRUE(again.converged());
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(x, solved);
  EXPECT_EQ(multiplier, pressure);
}

TEST(Newton, BodyThatNothingHoldsIsAMechanism) {
  for (bool constrained : {false, true}) {
    Net net(constrained);
    net.ground = 0;
    NewtonWorkspace work = net.workspace();
    VecX x = net.rest();
    double multiplier = 0;
    EXPECT_EQ(solve_equilibrium(net, {}, work, x, multiplier).status, NewtonStatus::mechanism);
  }
}

TEST(Newton, ValueThatIsNotFiniteIsReported) {
  Net net(false);
  net.poison = std::nan("");
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  EXPECT_EQ(solve_equilibrium(net, {}, work, x, multiplier).status, NewtonStatus::not_finite);
}

TEST(Newton, ASolveThatIsToldToStopDoesSoBeforeTheNextIteration) {
  Net net(false);
  net.load *= 40;
  NewtonSettings settings;
  int asked = 0;
  settings.stop = [&] { return ++asked == 3; };
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  const NewtonResult result = solve_equilibrium(net, settings, work, x, multiplier);
  EXPECT_EQ(result.status, NewtonStatus::stopped);
  EXPECT_EQ(result.iterations, 2);
}

TEST(Newton, IterationLimitIsReportedWithTheLastIterate) {
  Net net(false);
  net.load *= 40;
  NewtonSettings settings;
  settings.max_iterations = 2;
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  const NewtonResult result = solve_equilibrium(net, settings, work, x, multiplier);
  EXPECT_EQ(result.status, NewtonStatus::iteration_limit);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_LT(net.value(x), net.value(net.rest())) << "x holds how far it came";
  const double scale = net.load.lpNorm<Eigen::Infinity>();
  double largest = 0;
  const VecX left = residual(net, x, multiplier);
  for (int i = 0; i < 18; i += 3) largest = std::max(largest, left.segment<3>(i).norm());
  EXPECT_NEAR(result.residual, largest / scale, 1e-12) << "the residual is that of x";
}

TEST(Newton, IndefiniteTangentIsPassedByAShift) {
  // Squeezed springs push outward: the tangent at a strongly squeezed start is indefinite, the rest is not.
  Net net(false);
  net.load.setZero();
  net.load[0] = 1e-3;
  NewtonWorkspace work = net.workspace();
  VecX x = 0.3 * net.rest();
  net.hessian(x, 0, work.matrix);
  ASSERT_EQ(work.factor.factorise(work.matrix), FactorStatus::not_positive_definite);
  double multiplier = 0;
  const NewtonResult result = solve_equilibrium(net, {}, work, x, multiplier);
  EXPECT_TRUE(result.converged()) << to_text(result.status);
  EXPECT_GT(result.shifts, 0);
}

TEST(Newton, LinearResponseIsTheChangeOfTheSolutionToFirstOrder) {
  Net net(true);
  net.volume *= 1.1;
  NewtonSettings tight;
  tight.tolerance = 1e-10;  // a thousandth of the change that is compared; 1e-11 is rounding
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  ASSERT_TRUE(solve_equilibrium(net, tight, work, x, multiplier).converged());
  ASSERT_TRUE(factorise_tangent(net, work, x, multiplier, true).converged());
  Rng rng(4);
  const VecX more = test::random_coordinates(rng, 18, 1.0);
  VecX dmultipliers;
  const double h = 1e-5;
  const VecX dx = linear_response(work, h * more, dmultipliers);
  net.load += h * more;
  VecX moved = x;
  double there = multiplier;
  ASSERT_TRUE(solve_equilibrium(net, tight, work, moved, there).converged());
  EXPECT_LT((moved - x - dx).norm(), 1e-3 * dx.norm());
  EXPECT_NEAR(there - multiplier, dmultipliers[0], 1e-3 * std::abs(dmultipliers[0]));
}

TEST(Newton, AFirstOrderAnswerIsBelievedAsFarAsHalfAnEdgeAndFailsWhereItIsNotFinite) {
  Net net(true);
  net.volume *= 1.1;
  NewtonWorkspace work = net.workspace();
  VecX x = net.rest();
  double multiplier = 0;
  VecX dmultipliers;
  ASSERT_TRUE(solve_equilibrium(net, {}, work, x, multiplier).converged());
  Rng rng(4);
  VecX more = test::random_coordinates(rng, 3 * Net::nodes, 1.0);
  std::vector<double> edges(Net::nodes, 1e6);
  const FirstOrderAnswer whole = first_order_answer(net, work, x, multiplier, more, edges, true);
  ASSERT_TRUE(whole.result.converged());
  EXPECT_EQ(whole.share, 1);
  EXPECT_EQ(whole.dx, linear_response(work, more, dmultipliers));
  EXPECT_EQ(whole.dmultipliers, dmultipliers);
  edges[2] = 0.1 * whole.dx.segment<3>(6).norm();
  edges[4] = 0.2 * whole.dx.segment<3>(12).norm();
  const FirstOrderAnswer part = first_order_answer(net, work, x, multiplier, more, edges, false);
  EXPECT_EQ(part.dx, whole.dx);
  EXPECT_NEAR(part.share, 0.5 * 0.1, 1e-12);  // rounding
  more[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(first_order_answer(net, work, x, multiplier, more, edges, false).result.status,
            NewtonStatus::not_finite);
}

TEST(Newton, ABodyAloneIsAGroupOfOne) {
  const Net free(false), filled(true);
  const LoneBody at_pressure(free, free.rest(), -3), kept(filled, filled.rest(), -3);
  EXPECT_EQ(at_pressure.multipliers().size(), 0);
  EXPECT_EQ(kept.multipliers(), VecX::Constant(1, -3));
  EXPECT_EQ(at_pressure.cancelling(), 3 * free.constraint_scale())
      << "the work of the pressure that is given";
  EXPECT_EQ(kept.cancelling(), 0) << "it is its constraint's";
  ASSERT_EQ(kept.parts().size(), 1u);
  EXPECT_EQ(kept.parts()[0].places.size(), Net::nodes);
  EXPECT_EQ(kept.parts()[0].displacements.size(), 0);
}

TEST(Newton, EveryStatusHasItsWords) {
  std::vector<std::string> words;
  for (NewtonStatus status :
       {NewtonStatus::converged, NewtonStatus::not_finite, NewtonStatus::mechanism,
        NewtonStatus::dependent_constraints, NewtonStatus::stalled, NewtonStatus::iteration_limit,
        NewtonStatus::out_of_memory, NewtonStatus::stopped})
    words.push_back(to_text(status));
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_FALSE(words[i].empty());
    EXPECT_EQ(std::count(words.begin(), words.end(), words[i]), 1) << words[i];
  }
}

}  // namespace
}  // namespace calot
