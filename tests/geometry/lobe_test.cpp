#include "geometry/lobe.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

TEST(Lobe, ItsEndsAreRoundAndItsMiddleIsNot) {
  const LobeForm form;
  const auto depth = [&](double across) {
    return lobe_place(form, {across, 1, 0.5}).z() - lobe_place(form, {across, 0, 0.5}).z();
  };
  const auto thickness = [&](double across) {
    return lobe_place(form, {across, 0.5, 1}).x() - lobe_place(form, {across, 0.5, 0}).x();
  };
  // Its lengths where it is not rounded: to a hundredth at three quarters of the way to an end.
  EXPECT_NEAR(depth(0.5), form.depth, 1e-12);
  EXPECT_GT(thickness(0.8), 0.9 * thickness(0.5));
  for (double end : {0.0, 1.0}) {
    EXPECT_LT(depth(end), 0.6 * depth(0.5));
    EXPECT_LT(thickness(end), 0.6 * thickness(0.5));
    EXPECT_NEAR(lobe_place(form, {end, 0.5, 0.5}).y(), (end - 0.5) * form.width, 1e-12);
  }
}

}  // namespace
}  // namespace calot
