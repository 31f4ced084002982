// The golden commands on a project of one small scenario.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "app/program.h"
#include "goldens/store.h"
#include "render/png.h"
#include "session/json.h"
#include "support/paths.h"

namespace calot::test {
namespace {

class GoldenProject : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    spill(folder_ / "scenarios" / "small.lua", small_scenario());
    fs::create_directories(folder_ / "scripts");
    fs::create_directory_symlink(fs::path(source_dir()) / "scripts" / "lua", folder_ / "scripts" / "lua");
  }
  fs::path golden(const std::string& name) const { return folder_ / "golden" / "small" / name; }

  /// A golden in a size that is drawn fast: what is accepted beside it has that size too.
  static void write_blank(const fs::path& golden) {
    Golden blank;
    blank.image.width = blank.sidecar.width = 64;
    blank.image.height = blank.sidecar.height = 36;
    blank.image.rgb.assign(3 * 64 * 36, 0);
    ASSERT_TRUE(write_golden(golden, blank));
  }
  /// Accepts the small scenario's two frames in that size.
  void accept_small() {
    write_blank(golden("t000.00s"));
    ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
  }

  /// Every file below golden/ with its content.
  std::map<std::string, std::string> goldens() const {
    std::map<std::string, std::string> files;
    if (!fs::exists(folder_ / "golden")) return files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_ / "golden")) {
      if (entry.is_regular_file()) files[entry.path().string()] = slurp(entry.path());
    }
    return files;
  }
  void edit_sidecar(const std::string& name, const std::function<void(Json&)>& change) {
    Json json = Json::parse(slurp(golden(name)));
    change(json);
    spill(golden(name), json.dump());
  }
};

TEST_F(GoldenProject, OnlyAcceptWithNamesWritesGoldens) {
  EXPECT_EQ(calot({"golden", "test"}).code, 1);  // nothing is stored yet
  EXPECT_EQ(calot({"golden", "report"}).code, 0);
  EXPECT_EQ(calot({"golden", "accept"}).code, 4);
  EXPECT_EQ(calot({"golden", "accept", "none"}).code, 5);
  EXPECT_TRUE(goldens().empty());
  write_blank(golden("t000.40s"));
  const auto blank = goldens();
  EXPECT_EQ(calot({"golden", "test"}).code, 1);
  EXPECT_EQ(goldens(), blank);
  ASSERT_EQ(calot({"golden", "accept", "small/t000.40s"}).code, 0);
  EXPECT_EQ(goldens().size(), 2u);
  EXPECT_NE(goldens(), blank);
  const Outcome all = calot({"golden", "accept", "small"});
  ASSERT_EQ(all.code, 0) << all.err;
  const auto accepted = goldens();
  EXPECT_EQ(accepted.size(), 4u);
  const Outcome test = calot({"golden", "test"});
  EXPECT_EQ(test.code, 0) << test.out << test.err;
  EXPECT_EQ(calot({"golden", "accept"}).code, 4);
  EXPECT_EQ(calot({"golden", "report"}).code, 0);
  EXPECT_EQ(goldens(), accepted);
}

