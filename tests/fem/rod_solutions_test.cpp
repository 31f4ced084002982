// Rods against what is known of them in closed form, or by an ordinary differential equation, under refinement.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/dense_cholesky.h"
#include "numerics/newton.h"
#include "support/derivatives.h"
#include "support/rods.h"

namespace calot {
namespace {

using std::numbers::pi;

/// A rod under dead loads and a pressure, some of its coordinates held where they are at the start.
class HeldRod : public BodyEnergy {
 public:
  HeldRod(const Rod& rod, VecX load, std::vector<int> held, double pressure = 0)
      : rod_(rod), load_(std::move(load)), held_(std::move(held)), pressure_(pressure) {}

  bool constrained() const override { return false; }
  double value(const VecX& x) const override { return rod_.value(x, pressure_) - load_.dot(x); }
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
    gradient = VecX::Zero(x.size());
    rod_.add_gradient(x, pressure_, gradient);
    gradient -= load_;
    for (int k : held_) gradient[k] = 0;
    largest_internal = std::max(largest_node(load_), pressure_);  // rods of unit size
  }
  void hessian(const VecX& x, double, BlockMatrix& matrix) const override {
    matrix.set_zero();
    rod_.add_hessian(x, pressure_, matrix);
    const double mean = matrix.diagonal_mean();
    const auto held = [&](int k) { return std::find(held_.begin(), held_.end(), k) != held_.end(); };
    for (int c = 0; c < matrix.size(); ++c)
      for (int e = matrix.column_starts()[c]; e < matrix.column_starts()[c + 1]; ++e)
        if (held(c) || held(matrix.rows()[e])) matrix.values()[e] = matrix.rows()[e] == c ? mean : 0;
  }
  double constraint(const VecX&, VecX&) const override { return 0; }
  double constraint_value(const VecX&) const override { return 0; }
  double constraint_scale() const override { return 1; }
  double length_scale() const override { return 1; }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

 private:
  const Rod& rod_;
  VecX load_;
  std::vector<int> held_;
  double pressure_;
};

/// The rod at rest in its loads, from x on.
VecX settled(const test::StraightRod& straight, const HeldRod& problem, VecX x) {
  NewtonWorkspace work(straight.matrix());
  NewtonSettings settings;
  settings.tolerance = 1e-7;  // a wall as stiff as 3e6 rounds to 1e-8
  double multiplier = 0;
  const NewtonResult result = solve_equilibrium(problem, settings, work, x, multiplier);
  EXPECT_LE(result.residual, settings.tolerance) << to_text(result.status);
  return x;
}

/// The weight of a rod along -y, N/m of rest length.
VecX weight(const Rod& rod, double per_length, Eigen::Index size) {
  VecX load = VecX::Zero(size);
  for (int row = 0; row < rod.stencils().rows(); ++row)
    spread(rod.stencils(), row, -per_length * rod.point_lengths()[row] * Vec3::UnitY(), load);
  return load;
}

Vec3 last_node(const VecX& x) { return x.tail<3>(); }

/// Clamped at its first node and direction; what is held there still stretches.
const std::vector<int> clamp = {0, 1, 2, 4, 5};

/// Of unit length, loaded in so many steps.
Vec3 cantilever_tip(int spans, const RodSection& section, double load, int steps = 1) {
  const test::StraightRod straight = test::straight_rod(spans, 1.0, section);
  VecX force = VecX::Zero(straight.rest.size()), x = straight.rest;
  for (int step = 1; step <= steps; ++step) {
    force[force.size() - 2] = load * step / steps;
    x = settled(straight, HeldRod(straight.rod, force, clamp), x);
  }
  return last_node(x);
}

/// How the errors fall from one to the next, each with twice the spans: 4 is the fourth order.
std::vector<double> orders(const std::vector<double>& errors) {
  std::vector<double> out;
  for (std::size_t k = 1; k < errors.size(); ++k) out.push_back(std::log2(errors[k - 1] / errors[k]));
  return out;
}

/// The same by shooting, unit length: EI theta'' = -P L cos(theta), L = 1 + P sin(theta) / EA, no moment at the tip.
class Elastica {
 public:
  Elastica(double axial, double bending, double load) : axial_(axial), bending_(bending), load_(load) {
    double low = 0, high = load / bending;  // the moment at the clamp, of a rod that stays straight
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (shoot(middle)[1] < 0 ? low : high) = middle;
    }
    const Eigen::Vector4d end = shoot(low);
    tip = {end[2], end[3], 0};
  }
  Vec3 tip;

