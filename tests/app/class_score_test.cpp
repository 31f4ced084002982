// calot score: a class of recordings, what they hold, what is cut, other benchmarks, results that are kept.

#include <fmt/format.h>

#include "app/program.h"
#include "base/hash.h"
#include "session/json.h"

namespace calot::test {
namespace {

/// The small exercise, a part more, so that a penalty can be given other figures too.
std::string scored_scenario() {
  std::string text = small_scenario("t:step('move', 'Move about'); t:wait(0.2 * s); t:note('seen', 1)");
  const std::string part = "expert = 0 }, weight = 1 },";
  text.replace(
      text.find(part), part.size(),
      "expert = 0 }, weight = 0.5 },\n    { calot.score.penalty { event = 'empty_grasp', each = 0.5 }, "
      "weight = 0.5 },");
  return text;
}

class ScoredClass : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    spill(folder_ / "small.lua", scored_scenario());
    const Outcome played = calot({"run", "small.lua", "--no-render", "-o", "out"});
    ASSERT_EQ(played.code, 0) << played.err;
    text_ = slurp(folder_ / "out" / "recording.jsonl");
  }

  Outcome score(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"score", "small.lua"});
    return calot(arguments);
  }
  /// The entry of one recording with this text.
  Json entry(const std::string& text, std::vector<std::string> options = {}) {
    spill(folder_ / "one.jsonl", text);
    options.insert(options.end(), {"one.jsonl", "--json"});
    outcome_ = score(std::move(options));
    EXPECT_TRUE(Json::accept(outcome_.out)) << outcome_.err;
    return Json::parse(outcome_.out)["recordings"][0];
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return text.replace(text.find(from), from.size(), to);
  }

  std::string text_;  ///< of a whole recording
  Outcome outcome_;
};

TEST_F(ScoredClass, TwoHundredRecordingsScoreTheSameWhateverTheNumberOfProcesses) {
  for (int i = 0; i < 200; ++i) {
    std::string text = of_session(text_, i);
    if (i == 20) text.resize(text.find("\"time_s\":0.1,"));
    if (i == 30) text = replaced(text, "\"time_s\":0.1,", "\"time_s\":7,");
    spill(folder_ / "class" / fmt::format("{:03}.jsonl", i), text);
  }
  const Outcome one = score({"class", "-j", "1", "--json"}), two = score({"class", "-j", "2", "--json"});
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(one.err, two.err);
  EXPECT_EQ(one.code, 4) << "one could not be read";
  EXPECT_NE(one.err.find("class/030.jsonl:6: time_s is 7, not 0.1"), std::string::npos) << one.err;
  EXPECT_NE(one.err.find("class/020.jsonl: it did not come to its end (cut)"), std::string::npos) << one.err;
  expect_next_command(one);
  const Json json = Json::parse(one.out);
  EXPECT_EQ(json["schema"], "calot.scores/3");
  ASSERT_EQ(json["recordings"].size(), 200u);
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_EQ(json["recordings"][i]["file"], fmt::format("class/{:03}.jsonl", i));
  ASSERT_EQ(json["groups"].size(), 1u);
  const Json& group = json["groups"][0];
  EXPECT_EQ(group["mode"], "demo");
  EXPECT_EQ(group["scored"], 199);
  EXPECT_EQ(group["whole"], 198);
  const double total = json["recordings"][0]["score"]["total"];
  EXPECT_NEAR(group["total"]["mean"].get<double>(), total, 1e-9);  // a sum of 198 rounds
  EXPECT_EQ(group["total"]["median"], total);
}

