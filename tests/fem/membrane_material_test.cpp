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
Mat2 nominal_stress(const MembraneSample& s, const Mat2& f) {
  Mat2 by_metric;
  by_metric << s.gradient[0], 0.5 * s.gradient[1], 0.5 * s.gradient[1], s.gradient[2];
  return 2.0 * f * by_metric;
}
Mat2 nominal_stress(const Mat2& f) { return nominal_stress(sample({Mat2::Identity(), f}), f); }
Mat2 nominal_stress(const Demiray& law, const Mat2& f) {
  return nominal_stress(law.sample({1, 0, 1}, 1, tensor(f.transpose() * f)), f);
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

TEST(NeoHookean, NegativeDefiniteMetricHasInfiniteEnergyAndNothingIsNan) {
  EXPECT_EQ(wall.energy({1, 0, 1}, 1, {-1, 0, -1}), std::numeric_limits<double>::infinity());
  for (const SurfaceTensor& metric : {SurfaceTensor(1, 1, 1), SurfaceTensor(-1, 0, -1)}) {
    const MembraneSample at = wall.sample({1, 0, 1}, 1, metric);
    EXPECT_TRUE(at.gradient.isZero(0) && at.hessian.isZero(0));
  }
}

const Demiray fung{100e3, 2e-3, 3.0};

TEST(Demiray, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(11);
  double stiffest = 0;  // how far the states are into the exponential
  for (int trial = 0; trial < 50; ++trial) {
    const Element e{1e-2 * (Mat2::Identity() + random_matrix(rng, 0.4)),
                    Mat2::Identity() + random_matrix(rng, 0.25)};
    const SurfaceTensor inverse = e.inverse();
    const double det = e.rest().determinant();
    const MembraneSample at = fung.sample(inverse, det, e.metric());
    EXPECT_DOUBLE_EQ(at.energy, fung.energy(inverse, det, e.metric()));
    const double h = 1e-5 * e.metric().norm();
    const auto value = [&](const VecX& a) { return fung.energy(inverse, det, a); };
    const auto gradient = [&](const VecX& a) -> VecX { return fung.sample(inverse, det, a).gradient; };
    // As for the neo-Hookean law; the exponential's third derivatives are larger by some b^2 = 10.
    EXPECT_LT(test::relative_error(at.gradient, test::difference_gradient(value, e.metric(), h)), 1e-5);
    EXPECT_LT(test::relative_error(at.hessian, test::difference_hessian(gradient, e.metric(), h)), 1e-5);
    EXPECT_LT((at.hessian - at.hessian.transpose()).norm(), 1e-14 * at.hessian.norm());
    stiffest = std::max(stiffest, at.energy / energy(e));
  }
  EXPECT_GT(stiffest, 2);
}

TEST(Demiray, WithoutStiffeningIsTheNeoHookeanWallToTheBit) {
  Rng rng(12);
  for (int trial = 0; trial < 20; ++trial) {
    const Element e = random_element(rng);
    const Demiray plain{wall.shear_modulus, wall.thickness};
    const MembraneSample a = plain.sample(e.inverse(), e.rest().determinant(), e.metric()), b = sample(e);
    EXPECT_EQ(a.energy, b.energy);
    EXPECT_EQ(a.gradient, b.gradient);
    EXPECT_EQ(a.hessian, b.hessian);
    EXPECT_EQ(plain.energy(e.inverse(), e.rest().determinant(), e.metric()), b.energy);
  }
}

TEST(Demiray, TendsToTheNeoHookeanWallInProportionToItsStiffening) {
  Rng rng(13);
  for (int trial = 0; trial < 20; ++trial) {
    const Element e = random_element(rng);
    const MembraneSample ground = sample(e);
    const double invariant = ground.energy / (0.5 * wall.shear_modulus * wall.thickness);  // I1 - 3
    double energy_error[2], gradient_error[2], hessian_error[2];
    for (int k = 0; k < 2; ++k) {
      const Demiray law{wall.shear_modulus, wall.thickness, (k == 0 ? 1e-3 : 1e-4) / invariant};
      const MembraneSample at = law.sample(e.inverse(), e.rest().determinant(), e.metric());
      energy_error[k] = at.energy / ground.energy - 1;
      gradient_error[k] = (at.gradient - ground.gradient).norm() / ground.gradient.norm();
      hessian_error[k] = (at.hessian - ground.hessian).norm() / ground.hessian.norm();
    }
    // (exp(y) - 1) / y = 1 + y / 2 + y^2 / 6 and exp(y) = 1 + y + y^2 / 2 at y = b (I1 - 3) = 1e-4.
    EXPECT_NEAR(energy_error[1], 0.5e-4, 1e-8);
    EXPECT_NEAR(gradient_error[1], 1e-4, 1e-8);
    EXPECT_NEAR(energy_error[0] / energy_error[1], 10, 0.01);
    EXPECT_NEAR(gradient_error[0] / gradient_error[1], 10, 0.01);
    EXPECT_NEAR(hessian_error[0] / hessian_error[1], 10, 0.01);
  }
}

TEST(Demiray, SmallStrainModuliAreThoseOfTheNeoHookeanWall) {
  Rng rng(14);
  for (int trial = 0; trial < 20; ++trial) {
    Element e = random_element(rng);
    e.deformation.setIdentity();
    const MembraneSample rest = fung.sample(e.inverse(), e.rest().determinant(), e.metric());
    const MembraneSample neo = sample(e);
    EXPECT_GT(neo.hessian.norm(), 0);
    EXPECT_LT((rest.hessian - neo.hessian).norm(), 1e-12 * neo.hessian.norm());  // gradients at rest round
    EXPECT_LT(rest.gradient.norm(), 1e-12 * wall.thickness * wall.shear_modulus * e.inverse().norm());
  }
}

TEST(Demiray, SheetUnderUniaxialAndBiaxialTensionFollowsTheClosedForms) {
  const double mu_t = fung.shear_modulus * fung.thickness, b = fung.stiffening;
  for (double l : {0.8, 1.2, 1.5}) {
    const double uniaxial = std::exp(b * (l * l + 2 / l - 3));
    const Mat2 along = nominal_stress(fung, diagonal(l, 1 / std::sqrt(l)));
    EXPECT_NEAR(along(0, 0), mu_t * (l - 1 / (l * l)) * uniaxial, 1e-11 * mu_t * uniaxial);
    EXPECT_NEAR(along(1, 1), 0, 1e-11 * mu_t * uniaxial) << "the free edges carry no stress";
    const double biaxial = std::exp(b * (2 * l * l + std::pow(l, -4) - 3));
    const Mat2 both = nominal_stress(fung, diagonal(l, l));
    EXPECT_NEAR(both(0, 0), mu_t * (l - std::pow(l, -5)) * biaxial, 1e-11 * mu_t * biaxial);
    EXPECT_NEAR(both(1, 1), both(0, 0), 1e-11 * mu_t * biaxial);
  }
}

TEST(Demiray, EnergyDoesNotDependOnTheFacesParameters) {
  Rng rng(15);
  int finite = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Element e = random_element(rng);
    const Element other{e.tangents * (Mat2::Identity() + random_matrix(rng, 0.4)), e.deformation};
    const double here = fung.energy(e.inverse(), e.rest().determinant(), e.metric());
    const double there = fung.energy(other.inverse(), other.rest().determinant(), other.metric());
    if (std::isinf(here)) continue;
    ++finite;
    // Rounding of the exponent, 1e-15 of at most 300 times a few operations, is relative to the energy.
    EXPECT_NEAR(there, here, 1e-10 * here);
  }
  EXPECT_GT(finite, 10);
}

