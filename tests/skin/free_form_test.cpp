#include "skin/free_form.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/rng.h"

namespace calot {
namespace {

constexpr double mm = 1e-3;

FreeForm::Lattice tilted_box() {
  FreeForm::Lattice lattice;
  lattice.frame.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  lattice.frame.translation() = Vec3(-50 * mm, 100 * mm, -80 * mm);
  lattice.half = Vec3(4 * mm, 5 * mm, 12 * mm);
  lattice.nodes = {4, 5, 6};
  return lattice;
}

Vec3 random_vector(Rng& rng) { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }

/// Within `share` of the box's extents.
Vec3 random_place(Rng& rng, const FreeForm::Lattice& lattice, double share) {
  return lattice.frame * Vec3(share * lattice.half.cwiseProduct(random_vector(rng)));
}

struct Manipulation {
  std::vector<Vec3> points, targets;
};

Manipulation random_manipulation(Rng& rng, const FreeForm::Lattice& lattice, int count) {
  Manipulation m;
  for (int k = 0; k < count; ++k) {
    m.points.push_back(random_place(rng, lattice, 0.7));
    m.targets.push_back(m.points.back() + 0.5 * mm * random_vector(rng));
  }
  return m;
}

FreeForm random_form(Rng& rng) {
  FreeForm form(tilted_box());
  Eigen::MatrixX3d nodes(form.nodes().rows(), 3);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) nodes.row(i) = 0.8 * mm * random_vector(rng);
  form.set_nodes(nodes);
  return form;
}

/// Beside the weights of a point (0.1 to 0.3 each) this is little.
constexpr double slight = 1e-4;

TEST(FreeForm, SlightlyDampedItTakesIndependentPointsToTheirTargets) {
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    FreeForm form(tilted_box());
    const Manipulation m = random_manipulation(rng, tilted_box(), 8);
    const Result<double> miss = form.manipulate(m.points, m.targets, slight);
    ASSERT_TRUE(miss);
    double largest = 0;
    for (std::size_t k = 0; k < m.points.size(); ++k)
      largest = std::max(largest, (m.points[k] + form.displacement(m.points[k]) - m.targets[k]).norm());
    // A miss is damping^2 over the least square of a singular value of the weights, here some 1e-3.
    EXPECT_LT(largest, 1e-4 * mm);
    EXPECT_EQ(miss.value(), largest);
  }
}

TEST(FreeForm, NoOtherLatticeDisplacementHasLessMissAndSize) {
  Rng rng(2);
  for (double damping : {1e-3, 0.06, 0.5}) {
    FreeForm form(tilted_box());
    const Manipulation m = random_manipulation(rng, tilted_box(), 10);
    ASSERT_TRUE(form.manipulate(m.points, m.targets, damping));
    const Eigen::MatrixX3d best = form.nodes();
    const auto cost = [&](const Eigen::MatrixX3d& nodes) {
      form.set_nodes(nodes);
      double sum = damping * damping * nodes.squaredNorm();
      for (std::size_t k = 0; k < m.points.size(); ++k)
        sum += (m.points[k] + form.displacement(m.points[k]) - m.targets[k]).squaredNorm();
      return sum;
    };
    const double least = cost(best);
    EXPECT_GT(best.norm(), 0.1 * mm);
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::MatrixX3d other(best.rows(), 3);
      for (Eigen::Index i = 0; i < other.rows(); ++i) other.row(i) = 0.01 * mm * random_vector(rng);
      EXPECT_GT(cost(best + other), least);
      EXPECT_GT(cost(best - other), least);
    }
  }
}

TEST(FreeForm, OfTwoTargetsForOnePointItTakesTheMiddleAndSaysByHowMuchItMisses) {
  FreeForm form(tilted_box());
  const Vec3 x = tilted_box().frame.translation();
  const Result<double> miss =
      form.manipulate({x, x}, {x + Vec3(1 * mm, 0, 0), x + Vec3(0, 0, 1 * mm)}, slight);
  ASSERT_TRUE(miss);
  EXPECT_LT((form.displacement(x) - Vec3(0.5 * mm, 0, 0.5 * mm)).norm(), 1e-6 * mm);
  EXPECT_NEAR(miss.value(), std::sqrt(0.5) * mm, 1e-6 * mm);
}

TEST(FreeForm, VanishesWithItsSlopesOnTheBoxsFacesAndOutside) {
  Rng rng(3);
  const FreeForm::Lattice box = tilted_box();
  for (int trial = 0; trial < 200; ++trial) {
    const FreeForm form = random_form(rng);
    const int axis = trial % 3;
    const double side = trial % 2 == 0 ? 1 : -1;
    Vec3 q = box.half.cwiseProduct(random_vector(rng));
    q[axis] = side * box.half[axis];
    const auto at = [&](double inward) {
      Vec3 p = q;
      p[axis] -= side * inward;
      return Vec3(box.frame * p);
    };
    // Cubic functions leave the face as the cube of the way, their slopes as its square; rounding of the place is
    // 1e-17 m.
    EXPECT_LT(form.displacement(at(0)).norm(), 1e-30);
    EXPECT_LT(form.gradient(at(0)).norm(), 1e-24);
    EXPECT_EQ(form.displacement(at(-1e-9)), Vec3::Zero());
    EXPECT_EQ(form.gradient(at(-1 * mm)), Mat3::Zero());
    EXPECT_FALSE(form.contains(at(-1e-9)));
    const double near = form.displacement(at(0.02 * mm)).norm(),
                 twice = form.displacement(at(0.04 * mm)).norm();
    EXPECT_NEAR(twice, 8 * near, 1e-6 * twice);
  }
}

