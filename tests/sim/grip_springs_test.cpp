#include "group/grip_springs.h"

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

/// Points of a sphere's skin that are pressed into their pads by `into` (m), one a spring, and 0.3 mm along them.
struct Held {
  StencilTable table;
  VecX x;
  GripSprings springs;
  BlockMatrix matrix;
};

Held held(Rng& rng, const std::vector<double>& into) {
  test::SkinOfSphere skin(rng);
  GripSprings springs;
  for (std::size_t i = 0; i < into.size(); ++i) {
    const int row = 9 * static_cast<int>(i);
    const Vec3 pad = test::random_vector(rng, 1).normalized();
    const Vec3 along = 0.3e-3 * pad.unitOrthogonal();
    springs.row.push_back(row);
    springs.target.push_back(skin.point(row) - into[i] * pad + along);
    springs.stiffness.push_back(rng.uniform(1e4, 4e4));
    springs.pad.push_back(pad);
  }
  BlockMatrix matrix = skin.matrix(springs.row);
  return {std::move(skin.table), skin.x, springs, std::move(matrix)};
}

VecX gradient_of(const Held& of, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  of.springs.add_gradient(of.table, x, g);
  return g;
}

TEST(GripSprings, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  // Drawn off, where the stiffness comes, and beyond.
  Held of = held(rng, {-0.2e-3, 7e-6, 13e-6, 0.1e-3});
  constexpr double h = 1e-7;  // m: of the 20 um over which the stiffness comes, its square is 1e-5 there
  const auto value = [&](const VecX& y) { return of.springs.value(of.table, y); };
  const VecX gradient = gradient_of(of, of.x);
  EXPECT_GT(gradient.norm(), 1) << "N";
  EXPECT_LT(test::relative_error(gradient, test::difference_gradient(value, of.x, h)), 1e-6);
  of.springs.add_hessian(of.table, of.x, of.matrix);
  EXPECT_GT(test::stored(of.matrix).norm(), 1e4) << "N/m";
  const auto gradients = [&](const VecX& y) { return gradient_of(of, y); };
  EXPECT_LT(test::relative_error(test::dense(of.matrix), test::difference_hessian(gradients, of.x, h)), 1e-6);
}

TEST(GripSprings, PressOnTheirPadsButAreNotDrawnOffThem) {
  Rng rng(2);
  const std::vector<double> into = {-1e-3, -1e-6, 0, 5e-6, 0.2e-3};
  const Held of = held(rng, into);
  for (std::size_t i = 0; i < into.size(); ++i) {
    const Vec3 at = blend(of.table, of.table.value, of.springs.row[i], of.x);
    const Vec3 pull = of.springs.sample(i, at).gradient;
    const double press = pull.dot(of.springs.pad[i]), k = of.springs.stiffness[i];
    if (into[i] <= 0) {
      EXPECT_NEAR(press, 0, 1e-9 * k * 1e-3) << into[i];
    } else {
      EXPECT_GT(press, 0) << into[i];
    }
    // Half of the 20 um over which it comes are given away.
    if (into[i] > 20e-6) {
      EXPECT_NEAR(press, k * (into[i] - 10e-6), 1e-9 * k * into[i]);
    }
    EXPECT_NEAR((pull - press * of.springs.pad[i]).norm(), 0.3e-3 * k, 1e-9 * k) << "along it they hold";
  }
}

TEST(GripSprings, WithoutPadsTieInEveryDirection) {
  Rng rng(3);
  Held of = held(rng, {-0.4e-3});
  of.springs.pad.clear();
  const Vec3 at = blend(of.table, of.table.value, of.springs.row[0], of.x);
  EXPECT_NEAR(of.springs.sample(0, at).gradient.norm(), 0.5e-3 * of.springs.stiffness[0], 1e-6);
}

}  // namespace
}  // namespace calot