TEST_F(ScoredClass, WhatARecordingHoldsIsWhatItsSimulationMeasures) {
  const Json held = entry(text_), simulated = entry(text_, {"--replay"});
  EXPECT_EQ(held["from"], "recording");
  EXPECT_EQ(simulated["from"], "simulation");
  EXPECT_EQ(simulated["verified"], true) << simulated["differences"];
  for (const char* key : {"score", "metrics", "steps", "end", "whole", "stopped_at_s", "params"})
    EXPECT_EQ(held[key], simulated[key]) << key;
  const Json report = Json::parse(slurp(folder_ / "out" / "report.json"));
  EXPECT_EQ(held["score"], report["score"]);
  EXPECT_EQ(held["metrics"], report["metrics"]);

  const Json lied = entry(sealed(replaced(text_, "\"note.seen\":1.0", "\"note.seen\":2.0")), {"--replay"});
  EXPECT_EQ(outcome_.code, 1);
  EXPECT_EQ(lied["verified"], false);
  EXPECT_EQ(lied["differences"], Json::array({"note.seen is 2 in the recording, 1 simulated"}));
  expect_next_command(outcome_);
  entry(replaced(text_, "\"note.seen\":1.0", "\"note.seen\":2.0"));
  EXPECT_EQ(outcome_.code, 4) << "the checksum no longer fits";
}

TEST_F(ScoredClass, MeasuresWithoutTheirStepsAreRefusedAndNoMessageHelpsToForgeThem) {
  const std::size_t head = text_.find('\n') + 1, measured = text_.find("{\"measured\""),
                    end = text_.find("{\"end\"");
  ASSERT_TRUE(measured != std::string::npos && end != std::string::npos);
  const std::string steps = "\"steps\":" + std::to_string(std::count(text_.begin(), text_.end(), '\n') - 3);
  const std::string forged = replaced(text_.substr(0, head) + text_.substr(measured), steps, "\"steps\":0");
  entry(sealed(forged));
  EXPECT_EQ(outcome_.code, 4);
  EXPECT_THAT(outcome_.err,
              ::testing::HasSubstr("what was measured is not of these steps: total.time_s is 0.2"));
  entry(forged);
  EXPECT_THAT(outcome_.err, ::testing::HasSubstr("their checksum is another"));
  const std::string right = sealed(forged), seal = right.substr(right.rfind("checksum") + 11, 16);
  EXPECT_THAT(outcome_.err + outcome_.out, ::testing::Not(::testing::HasSubstr(seal)));
}

TEST_F(ScoredClass, ARecordingCutAnywhereIsScoredUpToThereAndSaysSo) {
  const Json whole = entry(text_);
  const std::size_t measured = text_.find("{\"measured\""), header = text_.find('\n') + 1;
  entry(text_.substr(0, header + 10));
  EXPECT_EQ(outcome_.code, 4);
  EXPECT_NE(outcome_.err.find("this recording has no step"), std::string::npos) << outcome_.err;
  for (const std::size_t size : {text_.find('\n', measured / 2) + 1, measured, measured + 40,
                                 text_.rfind("{\"end\""), text_.size() - 2}) {
    const Json cut = entry(text_.substr(0, size));
    EXPECT_EQ(cut["from"], "simulation");
    EXPECT_NE(outcome_.err.find("1 of 1 simulated: the recording was cut"), std::string::npos)
        << outcome_.err;
    EXPECT_NE(cut["notes"].dump().find("the recording has no end: it was cut"), std::string::npos)
        << cut["notes"];
    const bool all_steps = size >= measured;
    EXPECT_EQ(outcome_.code, all_steps ? 0 : 1) << outcome_.err;
    EXPECT_EQ(cut["end"], all_steps ? "done" : "cut");
    EXPECT_EQ(cut["whole"], all_steps);
    const auto steps =
        std::count(text_.begin(), text_.begin() + static_cast<long>(std::min(size, measured)), '\n') - 1;
    EXPECT_NEAR(cut["stopped_at_s"].get<double>(), static_cast<double>(steps) / 50, 1e-12);
    EXPECT_EQ(cut["metrics"]["total.time_s"], cut["stopped_at_s"]);
    if (all_steps) {
      EXPECT_EQ(cut["metrics"], whole["metrics"]) << "the cut lost nothing of the session";
      continue;
    }
    EXPECT_FALSE(cut["score"]["passed"].get<bool>());
    EXPECT_NE(
        outcome_.err.find(fmt::format("(cut): scored up to {:.3f} s", cut["stopped_at_s"].get<double>())),
        std::string::npos)
        << outcome_.err;
  }
  entry(text_.substr(0, header - 1) + "oops");
  EXPECT_EQ(outcome_.code, 4) << "without its first line it is no recording";
}