TEST(FreeForm, ItsGradientIsThatOfTheDisplacement) {
  Rng rng(4);
  const FreeForm form = random_form(rng);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 x = random_place(rng, tilted_box(), 0.9);
    const Mat3 gradient = form.gradient(x);
    EXPECT_GT(gradient.norm(), 1e-3);
    constexpr double h = 1e-7;  // m; the third derivative is about 1 mm / (1 mm)^3
    for (int c = 0; c < 3; ++c) {
      const Vec3 step = h * Vec3::Unit(c);
      const Vec3 by_difference = (form.displacement(x + step) - form.displacement(x - step)) / (2 * h);
      EXPECT_LT((gradient.col(c) - by_difference).norm(), 1e-7);
    }
  }
}

TEST(FreeForm, NormalsStandOnTheMovedSurface) {
  Rng rng(5);
  const FreeForm form = random_form(rng);
  double turned = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 x = random_place(rng, tilted_box(), 0.8), n = random_vector(rng).normalized();
    const Vec3 a = n.unitOrthogonal(), b = n.cross(a);
    constexpr double h = 1e-7;
    const auto tangent = [&](const Vec3& way) {
      return Vec3(2 * h * way + form.displacement(x + h * way) - form.displacement(x - h * way));
    };
    const Vec3 expected = tangent(a).cross(tangent(b)).normalized(), moved = form.moved_normal(x, n);
    EXPECT_LT((moved - expected).norm(), 1e-6);
    turned = std::max(turned, (moved - n).norm());
  }
  EXPECT_GT(turned, 0.05) << "nothing was turned";
}

TEST(FreeForm, WithNothingToMoveItIsTheIdentity) {
  Rng rng(6);
  const FreeForm fresh(tilted_box());
  FreeForm still(tilted_box());
  Manipulation m = random_manipulation(rng, tilted_box(), 12);
  ASSERT_TRUE(still.manipulate(m.points, m.points, slight));
  FreeForm emptied = random_form(rng);
  ASSERT_TRUE(emptied.manipulate({}, {}, slight));
  for (const FreeForm* form : std::initializer_list<const FreeForm*>{&fresh, &still, &emptied})
    for (int k = 0; k < 20; ++k) {
      const Vec3 x = random_place(rng, tilted_box(), 1.2), n = random_vector(rng).normalized();
      EXPECT_EQ(form->displacement(x), Vec3::Zero());
      EXPECT_LT((form->moved_normal(x, n) - n).norm(), 1e-15);
    }
}

TEST(FreeForm, APointOutsideItsBoxStaysAndIsReportedAsMissed) {
  FreeForm form(tilted_box());
  const Vec3 outside = tilted_box().frame * Vec3(5 * mm, 0, 0), inside = tilted_box().frame.translation();
  const Vec3 way(0, 0, 1 * mm);
  const Result<double> miss = form.manipulate({outside, inside}, {outside + way, inside + way}, slight);
  ASSERT_TRUE(miss);
  EXPECT_NEAR(miss.value(), 1 * mm, 1e-15);
  EXPECT_EQ(form.displacement(outside), Vec3::Zero());
  EXPECT_LT((form.displacement(inside) - way).norm(), 1e-6 * mm);
}

TEST(FreeForm, DampingTradesMissForASmallerLatticeDisplacement) {
  Rng rng(7);
  const Manipulation m = random_manipulation(rng, tilted_box(), 10);
  double miss = 0, norm = 1;
  for (double damping : {1e-4, 1e-3, 1e-2, 1e-1}) {
    FreeForm form(tilted_box());
    const Result<double> missed = form.manipulate(m.points, m.targets, damping);
    ASSERT_TRUE(missed);
    EXPECT_GT(missed.value(), miss);
    EXPECT_LT(form.nodes().norm(), norm);
    miss = missed.value();
    norm = form.nodes().norm();
  }
}

TEST(FreeForm, RefusesWhatDoesNotPairUpAndTooLittleDamping) {
  FreeForm form(tilted_box());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(form.manipulate({Vec3::Zero()}, {}, slight));
  EXPECT_FALSE(form.manipulate({Vec3(0, nan, 0)}, {Vec3::Zero()}, slight));
  EXPECT_FALSE(form.manipulate({Vec3::Zero()}, {Vec3(nan, 0, 0)}, slight));
  EXPECT_FALSE(form.manipulate({Vec3::Zero()}, {Vec3::Zero()}, 0));
}

}  // namespace
}  // namespace calot
