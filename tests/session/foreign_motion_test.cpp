// Motion from elsewhere: the same in every format, each broken row refused by its number, trocars found.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>

#include "base/units.h"
#include "input/registration.h"
#include "session/session_for_tests.h"
#include "support/text_files.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

using units::mm;
constexpr int moments = 40;

class ForeignFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (folder_.path() / "motion").string();
    registration_.exercise = "small";
    registration_.unit = mm;
    // Theirs is turned by 90 degrees about the patient's z, and then about its x.
    registration_.x_axis = {0, 1, 0};
    registration_.y_axis = {0, 0, 1};
    registration_.z_axis = {1, 0, 0};
    tool_.name = "left";
    tool_.source = "LeftToTrackerTransform";
    tool_.port = Vec3(12, -7, 30);
    tool_.jaw_closed = 100;
    tool_.jaw_open = 300;
  }

  /// A smooth motion, one pose each 20 ms.
  static InstrumentPose pose(int k) {
    const double t = k / 50.0;
    return {0.4 + 0.2 * std::sin(2 * t), -0.3 + 0.3 * t, 0.12 + 0.02 * t, 3 + 2 * t, 0.5 + 0.2 * t};
  }
  Mat3 axes() const {
    Mat3 axes;
    axes << registration_.x_axis, registration_.y_axis, registration_.z_axis;
    return axes;
  }
  /// The tool's frame as they see it: where its tip is (mm), its axes.
  Vec3 tip(int k) const {
    return *tool_.port + axes().transpose() * tip_position(Vec3::Zero(), pose(k), geometry_) / mm;
  }
  Mat3 frame(int k) const {
    return axes().transpose() * hinge_frame(Vec3::Zero(), pose(k), geometry_).linear();
  }
  double jaw(int k) const { return 100 + 200 * pose(k).jaw / geometry_.jaw_opening; }

  void write(const std::function<std::string(int)>& row, const std::string& head = "", int each = 1) const {
    std::ofstream out(path_);
    out << head;
    for (int k = 0; k < moments; k += each) out << row(k);
  }
  static std::string numbers(std::vector<double> values) {
    return fmt::format("{:.12g}", fmt::join(values, " "));
  }

  void write_csv() {
    registration_.format = MotionFormat::csv;
    write(
        [&](int k) {
          const Vec3 at = tip(k), along = 3 * frame(k).col(2);
          return fmt::format(
              "{:.12g};\"{}\";{:.12g};{:.12g};{:.12g};{:.12g};{:.12g};{:.12g};{:.12g};{:.12g};x\r\n", jaw(k),
              tool_.source, 5 + k / 50.0, at.x(), at.y(), at.z(), along.x(), along.y(), along.z(),
              pose(k).roll);
        },
        "jaw;instrument;\"Time (s)\";tip_x;tip_y;tip_z;dir_x;dir_y;dir_z;roll;remark\r\n");
    registration_.columns.time = "Time (s)";
  }
  void write_jigsaws() {
    registration_.format = MotionFormat::jigsaws;
    registration_.time_step = 0.02;
    tool_.source = "slave_left";
    write([&](int k) {
      const Vec3 at = tip(k);
      const Mat3 r = frame(k).transpose();  // Eigen's columns are their rows
      std::vector<double> row(38, 7);
      row.insert(row.end(), {at.x(), at.y(), at.z()});
      row.insert(row.end(), r.data(), r.data() + 9);
      row.insert(row.end(), 6, 0);
      row.push_back(jaw(k));
      row.insert(row.end(), 19, 0);
      return numbers(row) + "  \n";
    });
  }
  void write_sequence() {
    registration_.format = MotionFormat::sequence;
    tool_.jaw = "LeftJaw";
    write(
        [&](int k) {
          Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
          m.topLeftCorner<3, 3>() = frame(k);
          m.topRightCorner<3, 1>() = tip(k);
          const Eigen::Matrix4d rows = m.transpose();
          const std::string name = fmt::format("Seq_Frame{:04}_", k);
          return name + "LeftToTrackerTransform = " + numbers({rows.data(), rows.data() + 16}) + " \n" +
                 name + "LeftToTrackerTransformStatus = OK\n" + name +
                 fmt::format("Timestamp = {:.12g}\n", 9 + k / 50.0) + name +
                 fmt::format("LeftJaw = {:.12g}\n", jaw(k));
        },
        "ObjectType = Image\nNDims = 3\n");
    std::ofstream(path_, std::ios::app) << "ElementDataFile = LOCAL\n" << std::string("\0\xff\n=", 4);
  }

  Result<ImportedRecording> imported() {
    registration_.instruments = {tool_};
    const Result<ForeignMotion> motion = read_foreign_motion(path_, registration_);
    if (!motion) return motion.failure();
    return to_recording(motion.value(), registration_, test::small_exercise());
  }
  std::string complaint() {
    const Result<ImportedRecording> result = imported();
    return result ? "" : to_text(result.failure());
  }
  void edit(int line, const std::string& from, const std::string& to) const {
    std::ifstream in(path_);
    std::string all, text;
    for (int k = 1; std::getline(in, text); ++k) {
      if (k == line) {
        ASSERT_NE(text.find(from), std::string::npos) << text;
        text.replace(text.find(from), from.size(), to);
      }
      all += text + '\n';
    }
    std::ofstream(path_) << all;
  }

  const InstrumentGeometry geometry_ = instrument_geometry(InstrumentType::atraumatic_grasper);
  Registration registration_;
  ForeignInstrument tool_;
  const test::Folder folder_;
  std::string path_;
};