TEST_F(ScoredClass, OfAChangedExerciseRecordingsAreSimulatedAnewAndSaySo) {
  const double before = entry(text_)["score"]["total"];
  spill(folder_ / "small.lua", replaced(scored_scenario(), "novice = 20", "novice = 40"));
  const Json changed = entry(text_);
  EXPECT_EQ(outcome_.code, 0);
  EXPECT_EQ(changed["from"], "simulation");
  EXPECT_NE(outcome_.err.find("1 of 1 simulated: the exercise has changed since it was recorded"),
            std::string::npos)
      << outcome_.err;
  EXPECT_NEAR(changed["score"]["total"].get<double>() - before, (100 - before) / 2, 1e-9);
}

TEST_F(ScoredClass, ARecordingOfAnotherExerciseIsNamedWithBoth) {
  std::string other = replaced(text_, "\"scenario\":\"small\"", "\"scenario\":\"other\"");
  other = replaced(other, "\"params\":{", "\"params\":{\"unknown\":\"here\",");
  entry(sealed(other));
  EXPECT_EQ(outcome_.code, 4);
  EXPECT_NE(outcome_.err.find("one.jsonl: the recording is of other"), std::string::npos) << outcome_.err;
  EXPECT_NE(outcome_.err.find("the scenario is small"), std::string::npos) << outcome_.err;
}

constexpr const char* clinic_table = R"(return {
  name = "The clinic's", version = 3, exercise = "small", pass = 90, calibration = "medians of nobody",
  parts = {
    { part = "left.path_length_mm", novice = 40 },
    { part = "empty_grasp", each = 1 },
  },
}
)";

TEST_F(ScoredClass, OtherBenchmarksReplaceFiguresWithoutSimulatingAndAreNamed) {
  spill(folder_ / "clinic.lua", clinic_table);
  const Json other = entry(text_, {"--benchmarks", "clinic.lua"});
  EXPECT_EQ(outcome_.code, 0) << outcome_.err;
  EXPECT_EQ(other["from"], "recording");
  EXPECT_EQ(Json::parse(outcome_.out)["benchmarks"],
            Json({{"name", "The clinic's"}, {"version", 3}, {"calibration", "medians of nobody"}}));
  const Json path = other["score"]["parts"][0];
  const double measured = path["measured"];
  EXPECT_NEAR(path["points"].get<double>(), 50 * (40 - measured) / 40, 1e-9);
  EXPECT_EQ(path["benchmark"]["novice"], 40);
  EXPECT_EQ(path["benchmark"]["expert"], 0) << "what the table does not name stays";
  EXPECT_EQ(path["benchmark"]["calibration"], "medians of nobody");
  EXPECT_EQ(other["score"]["pass_mark"], 90);
  EXPECT_NE(score({"one.jsonl", "--benchmarks", "clinic.lua"})
                .out.find("The clinic's, version 3, medians of nobody"),
            std::string::npos);
}

