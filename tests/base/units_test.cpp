#include "base/units.h"

#include <gtest/gtest.h>

namespace calot::units {
namespace {

TEST(Units, DerivedOnesFollowFromTheirDefinitions) {
  constexpr double ulps = 4e-16;  // relative rounding of a product or two
  EXPECT_NEAR(mL / (cm * cm * cm), 1.0, ulps);
  EXPECT_NEAR(L / (1000 * mL), 1.0, ulps);
  EXPECT_NEAR(kPa / (N / m / m * 1000), 1.0, ulps);
  EXPECT_NEAR(MPa / (N / (mm * mm)), 1.0, ulps);
  EXPECT_NEAR(180 * deg / std::acos(-1.0), 1.0, ulps);
  // A millimetre of mercury of 13595.1 kg/m^3 under standard gravity, given to 12 digits.
  EXPECT_NEAR(mmHg / (13595.1 * kg / (m * m * m) * standard_gravity * mm), 1.0, 1e-11);
}

}  // namespace
}  // namespace calot::units
