// Sessions that somebody operates, on a clock that only these tests move.

#include "session/live.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <thread>

#include "input/live_lines.h"
#include "session/runner.h"
#include "session/session_for_tests.h"
#include "support/text_files.h"

namespace calot {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double steps_a_second = 50;  // Hz, of the small scene

/// Time passes while somebody sleeps on it; what is to happen at a time then happens.
class FakeClock : public LiveClock {
 public:
  double now() const override { return now_; }
  void sleep(double duration) override { pass(duration); }
  void pass(double duration) {
    now_ += duration;
    while (!plan_.empty() && plan_.begin()->first <= now_) {
      const std::function<void()> happens = plan_.begin()->second;
      plan_.erase(plan_.begin());
      happens();
    }
  }
  void at(double time, std::function<void()> happens) { plan_.emplace(time, std::move(happens)); }

 private:
  double now_ = 0;
  std::multimap<double, std::function<void()>> plan_;
};

/// A world, and all that a live session of it needs.
struct Rig {
  FakeClock clock;
  LiveMailbox mailbox{clock};
  World world = World::create(test::small_scene()).value();
  InstrumentPose rest = world.report().instruments[0].pose;
  LiveOptions options;
  SessionOptions session;
  std::vector<std::string> said;
  std::optional<LiveSource> source;

  Rig() {
    options.begins_at_once = true;
    options.say = [this](const std::string& text) { said.push_back(text); };
    session.end_with_source = true;
  }