TEST_F(ScoredClass, MistakesInBenchmarksAreNamedAtTheirLines) {
  const auto complaint = [&](const std::string& from, const std::string& to) {
    spill(folder_ / "clinic.lua", replaced(clinic_table, from, to));
    const Outcome outcome = score({"out", "--benchmarks", "clinic.lua"});
    EXPECT_EQ(outcome.code, 6) << outcome.err;
    expect_next_command(outcome);
    return outcome.err;
  };
  const auto starts = [](const std::string& text, const std::string& begin) {
    EXPECT_EQ(text.substr(0, begin.size()), begin);
  };
  starts(complaint("empty_grasp\"", "empty_gasp\""),
         "clinic.lua:5: parts[2]: the score has no part \"empty_gasp\" (did you mean \"empty_grasp\"?)");
  starts(complaint("each = 1", "novice = 1"), "clinic.lua:5: parts[2]: empty_grasp is a penalty");
  starts(complaint("novice = 40", "each = 1"), "clinic.lua:4: parts[1]: left.path_length_mm lies between");
  starts(complaint("novice = 40", "novice = 0"),
         "clinic.lua:4: parts[1]: left.path_length_mm: novice and expert are both 0");
  starts(complaint("\"small\"", "\"other\""),
         "clinic.lua:2: exercise: these are benchmarks of other, not of small");
  starts(complaint("version = 3", "version = 'x'"),
         "clinic.lua:2: version: version must be a number, got a text");
  starts(complaint("novice = 40", "novize = 40"), "clinic.lua:4: parts[1].novize: unknown key \"novize\"");
  starts(complaint("version = 3,", ""), "clinic.lua:1: \"version\" is missing");
  starts(complaint("version = 3,", "version = = 3,"), "clinic.lua:2: unexpected symbol near '='");
}

TEST_F(ScoredClass, ASecondRunTakesWhatIsThereUnlessAnythingButTheNameIsOther) {
  spill(folder_ / "class" / "a.jsonl", text_);
  spill(folder_ / "class" / "b.jsonl", of_session(text_.substr(0, text_.find("\"time_s\":0.1,")), 2));
  spill(folder_ / "class" / "c.jsonl", "no recording");
  const Outcome first = score({"class", "-o", "kept", "--json"});
  EXPECT_EQ(first.code, 4) << first.err;
  EXPECT_EQ(first.err.find("taken"), std::string::npos) << first.err;
  EXPECT_EQ(first.out, slurp(folder_ / "kept" / "scores.json"));
  EXPECT_NE(slurp(folder_ / "kept" / "scores.csv").find(",simulation,cut,false"), std::string::npos);

  fs::rename(folder_ / "class" / "a.jsonl", folder_ / "class" / "d.jsonl");
  const Outcome second = score({"class", "-o", "kept", "--json"});
  EXPECT_NE(second.err.find("2 of 3 taken from kept"), std::string::npos) << second.err;
  EXPECT_EQ(Json::parse(second.out)["recordings"][2]["file"], "class/d.jsonl");
  EXPECT_EQ(Json::parse(second.out)["recordings"][2]["metrics"],
            Json::parse(first.out)["recordings"][0]["metrics"]);

  EXPECT_EQ(score({"class", "-o", "kept", "--again"}).err.find("taken"), std::string::npos);
  spill(folder_ / "clinic.lua", clinic_table);
  EXPECT_EQ(score({"class", "-o", "kept", "--benchmarks", "clinic.lua"}).err.find("taken"),
            std::string::npos);
  int damaged = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_ / "kept")) {
    const std::string text = slurp(file.path()), from = "\"metrics\":{";
    if (text.find(from) == std::string::npos) continue;  // a class's scores
    spill(file.path(), replaced(text, from, from + "\"left.luck\":1,"));
    ++damaged;
  }
  EXPECT_EQ(damaged, 4) << "two recordings by two sets of benchmarks";
  EXPECT_EQ(score({"class", "-o", "kept", "--json"}).out, second.out) << "a damaged result is not taken";
}

