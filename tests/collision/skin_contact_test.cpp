// Contact of two skins: forces, their smoothness, and that nothing passes.

#include "collision/skin_contact.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "collision/edge_distance.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace skin_contact_test {
namespace {

using Points = std::vector<Vec3>;

constexpr Barrier barrier{0.4e-3, 20e3};

/// A line with balls about its points, and a bumpy sheet.
struct Line {
  Points points;
  ContactSkin skin;
  Line(Points at, double radius)
      : points(std::move(at)), skin(points, {}, segments(points), radius, even_areas(points.size())) {}
  static std::vector<double> even_areas(std::size_t count) { return std::vector<double>(count, 1e-6); }
  static std::vector<Segment> segments(const Points& p) {
    std::vector<Segment> out;
    for (int k = 1; k < static_cast<int>(p.size()); ++k) out.push_back({k, k - 1});
    return out;
  }
};

struct Sheet {
  Points points;
  ContactSkin skin;
  /// `across` cells of a millimetre about the origin in the plane z = 0, its points off by up to `bump`.
  Sheet(Rng& rng, int across, double bump)
      : points(places(rng, across, bump)),
        skin(points, cells(across), {}, 0, std::vector<double>(points.size(), 0.5e-6)) {}

  static Points places(Rng& rng, int across, double bump) {
    Points out;
    for (int i = 0; i <= across; ++i)
      for (int j = 0; j <= across; ++j)
        out.push_back(1e-3 * Vec3(i - 0.5 * across, j - 0.5 * across, 0) + test::random_vector(rng, bump));
    return out;
  }
  static std::vector<Triangle> cells(int across) {
    std::vector<Triangle> out;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j) {
        const int a = i * (across + 1) + j, b = a + across + 1;
        out.push_back({a, b, b + 1});
        out.push_back({a, b + 1, a + 1});
      }
    return out;
  }
};

Points along(const Vec3& from, const Vec3& to, int spans) {
  Points out;
  for (int k = 0; k <= spans; ++k) out.push_back(from + (to - from) * k / spans);
  return out;
}

/// Energy of two skins, and its gradient by all their points, the first skin's before the other's.
struct Both {
  const ContactSkin &one, &two;

  Points split(const VecX& x, bool second, std::size_t first_points) const {
    const std::size_t count = static_cast<std::size_t>(x.size()) / 3;
    Points out;
    for (std::size_t k = second ? first_points : 0; k < (second ? count : first_points); ++k)
      out.push_back(x.segment<3>(3 * static_cast<Eigen::Index>(k)));
    return out;
  }
  struct Sum {
    double energy = 0;
    VecX gradient;
    Eigen::MatrixXd hessian;
    int touches = 0;
    std::array<int, 4> by_corners{};
  };
  Sum operator()(const VecX& x, std::size_t first_points, bool with_hessian = false) const {
    const Points a = split(x, false, first_points), b = split(x, true, first_points);
    const std::array<PlacedSkin, 2> skins{PlacedSkin{&one, &a, nullptr}, PlacedSkin{&two, &b, nullptr}};
    const std::array<int, 2> shift{0, static_cast<int>(first_points)};
    Sum out;
    out.gradient = VecX::Zero(x.size());
    if (with_hessian) out.hessian = Eigen::MatrixXd::Zero(x.size(), x.size());
    const std::vector<SkinPair> pairs = skin_pairs(skins, {barrier.range, 1});
    for (const SkinTouch& touch : skin_touches(skins, pairs, barrier.range)) {
      const BarrierSample at_gap = barrier.sample(touch.gap);
      out.energy += touch.area * at_gap.energy;
      ++out.touches;
      ++out.by_corners[touch.part.corners];
      std::array<int, 4> ids{shift[touch.skin] + touch.point, -1, -1, -1};
      for (int k = 0; k < touch.part.corners; ++k) ids[k + 1] = shift[touch.other] + touch.part.corner[k];
      const auto gradient = touch_gradient(touch, at_gap);
      for (int k = 0; k <= touch.part.corners; ++k)
        out.gradient.segment<3>(3 * ids[k]) += gradient.segment<3>(3 * k);
      if (!with_hessian) continue;
      const std::array<Vec3, 3> corners = touch_corners(touch, touch.other == 0 ? a : b);
      const auto hessian =
          touch_hessian(touch, {corners.data(), static_cast<std::size_t>(touch.part.corners)}, at_gap);
      for (int k = 0; k <= touch.part.corners; ++k)
        for (int l = 0; l <= touch.part.corners; ++l)
          out.hessian.block<3, 3>(3 * ids[k], 3 * ids[l]) += hessian.block<3, 3>(3 * k, 3 * l);
    }
    return out;
  }
};

