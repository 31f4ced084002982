#include "session/force_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace calot {
namespace {

using testing::HasSubstr;

Traces pulled(double force) {
  Traces traces;
  traces.time = {0, 0.1, 0.2};
  traces.instruments.resize(1);
  for (int k = 0; k < 3; ++k) {
    InstrumentSample sample;
    sample.tip = Vec3(0, 0, 10e-3 * k);
    sample.force = force * k;
    traces.instruments[0].push_back(sample);
  }
  return traces;
}

TEST(ForcePlot, HasTheForceOfEachSampleOverTheWayOfItsTip) {
  SceneDefinition scene;
  scene.instruments.emplace_back().name = "left";
  const std::string plot = force_plot(scene, pulled(1.0));
  // From no way and no force to the corner of 20 mm and 2 N, half of each between.
  EXPECT_THAT(plot, HasSubstr(R"(points="60.0,310.0 340.0,175.0 620.0,40.0 ")"));
  EXPECT_THAT(plot, HasSubstr(">left<"));
  EXPECT_THAT(plot, HasSubstr("way of the tip, mm"));
}

TEST(ForcePlot, IsLeftOutWhereNothingWasTouched) {
  SceneDefinition scene;
  scene.instruments.emplace_back().name = "left";
  EXPECT_EQ(force_plot(scene, pulled(0.0)), "");
  EXPECT_EQ(force_plot(scene, {}), "");
}

}  // namespace
}  // namespace calot
