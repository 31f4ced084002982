// A step that asks what bends sharply as it is ends where Newton's own needs several.

#include "numerics/sharp_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/newton.h"
#include "numerics/response.h"
#include "random_matrices.h"

namespace calot {
namespace {

constexpr int chain_nodes = 6;
constexpr double between = 200, hold = 50;  // N/m

/// What presses at a distance, m: J, N and N/m, as a contact's barrier does; a parabola goes on below a fiftieth of the range.
struct Press {
  double energy = 0, derivative = 0, second = 0;
};
Press press_at(double distance) {
  constexpr double range = 1e-3, stiffness = 40, soft = 0.02 * range;
  if (distance >= range) return {};
  if (distance < soft) {
    const Press at = press_at(soft);
    const double beyond = distance - soft;
    return {at.energy + beyond * (at.derivative + 0.5 * beyond * at.second),
            at.derivative + beyond * at.second, at.second};
  }
  const double by = -stiffness / range, gap = distance - range, log = std::log(distance / range),
               share = gap / distance;
  return {by * gap * gap * log, by * gap * (2 * log + share), by * (2 * log + 4 * share - share * share)};
}

/// A chain of nodes on springs, over the first of which a plate comes down to a height: a barrier of its distance.
class PressedChain : public ConstrainedEnergy {
 public:
  double height = 0;  ///< m
  bool knows_what_is_sharp = true;

  std::vector<Part> parts() const override { return {{{0, chain_nodes}, {}, 1}}; }
  int constraints() const override { return 0; }
  static double soft(const VecX& x) {
    double sum = 0.5 * hold * x.squaredNorm();
    for (Eigen::Index i = 3; i < x.size(); ++i) sum += 0.5 * between * (x[i] - x[i - 3]) * (x[i] - x[i - 3]);
    return sum;
  }
  Press plate(const VecX& x) const { return press_at(height - x[2]); }
  double value(const VecX& x) const override { return soft(x) + plate(x).energy; }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient = hold * x;
    for (Eigen::Index i = 3; i < x.size(); ++i) {
      gradient[i] += between * (x[i] - x[i - 3]);
      gradient[i - 3] -= between * (x[i] - x[i - 3]);
    }
    gradient[2] -= plate(x).derivative;
    largest_internal = VecX::Constant(1, hold * 1e-3);
  }
  void hessian(const VecX& x, const VecX&, BlockMatrix& matrix) const override {
    matrix.set_zero();
    for (int i = 0; i < chain_nodes; ++i) {
      const int neighbours = (i > 0 ? 1 : 0) + (i + 1 < chain_nodes ? 1 : 0);
      matrix.add(i, i, (hold + neighbours * between) * Mat3::Identity());
      if (i > 0) matrix.add(i, i - 1, -between * Mat3::Identity());
    }
    matrix.add(0, 0, plate(x).second * Vec3::UnitZ() * Vec3::UnitZ().transpose());
  }
  void constraint(const VecX&, VecX&, Eigen::MatrixXd&) const override {}
  VecX constraint_values(const VecX&) const override { return {}; }
  VecX constraint_scales() const override { return {}; }
  double safe_share(const VecX&, const VecX&) const override { return 1; }
  std::vector<SharpTangent> sharp_tangents(const VecX& x, bool) const override {
    return {{0, 0, 0, plate(x).second * Vec3::UnitZ() * Vec3::UnitZ().transpose()}};
  }
  std::unique_ptr<const SharpTerms> sharp_terms(const VecX& x, const VecX& step, double least,
                                                std::span<const SharpTangent> tangents) const override;

