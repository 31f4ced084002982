#include "fem/membrane_material.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "support/derivatives.h"

namespace calot {
namespace {

using Mat2 = Eigen::Matrix2d;

SurfaceTensor tensor(const Mat2& m) { return {m(0, 0), m(0, 1), m(1, 1)}; }

/// Rest and deformed metric of a random well-shaped element: of random tangents J and of F J.
struct Element {
  Mat2 tangents, deformation;
  SurfaceTensor inverse() const { return tensor(Mat2(rest().inverse())); }
  Mat2 rest() const { return tangents.transpose() * tangents; }
  SurfaceTensor metric() const {
    return tensor(Mat2((deformation * tangents).transpose() * deformation * tangents));
  }
};

Mat2 random_matrix(Rng& rng, double reach) {
  const double a = rng.uniform(-reach, reach), b = rng.uniform(-reach, reach);
  const double c = rng.uniform(-reach, reach);
  Mat2 m;
  m << a, b, c, rng.uniform(-reach, reach);
  return m;
}

Element random_element(Rng& rng) {
  return {1e-2 * (Mat2::Identity() + random_matrix(rng, 0.4)), Mat2::Identity() + random_matrix(rng, 0.4)};
}

const NeoHookean wall{100e3, 2e-3};

double energy(const Element& e) { return wall.energy(e.inverse(), e.rest().determinant(), e.metric()); }
MembraneSample sample(const Element& e) {
  return wall.sample(e.inverse(), e.rest().determinant(), e.metric());
}

/// Nominal stress resultant (N/m) P = dW/dF = 2 F (dW/dC) for a unit rest metric.
Mat2 nominal_stress(const Mat2& f) {
  const MembraneSample s = sample({Mat2::Identity(), f});
  Mat2 by_metric;
  by_metric << s.gradient[0], 0.5 * s.gradient[1], 0.5 * s.gradient[1], s.gradient[2];
  return 2.0 * f * by_metric;
}

Mat2 diagonal(double a, double b) { return Eigen::Vector2d(a, b).asDiagonal(); }

TEST(NeoHookean, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Element e = random_element(rng);
    const SurfaceTensor inverse = e.inverse();
    const double det = e.rest().determinant();
    const MembraneSample at = sample(e);
    EXPECT_DOUBLE_EQ(at.energy, energy(e));
    const double h = 1e-5 * e.metric().norm();
    const auto value = [&](const VecX& a) { return wall.energy(inverse, det, a); };
    const auto gradient = [&](const VecX& a) -> VecX { return wall.sample(inverse, det, a).gradient; };
    // Central differences are wrong by (h / metric)^2 = 1e-10 times third derivatives, which grow as the
    // metric's determinant falls (0.1 of its scale is met here), and by rounding / h = 1e-11.
    EXPECT_LT(test::relative_error(at.gradient, test::difference_gradient(value, e.metric(), h)), 1e-6);
    EXPECT_LT(test::relative_error(at.hessian, test::difference_hessian(gradient, e.metric(), h)), 1e-6);
    EXPECT_LT((at.hessian - at.hessian.transpose()).norm(), 1e-14 * at.hessian.norm());
  }
}

TEST(NeoHookean, RestIsTheStressFreeMinimum) {
  Rng rng(2);
  for (int trial = 0; trial < 20; ++trial) {
    Element e = random_element(rng);
    const double deformed = energy(e);
    e.deformation.setIdentity();
    const MembraneSample rest = sample(e);
    const double scale = wall.thickness * wall.shear_modulus;  // J/m^2
    EXPECT_GT(deformed, 0);
    EXPECT_NEAR(rest.energy, 0, 1e-13 * scale);
    EXPECT_LT(rest.gradient.norm(), 1e-12 * scale * e.inverse().norm());
  }
}

TEST(NeoHookean, SheetUnderUniaxialTensionFollowsTheClosedForm) {
  const double mu_t = wall.shear_modulus * wall.thickness;
  for (double stretch : {0.7, 0.9, 1.1, 1.5, 2.5}) {
    const Mat2 f = diagonal(stretch, 1 / std::sqrt(stretch));
    const Mat2 p = nominal_stress(f);
    EXPECT_NEAR(energy({Mat2::Identity(), f}), 0.5 * mu_t * (stretch * stretch + 2 / stretch - 3),
                1e-12 * mu_t);
    EXPECT_NEAR(p(0, 0), mu_t * (stretch - 1 / (stretch * stretch)), 1e-12 * mu_t);
    EXPECT_NEAR(p(1, 1), 0, 1e-12 * mu_t) << "the free edges carry no stress";
  }
}

TEST(NeoHookean, SheetUnderBiaxialAndPureShearTensionFollowsTheClosedForms) {
  const double mu_t = wall.shear_modulus * wall.thickness;
  for (double stretch : {0.8, 1.2, 2.0}) {
    const Mat2 biaxial = nominal_stress(diagonal(stretch, stretch));
    EXPECT_NEAR(biaxial(0, 0), mu_t * (stretch - std::pow(stretch, -5)), 1e-12 * mu_t);
    EXPECT_NEAR(biaxial(1, 1), biaxial(0, 0), 1e-12 * mu_t);
    const Mat2 shear = nominal_stress(diagonal(stretch, 1.0));
    EXPECT_NEAR(shear(0, 0), mu_t * (stretch - std::pow(stretch, -3)), 1e-12 * mu_t);
    EXPECT_NEAR(shear(1, 1), mu_t * (1 - std::pow(stretch, -2)), 1e-12 * mu_t);
  }
}

TEST(NeoHookean, EnergyDoesNotDependOnTheFacesParameters) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Element e = random_element(rng);
    const Element other{e.tangents * (Mat2::Identity() + random_matrix(rng, 0.4)), e.deformation};
    EXPECT_NEAR(energy(other), energy(e), 1e-10 * energy(e));
    EXPECT_NEAR(largest_stretch(other.inverse(), other.metric()), largest_stretch(e.inverse(), e.metric()),
                1e-7);  // a root of a difference of squares halves the digits where both stretches agree
  }
}

