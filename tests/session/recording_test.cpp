#include "session/recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <limits>

#include "base/rng.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

class RecordingFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "calot-recording-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    path_ = (folder_ / "recording.jsonl").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  static RecordingHeader header() {
    RecordingHeader header;
    header.scenario = "grasp-and-traction";
    header.file = "scenarios/\"odd\" name.lua";
    header.source_hash = 0x0123456789abcdefULL;
    header.seed = std::numeric_limits<std::uint64_t>::max();
    header.params = {{"anatomy", "hydrops"}};
    header.rate = 50;
    header.instruments = {"left", "right"};
    header.toolchain = "GNU 12.2.0";
    header.instruction_set = "x86-64-v3";
    header.state_hash = 0xfedcba9876543210ULL;
    return header;
  }

  void write(const std::vector<RecordedStep>& steps, const std::string& end) {
    Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
    ASSERT_TRUE(writer);
    for (const RecordedStep& step : steps) ASSERT_TRUE(writer->write(step));
    ASSERT_TRUE(end.empty() || writer->finish(end));
  }

  void append(const std::string& text) { std::ofstream(path_, std::ios::app) << text; }

  /// The failure's text; empty where the file could be read.
  std::string complaint() {
    const Result<Recording> recording = read_recording(path_);
    return recording ? "" : to_text(recording.failure());
  }

  fs::path folder_;
  std::string path_;
};

std::vector<RecordedStep> random_steps(int count) {
  Rng rng(3);
  std::vector<RecordedStep> steps;
  for (int i = 0; i < count; ++i) {
    RecordedStep step;
    step.time = (i + 1) / 50.0;
    for (int k = 0; k < 2; ++k) {
      step.input.instruments.push_back(
          {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform() / 3, rng.uniform(-9, 9), rng.uniform()});
    }
    step.state_hash = rng.next();
    steps.push_back(step);
  }
  return steps;
}

TEST_F(RecordingFile, ReadsBackTheSameBits) {
  std::vector<RecordedStep> steps = random_steps(50);
  steps[0].input.instruments[0] = {-0.0, std::numeric_limits<double>::denorm_min(), 1.0 / 3, 1e300, 5e-324};
  write(steps, "done");
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << complaint();
  EXPECT_EQ(recording->end, "done");
  EXPECT_EQ(recording->header.file, header().file);
  EXPECT_EQ(recording->header.seed, header().seed);
  EXPECT_EQ(recording->header.source_hash, header().source_hash);
  EXPECT_EQ(recording->header.params, header().params);
  EXPECT_EQ(recording->header.instruments, header().instruments);
  ASSERT_EQ(recording->steps.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(recording->steps[i].state_hash, steps[i].state_hash);
    for (std::size_t k = 0; k < 2; ++k) {
      const InstrumentPose &a = recording->steps[i].input.instruments[k], &b = steps[i].input.instruments[k];
      for (const auto& [x, y] : {std::pair{a.pitch, b.pitch},
                                 {a.yaw, b.yaw},
                                 {a.insertion, b.insertion},
                                 {a.roll, b.roll},
                                 {a.jaw, b.jaw}}) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y));
      }
    }
  }
}

TEST_F(RecordingFile, IsCompleteOnDiskAfterEveryStep) {
  Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
  ASSERT_TRUE(writer);
  std::size_t written = 0;
  for (const RecordedStep& step : random_steps(5)) {
    ASSERT_TRUE(writer->write(step));
    const Result<Recording> recording = read_recording(path_);  // while the writer still holds it open
    ASSERT_TRUE(recording);
    EXPECT_EQ(recording->steps.size(), ++written);
    EXPECT_EQ(recording->end, "");
  }
}

TEST_F(RecordingFile, ALastLineCutShortIsDropped) {
  write(random_steps(3), "");
  append("{\"time_s\":0.08,\"poses\":[[0.1,0.");
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << complaint();
  EXPECT_EQ(recording->steps.size(), 3u);
}

TEST_F(RecordingFile, WhatIsWrongIsNamedByFileAndLine) {
  write(random_steps(3), "");
  append("{\"time_s\":0.08,\"poses\":[[0.1,0.2,0.3,0.4]],\"state_hash\":\"00\"}\n");
  EXPECT_NE(complaint().find(path_ + ":5:"), std::string::npos) << complaint();
  EXPECT_NE(complaint().find("5 numbers"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, OneInstrumentTooFewIsRefused) {
  write({}, "");
  append("{\"time_s\":0.02,\"poses\":[[0,0,0,0,0]],\"state_hash\":\"00\"}\n");
  EXPECT_NE(complaint().find("1 poses where the header names 2"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, MissingStepsAreNoticedByTheLastLine) {
  write(random_steps(2), "");
  append("{\"end\":\"done\",\"steps\":3}\n");
  EXPECT_NE(complaint().find("3 steps were recorded, 2 are here"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, OtherFilesAreRefusedForWhatTheyAre) {
  append("return calot.exercise {\n");
  EXPECT_NE(complaint().find(path_ + ":1:"), std::string::npos) << complaint();
  fs::remove(path_);
  append("");
  EXPECT_NE(complaint().find("empty"), std::string::npos) << complaint();
  fs::remove(path_);
  EXPECT_NE(complaint().find("cannot read"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, AFolderThatDoesNotExistIsAUsageError) {
  const Result<RecordingWriter> writer =
      RecordingWriter::create((folder_ / "none" / "r.jsonl").string(), header());
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.failure().kind, FailureKind::usage);
}

}  // namespace
}  // namespace calot