  NewtonWorkspace workspace() const {
    std::vector<std::vector<int>> cliques;
    for (int i = 1; i < chain_nodes; ++i) cliques.push_back({i - 1, i});
    return NewtonWorkspace(BlockMatrix(chain_nodes, cliques));
  }
};

class Plate : public SharpTerms {
 public:
  Plate(const PressedChain& chain, const Mat3& tangent) : chain_(chain), tangent_(tangent) { nodes_ = {0}; }
  double value(const VecX& x) const override { return chain_.plate(x).energy; }
  VecX gradient(const VecX& x) const override {
    VecX out = VecX::Zero(x.size());
    out[2] = -chain_.plate(x).derivative;
    return out;
  }
  SharpHessian hessian(const VecX& x, bool) const override {
    return of(chain_.plate(x).second * Vec3::UnitZ() * Vec3::UnitZ().transpose());
  }
  SharpHessian factorised() const override { return of(tangent_); }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

 private:
  static SharpHessian of(const Mat3& block) {
    BlockMatrix matrix(chain_nodes, std::vector<std::vector<int>>{{0}});
    matrix.add(0, 0, block);
    return {{{0, matrix}}};
  }
  const PressedChain& chain_;
  Mat3 tangent_;
};

std::unique_ptr<const SharpTerms> PressedChain::sharp_terms(const VecX& x, const VecX& step, double least,
                                                            std::span<const SharpTangent> tangents) const {
  const double missed =
      plate(x).derivative - plate(x + step).derivative - tangents[0].stiffness(2, 2) * step[2];
  if (!knows_what_is_sharp || std::abs(missed) <= least) return nullptr;
  return std::make_unique<Plate>(*this, tangents[0].stiffness);
}

/// Pressed so far that the distance is a hundredth of where it begins to press.
VecX pressed(const PressedChain& chain) {
  VecX x = VecX::Zero(3 * chain_nodes);
  x[2] = chain.height - 0.01e-3;
  return x;
}

TEST(SharpStep, EndsInBalanceWhereNewtonsOwnStepsHalveWhatIsLeft) {
  for (const double height : {-5e-3, -1e-3, 0.2e-3}) {
    PressedChain chain;
    chain.height = height;
    VecX at[2], none;
    NewtonResult results[2];
    for (int knows : {0, 1}) {
      chain.knows_what_is_sharp = knows == 1;
      NewtonWorkspace work = chain.workspace();
      at[knows] = pressed(chain);
      results[knows] = solve_equilibrium(chain, {}, work, at[knows], none);
      ASSERT_TRUE(results[knows].converged()) << to_text(results[knows].status);
    }
    // The rest is linear. The first step leaves the thousandth of what it is asked to balance, which is much here; what
    // follows are chords, or one more matrix.
    EXPECT_LE(results[1].iterations, 4) << height;
    EXPECT_LE(results[1].factorisations, 2) << height;
    EXPECT_GE(results[0].factorisations, 5) << height;
    EXPECT_LT((at[1] - at[0]).norm(), 1e-8);
    EXPECT_GT((at[1] - pressed(chain)).norm(), 1e-5);
  }
}

TEST(SharpStep, MovesOnlyWhatTheFactorAnswersAndNothingWhereNothingBends) {
  PressedChain chain;
  chain.height = -2e-3;
  NewtonWorkspace work = chain.workspace();
  const VecX x = pressed(chain), none;
  ASSERT_TRUE(factorise_tangent(chain, work, x, none, true).converged());
  VecX gradient, internal;
  chain.gradient(x, gradient, internal);
  const VecX step = work.factor.solve(VecX(-gradient));
  const double residual = largest_node(gradient);
  EXPECT_EQ(sharp_load(chain, work, {x, step, residual}, 1e9).size(), 0);
  const VecX load = sharp_load(chain, work, {x, step, residual}, 1e-6 * residual);
  ASSERT_EQ(load.size(), x.size());
  EXPECT_NE(load[2], 0);
  EXPECT_EQ(load.tail(load.size() - 3), VecX::Zero(load.size() - 3));
  const VecX end = x + step + work.factor.solve(load);
  VecX left;
  chain.gradient(end, left, internal);
  EXPECT_LT(largest_node(left), 2e-3 * residual);
  chain.gradient(x + step, left, internal);
  EXPECT_GT(largest_node(left), 0.2 * residual);
}

}  // namespace
}  // namespace calot
