#include "base/status.h"

#include <gtest/gtest.h>

#include <memory>

namespace calot {
namespace {

TEST(Status, TextNamesFileLineFieldMessageAndHint) {
  const Problem problem{{"a.lua", 12, "scene.solver.rate"}, "0 is not a step rate", "give 1 to 2000"};
  EXPECT_EQ(to_text(problem), "a.lua:12: scene.solver.rate: 0 is not a step rate (give 1 to 2000)");
}

TEST(Status, TextLeavesOutWhatIsNotKnown) {
  EXPECT_EQ(to_text(Problem{{}, "no", ""}), "no");
  EXPECT_EQ(to_text(Problem{{"a.lua", 0, ""}, "no", ""}), "a.lua: no");
  EXPECT_EQ(to_text(Problem{{"", 5, ""}, "no", ""}), "no");
  EXPECT_EQ(to_text(Problem{{"", 0, "scene"}, "no", "yes"}), "scene: no (yes)");
}

TEST(Status, TextOfAFailureIsOneLineAProblemInOrder) {
  Failure failure = fail(FailureKind::scenario, "first", "do this");
  failure.problems.push_back({{}, "second", ""});
  EXPECT_EQ(to_text(failure), "first (do this)\nsecond");
  EXPECT_EQ(to_text(Failure{}), "");
}

TEST(Status, FailKeepsKindPlaceMessageAndHint) {
  const Failure failure = fail(FailureKind::simulation, "stuck", "slow down", {"b.lua", 3, "demo"});
  EXPECT_EQ(failure.kind, FailureKind::simulation);
  ASSERT_EQ(failure.problems.size(), 1u);
  EXPECT_EQ(failure.problems[0].message, "stuck");
  EXPECT_EQ(failure.problems[0].hint, "slow down");
  EXPECT_EQ(failure.problems[0].place.line, 3);
}

TEST(Status, AResultIsItsValueOrItsFailure) {
  Result<int> good = 7;
  ASSERT_TRUE(good);
  good.value() += 1;
  EXPECT_EQ(std::as_const(good).value(), 8);
  const Result<int> bad = fail(FailureKind::usage, "no");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.failure().kind, FailureKind::usage);
}

TEST(Status, AResultHandsOverWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(5);
  ASSERT_TRUE(made);
  EXPECT_EQ(**made.operator->(), 5);
  const std::unique_ptr<int> taken = std::move(made).value();
  EXPECT_EQ(*taken, 5);
}

TEST(StatusDeathTest, TakingTheValueOfAFailureEndsTheProcess) {
  const Result<int> bad = fail(FailureKind::internal, "no");
  EXPECT_DEATH(static_cast<void>(bad.value()), "");
}

}  // namespace
}  // namespace calot