VecX stacked(const Points& a, const Points& b) {
  Points all = a;
  all.insert(all.end(), b.begin(), b.end());
  return to_coordinates(all);
}

/// A bent line above a bumpy sheet, and two bent lines across each other: all within the barrier's range somewhere.
struct Meeting {
  Sheet sheet;
  Line line, other;
  explicit Meeting(Rng& rng)
      : sheet(rng, 5, 0.1e-3),
        line(bent(rng, {-3e-3, -1e-3, 1.25e-3}, {3e-3, 1.5e-3, 1.25e-3}), 1e-3),
        other(bent(rng, {0.5e-3, -3e-3, 3.05e-3}, {-0.3e-3, 3e-3, 3.05e-3}), 0.6e-3) {}
  static Points bent(Rng& rng, const Vec3& from, const Vec3& to) {
    Points out = along(from, to, 10);
    for (Vec3& p : out) p += test::random_vector(rng, 0.05e-3);
    return out;
  }
};

TEST(SkinContact, GradientAndHessianAreTheDerivativesOfTheEnergy) {
  Rng rng(1);
  std::array<int, 4> seen{};
  for (int trial = 0; trial < 2; ++trial) {
    const Meeting at(rng);
    const auto check_both = [&](const ContactSkin& one, const Points& a, const ContactSkin& two,
                                const Points& b) {
      const Both both{one, two};
      const VecX x = stacked(a, b);
      const auto value = [&](const VecX& y) { return both(y, a.size()).energy; };
      const auto gradient = [&](const VecX& y) { return both(y, a.size()).gradient; };
      const Both::Sum sum = both(x, a.size(), true);
      for (int k = 1; k < 4; ++k) seen[k] += sum.by_corners[k];
      EXPECT_GT(sum.touches, 3);
      EXPECT_GT(sum.energy, 0);
      // Gaps of 5e-5 m: differences err by (2e-9 / 5e-5)^2, by rounding, and where a part is left within the step.
      EXPECT_LT(test::relative_error(sum.gradient, test::difference_gradient(value, x, 2e-9)), 1e-5);
      EXPECT_LT(test::relative_error(sum.hessian, test::difference_hessian(gradient, x, 2e-9)), 1e-5);
      // Action and reaction on one line.
      const double size = sum.gradient.cwiseAbs().sum();
      EXPECT_LT(test::net_force(sum.gradient).norm(), 1e-13 * size);
      EXPECT_LT(test::net_torque(x, sum.gradient, Vec3::Zero()).norm(), 1e-13 * size * 6e-3);
    };
    check_both(at.line.skin, at.line.points, at.sheet.skin, at.sheet.points);
    check_both(at.line.skin, at.line.points, at.other.skin, at.other.points);
  }
  for (int k = 1; k < 4; ++k) EXPECT_GT(seen[k], 3) << k;
}

TEST(SkinContact, AboveAStraightLineAPointSeesItsRadiusOnceHoweverItIsCut) {
  const Points pin{Vec3(0.1e-3, 0.2e-3, 1.2e-3)};
  const ContactSkin point(pin, {}, {}, 0.3e-3, {2e-6});
  const double exact = 2e-6 * barrier.sample(std::hypot(0.2e-3, 1.2e-3) - 1e-3).energy;
  for (int spans : {1, 3, 7, 40}) {
    const Line line(along({-5e-3, 0, 0}, {5e-3, 0, 0}, spans), 0.7e-3);
    const ContactSkin still(line.points, {}, Line::segments(line.points), 0.7e-3,
                            std::vector<double>(line.points.size(), 0.0));
    EXPECT_NEAR(Both({point, still})(stacked(pin, line.points), 1).energy, exact, 1e-12 * exact) << spans;
  }
}

