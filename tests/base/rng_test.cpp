#include "base/rng.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

TEST(Rng, IsSplitMix64) {
  // The first outputs for seed 1234567, published with the reference implementation's ports.
  Rng rng(1234567);
  for (const std::uint64_t expected : {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
                                       4593380528125082431ULL, 16408922859458223821ULL})
    EXPECT_EQ(rng.next(), expected);
}

TEST(Rng, RepeatsItselfForASeedAndOnlyForIt) {
  Rng first(7), second(7), other(8);
  int equal_to_other = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t value = first.next();
    EXPECT_EQ(value, second.next());
    equal_to_other += value == other.next() ? 1 : 0;
  }
  EXPECT_EQ(equal_to_other, 0);
}

TEST(Rng, UniformHasTheMomentsOfTheUnitInterval) {
  constexpr int n = 200000;
  Rng rng(3);
  double sum = 0, squares = 0, products = 0, before = 0.5;
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
    products += (u - 0.5) * (before - 0.5);
    before = u;
  }
  // Five standard deviations of each estimate: sqrt(1/12 / n), sqrt(1/180 / n) and 1/12 / sqrt(n).
  const double root = std::sqrt(n);
  EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12) / root);
  EXPECT_NEAR(squares / n, 1.0 / 12, 5 * std::sqrt(1.0 / 180) / root);
  EXPECT_NEAR(products / n, 0.0, 5.0 / 12 / root);
}

TEST(Rng, UniformFillsEveryTenthEvenly) {
  constexpr int n = 100000;
  Rng rng(4);
  std::vector<int> counts(10);
  for (int i = 0; i < n; ++i) ++counts[static_cast<std::size_t>(10 * rng.uniform())];
  // A count is binomial with standard deviation sqrt(n 0.1 0.9) = 95: five of them.
  for (const int count : counts) EXPECT_NEAR(count, n / 10, 5 * std::sqrt(n * 0.09));
}

TEST(Rng, UniformBetweenLimitsStaysBetweenThem) {
  Rng rng(5);
  double least = 3, most = -2;
  for (int i = 0; i < 10000; ++i) {
    const double u = rng.uniform(-2, 3);
    least = std::min(least, u);
    most = std::max(most, u);
  }
  EXPECT_GE(least, -2);
  EXPECT_LT(most, 3);
  // All of 10000 missing the outer 1% on a side has a chance of 0.99^10000 = 1e-44.
  EXPECT_LT(least, -1.95);
  EXPECT_GT(most, 2.95);
}

}  // namespace
}  // namespace calot
