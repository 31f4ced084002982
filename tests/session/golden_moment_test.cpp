#include "session/golden_moment.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

/// Grasps of the gallbladder at 1, 4 and 6 s, of the duct at 5 s; the second step begins at 3 s.
Progress two_steps() {
  Progress progress;
  const auto grasp = [&](double time, const std::string& organ) {
    WorldEvent event;
    event.kind = EventKind::grasp;
    event.time = time;
    event.organ = organ;
    progress.add_event(event);
  };
  progress.begin_step(0, "lift", "Lift");
  grasp(1, "gallbladder");
  progress.begin_step(3, "expose", "Expose");
  grasp(4, "gallbladder");
  grasp(5, "cystic_duct.patient");
  grasp(6, "gallbladder");
  return progress;
}

GoldenMoment grasp_of(const std::string& organ) {
  GoldenMoment moment;
  moment.event = "grasp";
  moment.organ = organ;
  return moment;
}

TEST(GoldenMoment, OfAStepIsDueSoLongAfterItsBeginning) {
  GoldenMoment moment;
  moment.step = "expose";
  EXPECT_EQ(due_time(moment, two_steps()), 3);
  moment.delay = 0.5;
  EXPECT_EQ(due_time(moment, two_steps()), 3.5);
  moment.step = "clip";
  EXPECT_EQ(due_time(moment, two_steps()), std::nullopt);
}

TEST(GoldenMoment, OfAnEventIsDueAfterTheOneThatIsCountedOfItsOrganAndItsPieces) {
  EXPECT_EQ(due_time(grasp_of(""), two_steps()), 1);
  EXPECT_EQ(due_time(grasp_of("cystic_duct"), two_steps()), 5);
  GoldenMoment moment = grasp_of("gallbladder");
  moment.delay = 0.25;
  const double times[] = {1, 4, 6};
  for (double time : times) {
    EXPECT_EQ(due_time(moment, two_steps()), time + 0.25);
    ++moment.count;
  }
  EXPECT_EQ(due_time(moment, two_steps()), std::nullopt) << "there is no fourth";
}

TEST(GoldenMoment, OfAnEventInAStepDoesNotCountThoseOfOtherSteps) {
  GoldenMoment moment = grasp_of("gallbladder");
  moment.step = "expose";
  EXPECT_EQ(due_time(moment, two_steps()), 4);
  moment.step = "lift";
  EXPECT_EQ(due_time(moment, two_steps()), 1);
  moment.event = "release";
  EXPECT_EQ(due_time(moment, two_steps()), std::nullopt);
}

}  // namespace
}  // namespace calot
