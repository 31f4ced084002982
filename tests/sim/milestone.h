#pragma once
// A world on its way that goes back to where it was.

#include <gtest/gtest.h>

#include "field/field_state.h"
#include "rig.h"

namespace calot::test {

/// Where a world and its driver are now, to go on from there again.
class Milestone {
 public:
  explicit Milestone(FundusPath& path) : path_(path), driver_(path.driver), state_(path.world.state()) {}

  const FieldState& state() const { return state_; }
  void go_back() const {
    ASSERT_TRUE(path_.world.restore(state_));
    path_.driver.follow(driver_);
  }

 private:
  FundusPath& path_;
  Driver driver_;
  FieldState state_;
};

/// The law of steps that are refused: with the skin touched, `refused_steps` change nothing, and the world goes on as
/// if it had not been asked for them.
inline void expect_refused_without_a_trace(FundusPath& path, const std::function<void()>& refused_steps) {
  ASSERT_TRUE(path.driver.go(path.fundus + 5e-3 * path.out, 0, 1)) << path.driver.why();
  ASSERT_TRUE(path.driver.go(path.fundus - 1e-3 * path.out, 0, 1)) << path.driver.why();
  ASSERT_TRUE(path.world.report().instruments[0].touching);
  const Milestone touched(path);
  const std::uint64_t hash = path.world.state_hash();
  const auto goes_on = [&] {
    EXPECT_TRUE(path.driver.go(path.fundus - 2e-3 * path.out, 0, 1)) << path.driver.why();
    return path.world.state_hash();
  };
  const std::uint64_t spared = goes_on();
  touched.go_back();
  refused_steps();
  EXPECT_EQ(path.world.state_hash(), hash);
  EXPECT_EQ(path.world.report().time, touched.state().report.time);
  EXPECT_EQ(goes_on(), spared);
}

}  // namespace calot::test