TEST(SkinContact, ThePotentialHasNoKinkWhereTheNearestPlacePassesFromSegmentToSegment) {
  Rng rng(2);
  Points zigzag = along({-5e-3, 0, 0}, {5e-3, 0, 0}, 10);
  for (Vec3& p : zigzag) p += test::random_vector(rng, 0.15e-3);
  const ContactSkin line(zigzag, {}, Line::segments(zigzag), 0.7e-3, std::vector<double>(zigzag.size(), 0.0));
  const ContactSkin ball({Vec3::Zero()}, {}, {}, 0.3e-3, {1e-6});
  const Both both{ball, line};
  double rise = 0, fall = 0;
  for (int way = 0; way < 4; ++way) {
    const Vec3 from(-4e-3, rng.uniform(-0.2e-3, 0.2e-3), 1.3e-3),
        to(4e-3, rng.uniform(-0.2e-3, 0.2e-3), 1.3e-3);
    constexpr int steps = 4000;
    const Vec3 step = (to - from) / steps;
    Both::Sum before = both(stacked({from}, zigzag), 1);
    for (int k = 1; k <= steps; ++k) {
      const Both::Sum now = both(stacked({from + k * step}, zigzag), 1);
      // The potential is the integral of its slope: the trapezium errs by the square of the step, a jump of the slope
      // by as much as the slope jumps: 1e-11 J are 1e-5 N, of 0.02.
      const double by_slope = 0.5 * (now.gradient + before.gradient).head<3>().dot(step);
      EXPECT_NEAR(now.energy - before.energy, by_slope, 5e-3 * std::abs(by_slope) + 1e-11);
      (now.energy > before.energy ? rise : fall) += std::abs(now.energy - before.energy);
      before = now;
    }
  }
  EXPECT_GT(rise, 1e-7);
  EXPECT_GT(fall, 1e-7);
}

TEST(SkinContact, SafeSharesKeepEveryGapsShareAndAreNotNeedlesslySmall) {
  constexpr double keep = 0.2;
  Rng rng(3);
  int cut = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 p = test::random_vector(rng, 3e-3), motion = -2 * p + test::random_vector(rng, 2e-3);
    const int count = 2 + trial % 2;
    Points corners, motions;
    for (int k = 0; k < count; ++k) {
      corners.push_back(test::random_vector(rng, 3e-3));
      motions.push_back(test::random_vector(rng, 2e-3));
    }
    const double radii = 0.8e-3;
    const auto gap = [&](double share) {
      Points now = corners;
      for (int k = 0; k < count; ++k) now[k] += share * motions[k];
      return nearest_point(p + share * motion, now).distance - radii;
    };
    const double share = safe_share(p, motion, corners, motions, keep, radii);
    if (gap(0) <= 0) {
      EXPECT_EQ(share, 0);
      continue;
    }
    for (int k = 0; k <= 100; ++k) EXPECT_GE(gap(share * k / 100), keep * gap(0) - 1e-14);
    if (share == 1) continue;
    ++cut;
    EXPECT_LT(gap(share), keep * gap(0) + 1e-10);
  }
  EXPECT_GT(cut, 15);
}

double nearest_of_lines(const Points& a, const Points& b) {
  double out = 1;
  for (std::size_t i = 1; i < a.size(); ++i)
    for (std::size_t k = 1; k < b.size(); ++k)
      out = std::min(out, nearest_of_edges({a[i - 1], a[i], b[k - 1], b[k]}).distance);
  return out;
}