TEST(Demiray, EnergyIsInfiniteAndNothingIsNanWhereItCannotBeComputed) {
  const auto infinite = [](const SurfaceTensor& metric) {
    const MembraneSample at = fung.sample({1, 0, 1}, 1, metric);
    EXPECT_EQ(fung.energy({1, 0, 1}, 1, metric), std::numeric_limits<double>::infinity());
    EXPECT_EQ(at.energy, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(at.gradient.isZero(0) && at.hessian.isZero(0));
  };
  infinite({1, 1, 1});      // collapsed
  infinite({1, 2, 1});      // indefinite
  infinite({-1, 0, -1});    // negative definite
  infinite({1e4, 0, 1e4});  // stretched by 100: exp(6e4)
  infinite({std::nan(""), 0, 1});
  // The last finite energies have finite derivatives: b (I1 - 3) = 299.
  const double stretch_squared = 0.5 * (299 / fung.stiffening + 3);
  const MembraneSample last = fung.sample({1, 0, 1}, 1, {stretch_squared, 0, stretch_squared});
  EXPECT_TRUE(std::isfinite(last.energy) && last.gradient.allFinite() && last.hessian.allFinite());
  EXPECT_GT(last.energy, 1e120);
  const double beyond = 0.5 * (301 / fung.stiffening + 3);  // exp(301) itself would be finite
  infinite({beyond, 0, beyond});
}

const FibreFamily family{50e3, 2.0, 2e-3};

/// The direction at `angle` from the first parameter line of an element of unit rest metric.
SurfaceTensor at_angle(double angle) { return fibre_direction(std::cos(angle), std::sin(angle)); }

/// Contravariant components of the rest tangent that is `along` in the plane: J m = along.
SurfaceTensor in_parameters(const Element& e, const Eigen::Vector2d& along) {
  const Eigen::Vector2d m = e.tangents.inverse() * along;
  return fibre_direction(m[0], m[1]);
}

TEST(FibreFamily, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(21);
  int tight = 0, slack = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Element e = random_element(rng);
    const double angle = rng.uniform(0, 3);
    const SurfaceTensor direction = in_parameters(e, {std::cos(angle), std::sin(angle)});
    const double strain = direction.dot(e.metric()) - 1;
    if (std::abs(strain) < 1e-2) continue;  // the difference must not straddle the Hessian's jump
    const MembraneSample at = family.sample(direction, e.metric());
    EXPECT_DOUBLE_EQ(at.energy, family.energy(direction, e.metric()));
    if (strain < 0) {
      ++slack;
      EXPECT_EQ(at.energy, 0);
      EXPECT_TRUE(at.gradient.isZero(0) && at.hessian.isZero(0));
      continue;
    }
    ++tight;
    const double h = 1e-6 * e.metric().norm();
    const auto value = [&](const VecX& a) { return family.energy(direction, a); };
    const auto gradient = [&](const VecX& a) -> VecX { return family.sample(direction, a).gradient; };
    EXPECT_GT(at.gradient.norm(), 0);
    // Central differences: h^2 = 1e-12 over a strain of 1e-2 at least, rounding / h = 1e-10 over the same.
    EXPECT_LT(test::relative_error(at.gradient, test::difference_gradient(value, e.metric(), h)), 1e-6);
    EXPECT_LT(test::relative_error(at.hessian, test::difference_hessian(gradient, e.metric(), h)), 1e-6);
  }
  EXPECT_GT(tight, 20);
  EXPECT_GT(slack, 20);
}