 private:
  /// By (theta, theta', x, y).
  Eigen::Vector4d slope(const Eigen::Vector4d& y) const {
    const double stretch = 1 + load_ * std::sin(y[0]) / axial_;
    return {y[1], -load_ / bending_ * stretch * std::cos(y[0]), stretch * std::cos(y[0]),
            stretch * std::sin(y[0])};
  }
  Eigen::Vector4d shoot(double curvature) const {
    constexpr int steps = 1000;  // of fourth order: 1e-12
    const double h = 1.0 / steps;
    Eigen::Vector4d y(0, curvature, 0, 0);
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector4d a = slope(y), b = slope(y + h / 2 * a), c = slope(y + h / 2 * b),
                            d = slope(y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return y;
  }
  double axial_, bending_, load_;
};

TEST(RodSolutions, ACantileversTipSinksByPL3Over3EIUnderASmallLoad) {
  // The cubic is in the space: what is left is the elastica's, about a tenth of the load squared.
  const RodSection section{.axial = 300, .bending = 1, .radius = 1};
  std::vector<double> errors;
  for (double load : {0.2, 0.1, 0.05}) {
    errors.push_back(1 - cantilever_tip(4, section, load).y() / (load / 3));
    EXPECT_LT(errors.back(), 0.15 * load * load);
  }
  for (double order : orders(errors)) EXPECT_NEAR(order, 2, 0.03);
}

TEST(RodSolutions, TheElasticaUsedHereIsThatOfTheTables) {
  // Mattiasson 1981, Int. J. Numer. Methods Eng. 17:145-153: P L^2 / EI = 5, no stretch.
  const Vec3 tip = Elastica(1e12, 1, 5).tip;
  EXPECT_NEAR(tip.y(), 0.71379, 5e-6);
  EXPECT_NEAR(1 - tip.x(), 0.38763, 5e-6);
}

TEST(RodSolutions, AStronglyBentCantileverConvergesToTheElasticaWithTheFourthOrder) {
  const RodSection section{.axial = 300, .bending = 1, .radius = 1};  // as thick as a duct
  const Vec3 exact = Elastica(section.axial, 1, 5).tip;
  std::vector<double> errors;
  for (int spans : {4, 8, 16}) errors.push_back((cantilever_tip(spans, section, 5, 4) - exact).norm());
  EXPECT_LT(errors[0], 3e-3);
  for (double order : orders(errors)) EXPECT_NEAR(order, 4, 0.2);
}

TEST(RodSolutions, AHundredTimesThinnerItStillBends) {
  // Too few spans make it stiff, but by no more than 2 % of its length, and finer ones catch up faster.
  const RodSection section{.axial = 3e6, .bending = 1, .radius = 1};
  const Vec3 exact = Elastica(section.axial, 1, 5).tip;
  std::vector<double> errors;
  for (int spans : {4, 8, 16, 32}) errors.push_back((cantilever_tip(spans, section, 5, 20) - exact).norm());
  EXPECT_LT(errors[0], 0.025);
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_GT(orders(errors).back(), 4.0);
}

TEST(RodSolutions, AHangingRodIsLongerByHalfItsWeightOverEA) {
  // Quadratic: in the space. It hangs along -y from a rest along x, and begins under tension: slack, it
  // would swing freely.
  const RodSection section{.axial = 7, .bending = 1e-3, .radius = 1};
  const test::StraightRod straight = test::straight_rod(4, 1.0, section);
  const VecX load = weight(straight.rod, 2, straight.rest.size());
  VecX x = straight.line.along({Vec3::Zero(), -1.2 * Vec3::UnitY()}).value();
  x = settled(straight, HeldRod(straight.rod, load, {0, 1, 2}), x);
  EXPECT_LT((last_node(x) - Vec3(0, -1 - 0.5 * 2.0 / 7, 0)).norm(), 1e-9);
}

/// Middle of a cable without bending, of rest length 1 and a weight, between ends at one height (Irvine, Cable
/// Structures, 1981, section 1.3): its sag.
double catenary_sag(double axial, double total, double span) {
  const auto across = [&](double h) { return h / axial + 2 * h / total * std::asinh(0.5 * total / h); };
  double low = 1e-6 * total, high = 1e3 * total;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (across(middle) < span ? low : high) = middle;
  }
  return total / (8 * axial) + low / total * (std::hypot(1, 0.5 * total / low) - 1);
}

