#include "session/progress.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

TEST(Progress, BeginningAStepEndsTheOneBeforeAsDone) {
  Progress progress;
  EXPECT_EQ(progress.running(), nullptr);
  progress.begin_step(0, "grasp", "Grasp", {30});
  progress.begin_step(4, "hold", "Hold", {0});
  ASSERT_EQ(progress.steps().size(), 2u);
  EXPECT_EQ(progress.steps()[0].outcome, "done");
  EXPECT_EQ(progress.steps()[0].ended, 4);
  ASSERT_NE(progress.running(), nullptr);
  EXPECT_EQ(progress.running()->name, "hold");
}

TEST(Progress, AnEndedStepRaisesItsEventWithNameAndDuration) {
  Progress progress;
  progress.begin_step(1, "grasp", "", {2});
  progress.end_step(3.5, "timeout");
  progress.begin_step(3.5, "hold", "", {0});
  progress.end_step(5, "aborted");
  ASSERT_EQ(progress.events().size(), 1u);  // an aborted step was neither done nor too late
  EXPECT_EQ(progress.events()[0].kind, EventKind::step_timeout);
  EXPECT_EQ(progress.events()[0].step, "grasp");
  EXPECT_EQ(progress.events()[0].time, 3.5);
  EXPECT_EQ(progress.events()[0].value, 2.5);
}

TEST(Progress, EndingWithoutARunningStepChangesNothing) {
  Progress progress;
  progress.end_step(1, "done");
  EXPECT_TRUE(progress.steps().empty());
  progress.begin_step(1, "a", "", {0});
  progress.end_step(2, "done");
  progress.end_step(3, "timeout");
  EXPECT_EQ(progress.steps()[0].outcome, "done");
  EXPECT_EQ(progress.events().size(), 1u);
}

TEST(Progress, AnEventCarriesTheStepItFellInto) {
  Progress progress;
  WorldEvent event;
  event.kind = EventKind::contact;
  progress.add_event(event);
  progress.begin_step(0, "grasp", "", {0});
  progress.add_event(event);
  EXPECT_EQ(progress.events()[0].step, "");
  EXPECT_EQ(progress.events()[1].step, "grasp");
}

}  // namespace
}  // namespace calot