TEST_F(ScoredClass, TheTableAndItsRowsAsCsvNameEveryRecording) {
  const Outcome csv = score({"out", "out/recording.jsonl", "--csv"}), text = score({"out"});
  EXPECT_EQ(csv.code, 0) << csv.err;
  EXPECT_NE(csv.err.find("is named twice"), std::string::npos) << csv.err;
  const std::size_t end = csv.out.find("\r\n");
  const std::string head = csv.out.substr(0, end), row = csv.out.substr(end + 2);
  EXPECT_TRUE(head.starts_with(
      "file,group,session,source,mode,trainee,attempt,began,machine,from,end,whole,stopped_at_s,"
      "measures,scoring,digest,pass_mark,outcome,verdict,total,passed,completed,steps_done,"
      "steps,critical,gates,left.path_length_mm points,left.path_length_mm weight,"
      "left.path_length_mm measured,left.path_length_mm reason,empty_grasp points,"))
      << head;
  EXPECT_TRUE(row.starts_with("out/recording.jsonl,demo,")) << row;
  EXPECT_NE(row.find(",recording,done,true,0.2,6,2,"), std::string::npos) << row;
  const auto fields = [](const std::string& line) {
    bool quoted = false;
    return 1 + std::count_if(line.begin(), line.end(), [&](char c) {
             quoted ^= c == '"';
             return c == ',' && !quoted;
           });
  };
  EXPECT_EQ(fields(head), fields(row.substr(0, row.find("\r\n"))));
  EXPECT_NE(row.find("\"left.path_length_mm = "), std::string::npos) << "its reason: " << row;
  EXPECT_NE(text.out.find("  out/recording.jsonl "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("demo: 1 of 1 passed (pass mark 80)"), std::string::npos) << text.out;
  EXPECT_EQ(score({"out", "--fail-below", "99"}).code, 1);
}

TEST_F(ScoredClass, WhatCannotBeScoredSaysWhatToDo) {
  fs::create_directories(folder_ / "empty");
  EXPECT_EQ(score({"empty"}).code, 5);
  EXPECT_EQ(score({"nobody.jsonl"}).code, 4);
  EXPECT_EQ(score({"out", "--benchmarks", "nowhere.lua"}).code, 4);
  EXPECT_EQ(calot({"score", "small.lua"}).code, 4);
  EXPECT_EQ(calot({"score", "nowhere.lua", "out"}).code, 4);
  spill(folder_ / "broken.lua", "return 7");
  EXPECT_EQ(calot({"score", "broken.lua", "out"}).code, 6);
  const Json other = entry(sealed(replaced(text_, "\"scenario\":\"small\"", "\"scenario\":\"large\"")));
  EXPECT_EQ(outcome_.code, 4);
  EXPECT_NE(other["failure"][0]["message"].get<std::string>().find("the recording is of large"),
            std::string::npos);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"empty"}, {"nobody.jsonl"}, {"out", "-j", "0"}})
    expect_next_command(score(arguments));
}

/// With what the first line says of who operated.
std::string of_whom(const std::string& text, const std::string& members) {
  std::string out = text;
  const std::string source = "\"source\":\"demo\"";
  return out.replace(out.find(source), source.size(), members);
}

