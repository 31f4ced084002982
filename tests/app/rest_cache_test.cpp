// What is kept from one start to the next: files that are whole or not there, of this program alone.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "process/loaded_code.h"
#include "process/result_files.h"
#include "program.h"

namespace calot::test {
namespace {

using ::testing::Optional;

class RestCache : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_ball_and(
        "name = 'duct', shape = { type = 'tube', radius = 2 * mm, points = { { 0, 0, 60 * mm }, { 0, 0, 75 * "
        "mm "
        "}, { 0, 0, 90 * mm } } }, held = { { name = 'root', landmark = 'start' }, { landmark = 'end' } }");
    setenv("CALOT_CACHE", cache().c_str(), 1);
  }
  void TearDown() override {
    setenv("CALOT_CACHE", "", 1);
    ProgramTest::TearDown();
  }
  /// A ball and another organ come to rest together.
  void write_ball_and(const std::string& organ) {
    std::string text = small_scenario();
    const std::string end = "{ landmark = \"bed\" } } } }";
    text.replace(text.find(end), end.size(), "{ landmark = \"bed\" } } }, { " + organ + " } }");
    spill(folder_ / "small.lua", text);
  }
  fs::path cache() const { return folder_ / "kept"; }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> out;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(cache(), none)) out.push_back(entry.path());
    return out;
  }
  /// The recording of a run, each of its states by its hash, but for what makes it a session of its own.
  std::string recording(const std::string& folder) {
    const Outcome run = calot({"run", "small.lua", "--no-render", "-o", folder});
    EXPECT_EQ(run.code, 0) << run.err;
    const std::string text = slurp(folder_ / folder / "recording.jsonl");
    const std::size_t session = text.find("\"session\""), make = text.find("\"toolchain\"");
    return text.substr(0, session) + text.substr(make, text.find("{\"end\"") - make);
  }
};

TEST_F(RestCache, AStateFoundOnDiskPlaysToTheSameBits) {
  setenv("CALOT_CACHE", "", 1);
  const std::string off = recording("off");
  EXPECT_TRUE(kept().empty()) << "switched off it keeps nothing";
  setenv("CALOT_CACHE", cache().c_str(), 1);
  EXPECT_EQ(recording("cold"), off);
  ASSERT_EQ(kept().size(), 1u);
  const std::string file = slurp(kept()[0]);
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24);
  fs::last_write_time(kept()[0], long_ago);
  EXPECT_EQ(recording("warm"), off);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_GT(fs::last_write_time(kept()[0]), long_ago) << "it was used";
  EXPECT_EQ(slurp(kept()[0]), file);
}

TEST_F(RestCache, ABrokenFileIsFoundAnew) {
  const std::string first = recording("first");
  ASSERT_EQ(kept().size(), 1u);
  const fs::path path = kept()[0];
  const std::string whole = slurp(path);
  std::string turned = whole;
  turned[whole.size() / 2] = static_cast<char>(turned[whole.size() / 2] ^ 1);
  for (const std::string& broken : {turned, whole.substr(0, whole.size() / 3), std::string("not ours")}) {
    spill(path, broken);
    EXPECT_EQ(recording("again"), first);
    EXPECT_EQ(slurp(path), whole);
  }
}

TEST_F(RestCache, ALobesReductionFoundOnDiskPlaysToTheSameBits) {
  write_ball_and(
      "name = 'liver', shape = { type = 'lobe', bed_width = 0, bed_depth = 0 }, neck = { -80 * mm, 150 * mm, "
      "-150 * mm }, fundus = { -80 * mm, 150 * mm, -110 * mm }, liver_side = { 0, 1, 0 }");
  setenv("CALOT_CACHE", "", 1);
  const std::string off = recording("off");
  setenv("CALOT_CACHE", cache().c_str(), 1);
  EXPECT_EQ(recording("cold"), off);
  EXPECT_EQ(recording("warm"), off);
  const std::vector<fs::path> both = kept();
  ASSERT_EQ(both.size(), 2u) << "the lobe's reduction, and how the two rest";
  for (const fs::path& one : both) {
    std::string broken = slurp(one);
    const std::string whole = broken;
    broken[whole.size() / 2] = static_cast<char>(broken[whole.size() / 2] ^ 1);
    spill(one, broken);
    EXPECT_EQ(recording("again"), off);
    EXPECT_EQ(slurp(one), whole);
  }
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(RestCache, AFolderThatCannotBeMadeIsNoError) {
  setenv("CALOT_CACHE", "/dev/null/kept", 1);
  const Outcome run = calot({"run", "small.lua", "--no-render", "-o", "out"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err.find("kept"), std::string::npos) << run.err;
}

TEST_F(RestCache, ConcurrentStartsBothWork) {
  const auto start = [&](const std::string& folder, const std::function<void(pid_t)>& meanwhile) {
    const Outcome run = calot({"check", "--build", "small.lua"}, meanwhile);
    EXPECT_EQ(run.code, 0) << folder << run.err;
  };
  start("one", [&](pid_t) { start("two", {}); });
  ASSERT_EQ(kept().size(), 1u) << "nothing half written is left";
  const std::string of_both = slurp(kept()[0]);
  fs::remove(kept()[0]);
  start("alone", {});
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_EQ(slurp(kept()[0]), of_both);
}

TEST_F(RestCache, AnotherProgramOrNameHasAnotherFile) {
  ResultFiles files(cache(), "program"), of_other(cache(), "another program");
  files.keep("name", "bytes");
  EXPECT_THAT(files.find("name"), Optional(std::string("bytes")));
  EXPECT_EQ(of_other.find("name"), std::nullopt);
  EXPECT_EQ(files.find("another name"), std::nullopt);
  fs::copy_file(files.file_of("name"), files.file_of("another name"));
  EXPECT_EQ(files.find("another name"), std::nullopt) << "moved, it is still the other's";
}

TEST_F(RestCache, TheProgramIsKnownByItsBuild) {
  const std::string code = loaded_code();
  EXPECT_EQ(code.size(), 64u);
  EXPECT_EQ(loaded_code(), code);
}

TEST_F(RestCache, TheOldestFilesGo) {
  ResultFiles files(cache(), "program");
  for (std::size_t k = 0; k < ResultFiles::most_files; ++k) {
    const std::string name = std::to_string(k);
    files.keep(name, "bytes");
    fs::last_write_time(files.file_of(name),
                        fs::file_time_type::clock::now() - std::chrono::minutes(100 - k));
  }
  EXPECT_TRUE(files.find("0")) << "used, it is the newest";
  files.keep("one more", "bytes");
  EXPECT_EQ(kept().size(), ResultFiles::most_files);
  EXPECT_TRUE(files.find("0"));
  EXPECT_FALSE(files.find("1"));
  EXPECT_TRUE(files.find("one more"));
  const fs::path part = cache() / "left.part";
  spill(part, "half");
  fs::last_write_time(part, fs::file_time_type::clock::now() - std::chrono::hours(2));
  files.keep("last", "bytes");
  EXPECT_FALSE(fs::exists(part));
}

TEST_F(RestCache, ItsFolderIsWhereTheUserSays) {
  EXPECT_EQ(results_folder(), cache());
  setenv("CALOT_CACHE", "", 1);
  EXPECT_TRUE(results_folder().empty());
}

}  // namespace
}  // namespace calot::test