  LiveInput input(double insertion_by, std::optional<double> time = std::nullopt) const {
    LiveInput wanted;
    wanted.pose = rest;
    wanted.pose.insertion += insertion_by;
    wanted.time = time;
    return wanted;
  }
  void send_at(double time, LiveEvent event) {
    clock.at(time, [this, event] { mailbox.put(event); });
  }
  SessionResult play(double duration, double step_takes = 0) {
    source.emplace(live_instruments(world.scene()), mailbox, options, clock);
    ExerciseDefinition exercise = test::small_exercise();
    exercise.scene = world.scene();
    test::TimedScript script(duration, exercise);
    const StepObserver watched = session.observer;
    session.observer = [&, watched](const World& present, const Progress& progress, bool last) {
      if (watched) watched(present, progress, last);
      if (present.report().time > 0) clock.pass(step_takes);
    };
    return run_session(world, script, *source, session);
  }
};

std::vector<double> insertions(const SessionResult& result) {
  std::vector<double> all;
  for (const InstrumentSample& sample : result.traces.instruments.at(0)) all.push_back(sample.insertion);
  return all;
}

TEST(Live, InRealTimeEachStepWaitsUntilItIsDue) {
  Rig rig;
  const SessionResult result = rig.play(0.4, 0.005);
  EXPECT_EQ(result.end, SessionEnd::steps_done);
  EXPECT_NEAR(rig.clock.now(), 0.38 + 0.005, 0.0021) << "the last of 20 steps begins at 0.38 s";
  EXPECT_EQ(rig.source->figures().slowed_steps, 0);
  EXPECT_THAT(result.notes, IsEmpty());
}

TEST(Live, WhereStepsTakeLongerThanTheyLastTheClockFallsBehindAndNoneIsLeftOut) {
  Rig rig;
  const SessionResult result = rig.play(0.4, 0.05);
  ASSERT_EQ(result.state_hashes.size(), 21u);
  const LiveFigures figures = rig.source->figures();
  // 19 steps have one before them that was 30 ms too long; what is less than a step behind is not lost yet.
  EXPECT_NEAR(figures.slowed, 19 * 0.03, 0.02 + 1e-9);
  EXPECT_NEAR(figures.longest_step, 0.05, 1e-9);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_THAT(result.notes[0], HasSubstr("too slow for real time"));
}

TEST(Live, AHiccupShorterThanAStepIsMadeUpFor) {
  Rig rig;
  bool hiccup = false;
  rig.session.observer = [&](const World& world, const Progress&, bool) {
    if (world.report().time > 0.1 && !hiccup) rig.clock.pass(0.035);
    hiccup = world.report().time > 0.1;
  };
  rig.play(0.4);
  EXPECT_EQ(rig.source->figures().slowed_steps, 0);
  EXPECT_NEAR(rig.clock.now(), 0.38, 0.0021);
}

TEST(Live, TheNewestInputBeforeAStepIsTheOneThatCounts) {
  Rig rig;
  rig.send_at(0.05, rig.input(1e-3));
  rig.send_at(0.055, rig.input(3e-3));
  rig.send_at(0.065, rig.input(2e-3));
  const std::vector<double> found = insertions(rig.play(0.14));
  const double rest = rig.rest.insertion;
  // Steps begin at 0, 0.02, ...: the one that begins at 0.06 is the fourth.
  EXPECT_THAT(found, ElementsAre(rest, rest, rest, rest, rest + 3e-3, rest + 2e-3, rest + 2e-3, rest + 2e-3));
  const LiveFigures figures = rig.source->figures();
  EXPECT_EQ(figures.inputs, 3);
  EXPECT_NEAR(figures.wait_most, 0.015, 0.0021) << "from 0.065 to 0.08 s";
}

TEST(Live, EveryInputWaitsForTheFirstPictureOfAStateThatFollowsIt) {
  Rig rig;
  rig.options.pictures = std::make_shared<LivePictures>(rig.clock);
  for (const double time : {0.05, 0.055, 0.065}) rig.send_at(time, rig.input(1e-3));
  rig.session.observer = [&](const World& world, const Progress&, bool) {
    // Of the states that follow the inputs, at 0.08 s and 0.1 s, the first one is left out; the later ones have none new.
    const double time = world.report().time;
    if (time < 0.01 || std::abs(time - 0.08) < 1e-9) return;
    rig.options.pictures->note_shown(rig.source->take_unseen());
  };
  rig.play(0.14);
  const LivePictures::Figures seen = rig.source->figures().pictures.value();
  EXPECT_EQ(seen.shown, 6) << "of seven states";
  EXPECT_NEAR(seen.running, 0.12, 0.0041) << "each is there when its step begins: 0 to 0.12 s";
  EXPECT_NEAR(seen.wait_median, 0.025, 0.0021) << "from 0.055 to 0.08 s";
  EXPECT_NEAR(seen.wait_most, 0.03, 0.0021) << "from 0.05 to 0.08 s";
}

TEST(Live, APauseIsNoTimeInWhichPicturesAreShownAndWhatComesInItDoesNotWait) {
  Rig rig;
  rig.options.pictures = std::make_shared<LivePictures>(rig.clock);
  rig.send_at(0.05, LiveCommand::pause);
  rig.send_at(5, rig.input(1e-3));
  rig.send_at(9.05, LiveCommand::resume);
  rig.session.observer = [&](const World& world, const Progress&, bool) {
    if (world.report().time > 0.01)
      rig.options.pictures->note_shown(rig.source->take_unseen(), rig.source->paused());
  };
  rig.play(0.14);
  const LivePictures::Figures seen = rig.source->figures().pictures.value();
  EXPECT_EQ(seen.shown, 7);
  EXPECT_NEAR(seen.running, 0.12, 0.0061) << "and 9 s of pause";
  EXPECT_LT(seen.wait_most, 0.1);
}

TEST(Live, WhereNobodyShowsPicturesNoneAreCounted) {
  Rig rig;
  rig.send_at(0.05, rig.input(1e-3));
  rig.play(0.14);
  EXPECT_THAT(rig.source->take_unseen(), IsEmpty());
  EXPECT_FALSE(rig.source->figures().pictures);
}

TEST(Live, TheClockBeginsWithTheFirstInputUnlessItBeginsAtOnce) {
  Rig rig;
  rig.options.begins_at_once = false;
  rig.send_at(7, rig.input(0));
  rig.play(0.1);
  EXPECT_NEAR(rig.clock.now(), 7.08, 0.0041);
  EXPECT_EQ(rig.source->figures().slowed_steps, 0);
}

TEST(Live, AJumpIsGoneAfterAtAHandsSpeedAndSaid) {
  Rig rig;
  rig.send_at(0.01, rig.input(50e-3));
  const SessionResult result = rig.play(0.2);
  const std::vector<double> found = insertions(result);
  for (std::size_t i = 1; i < found.size(); ++i)
    EXPECT_LE(found[i] - found[i - 1], LiveSource::most_tip_speed / steps_a_second * (1 + 1e-9)) << i;
  EXPECT_EQ(found.back(), rig.rest.insertion + 50e-3) << "it arrives, to the bit";
  EXPECT_EQ(rig.source->figures().following_steps, 2);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_THAT(result.notes[0], HasSubstr("jump"));
}

TEST(Live, WhatAHandDidWhileAStepTookTooLongIsGoneAfterSlowly) {
  Rig rig;
  // The fourth step takes half a second; meanwhile the hand has gone on by 6 mm, outwards: it touches nothing.
  rig.session.observer = [&](const World& world, const Progress&, bool) {
    if (std::abs(world.report().time - 4 / steps_a_second) < 1e-9) rig.clock.pass(0.5);
  };
  rig.send_at(0.3, rig.input(-6e-3));
  rig.send_at(0.75, rig.input(-26e-3));
  const std::vector<double> found = insertions(rig.play(0.4));
  std::vector<double> ways;
  for (std::size_t i = 1; i < found.size(); ++i)
    if (std::abs(found[i] - found[i - 1]) > 1e-12) ways.push_back(found[i - 1] - found[i]);
  const double late = LiveSource::late_tip_speed / steps_a_second,
               usual = LiveSource::most_tip_speed / steps_a_second;
  const auto is = [](double way) { return testing::DoubleNear(way, 1e-12); };
  EXPECT_THAT(ways, ElementsAre(is(late), is(late), is(late), is(usual)))
      << "in time again, it is quick again";
}

TEST(Live, InTissueItIsGoneAfterAsByACarefulHand) {
  Rig rig;
  double inserted = 0, touched_at = 0;
  rig.session.observer = [&](const World& world, const Progress&, bool) {
    if (touched_at > 0) return;
    const bool touches = world.report().instruments[0].touching;
    inserted += touches ? 4e-3 : 1e-3;
    rig.mailbox.put(rig.input(inserted));
    if (!touches) return;
    touched_at = world.report().time;
    rig.clock.pass(0.5);
  };
  const std::vector<double> found = insertions(rig.play(1.6));
  ASSERT_GT(touched_at, 0) << "it never came to the ball";
  const double careful = LiveSource::late_tissue_speed / steps_a_second;
  std::vector<double> ways;
  for (auto i = static_cast<std::size_t>(std::lround(touched_at * steps_a_second)); i + 1 < found.size(); ++i)
    ways.push_back(found[i + 1] - found[i]);
  ASSERT_GE(ways.size(), 3u);
  EXPECT_NEAR(*std::max_element(ways.begin(), ways.end()), careful, 1e-12);
}

TEST(Live, TheLaparoscopeMovesAsAnInstrumentAndItsReplayGoesThroughTheSameStates) {
  Rig rig;
  const test::Folder folder;
  const std::string file = (folder.path() / "recording.jsonl").string();
  Result<RecordingWriter> writer =
      RecordingWriter::create(file, recording_header(test::small_exercise(), rig.world, "small.lua"));
  ASSERT_TRUE(writer);
  rig.session.recording = &writer.value();
  LiveInput input;
  input.instrument = 1;
  input.pose = rig.world.report().laparoscope.pose;
  const InstrumentPose start = input.pose;
  input.pose.insertion += 50e-3;
  rig.send_at(0.05, input);
  const SessionResult result = rig.play(0.2);
  EXPECT_EQ(rig.world.report().laparoscope.pose, input.pose);
  EXPECT_EQ(insertions(result).back(), rig.rest.insertion) << "the instrument stays";
  EXPECT_EQ(rig.source->figures().following_steps, 2) << "a jump is gone after here too";
  const Result<Recording> recording = read_recording(file);
  ASSERT_TRUE(recording) << to_text(recording.failure());
  std::vector<int> moving;
  for (std::size_t i = 0; i < recording->steps.size(); ++i)
    if (recording->steps[i].input.laparoscope) moving.push_back(static_cast<int>(i));
  EXPECT_THAT(moving, ElementsAre(3, 4, 5)) << "it is named where it moves";
  World again = World::create(test::small_scene()).value();
  EXPECT_EQ(again.report().laparoscope.pose, start);
  ReplaySource replay(recording.value());
  test::TimedScript script(0.2);
  EXPECT_EQ(run_session(again, script, replay, {}).state_hashes, result.state_hashes);
  EXPECT_EQ(again.report().laparoscope.pose, input.pose);
}

TEST(Live, WhatIsAskedToComeInComesOnceTheOtherOneIsDrawnBackAndGoesOnFromThere) {
  Rig rig;
  rig.world = World::create(test::shared_port()).value();
  const auto blades = [&](InstrumentAction action, double insertion_by) {
    LiveInput wanted = rig.input(insertion_by);
    wanted.instrument = 1;
    wanted.action = action;
    return wanted;
  };
  rig.send_at(0.3, rig.input(15e-3));                       // 15 mm further in
  rig.send_at(0.5, blades(InstrumentAction::none, 20e-3));  // it waits: nothing moves
  rig.send_at(0.7, blades(InstrumentAction::exchange, 0));  // the other one goes back at 150 mm/s: 0.1 s
  rig.send_at(0.73, rig.input(30e-3));                      // meanwhile it is the assistant's
  rig.send_at(1.2, blades(InstrumentAction::none, 4e-3));
  const SessionResult result = rig.play(1.6);
  ASSERT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_THAT(
      rig.said,
      ElementsAre("blades waits outside, and left is in its port: the action exchange has it come in.",
                  "blades came in for left."));
  const std::vector<InstrumentState>& now = rig.world.report().instruments;
  EXPECT_TRUE(now[0].waits);
  EXPECT_NEAR(now[0].pose.insertion, rig.rest.insertion, 1e-12);
  EXPECT_NEAR(now[1].pose.insertion, rig.rest.insertion + 4e-3, 1e-12);
  // 15 mm in and back, and 4 mm of the other one: no way between two instruments is anyone's. Of a motion that ends as
  // it leaves, what comes after the last point of the 30 Hz grid is not seen: 5 mm at 150 mm/s.
  EXPECT_NEAR(result.metrics.at("left.path_length_mm"), 27.5, 2.6);
  EXPECT_NEAR(result.metrics.at("blades.path_length_mm"), 4, 0.2);
}

TEST(Live, WhilePausedNoStepIsTakenAndNoTimeIsLost) {
  Rig rig;
  rig.send_at(0.05, LiveCommand::pause);
  rig.send_at(3.05, LiveCommand::resume);
  const SessionResult result = rig.play(0.2);
  EXPECT_EQ(result.state_hashes.size(), 11u);
  EXPECT_NEAR(rig.clock.now(), 3.18, 0.0041);
  const LiveFigures figures = rig.source->figures();
  EXPECT_EQ(figures.pauses, 1);
  EXPECT_NEAR(figures.paused, 3, 0.0041);
  EXPECT_EQ(figures.slowed_steps, 0);
  EXPECT_THAT(rig.said, ElementsAre("Paused.", "Going on."));
}

TEST(Live, AnExamIsNeitherPausedNorBegunAgain) {
  Rig rig;
  rig.options.mode = LiveMode::exam;
  rig.send_at(0.05, LiveCommand::pause);
  rig.send_at(0.06, LiveCommand::restart);
  const SessionResult result = rig.play(0.2);
  EXPECT_EQ(result.end, SessionEnd::steps_done);
  EXPECT_NEAR(rig.clock.now(), 0.18, 0.0021);
  ASSERT_EQ(rig.said.size(), 2u);
  EXPECT_THAT(rig.said[0], HasSubstr("an exam knows no pause"));
  EXPECT_EQ(rig.source->figures().refused, 2);
}

TEST(Live, AnExamThatEndsBeforeAnythingHasComeNeverBeganAndHasNoScore) {
  for (const LiveEvent& event : {LiveEvent(LiveCommand::end), LiveEvent(LiveCommand::abandon),
                                 LiveEvent(LiveLoss{"a pipe has ended"})}) {
    Rig rig;
    rig.options.mode = LiveMode::exam;
    rig.options.begins_at_once = false;
    rig.send_at(0.1, event);
    const SessionResult result = rig.play(5);
    EXPECT_EQ(result.end, SessionEnd::interrupted);
    EXPECT_EQ(result.traces.time.back(), 0);
    EXPECT_THAT(result.notes[0], HasSubstr("ended before it began"));
  }
}

TEST(Live, GivenUpPracticeIsInterruptedAndAGivenUpExamIsScoredAsItStands) {
  for (const LiveMode mode : {LiveMode::practice, LiveMode::exam}) {
    for (const LiveEvent& event :
         {LiveEvent(LiveCommand::abandon), LiveEvent(LiveLoss{"a pipe has ended"})}) {
      Rig rig;
      rig.options.mode = mode;
      rig.send_at(0.1, event);
      const SessionResult result = rig.play(5);
      EXPECT_EQ(result.end, mode == LiveMode::exam ? SessionEnd::source_ended : SessionEnd::interrupted);
      EXPECT_NEAR(result.traces.time.back(), 0.1, 0.021);
      EXPECT_EQ(result.notes.size(), 1u) << "how it ended";
    }
  }
  Rig rig;
  rig.send_at(0.1, LiveCommand::end);
  EXPECT_EQ(rig.play(5).end, SessionEnd::source_ended);
  Rig again;
  again.send_at(0.1, LiveCommand::restart);
  EXPECT_EQ(again.play(5).end, SessionEnd::interrupted);
  EXPECT_TRUE(again.source->wants_restart());
}

TEST(Live, PracticeWaitsForASourceThatMayComeBackAndEndsWhereItDoesNot) {
  Rig rig;
  rig.send_at(0.1, LiveLoss{"it was unplugged", true});
  rig.send_at(2.1, rig.input(1e-3));
  EXPECT_EQ(rig.play(0.3).end, SessionEnd::steps_done);
  EXPECT_NEAR(rig.source->figures().paused, 2, 0.0041);
  Rig gone;
  gone.send_at(0.1, LiveLoss{"it was unplugged", true});
  EXPECT_EQ(gone.play(5).end, SessionEnd::interrupted);
  EXPECT_EQ(gone.source->figures().ended_by, "lost");
  EXPECT_NEAR(gone.clock.now(), 0.1 + gone.options.return_within, 0.03);
}

TEST(Live, SilenceIsSaidOnceAndTheInstrumentsStayWhereTheyAre) {
  Rig rig;
  rig.options.watch_silence = true;
  rig.send_at(0.05, rig.input(1e-3));
  const SessionResult result = rig.play(8);
  EXPECT_EQ(result.end, SessionEnd::steps_done);
  EXPECT_EQ(insertions(result).back(), rig.rest.insertion + 1e-3);
  ASSERT_EQ(rig.said.size(), 1u);
  EXPECT_THAT(rig.said[0], HasSubstr("Nothing has come for 5 s"));
}

TEST(Live, ByTheirStampsInputsCountInTheSameStepHoweverTheyCome) {
  std::vector<std::vector<std::uint64_t>> hashes;
  for (const double later : {0.0, 0.3}) {
    Rig rig;
    rig.options.stamped = true;
    double when = 0;
    for (int i = 0; i <= 30; ++i) rig.send_at(when += later, rig.input(1e-3 * i, 0.013 * i));
    rig.send_at(when, LiveCommand::end);
    rig.clock.pass(1e-6);
    const SessionResult result = rig.play(5);
    EXPECT_EQ(result.end, SessionEnd::source_ended);
    EXPECT_NEAR(result.traces.time.back(), 0.4, 1e-9) << "the last is of 0.39 s: a step ends at 0.4";
    EXPECT_EQ(insertions(result)[1], rig.rest.insertion + 1e-3) << "0.013 s is within the first step";
    hashes.push_back(result.state_hashes);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

std::vector<std::string> acts_of(const SessionResult& result) {
  std::vector<std::string> acts;
  for (const SessionEvent& event : result.progress.events())
    if (is_session_act(to_text(event.kind)))
      acts.push_back(fmt::format("{} {:.2f} {}", to_text(event.kind), event.time, event.text));
  return acts;
}

TEST(Live, ActsCountOnceInTheStepAfterThemAndABailOutEndsTheOperation) {
  Rig rig;
  rig.send_at(0.05, SessionAct{EventKind::time_out, "landmarks named"});
  rig.send_at(0.09, SessionAct{EventKind::bail_out, "convert"});
  const SessionResult result = rig.play(1);
  EXPECT_EQ(result.end, SessionEnd::bailed_out);
  EXPECT_THAT(acts_of(result), ElementsAre("time_out 0.08 landmarks named", "bail_out 0.12 convert"));
}

TEST(Live, AnActBeginsTheClockAndIsRefusedWhileItStands) {
  Rig rig;
  rig.options.begins_at_once = false;
  rig.send_at(0.5, SessionAct{EventKind::time_out, ""});
  rig.send_at(0.55, LiveCommand::pause);
  rig.send_at(0.6, SessionAct{EventKind::bail_out, ""});
  rig.send_at(0.7, LiveCommand::resume);
  const SessionResult result = rig.play(0.2);
  EXPECT_EQ(result.end, SessionEnd::steps_done);
  EXPECT_THAT(acts_of(result), ElementsAre("time_out 0.02 "));
  EXPECT_EQ(rig.source->figures().refused, 1);
}

TEST(Live, ByTheirStampsActsCountInTheStepOfTheInputsBeforeThem) {
  const std::string text =
      "pose 0 left 0 0 0.06 0 0\ntime_out  landmarks named \npose 0.05 left 0 0 0.06 0 0\nbail_out\n";
  for (const std::size_t piece : {std::size_t{7}, text.size()}) {
    Rig rig;
    rig.options.stamped = true;
    LiveLines lines(live_instruments(rig.world.scene()), "test");
    std::vector<LiveEvent> events;
    for (std::size_t from = 0; from < text.size(); from += piece) lines.add(text.substr(from, piece), events);
    for (LiveEvent& event : events) rig.mailbox.put(std::move(event));
    const SessionResult result = rig.play(1);
    EXPECT_EQ(result.end, SessionEnd::bailed_out);
    EXPECT_THAT(acts_of(result), ElementsAre("time_out 0.02 landmarks named", "bail_out 0.06 "));
  }
}

TEST(Live, WhatIsSaidAtAnActIsPlainAndShort) {
  LiveLines lines(live_instruments(test::small_scene()), "test");
  std::vector<LiveEvent> events;
  lines.add("time_out " + std::string(201, 'x') + "\ntime_out \xff\ntime_out a\x01\n", events);
  ASSERT_EQ(events.size(), 3u);
  for (const LiveEvent& event : events) EXPECT_TRUE(std::holds_alternative<LiveRefusal>(event));
  EXPECT_FALSE(read_session_act("time-out", ""));
  EXPECT_TRUE(read_session_act("bail_out", std::string(200, 'x')));
}

TEST(Live, AFullMailboxHoldsItsSenderUntilThereIsRoomOrItIsClosed) {
  LiveMailbox mailbox;
  for (std::size_t i = 0; i < LiveMailbox::capacity; ++i) ASSERT_TRUE(mailbox.offer(LiveInput{}));
  EXPECT_FALSE(mailbox.offer(LiveInput{}));
  bool second = true;
  std::thread sender([&] {
    mailbox.put(LiveInput{});
    second = mailbox.put(LiveInput{});
  });
  while (mailbox.times_full() < 1) std::this_thread::yield();
  EXPECT_TRUE(mailbox.take());
  while (mailbox.times_full() < 2) std::this_thread::yield();
  mailbox.close();
  sender.join();
  EXPECT_FALSE(second);
}

// ---- lines

class Lines : public testing::Test {
 protected:
  std::vector<LiveEvent> read(const std::string& text) {
    std::vector<LiveEvent> events;
    lines_.add(text, events);
    return events;
  }
  /// The one refusal of a text of one or more lines.
  std::string refusal(const std::string& text) {
    for (const LiveEvent& event : read(text))
      if (const auto* refused = std::get_if<LiveRefusal>(&event)) return to_text(refused->problem);
    return "nothing was refused";
  }
  LiveLines lines_{live_instruments(test::small_scene()), "here"};
};

TEST_F(Lines, APoseIsAsRecordingsHoldItAndATipIsWhereTheClosedJawsEnd) {
  std::vector<LiveEvent> events = read("pose 0.5 left 0.1 -0.2 0.15 3 0.25\n");
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::get<LiveInput>(events[0]).pose, (InstrumentPose{0.1, -0.2, 0.15, 3, 0.25}));
  EXPECT_EQ(std::get<LiveInput>(events[0]).time, 0.5);
  events = read(" tip  0.6 left -0.08 0.1 -0.06 0.5 1\r\n");
  ASSERT_EQ(events.size(), 1u);
  const LiveInput input = std::get<LiveInput>(events[0]);
  const LiveInstrument left = live_instruments(test::small_scene())[0];
  InstrumentPose closed = input.pose;
  closed.jaw = 0;
  EXPECT_LT((tip_position(left.trocar, closed, left.geometry) - Vec3(-0.08, 0.1, -0.06)).norm(), 1e-12);
  EXPECT_EQ(input.pose.jaw, 1);
}

TEST_F(Lines, CommentsAndEmptyLinesAreNothingAndCommandsAreEvents) {
  const std::vector<LiveEvent> events = read("# a comment\n\n  \npause\nresume\nrestart\nabandon\nend\n");
  ASSERT_EQ(events.size(), 5u);
  EXPECT_EQ(std::get<LiveCommand>(events[4]), LiveCommand::end);
  EXPECT_TRUE(lines_.ended());
}

TEST_F(Lines, WhatCannotBeUsedIsRefusedWithItsLineAndWhy) {
  const std::string good = "pose 1 left 0 0 0.1 0 0\n";
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"pose 1 left 0 0 nan 0 0\n", "insertion is \"nan\""},
      {"pose 1 left 0 0 inf 0 0\n", "insertion is \"inf\""},
      {"pose 1 left 0 0 1e999 0 0\n", "insertion is"},
      {"pose 1 left 0 0 0.1x 0 0\n", "insertion is \"0.1x\""},
      {"pose nan left 0 0 0.1 0 0\n", "time is \"nan\""},
      {"pose -1 left 0 0 0.1 0 0\n", "before 0"},
      {"pose 0.5 left 0 0 0.1 0 0\n", "time 0.5 is before the 1 of line 1"},
      {"pose 1 lefd 0 0 0.1 0 0\n", "did you mean \"left\"?"},
      {"pose 1 left 0 0 0.1 0\n", "write: pose T NAME"},
      {"pose 1 left 0 0 0.1 0 0 none more\n", "write: pose T NAME"},
      {"tip 1 left 0 0\n", "write: tip T NAME"},
      {"pose 1 left 0 0 0.9 0 0\n", "cannot take the pose"},
      {"pose 1 left 0 0 0.1 0 2\n", "cannot take the pose"},
      {"pose 1 left 0 0 0.1 0 0 activat\n", "did you mean \"activate\"?"},
      {"pose 1 left 0 0 0.1 0 0 activate\n", "cannot activate"},
      {"pausee\n", "did you mean \"pause\"?"},
      {"pause now\n", "stands alone"},
      {std::string("\x01\xff\0pose", 7) + "\n", "begins no line"},
      {std::string(5000, 'x') + "\n", "more than 1000 bytes"}};
  for (const auto& [line, why] : wrong) {
    LiveLines fresh(live_instruments(test::small_scene()), "here");
    lines_ = fresh;
    const std::string found = refusal(good + line);
    EXPECT_THAT(found, HasSubstr(why));
    EXPECT_THAT(found, HasSubstr("here:2: ")) << "the line's number";
    for (const char c : found) EXPECT_TRUE(c >= ' ' && c <= '~') << "a control byte reaches the terminal";
    EXPECT_EQ(read(good).size(), 1u) << "what follows is read: " << line;
  }
}

TEST_F(Lines, ALineCutShortIsNotTakenForAWholeOne) {
  std::vector<LiveEvent> events = read("pose 0 left 0 0 0.1 0 0\npose 1 left 0 0 0.1 0 0.5");
  ASSERT_EQ(events.size(), 1u);
  lines_.finish(events);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_THAT(to_text(std::get<LiveRefusal>(events[1]).problem), HasSubstr("has no end"));
}

TEST_F(Lines, AfterARestartTimeBeginsAnew) {
  EXPECT_EQ(refusal("pose 5 left 0 0 0.1 0 0\nrestart\npose 0 left 0 0 0.1 0 0\n"), "nothing was refused");
}

TEST_F(Lines, BytesInAnyPortionsAreTheSameLines) {
  const std::string text = "pose 0 left 0 0 0.1 0 0\nnonsense\n" + std::string(2000, ' ') + "\npause\n";
  const std::size_t whole = read(text).size();
  ASSERT_EQ(whole, 4u);
  LiveLines apart(live_instruments(test::small_scene()), "here");
  std::vector<LiveEvent> events;
  for (const char c : text) apart.add({&c, 1}, events);
  EXPECT_EQ(events.size(), whole);
}

}  // namespace
}  // namespace calot