TEST_F(ScoredClass, ACopyCountsOnceAndTheLongestWholeOneIsIt) {
  spill(folder_ / "class" / "a_cut.jsonl", text_.substr(0, text_.find("\"time_s\":0.1,")));
  spill(folder_ / "class" / "b.jsonl", text_);
  spill(folder_ / "class" / "c.jsonl", text_);
  spill(folder_ / "class" / "d_other.jsonl", of_session(text_, 7));
  // Of two that were cut, the longer one.
  spill(folder_ / "cuts" / "a.jsonl", text_.substr(0, text_.find("\"time_s\":0.08")));
  spill(folder_ / "cuts" / "b.jsonl", text_.substr(0, text_.find("\"time_s\":0.14")));
  EXPECT_EQ(Json::parse(score({"cuts", "--json"}).out)["recordings"][0]["copy_of"], "cuts/b.jsonl");
  const Outcome outcome = score({"class", "--json"});
  EXPECT_EQ(outcome.code, 0) << "what is left out fails nothing: " << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["groups"][0]["files"], Json({"class/b.jsonl", "class/d_other.jsonl"}));
  EXPECT_EQ(json["recordings"][0]["copy_of"], "class/b.jsonl");
  EXPECT_EQ(json["recordings"][2]["copy_of"], "class/b.jsonl");
  const std::string text = score({"class"}).out;
  EXPECT_NE(text.find("class/c.jsonl: the same session as class/b.jsonl: it counts once"), std::string::npos)
      << text;
  EXPECT_EQ(score({"class", "-o", "kept"}).err.find("taken from"), std::string::npos)
      << "nothing was there before";
  // A copy whose figures were changed is told of all the same.
  spill(folder_ / "forged" / "a.jsonl", text_);
  spill(folder_ / "forged" / "b.jsonl", sealed(replaced(text_, "\"note.seen\":1.0", "\"note.seen\":2.0")));
  const Outcome forged = score({"forged", "--replay"});
  EXPECT_EQ(forged.code, 1);
  EXPECT_NE(forged.err.find("forged/b.jsonl: note.seen is 2 in the recording"), std::string::npos)
      << forged.err;
  // One that names no session is known by its text.
  const std::string nameless = sealed(replaced(text_, text_.substr(text_.find("\"session\""), 45), ""));
  for (const char* name : {"a.jsonl", "b.jsonl"}) spill(folder_ / "nameless" / name, nameless);
  EXPECT_EQ(Json::parse(score({"nameless", "--json"}).out)["recordings"][1]["copy_of"], "nameless/a.jsonl");
  ASSERT_EQ(
      calot({"replay", "nameless/a.jsonl", "--scenario", "small.lua", "--no-render", "-o", "nameless/again"})
          .code,
      0);
  EXPECT_EQ(Json::parse(score({"nameless", "--json"}).out)["groups"][0]["scored"], 1)
      << "a replay is no other session";
}

