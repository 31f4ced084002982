#include "tools/tool.h"

#include <gtest/gtest.h>

#include "field/grip.h"
#include "support/bodies.h"

namespace calot {
namespace {

constexpr InstrumentPose jaw_at(double jaw) { return {0, 0, 0.1, 0, jaw}; }

/// Angles at which a closing in `steps` even steps may take hold.
std::vector<double> holding_angles(double from, double to, int steps) {
  std::vector<double> angles;
  for (int k = 0; k < steps; ++k) {
    const InstrumentPose a = jaw_at(from + (to - from) * k / steps);
    const InstrumentPose b = jaw_at(from + (to - from) * (k + 1) / steps);
    double last = 0;
    for (double share : closing_stops(a, b, grip_grid)) {
      EXPECT_GT(share, last);
      EXPECT_LE(share, 1.0);
      last = share;
      angles.push_back(interpolate(a, b, share).jaw);
    }
  }
  return angles;
}

TEST(Tool, JawsTakeHoldAtTheSameAnglesWhateverTheSteps) {
  for (const auto& [from, to] : {std::pair{0.8, 0.0}, {30 * grip_grid, 2 * grip_grid}, {0.5, 0.1}}) {
    const std::vector<double> once = holding_angles(from, to, 1);
    EXPECT_EQ(once.size(),
              std::lround(std::ceil(from / grip_grid - 1e-9) - std::ceil(to / grip_grid - 1e-9)));
    for (int steps : {2, 7, 28, 560}) {
      const std::vector<double> often = holding_angles(from, to, steps);
      ASSERT_EQ(often.size(), once.size()) << steps;
      for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_NEAR(often[i], once[i], 1e-12);
        EXPECT_NEAR(std::remainder(once[i], grip_grid), 0, 1e-12);
      }
    }
  }
}

TEST(Tool, OpeningOrStillJawsTakeNoHold) {
  EXPECT_TRUE(closing_stops(jaw_at(0.1), jaw_at(0.8), grip_grid).empty());
  EXPECT_TRUE(closing_stops(jaw_at(0.1), jaw_at(0.1), grip_grid).empty());
}

TEST(Tool, InterpolationMeetsItsEndsExactly) {
  const InstrumentPose a{0.1, -0.2, 0.15, 0.3, 0.7}, b{0.3, 0.1, 0.18, -1.0, 0.2};
  EXPECT_EQ(interpolate(a, b, 0.0), a);
  EXPECT_EQ(interpolate(a, b, 1.0), b);
  EXPECT_NEAR(interpolate(a, b, 0.25).insertion, 0.1575, 1e-15);
}

class ToolOfType : public ::testing::TestWithParam<std::string> {
 protected:
  const InstrumentType type = *instrument_type_called(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Each, ToolOfType, ::testing::ValuesIn(instrument_type_names()),
                         [](const auto& one) { return one.param; });

TEST_P(ToolOfType, PartMotionCarriesEachShapeFromOnePoseToTheOther) {
  Tool tool;
  tool.trocar = Vec3(0.1, 0, 0.05);
  tool.geometry = instrument_geometry(type);
  const double jaw = tool.geometry.has_jaws() ? 0.7 : 0;
  const InstrumentPose from{0.1, -0.2, 0.15, 0.3, jaw}, to{0.12, -0.15, 0.155, 0.35, 0.9 * jaw};
  const std::vector<Shape> before = instrument_shapes(tool.trocar, from, tool.geometry);
  const std::vector<Shape> after = instrument_shapes(tool.trocar, to, tool.geometry);
  Rng rng(1);
  for (int part = 0; part < shapes_per_tool; ++part) {
    const Pose motion = part_motion(tool, from, to, part);
    for (int k = 0; k < 20; ++k) {
      const Vec3 x = tip_position(tool.trocar, from, tool.geometry) + test::random_vector(rng, 20e-3);
      // The shaft's far end slides with the handle; near the tip carried points keep their distance.
      EXPECT_NEAR(signed_distance(after[part], motion * x), signed_distance(before[part], x), 1e-15);
    }
  }
}

}  // namespace
}  // namespace calot