/// The motion of `pose` after the way in, whose roll may be whole turns off.
void expect_motion(const ImportedRecording& result, const std::function<InstrumentPose(int)>& expected,
                   double slack) {
  const std::vector<RecordedStep>& steps = result.recording.steps;
  ASSERT_GE(steps.size(), static_cast<std::size_t>(moments));
  const std::size_t lead = steps.size() - moments;
  EXPECT_EQ(lead, 45u) << "from 30 to 120 mm at 100 mm/s";
  const double turns = steps[lead].input.instruments[0].roll - expected(0).roll;
  EXPECT_NEAR(std::remainder(turns, 2 * std::numbers::pi), 0, slack);
  for (int k = 0; k < moments; ++k) {
    const RecordedStep& step = steps[lead + static_cast<std::size_t>(k)];
    const InstrumentPose &found = step.input.instruments[0], wanted = expected(k);
    EXPECT_NEAR(found.pitch, wanted.pitch, slack) << k;
    EXPECT_NEAR(found.yaw, wanted.yaw, slack) << k;
    EXPECT_NEAR(found.insertion, wanted.insertion, slack) << k;
    EXPECT_NEAR(found.roll - turns, wanted.roll, slack) << k;
    EXPECT_NEAR(found.jaw, wanted.jaw, slack) << k;
  }
}

TEST_F(ForeignFile, TheSameMotionIsTheSameRecordingFromEveryFormat) {
  const double digits = 1e-9;  // twelve digits of 100 mm, and of the angles that they give
  const std::vector<std::function<void()>> formats{[this] { write_csv(); }, [this] { write_jigsaws(); },
                                                   [this] { write_sequence(); }};
  for (const auto& write_format : formats) {
    write_format();
    const Result<ImportedRecording> result = imported();
    ASSERT_TRUE(result) << to_text(result.failure());
    expect_motion(result.value(), pose, digits);
    tool_.source = "LeftToTrackerTransform";
  }
}

TEST_F(ForeignFile, PivotAnglesAreTakenAsTheyAreInTheirUnits) {
  registration_.angle_unit = std::numbers::pi / 180;
  const double deg = registration_.angle_unit;
  tool_.jaw_closed = tool_.jaw_open = std::nullopt;
  write(
      [&](int k) {
        const InstrumentPose p = pose(k);
        return fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", k / 50.0, p.pitch / deg,
                           p.yaw / deg, p.insertion / mm, p.roll / deg, p.jaw / deg);
      },
      "time,pitch,yaw,insertion,roll,jaw\n");
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result) << to_text(result.failure());
  expect_motion(result.value(), pose, 1e-9);
}