TEST_F(ScoredClass, PracticeAndExamAreAveragedApartAndWhoOperatedIsShown) {
  const std::string who = R"("source":"lines","mode":"{}","trainee":"{}","attempt":{})";
  for (int i = 0; i < 6; ++i)
    spill(folder_ / "class" / fmt::format("{}.jsonl", i),
          of_session(sealed(of_whom(text_, fmt::format(fmt::runtime(who), i < 2 ? "exam" : "practice",
                                                       i % 2 == 0 ? "T-01" : "T-02", i + 1))),
                     i + 1));
  const Json json = Json::parse(score({"class", "--json"}).out);
  ASSERT_EQ(json["groups"].size(), 2u);
  EXPECT_EQ(json["groups"][0]["mode"], "exam");
  EXPECT_EQ(json["groups"][0]["scored"], 2);
  EXPECT_EQ(json["groups"][1]["scored"], 4);
  EXPECT_FALSE(json.contains("class")) << "no mean of all";
  spill(folder_ / "names.csv", "trainee,name\nT-01,\"Muster, Anna\"\nT-09,Nobody\n");
  const std::string text = score({"class", "--names", "names.csv", "-o", "kept"}).out;
  for (const char* part : {"exam: 2 of 2 passed", "practice: 4 of 4 passed", "Muster, Anna (T-01)", " T-02 ",
                           "mean of 4 finished, of 4 attempts", "averaged apart"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in\n" << text;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_ / "kept"))
    EXPECT_EQ(slurp(file.path()).find("Muster"), std::string::npos) << file.path();
  EXPECT_NE(score({"class", "--names", "names.csv", "--csv"}).out.find("\"Muster, Anna\""),
            std::string::npos);
}

TEST_F(ScoredClass, ARegistersMistakesAreNamedAtTheirLines) {
  const auto complaint = [&](const std::string& text) {
    spill(folder_ / "names.csv", text);
    const Outcome outcome = score({"out", "--names", "names.csv"});
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    expect_next_command(outcome);
    return outcome.err;
  };
  const std::pair<const char*, const char*> wrong[] = {
      {"", "names.csv:1: this register is empty"},
      {"T-01,Anna\n", "names.csv:1: this is no register of names"},
      {"trainee,name\nT-01\n", "names.csv:2: this line has no trainee and name"},
      {"trainee,name\nAnna Muster,Anna\n", "names.csv:2: \"Anna Muster\" is no pseudonym"},
      {"trainee,name\nT-01,A\n\nT-01,B\n", "names.csv:4: T-01 stands twice"},
      {"trainee,name\nT-01,\n", "names.csv:2: T-01 has no name"}};
  for (const auto& [text, words] : wrong)
    EXPECT_NE(complaint(text).find(words), std::string::npos) << complaint(text);
  spill(folder_ / "names.csv", "\xef\xbb\xbfname;group;trainee\r\nAnna;3;T-01\r\n");
  EXPECT_EQ(score({"out", "--names", "names.csv"}).code, 0) << "as a spreadsheet writes it";
  EXPECT_EQ(score({"out", "--names", "nowhere.csv"}).code, 4);
}

TEST_F(ScoredClass, OtherParametersAreAScoreOfTheirOwn) {
  std::string text = replaced(scored_scenario(), "score = calot.score.weighted {",
                              "score = function(p) return calot.score.weighted {");
  const std::size_t end = text.rfind("},\n", text.find("golden =")) + 1;
  text = replaced(text.insert(end, " end"), "novice = 20", "novice = p.height * 2000");
  spill(folder_ / "small.lua", text);
  for (const char* height : {"10", "20"})
    ASSERT_EQ(calot({"run", "small.lua", "--no-render", "-o", std::string("runs/") + height, "--param",
                     std::string("height=") + height})
                  .code,
              0);
  const Json json = Json::parse(score({"runs", "--json"}).out);
  ASSERT_EQ(json["groups"].size(), 2u) << json.dump(1);
  EXPECT_NE(json["groups"][0]["digest"], json["groups"][1]["digest"]);
  const std::string shown = score({"runs"}).out;
  EXPECT_NE(shown.find("demo, height = 20: "), std::string::npos) << shown;
  EXPECT_EQ(shown.find("nan"), std::string::npos) << "every part has its points: " << shown;
}

TEST_F(ScoredClass, WhatWasMeasuredByAnOlderVersionIsMeasuredAnew) {
  const Json newer = entry(sealed(replaced(text_, "\"measures\":6", "\"measures\":1")));
  EXPECT_EQ(newer["from"], "simulation");
  EXPECT_EQ(newer["measures"], 6);
  EXPECT_EQ(newer["recorded"]["measures"], 1);
  EXPECT_NE(outcome_.err.find("measured by version 1, and this program measures by version 6"),
            std::string::npos)
      << outcome_.err;
  EXPECT_EQ(newer["metrics"], entry(text_)["metrics"]) << "the same session";
  // calot.recording/2 says neither, and is of version 1.
  std::string old = replaced(text_, "calot.recording/3", "calot.recording/2");
  const std::size_t hash = old.find("\"exercise_hash\":"), seed = old.find("\"seed\""),
                    session = old.find("\"session\""), make = old.find("\"toolchain\"");
  const std::string exercise = old.substr(hash, 35);
  old = old.substr(0, hash) + old.substr(seed, session - seed) + old.substr(make);
  old = replaced(old, "{\"measured\":{", "{\"measured\":{" + exercise);
  const Json of_old = entry(sealed(old));
  EXPECT_EQ(outcome_.code, 0) << outcome_.err;
  EXPECT_EQ(of_old["recorded"], Json({{"schema", 2}, {"measures", 1}, {"scoring", 1}}));
  EXPECT_EQ(of_old["from"], "simulation");
  EXPECT_EQ(of_old["score"], newer["score"]);
}

}  // namespace
}  // namespace calot::test