TEST(SkinContact, LinesWhosePointsKeepTheirGapsAreAsFarApartAsPromised) {
  // Random segments against each other, moved apart until all points just keep their gaps: never nearer than the
  // bound; and where the middles cross squarely it is reached.
  constexpr double radii = 1e-3, spacing = 0.9e-3;
  const double bound = line_clearance(radii, spacing);
  EXPECT_GT(bound, 0.86 * radii);
  Rng rng(4);
  double nearest = 1;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 u = spacing / 2 * test::random_vector(rng, 1.0).normalized(),
               v = test::random_vector(rng, 1.0).normalized();
    const Vec3 middle = radii * test::random_vector(rng, 1.2);
    const Points one{middle - u, middle + u}, other{-5e-3 * v, 5e-3 * v};
    const double points =
        std::min(nearest_point(one[0], other).distance, nearest_point(one[1], other).distance);
    if (points < radii) continue;
    const double between = nearest_of_lines(one, other);
    EXPECT_GE(between, bound);
    nearest = std::min(nearest, between);
  }
  EXPECT_LT(nearest, 1.05 * bound);  // of those that were tried
  const Vec3 half(spacing / 2, 0, bound);
  EXPECT_NEAR(nearest_point(half, Points{{0, -1, 0}, {0, 1, 0}}).distance, radii, 1e-15);
  EXPECT_EQ(line_clearance(1e-3, 2.1e-3), 0);
}

/// Places after as much of a motion as is safe, of both skins.
void move_safely(std::array<PlacedSkin, 2> skins, Points& a, const Points& da, Points& b, const Points& db) {
  constexpr double keep = 0.2;
  skins[0].motions = &da;
  skins[1].motions = &db;
  const double share = safe_share(skins, skin_pairs(skins, {0, 1 - keep}), keep);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += share * da[k];
  for (std::size_t k = 0; k < b.size(); ++k) b[k] += share * db[k];
}

TEST(SkinContact, TwoThinRodsPushedThroughEachOtherNeverPass) {
  // Both as thin as 0.3 mm, their points two thirds of that apart, by steps of many times their thickness.
  constexpr double radius = 0.3e-3, length = 6e-3;
  Rng rng(5);
  int met = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Line one(along({-length / 2, 0, 1e-3}, {length / 2, 0, 1e-3}, 30), radius);
    Line two(along({0, -length / 2, -1e-3}, {0, length / 2, -1e-3}, 30), radius);
    const double bound = line_clearance(2 * radius, 1.5 * length / 30);
    const std::array<PlacedSkin, 2> skins{PlacedSkin{&one.skin, &one.points, nullptr},
                                          PlacedSkin{&two.skin, &two.points, nullptr}};
    for (int step = 0; step < 10; ++step) {
      const Vec3 down = Vec3(0, 0, -4e-3) + test::random_vector(rng, 1e-3);
      Points da, db;
      for (const Vec3& p : one.points) da.push_back(down + p.cross(test::random_vector(rng, 0.1)));
      for (std::size_t k = 0; k < two.points.size(); ++k) db.push_back(test::random_vector(rng, 0.02e-3));
      move_safely(skins, one.points, da, two.points, db);
      EXPECT_GT(nearest_of_lines(one.points, two.points), bound);
    }
    met += nearest_of_lines(one.points, two.points) < 2.2 * radius;
    EXPECT_GT(one.points[15].z(), two.points[15].z()) << "still above";
  }
  EXPECT_GT(met, 6);
}

TEST(SkinContact, WhatIsClosedOrNotFiniteMayNotMove) {
  const Line one(along({-1e-3, 0, 0}, {1e-3, 0, 0}, 4), 0.3e-3);
  const Line near(along({0, -1e-3, 0.5e-3}, {0, 1e-3, 0.5e-3}, 4), 0.3e-3);
  const Line far(along({0, -1e-3, 5e-3}, {0, 1e-3, 5e-3}, 4), 0.3e-3);
  Points motion(5, Vec3(0, 0, 1e-4)), lost = motion;
  lost[2].x() = std::nan("");
  const auto share = [&](const Line& other, const Points& way) {
    const std::array<PlacedSkin, 2> skins{PlacedSkin{&one.skin, &one.points, &way},
                                          PlacedSkin{&other.skin, &other.points, nullptr}};
    return safe_share(skins, skin_pairs(skins, {0, 0.8}), 0.2);
  };
  EXPECT_EQ(share(near, motion), 0);
  EXPECT_EQ(share(far, motion), 1);
  EXPECT_EQ(share(far, lost), 0);
}

}  // namespace
}  // namespace skin_contact_test
}  // namespace calot
