// Clips and cuts of a scenario's demo, on one tube.

#include <gtest/gtest.h>

#include "lua/scenario_files.h"
#include "session/metrics.h"
#include "session/recording.h"
#include "session/runner.h"

namespace calot {
namespace {

using test::Folder;

/// A duct across the way of an applier and of scissors, which come to it from above.
test::ScenarioText clipped_duct(const std::string& demo) {
  test::ScenarioText text;
  text.scene =
      "return { anatomy = { table_head_up = 0, table_left_down = 0, organs = {\n"
      "  { name = 'duct', shape = { type = 'tube', radius = 1.8 * mm, patient_end = 'start', points = {\n"
      "      { 0, -20 * mm, -100 * mm }, { 0, 0, -100 * mm }, { 0, 20 * mm, -100 * mm } } },\n"
      "    wall = { thickness = 0.8 * mm, density = 1050 },\n"
      "    held = { { name = 'a', landmark = 'start', radius = 4 * mm, stiffness = 1e6 },\n"
      "             { name = 'b', landmark = 'end', radius = 4 * mm, stiffness = 1e6 } } } } },\n"
      "ports = { one = { 0, -6 * mm, 0 }, two = { 30 * mm, 0, 0 } },\n"
      "laparoscope = { look_at = 'duct.middle' }, solver = { motion = 'dynamic', rate = 25 },\n"
      "instruments = { applier = { type = 'clip_applier', port = 'one', clips = 3 },\n"
      "                blades = { type = 'scissors', port = 'two' } } }";
  text.steps =
      "t:step('divide', 'Divide the duct')\n"
      "t:wait_until(function() return t:divided('duct') end)\n"
      "local clips = t:clips('duct.patient')\n"
      "t:note('clips', #clips)\n t:note('opening', clips[1] and clips[1].opening or 1)\n"
      "t:note('size', clips[1] and clips[1].size or 'none')\n"
      "t:note('left', t.applier:clips_left())";
  text.demo = demo;
  return text;
}

const char* const clip_it =
    "t.applier:open(28 * deg) t.applier:move_to({ 0, -6 * mm, -105 * mm }, { speed = 200 * mm / s })\n"
    "t.applier:fire() t.applier:move_by({ 0, 0, 60 * mm }, { speed = 200 * mm / s })\n";
const char* const cut_it =
    "t.blades:open(40 * deg) t.blades:move_to({ 0, 0, -106 * mm }, { speed = 200 * mm / s }) "
    "t.blades:close()\n";

SessionResult played(const test::ScenarioText& text, RecordingWriter* recording = nullptr) {
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  EXPECT_TRUE(script) << to_text(script.failure());
  if (!script) return {};
  World world = World::create(script.value()->definition().scene).value();
  SessionOptions options;
  options.recording = recording;
  return run_session(world, *script.value(), script.value()->demo(), options);
}

double noted(const SessionResult& result, const std::string& name) {
  const auto found = result.metrics.find("note." + name);
  return found == result.metrics.end() ? -1 : found->second;
}

TEST(Clipping, AStepSeesTheClipsOnThePiecesOfWhatWasDivided) {
  const SessionResult result = played(clipped_duct(std::string(clip_it) + cut_it));
  EXPECT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_EQ(noted(result, "clips"), 1);
  EXPECT_EQ(noted(result, "opening"), 0);
  EXPECT_EQ(noted(result, "left"), 2);
  EXPECT_EQ(result.metrics.at("applier.clips"), 1);
  EXPECT_EQ(result.metrics.at("blades.cuts"), 1);
  EXPECT_EQ(result.metrics.at("blades.cuts_unclipped"), 0);
}

/// The same through one port.
test::ScenarioText through_one_port(const std::string& demo) {
  test::ScenarioText text = clipped_duct(demo);
  const std::string one = "port = 'one'", two = "port = 'two' }";
  text.scene.replace(text.scene.find(one), one.size(), "port = 'two'");
  text.scene.replace(text.scene.find(two), two.size(), "port = 'two', waits = true }");
  return text;
}

TEST(Clipping, ThroughOnePortInstrumentsAreExchanged) {
  const SessionResult result = played(through_one_port(
      "t.applier:open(28 * deg) t.applier:move_to({ 0, -6 * mm, -105 * mm }, { speed = 200 * mm / s })\n"
      "t.applier:fire()\n"
      "assert(t.blades:waits() and not t.applier:waits())\n"
      "t.blades:exchange({ duration = 0.2 * s })\n"
      "assert(t.applier:waits() and not t.blades:waits())\n" +
      std::string(cut_it)));
  EXPECT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_EQ(noted(result, "clips"), 1);
  EXPECT_EQ(result.metrics.at("blades.cuts"), 1);
  // From 30 mm deep to the duct and back: what comes in does not go the way of what goes out.
  EXPECT_NEAR(result.metrics.at("applier.path_length_mm"), 2 * (std::hypot(30, 6, 105) - 30), 5);
  EXPECT_NEAR(result.metrics.at("blades.path_length_mm"), std::hypot(30, 106) - 30, 5);
}

TEST(Clipping, AnInstrumentThatWaitsIsNotMovedAndOneThatIsInDoesNotComeIn) {
  const auto complaint = [](const std::string& demo) {
    const Folder folder;
    const Result<std::unique_ptr<ExerciseScript>> script =
        test::load_text(folder, through_one_port(demo).text());
    return script ? std::string("none") : to_text(script.failure());
  };
  EXPECT_NE(complaint("t.blades:close()").find("blades waits outside: applier is in its port"),
            std::string::npos);
  EXPECT_NE(complaint("t.blades:exchange() t.applier:fire() t.applier:open()").find("applier waits outside"),
            std::string::npos);
  EXPECT_NE(complaint("t.applier:exchange()").find("applier is in its port already"), std::string::npos);
  EXPECT_EQ(complaint("t.blades:exchange() t.blades:open() t.applier:exchange() t.applier:open()"), "none");
}

TEST(Clipping, ARecordingOfItIsPlayedAgainToTheSameBits) {
  const test::ScenarioText text = clipped_duct(std::string(clip_it) + cut_it);
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> script = test::load_text(folder, text.text());
  ASSERT_TRUE(script);
  const std::string path = folder.path() / "recording.jsonl";
  World world = World::create(script.value()->definition().scene).value();
  Result<RecordingWriter> writer =
      RecordingWriter::create(path, recording_header(script.value()->definition(), world, "x.lua"));
  ASSERT_TRUE(writer);
  SessionOptions options;
  options.recording = &writer.value();
  const SessionResult first = run_session(world, *script.value(), script.value()->demo(), options);
  const Result<Recording> recording = read_recording(path);
  ASSERT_TRUE(recording) << to_text(recording.failure());
  Result<std::unique_ptr<ExerciseScript>> again = test::load_text(folder, text.text());
  World second = World::create(again.value()->definition().scene).value();
  ReplaySource source(recording.value());
  const SessionResult replayed = run_session(second, *again.value(), source, {});
  EXPECT_GT(first.state_hashes.size(), 10u);
  EXPECT_EQ(replayed.state_hashes, first.state_hashes);
  EXPECT_TRUE(second.organ("duct.patient"));
}

TEST(Clipping, CutFirstIsCountedAsThat) {
  const SessionResult result = played(clipped_duct(cut_it));
  EXPECT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_EQ(result.metrics.at("blades.cuts_unclipped"), 1);
  EXPECT_EQ(noted(result, "clips"), 0);
}

TEST(Clipping, WhatAnInstrumentCannotDoIsSaidAtItsLine) {
  const auto complaint = [](const std::string& demo) {
    const Folder folder;
    const auto script = test::load_text(folder, clipped_duct(demo).text());
    return script ? std::string() : to_text(script.failure());
  };
  EXPECT_NE(complaint("t.blades:fire()").find("fire is for what can fire, which blades cannot"),
            std::string::npos)
      << complaint("t.blades:fire()");
  EXPECT_NE(complaint("t.applier:open(50 * deg)").find("a clip_applier opens by 36"), std::string::npos)
      << complaint("t.applier:open(50 * deg)");
  test::ScenarioText text = clipped_duct("t:wait(1 * s)");
  text.scene.replace(text.scene.find("type = 'scissors'"), 0, "clips = 2, ");
  const Folder folder;
  const auto script = test::load_text(folder, text.text());
  ASSERT_FALSE(script);
  EXPECT_NE(to_text(script.failure()).find("its type scissors sets no clips"), std::string::npos)
      << to_text(script.failure());
}

}  // namespace
}  // namespace calot