TEST(RodSolutions, AHeavyCableHangsInACatenary) {
  const RodSection section{.axial = 20, .bending = 1e-7, .radius = 1};  // bends its last 4e-4 only
  const double exact = catenary_sag(20, 1, 0.8);
  EXPECT_NEAR(exact, 0.28, 0.01);
  std::vector<double> errors;
  for (int spans : {4, 8, 16}) {
    const test::StraightRod cable = test::straight_rod(spans, 1.0, section);
    const int size = static_cast<int>(cable.rest.size());
    const VecX start = cable.line.along({Vec3::Zero(), {0.2, -0.2, 0}, {0.6, -0.2, 0}, {0.8, 0, 0}}).value();
    const VecX load = weight(cable.rod, 1, size);
    const VecX x = settled(cable, HeldRod(cable.rod, load, {0, 1, 2, size - 3, size - 2, size - 1}), start);
    const StencilTable middle = cable.line.stencils({spans / 2.0});
    errors.push_back(std::abs(-blend(middle, middle.value, 0, x).y() - exact));
  }
  EXPECT_LT(errors[0], 5e-3);
  for (double order : orders(errors)) EXPECT_GT(order, 4.0);
}

/// Whether a straight rod, pinned at both ends, stays straight when squeezed to a share of its length under a pressure.
bool stays_straight(const test::StraightRod& straight, double stretch, double pressure) {
  BlockMatrix matrix = straight.matrix();
  straight.rod.add_hessian(stretch * straight.rest, pressure, matrix);
  const Eigen::MatrixXd hessian = test::dense(matrix);
  const int inner = straight.line.nodes() - 2;
  Eigen::MatrixXd sideways(inner, inner);  // along y: along x nothing couples with it
  for (int i = 0; i < inner; ++i)
    for (int j = 0; j < inner; ++j) sideways(i, j) = hessian(3 * i + 4, 3 * j + 4);
  return cholesky_in_place(sideways);
}

/// The largest value up to `high` for which `holds` does.
template <class Holds>
double limit_of(const Holds& holds, double high) {
  double low = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

TEST(RodSolutions, APinnedColumnBucklesAtEulersLoad) {
  // Of a rod that its thrust P has shortened: P (1 - P / EA) = pi^2 EI / length^2.
  const RodSection section{.axial = 2e4, .bending = 1, .radius = 1};
  const double exact = 0.5 * section.axial * (1 - std::sqrt(1 - 4 * pi * pi / section.axial));
  std::vector<double> errors;
  for (int spans : {2, 4, 8, 16}) {
    const test::StraightRod column = test::straight_rod(spans, 1.0, section);
    const double thrust =
        limit_of([&](double p) { return stays_straight(column, 1 - p / section.axial, 0); }, 100);
    EXPECT_NEAR(thrust, pi * pi, (spans == 2 ? 0.02 : 0.01) * pi * pi);
    errors.push_back(std::abs(thrust - exact));
  }
  for (double order : orders(errors)) EXPECT_NEAR(order, 4, 0.3);
}

TEST(RodSolutions, AHeldTubeBucklesWhenItsPressuresThrustIsEulersLoad) {
  const RodSection section{.axial = 2000, .bending = 1, .radius = 0.05, .hoop = 1e4};
  const test::StraightRod tube = test::straight_rod(8, 1.0, section);
  const double pressure = limit_of([&](double p) { return stays_straight(tube, 1, p); }, 1e5);
  const double grown = answer(section, 1, pressure).radius;
  EXPECT_GT(grown, 1.004 * section.radius);
  EXPECT_NEAR(pressure * pi * grown * grown, pi * pi, 1e-4 * pi * pi) << "as a column of eight spans";
}

TEST(RodSolutions, AFreeTubeIsStretchedByThePressureOnItsEnds) {
  const RodSection section = tube_section(1e4, 0.1, 0.02);
  const test::StraightRod tube = test::straight_rod(4, 1.0, section);
  std::vector<double> errors;
  for (double pressure : {20.0, 10.0, 5.0}) {
    const HeldRod problem(tube.rod, VecX::Zero(tube.rest.size()), clamp, pressure);
    // Begins under tension: the pressure alone would buckle it.
    const VecX x = settled(tube, problem, 1.1 * tube.rest);
    for (const Rod::Sample& at : tube.rod.samples(x, pressure)) {
      const double push = pressure * pi * at.answer.radius * at.answer.radius;
      EXPECT_NEAR(section.axial * (at.stretch - 1), push, 1e-6 * push);
      EXPECT_NEAR(at.stretch, last_node(x).x(), 1e-9);
    }
    // Thin-walled: axial strain p r / (2 E t), half the hoop's; the rest is of the pressure's second order.
    errors.push_back(last_node(x).x() - 1 - 0.5 * pressure * section.radius / section.hoop);
    EXPECT_GT(errors.back(), 0);
  }
  for (double order : orders(errors)) EXPECT_NEAR(order, 2, 0.1);
}

}  // namespace
}  // namespace calot
