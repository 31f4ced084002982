#include "session/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/rng.h"
#include "support/text_files.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

class RecordingFile : public ::testing::Test {
 protected:
  void SetUp() override { path_ = (folder_ / "recording.jsonl").string(); }

  static RecordingHeader header() {
    RecordingHeader header;
    header.scenario = "grasp-and-traction";
    header.file = "scenarios/\"odd\" name.lua";
    header.source_hash = 0x0123456789abcdefULL;
    header.exercise_hash = 0xfeedULL << 48;
    header.measures = header.scoring = 1;
    header.seed = std::numeric_limits<std::uint64_t>::max();
    header.params = {{"anatomy", "hydrops"}};
    header.rate = 50;
    header.instruments = {"left", "right"};
    header.make = {"GNU 12.2.0", "x86-64-v3", "glibc 2.36"};
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

  const test::Folder home_;
  const fs::path folder_ = home_.path();
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
  EXPECT_EQ(recording->header.exercise_hash, header().exercise_hash);
  EXPECT_EQ(recording->header.measures, header().measures);
  EXPECT_EQ(recording->header.scoring, header().scoring);
  EXPECT_EQ(recording->header.seed, header().seed);
  EXPECT_EQ(recording->header.source_hash, header().source_hash);
  EXPECT_EQ(recording->header.params, header().params);
  EXPECT_EQ(recording->header.make, header().make);
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

TEST_F(RecordingFile, SaysWhoOperatedWhenAndByWhatAndWhatDoesNotFitIsRefused) {
  RecordingHeader exam = header();
  exam.attempt = begin_attempt({.source = "lines", .mode = "exam", .trainee = "T-07", .number = 2});
  EXPECT_NE(begin_attempt({}).session, exam.attempt.session) << "no two sessions are one";
  const auto write_it = [&](const RecordingHeader& given) {
    Result<RecordingWriter> writer = RecordingWriter::create(path_, given);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write(random_steps(1)[0]));
  };
  write_it(exam);
  ASSERT_TRUE(read_recording(path_)) << complaint();
  EXPECT_EQ(read_recording(path_)->header.attempt, exam.attempt);
  EXPECT_EQ(read_recording(path_)->header.version, 3);
  EXPECT_FALSE(exam.attempt.began.empty() || exam.attempt.machine.empty());
  const std::tuple<void (*)(Attempt&), const char*> wrong[] = {
      {[](Attempt& a) { a.mode = "exams"; }, "did you mean \"exam\"?"},
      {[](Attempt& a) { a.source = "line"; }, "did you mean \"lines\"?"},
      {[](Attempt& a) { a.session = "12"; }, "session must be 32 lower-case hexadecimal digits"},
      {[](Attempt& a) { a.trainee = "Anna Muster"; }, "trainee is no pseudonym"},
      {[](Attempt& a) { a.began = "yesterday"; }, "began must be a time such as"}};
  for (const auto& [change, words] : wrong) {
    RecordingHeader bad = exam;
    change(bad.attempt);
    write_it(bad);
    EXPECT_NE(complaint().find(words), std::string::npos) << words << ": " << complaint();
  }
}

Measured small_measured() {
  Measured measured;
  measured.metrics = {{"left.path_length_mm", 1.0 / 3}, {"note.depth", -0.0}};
  measured.progress.begin_step(0, "only", "The \"only\" step", {30});
  WorldEvent pull;
  pull.kind = EventKind::overforce;
  pull.time = 0.1 + 0.2;
  pull.instrument = "left";
  pull.value = 5.1;
  measured.progress.add_event(pull);
  for (const auto& value : {std::variant<double, bool, std::string>(1e-3), {true}, {std::string("deep")}})
    measured.progress.add_note({0.2, "", "depth", value, "m"});
  measured.progress.end_step(2, "done");
  measured.progress.begin_step(2, "next", "Never ended", {0});
  measured.notes = {"something is less accurate"};
  return measured;
}

TEST_F(RecordingFile, WhatWasMeasuredIsReadBackAsTheSameBits) {
  Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
  for (const RecordedStep& step : random_steps(100)) ASSERT_TRUE(writer->write(step));  // 2 s
  const Measured measured = small_measured();
  ASSERT_TRUE(writer->write(measured) && writer->finish("done"));
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << complaint();
  ASSERT_TRUE(recording->measured);
  EXPECT_EQ(measured_json(*recording->measured), measured_json(measured));
  EXPECT_EQ(recording->measured->metrics, measured.metrics);
  EXPECT_EQ(recording->measured->progress.running()->name, "next");
  EXPECT_EQ(recording->measured->progress.events()[0].time, 0.1 + 0.2);
  EXPECT_EQ(recording->steps.size(), 100u);
}

TEST_F(RecordingFile, WhatWasMeasuredAfterItsStepsIsRefused) {
  Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
  for (const RecordedStep& step : random_steps(99)) ASSERT_TRUE(writer->write(step));
  ASSERT_TRUE(writer->write(small_measured()) && writer->finish("done"));
  EXPECT_NE(complaint().find("not of these steps: step only is of 2 s, and the steps end at 1.98 s"),
            std::string::npos)
      << complaint();
}

TEST_F(RecordingFile, WhatWasMeasuredCountsOnlyInAWholeRecordingAndOnlyBehindItsSteps) {
  Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
  const std::vector<RecordedStep> steps = random_steps(3);
  ASSERT_TRUE(writer->write(steps[0]) && writer->write(small_measured()));
  const Result<Recording> cut = read_recording(path_);
  ASSERT_TRUE(cut) << complaint();
  EXPECT_FALSE(cut->measured);
  EXPECT_TRUE(cut_note(cut.value()));
  ASSERT_TRUE(writer->write(steps[1]));
  EXPECT_NE(complaint().find("jsonl:4: there is more between what was measured"), std::string::npos)
      << complaint();
}

TEST_F(RecordingFile, EveryMistakeInWhatWasMeasuredIsNamed) {
  write(random_steps(1), "");
  append(
      R"({"measured":{"exercise_hash":"1","metrics":{"a":"b"},"steps":7,"events":[{"event":"sneeze","time_s":1,)"
      R"("step":"x","force":1}],"noted":[{"name":"a","unit":"","time_s":0,"step":"","value":[]}],"notes":[]}})"
      "\n");
  const std::string said = complaint();
  for (const char* part :
       {"exercise_hash is not known here", "metrics: a must be a number", "steps must be a list",
        "events[0].event is of no kind", "events[0].force is not known", "noted[0].value must"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " is missing in\n" << said;
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

/// What a reader hears of a recording that is not whole; empty where it takes it for whole.
std::string noticed(const std::string& path) {
  const Result<Recording> recording = read_recording(path);
  return recording ? cut_note(recording.value()).value_or("") : to_text(recording.failure());
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(RecordingFile, ACutRecordingSaysWhereItEnds) {
  constexpr int steps = 30;
  write(random_steps(steps), "done");
  const std::string whole = text_of(path_);
  EXPECT_EQ(noticed(path_), "");
  const auto cut_at = [&](std::size_t size) {
    std::ofstream(path_, std::ios::binary) << whole.substr(0, size);
    return noticed(path_);
  };
  EXPECT_NE(cut_at(0).find("it is empty"), std::string::npos);
  int lines = 0;
  for (std::size_t end = whole.find('\n'); end + 1 < whole.size(); end = whole.find('\n', end + 1)) {
    const std::string where = fmt::format("stops at step {} ({:.3f} s)", lines, lines / 50.0);
    EXPECT_NE(cut_at(end + 1).find(where), std::string::npos) << noticed(path_);
    // In the middle of the line after.
    EXPECT_NE(cut_at(end + 1 + (whole.find('\n', end + 1) - end) / 2).find(where), std::string::npos);
    ++lines;
  }
  EXPECT_EQ(lines, steps + 1) << "header and steps";
  EXPECT_NE(cut_at(whole.find('\n') / 2).find(path_ + ":1: this ends in the middle"), std::string::npos);
  EXPECT_EQ(cut_at(whole.size() - 1), "") << "of the last line end, nothing depends";
}

TEST_F(RecordingFile, ALineThatIsMissingOrTwiceThereIsNoticed) {
  write(random_steps(30), "done");
  const std::string whole = text_of(path_);
  std::size_t begin = 0;
  for (std::size_t end = whole.find('\n'); end != std::string::npos; end = whole.find('\n', begin)) {
    std::string missing = whole, twice = whole;
    missing.erase(begin, end + 1 - begin);
    twice.insert(begin, whole.substr(begin, end + 1 - begin));
    for (const std::string& text : {missing, twice}) {
      std::ofstream(path_, std::ios::binary) << text;
      EXPECT_NE(noticed(path_), "") << "line at byte " << begin;
    }
    begin = end + 1;
  }
}

TEST_F(RecordingFile, EveryFlippedBitIsNoticed) {
  {
    Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
    for (const RecordedStep& step : random_steps(20)) ASSERT_TRUE(writer->write(step));
    ASSERT_TRUE(writer->write(small_measured()) && writer->finish("done"));
  }
  const std::string whole = text_of(path_);
  Rng rng(11);
  for (int i = 0; i < 500; ++i) {
    const std::size_t at = rng.next() % whole.size();
    const unsigned bit = rng.next() % 8;
    std::string text = whole;
    text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << bit));
    std::ofstream(path_, std::ios::binary) << text;
    EXPECT_NE(noticed(path_), "") << "bit " << bit << " of byte " << at << ", " << whole.substr(at, 20);
  }
}

TEST_F(RecordingFile, PosesFromElsewhereNeedNoHashes) {
  append(R"({"schema":"calot.recording/1","scenario":"small","rate_Hz":50,"instruments":["left"]})"
         "\n"
         R"({"time_s":0.02,"poses":[[0.1,0.2,0.03,0,0]]})"
         "\n"
         R"({"end":"done","steps":1})"
         "\n");
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << complaint();
  EXPECT_FALSE(recording->header.state_hash);
  ASSERT_EQ(recording->steps.size(), 1u);
  EXPECT_EQ(recording->steps[0].input.instruments[0].insertion, 0.03);
  EXPECT_EQ(noticed(path_), "");
}

TEST_F(RecordingFile, ActionsAreWrittenWhereSomethingActsAndReadBack) {
  using enum InstrumentAction;
  RecordedStep step{0.02, {{{0.1, 0.2, 0.03, 0, 0}, {0, 0, 0.03, 0, 0}}, {none, none}}, 1};
  RecordedStep acts = step;
  acts.time = 0.04;
  acts.input.actions = {none, activate};
  write({step, acts}, "done");
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << complaint();
  EXPECT_TRUE(recording->steps[0].input.actions.empty());
  EXPECT_EQ(recording->steps[1].input.actions, acts.input.actions);
}

TEST_F(RecordingFile, ARecordingOfVersionOneIsReadAndKnowsNoActions) {
  const std::string head = R"(,"scenario":"small","rate_Hz":50,"instruments":["left"]})"
                           "\n";
  const std::string step = R"({"time_s":0.02,"poses":[[0,0,0.03,0,0]])";
  const auto said = [&](int version, const std::string& actions) {
    std::ofstream(path_) << R"({"schema":"calot.recording/)" << version << '"' << head << step << actions
                         << "}\n"
                         << R"({"end":"done","steps":1})"
                            "\n";
    return complaint();
  };
  EXPECT_EQ(said(1, ""), "");
  EXPECT_NE(said(1, R"(,"actions":["activate"])").find("actions is not known here"), std::string::npos);
  EXPECT_EQ(said(2, R"(,"actions":["activate"])"), "");
  EXPECT_NE(said(2, R"(,"actions":["activat"])").find("\"activat\" is no action; did you mean \"activate\"?"),
            std::string::npos);
  EXPECT_NE(said(2, R"(,"actions":["none","none"])").find("2 actions for 1 instruments"), std::string::npos);
  EXPECT_EQ(said(3, ""), "");
  EXPECT_NE(
      said(4, "").find("not a recording of schema calot.recording/1, calot.recording/2, calot.recording/3"),
      std::string::npos);
}

TEST_F(RecordingFile, AnErrorIsNeverThatOfALibrary) {
  constexpr int deep = 400'000;  // levels: more than a stack of 8 MiB has room for
  const std::string head =
      R"({"schema":"calot.recording/1","scenario":"small","rate_Hz":50,"instruments":["left"])";
  const std::string step = R"({"time_s":0.02,"poses":[[0,0,0,0,0]]})";
  const std::tuple<std::string, int, std::string> table[] = {
      {"\xff\xfe", 1, "not JSON at byte 1"},
      {"[]", 1, "not a recording of schema"},
      {"{\"schema\":7}", 1, "not a recording of schema"},
      {head + "}\n{\"time_s\":0.02,}\n", 2, "not JSON at byte 16"},
      {head + "}\n{\"time_s\":1e999,\"poses\":[]}\n", 2, "beyond what a double can be"},
      {head + "}\n{\"time_s\":0.02}\n", 2, "poses is missing"},
      {head + "}\n7\n", 2, "time_s is missing"},
      {head + "}\n{\"time_s\":0.02,\"poses\":{}}\n", 2, "poses must be a list"},
      {head + "}\n{\"time_s\":\"x\",\"poses\":[[0,0,0,0,0]]}\n", 2, "time_s must be a number, not \"x\""},
      {head + "}\n{\"time_s\":0.04,\"poses\":[[0,0,0,0,0]]}\n", 2, "time_s is 0.04, not 0.02"},
      {head + "}\n{\"time_s\":0.02,\"poses\":[[0,0,0,0,0]],\"pose\":1}\n", 2,
       "pose is not known here; did you mean \"poses\"?"},
      {head + ",\"seed\":-1}\n", 1, "seed must be a whole number that is not negative"},
      {head + ",\"params\":[1]}\n", 1, "params must be an object of texts"},
      {head + ",\"source_hash\":\"123\"}\n", 1, "source_hash must be sixteen lower-case hexadecimal digits"},
      {head + ",\"state_hash\":\"0000000000000000\"}\n" + step + "\n", 2, "state_hash is missing"},
      {head + "}\n" + step + "\n{\"end\":\"done\",\"steps\":-1}\n", 3, "steps must be a whole number"},
      {head + "}\n" + step + "\n{\"end\":\"gone\",\"steps\":1}\n", 3, "does not end as \"gone\""},
      {head + "}\n" + step + "\n{\"measured\":7}\n", 3, "exercise_hash is missing"},
      {head + "}\n" + step + "\n{\"measured\":{\"metrics\":" + std::string(deep, '[') +
           std::string(deep, ']') + "}}\n",
       3, "metrics must be an object of numbers"},
      {head + "}\n" + std::string(1 << 20, ' '), 2, "more than 1048575 bytes"},
      {"{\"schema\":" + std::string(deep, '[') + std::string(deep, ']') + "}\n", 1,
       "not a recording of schema"},
      {head + "}\n{\"time_s\":" + std::string(deep, '[') + std::string(deep, ']') +
           ",\"poses\":[[0,0,0,0,0]]}\n",
       2, "time_s must be a number, not a list"},
      {head + ",\"file\":\"" + std::string(5000, 'f') + "\"}\n", 1, "file has 5000 bytes, more than 4096"},
      {head + ",\"" + std::string(5000, 'k') + "\":1}\n", 1, "k... (5000 bytes) is not known here"},
      {R"({"schema":"calot.recording/1","scenario":"small","rate_Hz":0,"instruments":["left"]})", 1,
       "rate_Hz is 0"},
  };
  for (const auto& [text, line, words] : table) {
    std::ofstream(path_, std::ios::binary) << text;
    EXPECT_NE(complaint().find(fmt::format("{}:{}: ", path_, line)), std::string::npos)
        << words << ": " << complaint();
    EXPECT_NE(complaint().find(words), std::string::npos) << words << ": " << complaint();
    EXPECT_EQ(complaint().find("exception"), std::string::npos) << complaint();
  }
}

TEST_F(RecordingFile, OfManyProblemsAHundredAreTold) {
  write({}, "");
  std::string poses = "[]";
  for (int i = 1; i < 1000; ++i) poses += ",[]";
  append("{\"time_s\":0.02,\"poses\":[" + poses + "],\"state_hash\":\"0000000000000000\"}\n");
  const Result<Recording> recording = read_recording(path_);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.failure().problems.size(), 100u);
  EXPECT_NE(complaint().find("poses[98] needs 5 numbers"), std::string::npos);
  EXPECT_NE(complaint().find(":2: and 901 more problems"), std::string::npos);
}

TEST_F(RecordingFile, MoreThan128MebibytesAreRefusedAtTheLineThatIsTooMuch) {
  write({}, "");
  std::ofstream out(path_, std::ios::app);
  for (int line = 1; line <= 130; ++line) {  // of a mebibyte with its end; with the header 128 are too much
    const std::string step = fmt::format(
        R"({{"time_s":{},"poses":[[0,0,0,0,0],[0,0,0,0,0]],"state_hash":"0000000000000000"}})", line / 50.0);
    out << step << std::string((1 << 20) - 2 - step.size(), ' ') << "\n";
  }
  out.close();
  EXPECT_NE(complaint().find(path_ + ":129: the recording has more than 128 MiB"), std::string::npos)
      << complaint();
}

TEST_F(RecordingFile, ANameThatIsNotUtf8IsWrittenAndReadBack) {
  RecordingHeader odd = header();
  odd.file = "odd \xff name.lua";
  ASSERT_TRUE(RecordingWriter::create(path_, odd));
  EXPECT_EQ(complaint(), "");
}

TEST_F(RecordingFile, WhatIsWrongIsNamedByFileAndLine) {
  write(random_steps(3), "");
  append("{\"time_s\":0.08,\"poses\":[[0.1,0.2,0.3,0.4]],\"state_hash\":\"00\"}\n");
  EXPECT_NE(complaint().find(path_ + ":5:"), std::string::npos) << complaint();
  EXPECT_NE(complaint().find("5 numbers"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, OneInstrumentTooFewIsRefused) {
  write({}, "");
  append("{\"time_s\":0.02,\"poses\":[[0,0,0,0,0]],\"state_hash\":\"0000000000000000\"}\n");
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

TEST_F(RecordingFile, AnActThatIsNoneIsRefusedWithItsLine) {
  write({}, "");
  append(R"({"time_s":0.02,"poses":[[0,0,0.03,0,0],[0,0,0.03,0,0]],"acts":[{"act":"time_uot"}],)"
         R"("state_hash":"0123456789abcdef"})"
         "\n");
  EXPECT_NE(complaint().find(":2: \"time_uot\" is no act (did you mean"), std::string::npos) << complaint();
}

TEST_F(RecordingFile, EventsKeepPlaceCauseAndText) {
  WorldEvent event{EventKind::injury,   4.5,          "blades", "common_duct", 0, Vec3(0.1, -0.0, 1.0 / 3),
                   EventCause::current, "Strasberg E"};
  Measured measured;
  measured.progress.add_event(event);
  measured.progress.add_event({EventKind::slip, 5, "left", "", 2.5});
  Result<RecordingWriter> writer = RecordingWriter::create(path_, header());
  ASSERT_TRUE(writer);
  for (const RecordedStep& step : random_steps(250)) ASSERT_TRUE(writer->write(step));  // 5 s
  ASSERT_TRUE(writer->write(measured) && writer->finish("done"));
  const Result<Recording> recording = read_recording(path_);
  ASSERT_TRUE(recording) << to_text(recording.failure());
  const std::vector<SessionEvent>& events = recording->measured->progress.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(*events[0].place, *event.place);
  EXPECT_EQ(events[0].cause, EventCause::current);
  EXPECT_EQ(events[0].text, "Strasberg E");
  EXPECT_FALSE(events[1].place) << "as in recordings made before events had one";
  EXPECT_EQ(events[1].cause, EventCause::none);
}

}  // namespace
}  // namespace calot