TEST(NeoHookean, CollapsedMetricHasInfiniteEnergy) {
  EXPECT_EQ(wall.energy({1, 0, 1}, 1, {1, 1, 1}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(wall.energy({1, 0, 1}, 1, {1, 2, 1}), std::numeric_limits<double>::infinity());
}

TEST(KoiterBending, EnergyFollowsThePlateFormulas) {
  const KoiterBending bending{100e3, 2e-3};
  const double d = bending.rigidity();
  // E t^3 / (12 (1 - nu^2)) with E = 3 mu and nu = 1/2.
  EXPECT_NEAR(d, 300e3 * 8e-9 / (12 * 0.75), 1e-15 * d);
  const Mat3 h = bending.hessian({1, 0, 1});
  Rng rng(4);
  for (int trial = 0; trial < 20; ++trial) {
    const double k1 = rng.uniform(-50, 50), k2 = rng.uniform(-50, 50), twist = rng.uniform(-50, 50);
    const Vec3 k(k1, twist, k2);
    const double plate = 0.5 * d * (k1 * k1 + k2 * k2 + 2 * 0.5 * k1 * k2 + 2 * (1 - 0.5) * twist * twist);
    EXPECT_NEAR(0.5 * k.dot(h * k), plate, 1e-12 * d * k.squaredNorm());
  }
  EXPECT_EQ(h, h.transpose());
}

TEST(KoiterBending, EnergyDoesNotDependOnTheFacesParameters) {
  const KoiterBending bending;
  Rng rng(5);
  for (int trial = 0; trial < 20; ++trial) {
    Mat2 k = random_matrix(rng, 50);
    k = (k + k.transpose()).eval();
    const Mat2 j = Mat2::Identity() + random_matrix(rng, 0.4);
    const Mat2 change = j.transpose() * k * j, rest = j.transpose() * j;
    const double there = 0.5 * tensor(change).dot(bending.hessian(tensor(rest.inverse())) * tensor(change));
    const double here = 0.5 * tensor(k).dot(bending.hessian({1, 0, 1}) * tensor(k));
    EXPECT_NEAR(there, here, 1e-10 * here);
  }
}

TEST(LargestStretch, FollowsTheClosedForms) {
  const SurfaceTensor unit(1, 0, 1);
  EXPECT_NEAR(largest_stretch(unit, {1.3 * 1.3, 0, 0.8 * 0.8}), 1.3, 1e-14);
  EXPECT_NEAR(largest_stretch(unit, {0.7 * 0.7, 0, 0.8 * 0.8}), 0.8, 1e-14);
  for (double shear : {0.1, 0.5, 2.0}) {
    // Simple shear: the roots of C = [1, g; g, 1 + g^2].
    const double expected = 0.5 * shear + std::sqrt(1 + 0.25 * shear * shear);
    EXPECT_NEAR(largest_stretch(unit, {1, shear, 1 + shear * shear}), expected, 1e-14 * expected);
  }
  // Rest lengths of 2 and 4: only the ratio counts.
  EXPECT_NEAR(largest_stretch({1 / 4.0, 0, 1 / 16.0}, {9, 0, 16}), 1.5, 1e-14);
}

}  // namespace
}  // namespace calot