TEST_F(ForeignFile, BetweenRowsItGoesStraightAndInstrumentsComeInFromTheirTrocars) {
  write([&](int k) { return fmt::format("{},0,0,{},0,0\n", 2 + k / 50.0, 100 + k); },
        "time,pitch,yaw,insertion,roll,jaw\n", 5);  // 10 Hz
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result) << to_text(result.failure());
  const std::vector<RecordedStep>& steps = result->recording.steps;
  EXPECT_EQ(result->recording.end, "source_ended");
  EXPECT_EQ(result->recording.header.scenario, "small");
  EXPECT_NEAR(steps.front().input.instruments[0].insertion, 0.030, 1e-12);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const double way = steps[i].input.instruments[0].insertion - steps[i - 1].input.instruments[0].insertion;
    EXPECT_NEAR(way, steps[i].input.instruments[0].insertion < 0.1 + 1e-9 ? lead_in_speed / 50 : 1 * mm,
                1e-12)
        << i;
    EXPECT_NEAR(steps[i].time, static_cast<double>(i + 1) / 50, 1e-12);
  }
  EXPECT_NE(result->notes.back().find("go in from their trocars, for 0.70 s"), std::string::npos);
}

TEST_F(ForeignFile, ATrocarIsFoundWhereAllShaftsMeet) {
  write_csv();
  const Vec3 port = *tool_.port;
  tool_.port.reset();
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result) << to_text(result.failure());
  // Directions of twelve digits, drawn out to 100 mm and divided by how far they turn, 0.2 rad.
  expect_motion(result.value(), pose, 1e-8);
  EXPECT_NE(result->notes[0].find(
                fmt::format("found at {{ {:.4g}, {:.4g}, {:.4g} }}", port.x(), port.y(), port.z())),
            std::string::npos)
      << result->notes[0];
  write([&](int k) { return fmt::format("{},0,0,{},0,0,1\n", k / 50.0, k); },
        "time,tip_x,tip_y,tip_z,dir_x,dir_y,dir_z\n");
  registration_.columns.time = "time";
  EXPECT_NE(complaint().find("cannot be found from shafts that hardly turn"), std::string::npos)
      << complaint();
}

TEST_F(ForeignFile, EveryBrokenRowIsRefusedWithItsNumber) {
  const auto expect_said = [&](const std::string& what) {
    const std::string said = complaint();
    EXPECT_NE(said.find(what), std::string::npos) << what << " is missing in\n" << said;
  };
  write_csv();
  edit(7, ";x", ";x;y");
  edit(9, "LeftToTrackerTransform\";5.14", "LeftToTrackerTransform\";soon");
  edit(11, "LeftToTrackerTransform\"", "LeftToTrackerTransform");
  expect_said("motion:7: 12 fields, where the first line names 11");
  expect_said("motion:9: Time (s) is \"soon\", no number");
  expect_said("motion:11: a quotation does not end");
  write_csv();
  edit(9, ";5.14;", ";5.1;");
  edit(20, ";5.36;", ";nan;");
  expect_said("motion:20: Time (s) is \"nan\"");
  edit(20, ";nan;", ";5.36;");
  expect_said("motion:9: its time, 5.1 s, is not after that of the row before, 5.12 s");
  write_csv();
  edit(1, "tip_x", "tip_ex");
  expect_said("motion:1: there is no column \"tip_x\" (did you mean \"tip_ex\"?");

  write_jigsaws();
  edit(3, "7 7", "7");
  edit(5, "7 7", "7 seven");
  edit(6, " 0 0 0 0 0 0 ", " 0 0 0 0 0 0 0 ");
  expect_said("motion:3: 75 numbers, not 76");
  expect_said("motion:5: what stands here is not all numbers");
  expect_said("motion:6: 77 numbers, not 76");
  tool_.source = "master_left";
  write([](int) { return numbers(std::vector<double>(76, 1)) + '\n'; });
  expect_said("motion:1: master_left: numbers 4 to 12 of its 19 are no rotation");

  tool_.source = "LeftToTrackerTransform";
  write_sequence();
  edit(3, "Transform = ", "Transform = 1 ");
  edit(9, "Timestamp", "Timestump");
  edit(14, "Jaw = ", "Jaw = wide ");
  expect_said("frame 0: LeftToTrackerTransform is missing, or not 16 numbers");
  expect_said("frame 1: Timestamp is missing, or no number");
  expect_said("frame 2: LeftJaw is missing, or no number");
}

