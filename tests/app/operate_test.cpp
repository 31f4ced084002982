// Operating an exercise by lines of text, from the outside.

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <nlohmann/json.hpp>

#include "app/program.h"
#include "geometry/types.h"
#include "support/long_run.h"
#include "support/paths.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

/// `seconds` of lines at 100 Hz that move the small scenario's instrument in, then `last`.
std::string moving_lines(double seconds, const std::string& last = "end\n") {
  std::string text = "# moves in\n";
  for (int i = 0; i <= 100 * seconds; ++i)
    text += fmt::format("tip {:.2f} left {} 0.06 -0.03 0 0.3\n", 0.01 * i, -0.08 + 1e-4 * i);
  return text + last;
}

/// A connection to the program's socket, once there is one; -1 after some 30 s.
int connect_to(const fs::path& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  for (int i = 0; i < 3000; ++i) {
    const int file = socket(AF_UNIX, SOCK_STREAM, 0);
    if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return file;
    close(file);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return -1;
}

void send_text(int file, const std::string& text) {
  EXPECT_EQ(send(file, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
}

class Operate : public ProgramTest {
 protected:
  Json report(const std::string& folder) { return Json::parse(slurp(folder_ / folder / "report.json")); }
  Json header(const std::string& folder) {
    const std::string text = slurp(folder_ / folder / "recording.jsonl");
    return Json::parse(text.substr(0, text.find('\n')));
  }
  Outcome operate(const std::string& lines, std::vector<std::string> more = {}) {
    spill(folder_ / "lines.txt", lines);
    std::vector<std::string> words = {"operate",   "small.lua", "--no-window", "--input",
                                      "lines.txt", "--stamped", "-o",          "here"};
    words.insert(words.end(), more.begin(), more.end());
    return calot(words);
  }
};

TEST_F(Operate, ASessionByTimeStampsIsScoredAndItsReplayGoesThroughTheSameStates) {
  const Outcome outcome = operate(moving_lines(2));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Score"), std::string::npos);
  EXPECT_NE(outcome.err.find("Move about"), std::string::npos) << "what is asked: " << outcome.err;
  const Json json = report("here");
  EXPECT_EQ(json["end"], "done") << "the steps end before the lines do";
  EXPECT_EQ(json["operated"]["mode"], "practice");
  EXPECT_EQ(json["operated"]["refused_inputs"], 0);
  EXPECT_GT(json["metrics"]["left.path_length_mm"], 5);
  EXPECT_EQ(header("here")["mode"], "practice");
  const Outcome replay = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_NE(replay.out.find("Every state is that of the recording."), std::string::npos);
}

TEST_F(Operate, TheLaparoscopeIsAnInstrumentOfTheLinesAndIsReplayed) {
  std::string lines = moving_lines(0.3);
  lines.insert(lines.find("tip 0.10"), "tip 0.09 laparoscope -0.05 0.02 -0.03 0.4 0\n");
  lines.insert(lines.find("tip 0.20"), "tip 0.19 laparoscope -0.05 0.02 -9 0 0\n");
  const Outcome outcome = operate(lines);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("laparoscope' cannot take the pose"), std::string::npos) << outcome.err;
  EXPECT_NE(slurp(folder_ / "here/recording.jsonl").find("\"laparoscope\":["), std::string::npos);
  const Outcome replay = calot({"replay", "here/recording.jsonl"});
  EXPECT_NE(replay.out.find("Every state is that of the recording."), std::string::npos) << replay.err;
}

/// From one place to another, mm, in so many seconds; the jaws from one opening to another, rad.
struct Reach {
  Vec3 to;
  double seconds, jaw;
};

/// Lines at 50 Hz of a hand that goes from reach to reach on straight lines, from some time on, which moves on with it.
std::string lines_of(const std::string& hand, Vec3 at, double jaw, const std::vector<Reach>& way,
                     double& time) {
  std::string text;
  for (const Reach& reach : way) {
    const int lines = static_cast<int>(50 * reach.seconds);
    for (int i = 1; i <= lines; ++i) {
      const double share = static_cast<double>(i) / lines;
      const Vec3 tip = 1e-3 * (at + share * (reach.to - at));
      text += fmt::format("tip {:.2f} {} {} {} {} 0 {}\n", time + 0.02 * i, hand, tip.x(), tip.y(), tip.z(),
                          jaw + share * (reach.jaw - jaw));
    }
    time += reach.seconds;
    at = reach.to;
    jaw = reach.jaw;
  }
  return text;
}

TEST_F(Operate, AnExpertsHandExposesTheTriangleThroughASocketAndPasses) {
  if (!long_run()) GTEST_SKIP() << "left to scripts/test --long: half a minute";
  // The fundus is pressed on with open jaws, taken, and pushed up over the liver; then the pouch is taken and drawn to
  // the patient's right and down.
  double time = 0;
  std::string lines = lines_of("fundus", {-122.3, 28.8, -40.2}, 1.04,
                               {{{-98, 121, -47.6}, 1.8, 1.04},
                                {{-84, 134.9, -65.2}, 0.7, 1.04},
                                {{-84, 134.9, -65.2}, 0.5, 0},
                                {{-93, 152, -45.3}, 1.5, 0}},
                               time);
  lines += lines_of("left", {-69.3, 82.2, -30.2}, 1.04,
                    {{{-54, 107.4, -67.6}, 1.2, 1.04},
                     {{-56.2, 123.8, -89.4}, 0.7, 1.04},
                     {{-56.2, 123.8, -89.4}, 0.5, 0},
                     {{-74.1, 112.8, -82.4}, 1.6, 0},
                     {{-74.1, 112.8, -82.4}, 5.4, 0}},
                    time) +
           "end\n";
  const Outcome outcome = calot({"operate", source_dir() + "/scenarios/exposure.lua", "--no-window",
                                 "--input", "unix:s", "--stamped", "-o", "here"},
                                [&](pid_t) {
                                  const int file = connect_to(folder_ / "s");
                                  send_text(file, lines);
                                  close(file);
                                });
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json json = report("here");
  EXPECT_TRUE(json["score"]["passed"].get<bool>()) << json["score"].dump(2);
  EXPECT_GT(json["metrics"]["note.triangle_seen_mm2"], 110) << "the demo's expert: 118";
}

TEST_F(Operate, AnExamThatIsGivenUpIsScoredAndOneOfPracticeIsNot) {
  Outcome outcome = operate(moving_lines(0.2, "abandon\n"), {"--exam"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(report("here")["end"], "source_ended");
  EXPECT_TRUE(report("here")["score"]["total"].is_number());
  EXPECT_FALSE(report("here")["score"]["passed"]);
  EXPECT_EQ(header("here")["mode"], "exam");
  outcome = operate(moving_lines(0.2, ""));
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("lines.txt has ended without saying `end`"), std::string::npos) << outcome.err;
  EXPECT_TRUE(report("here")["score"]["total"].is_null());
  EXPECT_EQ(report("here")["operated"]["ended_by"], "lost");
  expect_next_command(outcome);
}

TEST_F(Operate, HintsAreForPracticeOnly) {
  spill(folder_ / "small.lua",
        small_scenario("t:step('move', 'Move about', { hint = 'Hold it like a pen' }); t:wait(0.04 * s)"));
  EXPECT_NE(operate(moving_lines(0.1)).err.find("like a pen"), std::string::npos);
  const Outcome exam = operate(moving_lines(0.1), {"--exam"});
  EXPECT_EQ(exam.code, 0) << exam.err;
  EXPECT_EQ(exam.err.find("like a pen"), std::string::npos);
}

TEST_F(Operate, BrokenLinesAreNamedAndChangeNothing) {
  const std::string good = moving_lines(0.3);
  ASSERT_EQ(operate(good).code, 0);
  const Json before = report("here");
  std::string bad = good;
  bad.insert(bad.find("tip 0.10"),
             "tip 0.09 left nan 0 0 0 0\nhello\ntip 0.09 right 0 0 0 0 0\npose 0.09 left 1 2 3 4 5\n");
  const Outcome outcome = operate(bad);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* said :
       {"lines.txt:12: x is \"nan\"", "lines.txt:13: \"hello\"", "lines.txt:14: there is no instrument",
        "lines.txt:15: instrument 'left' cannot take the pose"})
    EXPECT_NE(outcome.err.find(said), std::string::npos) << said << "\n" << outcome.err;
  EXPECT_EQ(report("here")["operated"]["refused_inputs"], 4);
  EXPECT_EQ(report("here")["state_hash"], before["state_hash"]);
}

TEST_F(Operate, ARestartKeepsTheAttemptBefore) {
  const Outcome outcome = operate(moving_lines(0.1, "restart\n") + moving_lines(0.2));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(report("here")["operated"]["ended_by"], "restart");
  EXPECT_EQ(report("here-2")["end"], "source_ended");
  EXPECT_NEAR(report("here-2")["timing"]["simulated_s"], 0.2, 1e-9);
}

TEST_F(Operate, WhatCannotBeReadIsAUsageError) {
  spill(folder_ / "file.txt", "");
  for (const std::string input : {"none.txt", ".", "unix:", "unix:none/socket", "unix:file.txt"}) {
    const Outcome outcome = calot({"operate", "small.lua", "--no-window", "--input", input});
    EXPECT_EQ(outcome.code, 4) << input << "\n" << outcome.err;
    expect_next_command(outcome);
  }
  const Outcome file = calot({"operate", "small.lua", "--no-window", "--input", "file.txt"});
  EXPECT_EQ(file.code, 4);
  EXPECT_NE(file.err.find("--stamped"), std::string::npos) << file.err;
  EXPECT_EQ(calot({"operate", "small.lua", "--exam", "--practice"}).code, 4);
}

TEST_F(Operate, AnExerciseWithoutInstrumentsIsRefused) {
  std::string text = small_scenario("t:step('wait', 'Wait'); t:wait(0.1 * s)", "t:wait(0.1 * s)");
  const auto replace = [&](const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
  };
  replace("{ left = { port = \"right_subcostal\" } }", "{}");
  replace("left.path_length_mm", "total.time_s");
  spill(folder_ / "small.lua", text);
  const Outcome outcome = operate(moving_lines(0.1));
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("no instrument"), std::string::npos) << outcome.err;
}

TEST_F(Operate, ASocketMovesItInRealTimeAndASecondSenderGoesOnWhereTheFirstWasLost) {
  const Outcome outcome =
      calot({"operate", "small.lua", "--no-window", "--input", "unix:s", "-o", "here"}, [&](pid_t) {
        const int first = connect_to(folder_ / "s");
        ASSERT_GE(first, 0);
        send_text(first, "tip 0 left -0.08 0.06 -0.03 0 0\n");
        ASSERT_TRUE(wait_for_lines(folder_ / "here/recording.jsonl", 5));
        close(first);
        const int second = connect_to(folder_ / "s");
        send_text(second, "tip 0 left -0.08 0.06 -0.035 0 0\n");
        ASSERT_TRUE(wait_for_lines(folder_ / "here/recording.jsonl", 33));
        close(second);
      });
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json json = report("here");
  EXPECT_EQ(json["end"], "done");
  EXPECT_EQ(json["operated"]["inputs"], 2);
  EXPECT_GE(json["timing"]["wall_s"], 0.56) << "30 steps at 50 Hz";
  EXPECT_FALSE(fs::exists(folder_ / "s")) << "the socket is taken away";
  EXPECT_EQ(calot({"replay", "here/recording.jsonl"}).code, 0);
}

TEST_F(Operate, WhoConnectsAndSaysNothingNeitherBeginsNorEndsAnExam) {
  const Outcome outcome = calot({"operate", "small.lua", "--no-window", "--exam", "--trainee", "T-07",
                                 "--input", "unix:s", "-o", "here"},
                                [&](pid_t) {
                                  close(connect_to(folder_ / "s"));  // as a port scan does
                                  const int odd = connect_to(folder_ / "s");
                                  send_text(odd, "GET / HTTP/1.1\n");
                                  close(odd);
                                  const int tracker = connect_to(folder_ / "s");
                                  ASSERT_GE(tracker, 0);
                                  send_text(tracker, "tip 0 left -0.08 0.06 -0.03 0 0\n");
                                  ASSERT_TRUE(wait_for_lines(folder_ / "here/recording.jsonl", 5));
                                  send_text(tracker, "end\n");
                                  close(tracker);
                                });
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json json = report("here");
  EXPECT_EQ(json["operated"]["inputs"], 1) << outcome.err;
  EXPECT_EQ(json["operated"]["ended_by"], "end");
  EXPECT_EQ(json["attempt"]["trainee"], "T-07");
  EXPECT_EQ(json["attempt"]["mode"], "exam");
  EXPECT_EQ(json["attempt"]["source"], "lines");
  EXPECT_EQ(json["attempt"]["attempt"], 1);
  EXPECT_NE(outcome.err.find("sent nothing that can be used"), std::string::npos) << outcome.err;
}

TEST_F(Operate, AnExamThatNeverBeganHasNoScore) {
  const Outcome outcome = operate("end\n", {"--exam"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_TRUE(report("here")["score"]["total"].is_null());
  EXPECT_EQ(calot({"score", "small.lua", "here"}).code, 4) << "nor later";
}

TEST_F(Operate, APersonsNameIsNoPseudonym) {
  const Outcome outcome = calot({"operate", "small.lua", "--no-window", "--trainee", "Anna Muster"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("\"Anna Muster\" is no pseudonym"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--names FILE"), std::string::npos) << outcome.err;
}

TEST_F(Operate, AKilledSessionLosesNothingThatWasRecorded) {
  spill(folder_ / "small.lua", endless_scenario());
  const fs::path recording = folder_ / "here" / "recording.jsonl";
  spill(folder_ / "lines.txt", moving_lines(3) + "tip 3600 left -0.08 0.06 -0.03 0 0\n");
  const Outcome outcome =
      calot({"operate", "small.lua", "--no-window", "--input", "lines.txt", "--stamped", "-o", "here"},
            [&](pid_t pid) {
              EXPECT_TRUE(wait_for_lines(recording, 20));
              kill(pid, SIGKILL);
            });
  EXPECT_EQ(outcome.code, 128 + SIGKILL);
  const Outcome replay = calot({"replay", "here/recording.jsonl"});
  EXPECT_EQ(replay.code, 1) << "cut, and played as far as it goes: " << replay.err;
  EXPECT_NE(replay.err.find("it was cut"), std::string::npos) << replay.err;
}

TEST_F(Operate, AFloodWithoutEndKeepsNoStepFromItsTurn) {
  spill(folder_ / "small.lua", endless_scenario());
  std::atomic<bool> enough{false};
  std::thread sender([&] {
    const int file = connect_to(folder_ / "s");
    std::string flood;
    for (int i = 0; i < 1000; ++i) flood += "tip 0 left -0.08 0.06 -0.03 0 0\n";
    while (!enough && send(file, flood.data(), flood.size(), MSG_NOSIGNAL) > 0) {
    }
    close(file);
  });
  const Outcome outcome =
      calot({"operate", "small.lua", "--no-window", "--input", "unix:s", "-o", "here"}, [&](pid_t pid) {
        EXPECT_TRUE(wait_for_lines(folder_ / "here/recording.jsonl", 10));
        kill(pid, SIGINT);
      });
  enough = true;
  sender.join();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_GT(report("here")["operated"]["inputs"], 10000) << "this was no flood";
}

}  // namespace
}  // namespace calot::test