TEST(FibreFamily, StretchAlongAndAcrossFollowsTheClosedForm) {
  const double k1 = family.stiffness * family.thickness, k2 = family.stiffening;
  for (double l : {1.05, 1.2, 1.5}) {
    const double y = l * l - 1;
    const Mat2 f = diagonal(l, 1 / std::sqrt(l));
    const SurfaceTensor metric = tensor(f.transpose() * f);
    EXPECT_NEAR(family.energy(at_angle(0), metric), k1 / (2 * k2) * (std::exp(k2 * y * y) - 1),
                1e-13 * k1 * std::exp(k2 * y * y));
    // P = dW/dl = 2 l k1 (I4 - 1) exp(k2 (I4 - 1)^2).
    const Mat2 along = nominal_stress(family.sample(at_angle(0), metric), f);
    const double stress = 2 * l * k1 * y * std::exp(k2 * y * y);
    EXPECT_NEAR(along(0, 0), stress, 1e-13 * stress);
    EXPECT_NEAR(along(1, 1), 0, 1e-13 * stress);
    // Across, the fibres shorten by 1 / sqrt(l) and carry nothing: the sheet is the isotropic one.
    EXPECT_EQ(family.energy(at_angle(0.5 * M_PI), metric), 0);
    EXPECT_TRUE(family.sample(at_angle(0.5 * M_PI), metric).gradient.isZero(0));
  }
}