TEST_F(ForeignFile, AFileOfAnotherFormatIsSaidToBeOneInFewWords) {
  write_csv();
  registration_.format = MotionFormat::jigsaws;
  registration_.instruments = {tool_};
  const Result<ForeignMotion> rows = read_foreign_motion(path_, registration_);
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.failure().problems.size(), 4u);
  EXPECT_NE(to_text(rows.failure()).find("not one row is right: is this a file of format jigsaws?"),
            std::string::npos);
  const Result<ForeignMotion> endless = read_foreign_motion("/dev/zero", registration_);
  ASSERT_FALSE(endless);
  EXPECT_NE(to_text(endless.failure()).find("/dev/zero:1: this line has 65536 bytes or more"),
            std::string::npos);
}

TEST_F(ForeignFile, WhatTheTrackerLostIsLeftOutAndALongGapIsRefused) {
  write_sequence();
  for (int k = 10; k < 14; ++k) edit(3 + 4 * k + 1, "OK", "INVALID");
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result) << to_text(result.failure());
  EXPECT_EQ(result->notes[0], "4 transforms are not valid, as their status says: left out");
  registration_.longest_gap = 0.05;
  EXPECT_NE(complaint().find("frame 14: nothing is known of the 0.1 s before it"), std::string::npos)
      << complaint();
}

TEST_F(ForeignFile, WhatIsOutOfReachIsRefusedAndJawsBeyondTheirRangeAreToldOf) {
  write_csv();
  registration_.unit = 1;
  EXPECT_NE(complaint().find("motion:2: left would be 119378.9 mm deep in its trocar: it reaches 300 mm"),
            std::string::npos)
      << complaint();
  registration_.unit = mm;
  tool_.jaw_open = 200;
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result);
  EXPECT_NE(result->notes[0].find("left: the jaws were beyond closed or fully open in "), std::string::npos);
  tool_.source = "right";
  EXPECT_NE(complaint().find("0 rows of \"right\", which is left"), std::string::npos) << complaint();
}

TEST_F(ForeignFile, WhatIsImportedIsReadBackAsARecordingWithoutStates) {
  write_csv();
  const Result<ImportedRecording> result = imported();
  ASSERT_TRUE(result);
  const std::string written = path_ + ".jsonl";
  ASSERT_FALSE(write_recording(written, result->recording));
  const Result<Recording> back = read_recording(written);
  ASSERT_TRUE(back) << to_text(back.failure());
  EXPECT_EQ(back->end, "source_ended");
  EXPECT_FALSE(back->header.state_hash);
  EXPECT_FALSE(back->measured);
  ASSERT_EQ(back->steps.size(), result->recording.steps.size());
  EXPECT_EQ(back->steps.back().input.instruments[0], result->recording.steps.back().input.instruments[0]);
}

TEST_F(ForeignFile, ARegistrationThatDoesNotFitTheExerciseIsRefused) {
  registration_.place = {"table.lua", 5, {}};
  tool_.place = {"table.lua", 6, {}};
  tool_.name = "lefd";
  registration_.instruments = {tool_, tool_};
  std::string said = to_text({FailureKind::scenario, problems_with(registration_, test::small_exercise())});
  for (const char* part :
       {"table.lua:6: the exercise has no instrument \"lefd\" (did you mean \"left\"?)",
        "table.lua:6: \"lefd\" is there twice", "table.lua:5: the exercise's instrument \"left\" is missing"})
    EXPECT_NE(said.find(part), std::string::npos) << said;
  registration_.exercise = "large";
  said = to_text({FailureKind::scenario, problems_with(registration_, test::small_exercise())});
  EXPECT_NE(said.find("this registers for large, not for small"), std::string::npos) << said;
}

}  // namespace
}  // namespace calot