TEST_F(GoldenProject, ASidecarOfAnySizeAndDepthIsRefusedInAFewLines) {
  Golden blank;
  blank.image.width = blank.image.height = blank.sidecar.width = blank.sidecar.height = 16;
  blank.image.rgb.assign(3 * 16 * 16, 0);
  ASSERT_TRUE(write_golden(golden("t000.00s"), blank));
  const Json sound = Json::parse(slurp(golden("t000.00s.json")));
  const auto complaint = [&](const std::string& text) {
    spill(golden("t000.00s.json"), text);
    const Result<Golden> read = read_golden(golden("t000.00s"));
    EXPECT_TRUE(read || read.failure().problems.size() <= 100);
    return read ? "" : to_text(read.failure());
  };
  const auto with = [&](const std::string& key, const std::string& value) {
    Json json = sound;
    json.erase(key);
    return json.dump().insert(1, "\"" + key + "\":" + value + ",");
  };
  EXPECT_EQ(complaint(sound.dump() + std::string(10'000, ' ')), "");
  EXPECT_THAT(complaint(sound.dump() + std::string(1 << 20, ' ')),
              ::testing::HasSubstr("t000.00s.json: the file has more than 65536 bytes"));
  EXPECT_THAT(complaint(with("width_px", std::string(30'000, '[') + std::string(30'000, ']'))),
              ::testing::HasSubstr("width_px must be a whole number from 16 to 4096, not a list"));
  std::string many = "1";
  for (int i = 0; i < 1000; ++i) many += fmt::format(",\"k{}\":1", i);
  EXPECT_THAT(complaint(with("k", many)), ::testing::HasSubstr("and 902 more problems"));
}

TEST_F(GoldenProject, AScenarioInAFolderIsNamedByItsPathAndTheFolderMayBeLeftOut) {
  spill(folder_ / "scenarios" / "paper" / "deep.lua", small_scenario());
  const fs::path golden = folder_ / "golden" / "paper" / "deep" / "t000.40s";
  write_blank(golden);
  const std::string blank = slurp(golden.string() + ".png");
  ASSERT_EQ(calot({"golden", "accept", "deep/t000.40s"}).code, 0);
  EXPECT_NE(slurp(golden.string() + ".png"), blank);
  EXPECT_EQ(goldens().size(), 2u);
  ASSERT_EQ(calot({"golden", "accept", "paper/deep"}).code, 0);
  EXPECT_EQ(goldens().size(), 4u);
  const Outcome one = calot({"golden", "test", "paper/deep/t000.00s", "--json"});
  EXPECT_EQ(one.code, 0) << one.out << one.err;
  const Json json = Json::parse(one.out);
  ASSERT_EQ(json["frames"].size(), 1u);
  EXPECT_EQ(json["frames"][0]["scenario"], "paper/deep");
  // Without names it is found like any other.
  const Json all = Json::parse(calot({"golden", "test", "--json"}).out);
  EXPECT_EQ(all["frames"].size(), 4u);
}

TEST_F(GoldenProject, ANameThatMayMeanTwoScenariosIsRefused) {
  spill(folder_ / "scenarios" / "first" / "deep.lua", small_scenario());
  spill(folder_ / "scenarios" / "second" / "deep.lua", small_scenario());
  for (const std::string name : {"deep", "deep/t000.40s"}) {
    const Outcome outcome = calot({"golden", "accept", name});
    EXPECT_EQ(outcome.code, 5) << name;
    EXPECT_NE(outcome.err.find("first/deep"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("second/deep"), std::string::npos) << outcome.err;
    expect_next_command(outcome);
  }
  EXPECT_TRUE(goldens().empty());
  // A scenario's full name is never in doubt, though others end in it.
  EXPECT_EQ(calot({"golden", "accept", "second/deep"}).code, 0);
  spill(folder_ / "scenarios" / "second" / "small.lua", small_scenario());
  EXPECT_EQ(calot({"golden", "accept", "small/t000.00s"}).code, 0);
  EXPECT_TRUE(fs::exists(golden("t000.00s.png")));
}

TEST_F(GoldenProject, ChangedPixelsOfTheSameStateAreRenderingsChange) {
  accept_small();
  const std::string file = golden("t000.40s.png").string();
  Image image = read_png(file).value();
  image.rgb[3 * 1000] ^= 1;
  ASSERT_TRUE(write_png(file, image));
  const Outcome outcome = calot({"golden", "test", "--json"});
  EXPECT_EQ(outcome.code, 1);
  const Json json = Json::parse(outcome.out);
  EXPECT_TRUE(json["frames"][0]["passed"].get<bool>());
  EXPECT_EQ(json["frames"][1]["verdict"], "rendering changed");
  EXPECT_EQ(json["frames"][1]["differing_pixels"], 1);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "golden" / "small" / "t000.40s.difference.png"));
}

TEST_F(GoldenProject, AnEditOfTheScenarioIsNamedBesideTheChangedPictures) {
  accept_small();
  std::string text = small_scenario();
  text.replace(text.find("port = \"umbilical\""), 18, "port = \"umbilical\", distance = 0.08");
  spill(folder_ / "scenarios" / "small.lua", text);
  const Json json = Json::parse(calot({"golden", "test", "small/t000.00s", "--json"}).out);
  EXPECT_EQ(json["frames"][0]["verdict"], "rendering changed");
  EXPECT_NE(
      json["frames"][0]["message"].get<std::string>().find("the exercise's text has changed since, too"),
      std::string::npos)
      << json;
}

TEST_F(GoldenProject, AnotherStateIsPhysicsChangeUnlessOnlyTheToolchainMadeIt) {
  accept_small();
  edit_sidecar("t000.00s.json", [](Json& json) { json["state_hash"] = "0000000000000000"; });
  edit_sidecar("t000.40s.json", [](Json& json) {
    json["state_hash"] = "0000000000000000";
    json["toolchain"] = "another compiler";
  });
  const Outcome outcome = calot({"golden", "test", "--json"});
  EXPECT_EQ(outcome.code, 1);
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["frames"][0]["verdict"], "physics changed");
  EXPECT_FALSE(json["frames"][0]["passed"].get<bool>());
  EXPECT_EQ(json["frames"][1]["verdict"], "same picture");
  EXPECT_TRUE(json["frames"][1]["passed"].get<bool>());
  EXPECT_NE(json["frames"][1]["message"].get<std::string>().find("another compiler"), std::string::npos);
}

TEST_F(GoldenProject, OfOtherBitsAnotherPicturePassesByTheCourseOfItsSession) {
  accept_small();
  const auto from_elsewhere = [](Json& json) {
    json["state_hash"] = "0000000000000000";
    json["instruction_set"] = "another one";
  };
  Image image = read_png(golden("t000.40s.png").string()).value();
  image.rgb.assign(image.rgb.size(), 255);
  ASSERT_TRUE(write_png(golden("t000.40s.png").string(), image));
  edit_sidecar("t000.40s.json", from_elsewhere);
  const Outcome passed = calot({"golden", "test", "--json"});
  EXPECT_EQ(passed.code, 0) << passed.out;
  const Json frame = Json::parse(passed.out)["frames"][1];
  EXPECT_EQ(frame["verdict"], "drifted");
  EXPECT_TRUE(frame["passed"].get<bool>());
  ASSERT_EQ(calot({"golden", "report", "-o", "page.html"}).code, 0);
  EXPECT_THAT(slurp(folder_ / "page.html"), ::testing::HasSubstr("<h2>small/t000.40s: drifted</h2>"));

  edit_sidecar("t000.40s.json", [](Json& json) { json["course"]["steps_done"] = 2; });
  const Outcome failed = calot({"golden", "test"});
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.out, ::testing::HasSubstr("small/t000.40s: drifted: other bits are expected here, but "
                                               "the session took another course"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "golden" / "small" / "t000.40s.difference.png"));

  edit_sidecar("t000.40s.json", [](Json& json) { json["course"]["steps_done"] = 1; });
  ASSERT_TRUE(write_png(golden("t000.00s.png").string(), image));
  edit_sidecar("t000.00s.json", from_elsewhere);
  const Json at_rest = Json::parse(calot({"golden", "test", "--json"}).out)["frames"][0];
  EXPECT_EQ(at_rest["verdict"], "physics changed") << "nothing has moved yet";
}

TEST_F(GoldenProject, AcceptStoresWhatBecameOfTheSession) {
  accept_small();
  ASSERT_EQ(calot({"run", "--no-render", "-o", "here", "scenarios/small.lua"}).code, 0);
  const Json report = Json::parse(slurp(folder_ / "here" / "report.json"));
  const double total = report["score"]["total"].get<double>();
  EXPECT_GT(total, 0);
  for (const char* name : {"t000.00s.json", "t000.40s.json"}) {
    const Json course = Json::parse(slurp(golden(name)))["course"];
    EXPECT_EQ(course, Json({{"score", total}, {"steps_done", 1}, {"errors", 0}})) << name;
  }
  std::string text = small_scenario("t:step('wait', 'Wait', { limit = 0.5 * s }); t:wait(0.6 * s)");
  const std::size_t score = text.find("  score = "), golden_times = text.find("  golden = ");
  text.erase(score, golden_times - score);
  spill(folder_ / "scenarios" / "small.lua", text);
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
  const Json course = Json::parse(slurp(golden("t000.00s.json")))["course"];
  EXPECT_EQ(course, Json({{"score", nullptr}, {"steps_done", 0}, {"errors", 1}})) << "the step timed out";
}

TEST_F(GoldenProject, AFrameTheScenarioNoLongerDeclaresIsStale) {
  accept_small();
  std::string text = small_scenario();
  text.replace(text.find("0.4 * s }"), 9, "0.2 * s }");
  spill(folder_ / "scenarios" / "small.lua", text);
  const Json json = Json::parse(calot({"golden", "test", "--json"}).out);
  EXPECT_EQ(json["frames"][1]["verdict"], "missing");  // t000.20s
  EXPECT_EQ(json["frames"][2]["verdict"], "stale");    // t000.40s
  accept_small();
  EXPECT_FALSE(fs::exists(golden("t000.40s.png")));
  EXPECT_EQ(calot({"golden", "test"}).code, 0);
}

TEST_F(GoldenProject, AMomentKeepsItsPictureWhereItComesLater) {
  const auto scenario_waiting = [&](const std::string& wait) {
    std::string text =
        small_scenario("t:step('move', 'Move'); t:wait(" + wait + "); t:step('on', 'On'); t:wait(0.1)");
    const std::string at = "at = { 0, 0.4 * s }";
    text.replace(text.find(at), at.size(),
                 at + ", moments = { { name = 'going_on', step = 'on', delay = 0.06 } }");
    spill(folder_ / "scenarios" / "small.lua", text);
  };
  const auto time_of = [&](const char* name) {
    return Json::parse(slurp(golden(name)))["time_s"].get<double>();
  };
  scenario_waiting("0.5 * s");
  accept_small();
  EXPECT_EQ(goldens().size(), 6u);
  EXPECT_NEAR(time_of("going_on.json"), 0.56, 0.011) << "a step of the solver, and rounding";
  const Outcome one = calot({"golden", "test", "small/going_on"});
  EXPECT_EQ(one.code, 0) << one.out << one.err;
  EXPECT_THAT(one.out, ::testing::HasSubstr("small/going_on: same"));
  scenario_waiting("0.7 * s");
  accept_small();
  EXPECT_EQ(goldens().size(), 6u);
  EXPECT_NEAR(time_of("going_on.json"), 0.76, 0.011);
}

TEST_F(GoldenProject, AMomentThatDoesNotComeIsNamedAndTheNextScenarioIsAcceptedAllTheSame) {
  std::string text = small_scenario();
  const std::string at = "at = { 0, 0.4 * s }";
  text.replace(text.find(at), at.size(), "at = { 0 }, moments = { { name = 'held', event = 'grasp' } }");
  spill(folder_ / "scenarios" / "first.lua", text);
  write_blank(golden("t000.00s"));
  write_blank(folder_ / "golden" / "first" / "t000.00s");
  const auto before = slurp(folder_ / "golden" / "first" / "t000.00s.png");
  const Outcome outcome = calot({"golden", "accept", "first", "small"});
  EXPECT_EQ(outcome.code, 6) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("without held: nothing of it was accepted"));
  EXPECT_EQ(slurp(folder_ / "golden" / "first" / "t000.00s.png"), before);
  EXPECT_TRUE(fs::exists(golden("t000.40s.png")));
  const Outcome run = calot({"run", "scenarios/first.lua", "--size", "64x36"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, ::testing::HasSubstr("There is no picture held: the session ended at 0.6 s"));
}

TEST_F(GoldenProject, ABrokenSidecarIsNamedAndHidesNoOtherFrame) {
  accept_small();
  spill(golden("t000.40s.json"), "{");
  const Outcome outcome = calot({"golden", "test"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.out.find("t000.40s.json: this ends in the middle"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("small/t000.00s: same"), std::string::npos) << outcome.out;
}

TEST_F(GoldenProject, EverySidecarValueIsCheckedAndNamed) {
  Golden golden;
  golden.image.width = 16;
  golden.image.height = 16;
  golden.image.rgb.assign(3 * 16 * 16, 7);
  golden.sidecar.width = golden.sidecar.height = 16;
  const fs::path stem = folder_ / "t000.00s";
  ASSERT_TRUE(write_golden(stem, golden));
  ASSERT_TRUE(read_golden(stem));
  const Json good = Json::parse(slurp(folder_ / "t000.00s.json"));
  const auto complaint = [&](const Json& json) {
    spill(folder_ / "t000.00s.json", json.dump());
    const Result<Golden> read = read_golden(stem);
    return read ? std::string() : to_text(read.failure());
  };
  const Json bad[] = {-5, 1e9, "x", nullptr, Json::array(), 1.5};
  const auto expect_named = [&](const Json& json, const std::string& key, const std::string& what) {
    const std::string said = complaint(json);
    EXPECT_NE(said.find("t000.00s.json: "), std::string::npos) << key << " " << what;
    EXPECT_NE(said.find(key == "schema" ? "schema" : key), std::string::npos)
        << key << " " << what << ": " << said;
    EXPECT_EQ(said.find("exception"), std::string::npos) << said;
  };
  for (const auto& [key, value] : good.items()) {
    Json missing = good;
    missing.erase(key);
    expect_named(missing, key, "missing");
    for (const Json& other : bad) {
      const bool fits = (value.is_string() && key != "schema" && key.find("hash") == std::string::npos &&
                         other.is_string()) ||
                        (key == "time_s" && other.is_number() && other >= 0);
      if (fits) continue;
      Json changed = good;
      changed[key] = other;
      expect_named(changed, key, other.dump());
    }
  }
  for (const auto& [key, value] : good["tolerance"].items()) {
    for (const Json& other : bad) {
      Json changed = good;
      changed["tolerance"][key] = other;
      expect_named(changed, "tolerance." + key, other.dump());
    }
  }
  for (const auto& [key, value] : good["course"].items()) {
    for (const Json& other : bad) {
      if (key == "score" && (other.is_null() || other == 1.5)) continue;
      Json changed = good;
      changed["course"][key] = other;
      expect_named(changed, "course." + key, other.dump());
    }
    Json missing = good;
    missing["course"].erase(key);
    expect_named(missing, "course." + key, "missing");
  }
  Json other_size = good;
  other_size["width_px"] = 17;
  expect_named(other_size, "width_px", "of another picture");
  Json unknown = good;
  unknown["widht_px"] = 16;
  expect_named(unknown, "widht_px", "unknown");
}

TEST_F(GoldenProject, GoldensWhoseScenarioIsGoneAndScenariosThatAreBrokenAreSaidBesideTheRest) {
  accept_small();
  spill(folder_ / "golden" / "gone" / "t000.00s.json", "{}");
  spill(folder_ / "scenarios" / "broken.lua", "return {\n");
  const Outcome outcome = calot({"golden", "test", "--json"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_NE(outcome.err.find("broken.lua:2"), std::string::npos) << outcome.err;
  expect_next_command(outcome);
  const Json json = Json::parse(outcome.out);
  ASSERT_EQ(json["frames"].size(), 3u);
  EXPECT_EQ(json["frames"][0]["verdict"], "same");
  EXPECT_EQ(json["frames"][1]["verdict"], "same");
  EXPECT_EQ(json["frames"][2]["scenario"], "gone");
  EXPECT_EQ(json["frames"][2]["verdict"], "no scenario");
  EXPECT_EQ(json["failures"][0]["scenario"], "broken");
  fs::remove(folder_ / "scenarios" / "broken.lua");
  EXPECT_EQ(calot({"golden", "test"}).code, 1) << "a golden without its scenario has failed";
}

TEST_F(GoldenProject, AnInterruptedAcceptSaysWhatWasAcceptedAndKeepsTheRestAsItWas) {
  spill(folder_ / "scenarios" / "slow.lua", endless_scenario());
  const Outcome outcome = calot({"golden", "accept", "small", "slow"}, [&](pid_t pid) {
    for (int i = 0; i < 3000 && !fs::exists(folder_ / "golden" / "slow" / ".new" / "t000.00s.json"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("2 frames were accepted, those named above; nothing of slow"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.out.find("small/t000.40s.png"), std::string::npos) << outcome.out;
  expect_next_command(outcome);
  std::set<std::string> folders;
  for (const auto& [file, text] : goldens()) folders.insert(fs::path(file).parent_path().filename());
  EXPECT_EQ(folders, (std::set<std::string>{"small"}));
}

TEST_F(GoldenProject, AnInterruptedTestSaysWhatWasComparedAndWhatIsLeft) {
  spill(folder_ / "scenarios" / "slow.lua", endless_scenario());
  const Outcome outcome = calot({"golden", "test", "small", "slow"}, [&](pid_t pid) {
    EXPECT_TRUE(wait_for_lines(folder_ / ".stdout", 3));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("frames were compared"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("not finished: slow."), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("Next: calot golden test slow"), std::string::npos) << outcome.err;
}

TEST_F(GoldenProject, TheReportIsOnePageThatNeedsNothingElse) {
  accept_small();
  ASSERT_EQ(calot({"golden", "report", "-o", "page.html"}).code, 0);
  const std::string page = slurp(folder_ / "page.html");
  std::size_t pictures = 0;
  for (std::size_t at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1)) {
    ++pictures;
    EXPECT_TRUE(page.substr(page.find("src=", at)).starts_with("src=\"data:image/png;base64,")) << pictures;
  }
  EXPECT_EQ(pictures, 6u);  // expected, actual and difference of two frames
  EXPECT_EQ(page.find("http"), std::string::npos);
}

}  // namespace
}  // namespace calot::test
