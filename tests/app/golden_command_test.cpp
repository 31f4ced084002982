// The golden commands on a project of one small scenario.

#include <nlohmann/json.hpp>

#include "app/program.h"
#include "render/png.h"
#include "support/paths.h"

namespace calot::test {
namespace {

using Json = nlohmann::json;

class GoldenProject : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    spill(folder_ / "scenarios" / "small.lua", small_scenario());
    fs::create_directories(folder_ / "scripts");
    fs::create_directory_symlink(fs::path(source_dir()) / "scripts" / "lua", folder_ / "scripts" / "lua");
  }
  fs::path golden(const std::string& name) const { return folder_ / "golden" / "small" / name; }

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
  ASSERT_EQ(calot({"golden", "accept", "small/t000.40s"}).code, 0);
  EXPECT_EQ(goldens().size(), 2u);
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

TEST_F(GoldenProject, AScenarioInAFolderIsNamedByItsPathAndTheFolderMayBeLeftOut) {
  spill(folder_ / "scenarios" / "paper" / "deep.lua", small_scenario());
  ASSERT_EQ(calot({"golden", "accept", "deep/t000.40s"}).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "golden" / "paper" / "deep" / "t000.40s.png"));
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
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
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

TEST_F(GoldenProject, AnotherStateIsPhysicsChangeUnlessOnlyTheToolchainMadeIt) {
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
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

TEST_F(GoldenProject, AFrameTheScenarioNoLongerDeclaresIsStale) {
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
  std::string text = small_scenario();
  text.replace(text.find("0.4 * s }"), 9, "0.2 * s }");
  spill(folder_ / "scenarios" / "small.lua", text);
  const Json json = Json::parse(calot({"golden", "test", "--json"}).out);
  EXPECT_EQ(json["frames"][1]["verdict"], "missing");  // t000.20s
  EXPECT_EQ(json["frames"][2]["verdict"], "stale");    // t000.40s
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
  EXPECT_FALSE(fs::exists(golden("t000.40s.png")));
  EXPECT_EQ(calot({"golden", "test"}).code, 0);
}

TEST_F(GoldenProject, ABrokenSidecarIsNamed) {
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
  spill(golden("t000.40s.json"), "{");
  const Outcome outcome = calot({"golden", "test"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("t000.40s.json"), std::string::npos) << outcome.out;
}

TEST_F(GoldenProject, TheReportIsOnePageThatNeedsNothingElse) {
  ASSERT_EQ(calot({"golden", "accept", "small"}).code, 0);
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