TEST(FibreFamily, TwoFamiliesUnderBiaxialAndShearStretchFollowTheClosedForm) {
  const double k1 = family.stiffness * family.thickness, k2 = family.stiffening, angle = 0.6;
  const double c = std::cos(angle), s = std::sin(angle), l1 = 1.3, l2 = 1.1;
  const Mat2 f = diagonal(l1, l2);
  const SurfaceTensor metric = tensor(f.transpose() * f);
  const double y = l1 * l1 * c * c + l2 * l2 * s * s - 1;
  const Mat2 p = nominal_stress(family.sample(at_angle(angle), metric), f) +
                 nominal_stress(family.sample(at_angle(-angle), metric), f);
  const double scale = 4 * k1 * y * std::exp(k2 * y * y);
  EXPECT_NEAR(p(0, 0), scale * l1 * c * c, 1e-13 * scale);
  EXPECT_NEAR(p(1, 1), scale * l2 * s * s, 1e-13 * scale);
  EXPECT_NEAR(p(0, 1), 0, 1e-13 * scale) << "the families' shears cancel";
  // One alone shears, and is stretched by simple shear: I4 = (c + g s)^2 + s^2.
  const double g = 0.4, sheared = (c + g * s) * (c + g * s) + s * s - 1;
  EXPECT_NEAR(family.energy(at_angle(angle), {1, g, 1 + g * g}),
              k1 / (2 * k2) * std::expm1(k2 * sheared * sheared), 1e-13 * k1);
}

TEST(FibreFamily, AddsFourTimesItsStiffnessToYoungsModulusAlongTheFibres) {
  const double l = 1 + 1e-6;
  const Mat2 f = diagonal(l, 1 / std::sqrt(l));
  const SurfaceTensor metric = tensor(f.transpose() * f);
  const double modulus = nominal_stress(family.sample(at_angle(0), metric), f)(0, 0) / (l - 1);
  EXPECT_NEAR(modulus, 4 * family.stiffness * family.thickness, 1e-5 * modulus);  // of second order in l - 1
}

TEST(FibreFamily, EnergyDoesNotDependOnTheFacesParameters) {
  Rng rng(22);
  int tight = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Element e = random_element(rng);
    const Element other{e.tangents * (Mat2::Identity() + random_matrix(rng, 0.4)), e.deformation};
    const double angle = rng.uniform(0, 3);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const double here = family.energy(in_parameters(e, along), e.metric());
    tight += here > 0;
    // Rounding of I4, of order 1, where its excess is small.
    EXPECT_NEAR(family.energy(in_parameters(other, along), other.metric()), here,
                1e-10 * (here + family.stiffness * family.thickness));
  }
  EXPECT_GT(tight, 10);
}

TEST(FibreFamily, WithoutStiffeningIsQuadraticAndTheLimitOfSmallStiffening) {
  const double k1t = 50e3 * 2e-3, y = 1.3 * 1.3 - 1;
  const SurfaceTensor metric(1.3 * 1.3, 0, 1);
  EXPECT_NEAR(FibreFamily({50e3, 0, 2e-3}).energy(at_angle(0), metric), 0.5 * k1t * y * y, 1e-14 * k1t);
  for (double k2 : {1e-3, 1e-4}) {
    const double excess = FibreFamily({50e3, k2, 2e-3}).energy(at_angle(0), metric) / (0.5 * k1t * y * y) - 1;
    EXPECT_NEAR(excess, 0.5 * k2 * y * y, k2 * k2);  // (exp(q) - 1) / q = 1 + q / 2 + q^2 / 6
  }
}

TEST(FibreFamily, EnergyIsInfiniteAndNothingIsNanBeyondTheLargestExponent) {
  const auto at_exponent = [](double exponent) {
    return SurfaceTensor(1 + std::sqrt(exponent / family.stiffening), 0, 1);
  };
  for (double exponent : {301.0, 1e6}) {
    const MembraneSample at = family.sample(at_angle(0), at_exponent(exponent));
    EXPECT_EQ(at.energy, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(at.gradient.isZero(0) && at.hessian.isZero(0));
  }
  const MembraneSample last = family.sample(at_angle(0), at_exponent(299));
  EXPECT_TRUE(std::isfinite(last.energy) && last.gradient.allFinite() && last.hessian.allFinite());
  EXPECT_GT(last.energy, 1e120);
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

TEST(FibreFamily, OfNoStiffnessBearsNothingHoweverStretched) {
  FibreFamily none;
  none.stiffness = 0;
  none.stiffening = 1000;
  const SurfaceTensor along(1, 0, 0);
  for (double stretch : {1.0, 1.5, 3.0}) {
    const MembraneSample s = none.sample(along, SurfaceTensor(stretch * stretch, 0, 1));
    EXPECT_EQ(s.energy, 0.0);
    EXPECT_EQ(s.gradient, Vec3::Zero());
    EXPECT_EQ(s.hessian, Mat3::Zero());
  }
}

}  // namespace
}  // namespace calot
