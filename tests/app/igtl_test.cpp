// OpenIGTLink as its own library sends it.

#include <gmock/gmock.h>
#include <openigtlink/igtlClientSocket.h>
#include <openigtlink/igtlImageMessage.h>
#include <openigtlink/igtlPositionMessage.h>
#include <openigtlink/igtlSensorMessage.h>
#include <openigtlink/igtlStringMessage.h>
#include <openigtlink/igtlTrackingDataMessage.h>
#include <openigtlink/igtlTransformMessage.h>
#include <openigtlink/igtl_header.h>
#include <openigtlink/igtl_util.h>

#include <numbers>
#include <thread>

#include "app/program.h"
#include "base/rng.h"
#include "input/igtl_messages.h"
#include "input/input_feed.h"
#include "session/runner.h"
#include "session/session_for_tests.h"

namespace calot {
namespace {

using testing::HasSubstr;

std::string packed(igtl::MessageBase& message) {
  message.Pack();
  return {static_cast<const char*>(message.GetPackPointer()),
          static_cast<std::size_t>(message.GetPackSize())};
}

/// Of a tool at a place, m.
std::string transform(const std::string& device, const Vec3& at, const Mat3& axes = Mat3::Identity()) {
  igtl::Matrix4x4 matrix = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[row][column] = static_cast<float>(axes(row, column));
    matrix[row][3] = static_cast<float>(at[row] / 1e-3);
  }
  matrix[3][3] = 1;
  const auto message = igtl::TransformMessage::New();
  message->SetDeviceName(device.c_str());
  message->SetMatrix(matrix);
  return packed(*message);
}

std::string text(const std::string& device, std::string what) {
  const auto message = igtl::StringMessage::New();
  message->SetDeviceName(device.c_str());
  message->SetString(what);
  return packed(*message);
}

std::string sensor(const std::string& device, std::vector<double> values) {
  const auto message = igtl::SensorMessage::New();
  message->SetDeviceName(device.c_str());
  message->SetLength(static_cast<unsigned>(values.size()));
  message->SetValue(values.data());
  return packed(*message);
}

std::string body_of(const std::string& message) { return message.substr(sizeof(igtl_header)); }

/// A message whose checksum is right, whatever its body.
std::string with_body(const std::string& message, std::string body) {
  igtl_header header;
  std::memcpy(&header, message.data(), sizeof header);
  igtl_header_convert_byte_order(&header);
  header.body_size = body.size();
  header.crc = crc64(reinterpret_cast<unsigned char*>(body.data()), body.size(), 0);
  igtl_header_convert_byte_order(&header);
  return std::string(reinterpret_cast<const char*>(&header), sizeof header) + body;
}

/// The same by version 3 of the protocol: an extended header before it and metadata after it.
std::string extended(const std::string& message) {
  const std::string header("\0\x0c\0\x02\0\0\0\x03\0\0\0\x01", 12), metadata("\0\0abc", 5);
  std::string newer = with_body(message, header + body_of(message) + metadata);
  newer[1] = 2;  // the header's version, big-endian
  return newer;
}

SceneDefinition scene() {
  SceneDefinition scene = test::small_scene();
  scene.instruments[0].type = InstrumentType::semm_forceps;  // has jaws, and carries current
  return scene;
}

class Igtl : public testing::Test {
 protected:
  std::vector<LiveInstrument> instruments_ = live_instruments(scene());
  std::shared_ptr<Registration> registration_ =
      std::make_shared<Registration>(direct_registration("small", instruments_));

  IgtlMessages messages() const { return {instruments_, registration_, "there"}; }
  std::vector<LiveEvent> read(const std::string& bytes) const {
    IgtlMessages fresh = messages();
    std::vector<LiveEvent> events;
    fresh.add(bytes, events);
    return events;
  }
  /// The one input that a text of messages is.
  LiveInput input(const std::string& bytes) const {
    const std::vector<LiveEvent> events = read(bytes);
    EXPECT_EQ(events.size(), 1u);
    return std::get<LiveInput>(events.at(0));
  }
  Vec3 tip(const LiveInput& input) const {
    const LiveInstrument& moved = instruments_[static_cast<std::size_t>(input.instrument)];
    return tip_position(moved.trocar, input.pose, moved.geometry);
  }
};

const Vec3 place(-0.08, 0.06, -0.03);
constexpr double float_rounding = 1e-8;  // m, of 100 mm

TEST_F(Igtl, AnInstrumentGoesWhereItsTransformOrPositionSays) {
  EXPECT_LT((tip(input(transform("left", place))) - place).norm(), float_rounding);
  EXPECT_LT((tip(input(extended(transform("left", place)))) - place).norm(), float_rounding);
  const auto position = igtl::PositionMessage::New();
  position->SetDeviceName("left");
  position->SetPosition(-80, 60, -30);
  position->SetQuaternion(0, 0, 0, 1);
  EXPECT_LT((tip(input(packed(*position))) - place).norm(), float_rounding);
  const auto element = igtl::TrackingDataElement::New();
  igtl::Matrix4x4 matrix = {{1, 0, 0, -80}, {0, 1, 0, 60}, {0, 0, 1, -30}, {0, 0, 0, 1}};
  element->SetName("left");
  element->SetMatrix(matrix);
  const auto tracking = igtl::TrackingDataMessage::New();
  tracking->SetDeviceName("tracker");
  tracking->AddTrackingDataElement(const_cast<igtl::TrackingDataElement::Pointer&>(element));
  EXPECT_LT((tip(input(packed(*tracking))) - place).norm(), float_rounding);
  const LiveInput scope = input(transform("laparoscope", place));
  EXPECT_EQ(scope.instrument, 1);
  EXPECT_LT((tip(scope) - place).norm(), float_rounding);
}

TEST_F(Igtl, ARegisteredToolKeepsItsPlaceRelativeToTheTrocarAndItsJawsTurnWithIt) {
  ForeignInstrument tool;
  tool.name = "left";
  tool.source = "StylusToTracker";
  tool.port = Vec3(100, 200, 300);
  tool.tip = Vec3(0, 0, 20);
  tool.jaw_closed = 1, tool.jaw_open = 3;
  registration_->instruments = {tool};
  registration_->x_axis = Vec3::UnitY();
  registration_->y_axis = -Vec3::UnitX();
  const Vec3 relative(0.01, -0.02, -0.11);  // of the tip to the trocar, in their frame
  const Mat3 down = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
  const Vec3 origin = Vec3(0.1, 0.2, 0.3) + relative - down * Vec3(0, 0, 0.02);
  const std::string bytes = transform("StylusToTracker", origin, down);
  const LiveInput still = input(bytes);
  EXPECT_LT((tip(still) - instruments_[0].trocar - Vec3(0.02, 0.01, -0.11)).norm(), float_rounding);
  const Mat3 turned = down * Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
  const LiveInput rolled =
      std::get<LiveInput>(read(bytes + transform("StylusToTracker", origin, turned)).at(1));
  EXPECT_NEAR(rolled.pose.roll - still.pose.roll, 0.3, 0.03) << "about the shaft, 12 degrees off their axis";
  const LiveInput open = std::get<LiveInput>(read(bytes + sensor("StylusToTracker/jaw", {2})).at(1));
  EXPECT_NEAR(open.pose.jaw, 0.5 * instruments_[0].geometry.jaw_opening, 1e-12);
}

TEST_F(Igtl, JawsActionsAndCommandsHaveMessagesOfTheirOwn) {
  const std::vector<LiveEvent> events =
      read(sensor("left/jaw", {0.4}) + transform("left", place) + text("left/action", "activate") +
           transform("left", place) + text("left/action", "none") + sensor("left/jaw", {9}) +
           text("session", "pause") + text("session", "end"));
  ASSERT_EQ(events.size(), 8u) << "jaws before their place are known move nothing yet";
  EXPECT_EQ(std::get<LiveInput>(events[0]).pose.jaw, 0.4);
  EXPECT_EQ(std::get<LiveInput>(events[1]).action, InstrumentAction::activate);
  EXPECT_EQ(std::get<LiveInput>(events[2]).action, InstrumentAction::activate) << "until another is said";
  EXPECT_EQ(std::get<LiveInput>(events[3]).action, InstrumentAction::none);
  EXPECT_THAT(std::get<LiveRemark>(events[4]).text, HasSubstr("left: its jaws"));
  EXPECT_EQ(std::get<LiveInput>(events[5]).pose.jaw, instruments_[0].geometry.jaw_opening);
  EXPECT_EQ(std::get<LiveCommand>(events[6]), LiveCommand::pause);
  EXPECT_EQ(std::get<LiveCommand>(events[7]), LiveCommand::end);
}

TEST_F(Igtl, ActsAreMessagesOfTheSessionWithWhatIsSaid) {
  const std::vector<LiveEvent> events =
      read(text("session", "time_out landmarks named") + text("session", "bail_out") +
           text("session", "time_out " + std::string(300, 'x')));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(std::get<SessionAct>(events[0]), (SessionAct{EventKind::time_out, "landmarks named"}));
  EXPECT_EQ(std::get<SessionAct>(events[1]), (SessionAct{EventKind::bail_out, ""}));
  EXPECT_THAT(std::get<LiveRefusal>(events[2]).problem.message, HasSubstr("too long"));
}

TEST_F(Igtl, WhatCannotBeUsedIsRefusedWithItsNumberAndWhyAndWhatFollowsIsRead) {
  const std::string good = transform("left", place);
  std::string damaged = good;
  damaged.back() ^= 1;
  const float no_number = std::numeric_limits<float>::quiet_NaN();
  const auto image = igtl::ImageMessage::New();
  image->SetDeviceName("camera");
  image->SetDimensions(200, 200, 1);
  image->SetScalarTypeToUint8();
  image->AllocateScalars();
  const std::string newer = extended(transform("left", place));
  std::string wild = body_of(newer);
  wild[4] = wild[5] = '\xff';  // metadata of 4 GB
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {damaged, "the checksum of this TRANSFORM is wrong"},
      {transform("left", Vec3(no_number, 0, 0)), "left: a value is not finite"},
      {transform("left", place, 2 * Mat3::Identity()), "axes are not of length 1"},
      {transform("left", Vec3(0, 0, -5)), "cannot take the pose"},
      {transform("lefd", place),
       "left out from here on: the device lefd (devices that do: left, laparoscope)"},
      {packed(*image), "left out from here on: messages of type IMAGE"},
      {with_body(good, ""), "a transform has 12 numbers"},
      {with_body(good, body_of(good) + "x"), "a transform has 12 numbers"},
      {with_body(good, std::string(70000, 'x')), "a TRANSFORM of 70000 bytes"},
      {with_body(newer, wild), "the parts of this TRANSFORM have no room"},
      {with_body(newer, "1234"), "the parts of this TRANSFORM have no room"},
      {with_body(text("session", "end"), "\x01"), "a string has a header"},
      {with_body(text("session", "end"), std::string("\0\3\xff\xff"
                                                     "end",
                                                     7)),
       "not as long as it says"},
      {text("session", "stop\x1b[2J"), "\"stop?[2J\" is no command"},
      {text("left/action", "activat"), "did you mean \"activate\"?"},
      {text("laparoscope/action", "activate"), "cannot activate"},
      {sensor("left/jaw", {0.1, 0.2}), "one number"},
      {sensor("left/jaw", {std::numeric_limits<double>::infinity()}), "not finite"}};
  for (const auto& [bytes, why] : wrong) {
    const std::vector<LiveEvent> events = read(good + bytes + good);
    ASSERT_EQ(events.size(), 3u) << why;
    EXPECT_THAT(to_text(std::get<LiveRefusal>(events[1]).problem), HasSubstr(why));
    EXPECT_THAT(to_text(std::get<LiveRefusal>(events[1]).problem), HasSubstr("there: message 2: "));
    EXPECT_TRUE(std::holds_alternative<LiveInput>(events[2])) << why;
  }
  EXPECT_EQ(read(transform("lefd", place) + transform("lefd", place)).size(), 1u);
}

TEST_F(Igtl, WhatIsNoHeaderEndsTheConnectionAndACutMessageIsSaid) {
  IgtlMessages other = messages();
  std::vector<LiveEvent> events;
  other.add("GET / HTTP/1.1\r\nHost: localhost\r\nUser-Agent: something that is lost\r\n\r\n", events);
  EXPECT_TRUE(other.broken());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_THAT(to_text(std::get<LiveRefusal>(events[0]).problem), HasSubstr("no header of OpenIGTLink"));
  const std::string good = transform("left", place);
  for (const std::size_t part : {std::size_t(1), sizeof(igtl_header), good.size() - 1}) {
    IgtlMessages cut = messages();
    events.clear();
    cut.add(good + good.substr(0, part), events);
    cut.finish(events);
    ASSERT_EQ(events.size(), 2u) << part;
    EXPECT_THAT(to_text(std::get<LiveRefusal>(events[1]).problem), HasSubstr("message 2: this last message"));
  }
}

TEST_F(Igtl, BytesInAnyPortionsAreTheSameMessages) {
  const std::string bytes = transform("left", place) + text("session", "pause") +
                            with_body(text("a", "b"), "") + sensor("left/jaw", {0.4});
  IgtlMessages apart = messages();
  std::vector<LiveEvent> events;
  for (const char c : bytes) apart.add({&c, 1}, events);
  EXPECT_EQ(events.size(), read(bytes).size());
  EXPECT_EQ(std::get<LiveInput>(events.back()).pose.jaw, 0.4);
}

TEST_F(Igtl, AnyBytesAreRefusedOrReadAndNeverMoreThanTheInstrumentCan) {
  Rng rng(5);
  const std::vector<std::string> seeds = {transform("left", place), sensor("left/jaw", {0.2}),
                                          extended(transform("left", place)), text("left/action", "activate"),
                                          text("session", "pause")};
  int used = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string& seed = seeds[static_cast<std::size_t>(i) % seeds.size()];
    std::string body = body_of(seed);
    for (int k = 0; k < 1 + i % 4; ++k) body[rng.next() % body.size()] = static_cast<char>(rng.next());
    if (i % 3 == 0) body.resize(rng.next() % (2 * body.size()));
    for (const LiveEvent& event : read(transform("left", place) + with_body(seed, body))) {
      if (const auto* input = std::get_if<LiveInput>(&event)) {
        ++used;
        ASSERT_EQ(check_pose("left", instruments_[0].geometry, input->pose), std::nullopt);
      }
      refused += std::holds_alternative<LiveRefusal>(event) ? 1 : 0;
    }
  }
  EXPECT_GT(used, 3000) << "some changes leave a message that can be used";
  EXPECT_GT(refused, 1000);
}

/// A connection of the library's, from which whole or half messages are sent.
class Sender {
 public:
  explicit Sender(const std::string& heard_at) {
    const std::size_t colon = heard_at.find(':');
    EXPECT_EQ(
        socket_->ConnectToServer(heard_at.substr(0, colon).c_str(), std::stoi(heard_at.substr(colon + 1))),
        0);
  }
  ~Sender() { socket_->CloseSocket(); }
  void send(const std::string& bytes) {
    EXPECT_EQ(socket_->Send(bytes.data(), static_cast<int>(bytes.size())), 1);
  }

 private:
  igtl::ClientSocket::Pointer socket_ = igtl::ClientSocket::New();
};

TEST_F(Igtl, AClientMovesTheInstrumentAStalledOneHoldsNothingUpAndALostOnePausesUntilAnotherComes) {
  World world = World::create(scene()).value();
  LiveMailbox mailbox;
  std::vector<std::string> said;
  LiveOptions options;
  options.say = [&](const std::string& line) { said.push_back(line); };
  LiveSource source(instruments_, mailbox, options);
  const auto maker = [&](const std::string&) { return std::make_unique<IgtlMessages>(messages()); };
  Result<std::unique_ptr<InputFeed>> feed = InputFeed::open("tcp:0", maker, mailbox);
  ASSERT_TRUE(feed) << to_text(feed.failure());

  std::atomic<int> steps{0};
  std::atomic<bool> at_second{false};
  const Vec3 first = place, second = place + Vec3(2e-3, 0, 1e-3);
  std::vector<Vec3> tips;
  SessionOptions session;
  session.end_with_source = true;
  session.observer = [&](const World& present, const Progress&, bool) {
    tips.push_back(present.report().instruments[0].tip);
    if ((tips.back() - second).norm() < float_rounding) at_second = true;
    ++steps;
  };
  std::thread senders([&] {
    const auto wait_for_steps = [&](int more) {
      for (const int until = steps + more; steps < until;)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    };
    {
      Sender sender(feed.value()->heard_at());
      sender.send(transform("left", first) + transform("left", first).substr(0, 70));
      wait_for_steps(12);  // it has stalled within a message; at 1 m/s 150 mm take 8 steps
    }
    Sender sender(feed.value()->heard_at());
    std::string flood;
    for (int i = 0; i < 20000; ++i) flood += transform("left", first);
    sender.send(flood + transform("left", second));
    for (int waited = 0; waited < 1000 && !at_second; ++waited)
      wait_for_steps(5);  // the flood is read beside the steps
    sender.send(text("session", "end"));
  });
  test::TimedScript script(20);
  const SessionResult result = run_session(world, script, source, session);
  senders.join();
  EXPECT_EQ(result.end, SessionEnd::source_ended);
  EXPECT_LT((tips.at(11) - first).norm(), float_rounding);
  EXPECT_LT((tips.back() - second).norm(), float_rounding);
  EXPECT_EQ(source.figures().inputs, 20002);
  EXPECT_EQ(source.figures().pauses, 1);
  EXPECT_EQ(source.figures().refused, 1) << "the half message";
  ASSERT_EQ(said.size(), 3u);
  EXPECT_THAT(said[1], HasSubstr("has ended without saying `end`"));
  EXPECT_THAT(said[2], HasSubstr("The input is back"));
}

TEST_F(Igtl, ASenderThatListensIsConnectedToAndAgainWhenItComesBack) {
  std::string heard_at;
  Result<Descriptor> tracker = listen_at({"127.0.0.1", "0", true}, heard_at);
  ASSERT_TRUE(tracker) << to_text(tracker.failure());
  LiveMailbox mailbox;
  const auto maker = [&](const std::string&) { return std::make_unique<IgtlMessages>(messages()); };
  const Result<std::unique_ptr<InputFeed>> feed = InputFeed::open("tcp:" + heard_at, maker, mailbox);
  ASSERT_TRUE(feed) << to_text(feed.failure());
  const auto next = [&] {
    for (int i = 0; i < 2000; ++i) {
      if (std::optional<LiveMailbox::Sent> sent = mailbox.take()) return std::move(sent->event);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return LiveEvent(LiveRemark{"nothing came"});
  };
  const std::string bytes = transform("left", place);
  for (int i = 0; i < 2; ++i) {
    Descriptor connection = accept_from(tracker->get());
    ASSERT_EQ(write(connection.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    EXPECT_TRUE(std::holds_alternative<LiveInput>(next())) << i;
    connection = Descriptor();
    const LiveEvent lost = next();
    ASSERT_TRUE(std::holds_alternative<LiveLoss>(lost)) << i;
    EXPECT_TRUE(std::get<LiveLoss>(lost).may_return);
  }
}

class OperateByIgtl : public test::ProgramTest {
 protected:
  void registration(const std::string& port) const {
    test::spill(folder_ / "t.lua",
                R"(return { version = 1, exercise = "small", format = "sequence", unit = 0.001,
      instruments = { { name = "left", source = "StylusToTracker", )" +
                    port + "} } }");
  }
};

TEST_F(OperateByIgtl, ATrackerThatIsConnectedToMovesItByItsRegistration) {
  std::string heard_at;
  const Result<Descriptor> tracker = listen_at({"127.0.0.1", "0", true}, heard_at);
  ASSERT_TRUE(tracker);
  registration("port = { 0, 0, 0 }");
  const auto outcome = calot(
      {"operate", "small.lua", "--no-window", "--igtl", heard_at, "--registration", "t.lua", "-o", "here"},
      [&](pid_t) {
        const Descriptor connection = accept_from(tracker->get());
        const std::string bytes = transform("StylusToTracker", Vec3(0.03, 0.02, -0.06));
        EXPECT_GT(write(connection.get(), bytes.data(), bytes.size()), 0);
        EXPECT_TRUE(wait_for_lines(folder_ / "here/recording.jsonl", 15));
        const std::string end = text("session", "end");
        EXPECT_GT(write(connection.get(), end.data(), end.size()), 0);
      });
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Result<Recording> recording = read_recording((folder_ / "here/recording.jsonl").string());
  ASSERT_TRUE(recording) << to_text(recording.failure());
  const InstrumentPose last = recording->steps.back().input.instruments[0];
  EXPECT_NEAR(last.insertion, 0.07, 1e-8) << "as far from the trocar as there";
}

TEST_F(OperateByIgtl, WhatCannotBeIsAUsageError) {
  registration("");
  const auto refused = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"operate", "small.lua", "--no-window"};
    words.insert(words.end(), more.begin(), more.end());
    const test::Outcome outcome = calot(words);
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(refused({"--igtl", "0", "--registration", "t.lua"}), HasSubstr("give port = { x, y, z }"));
  EXPECT_THAT(refused({"--igtl", "127.0.0.1:1"}), HasSubstr("cannot connect to 127.0.0.1:1"));
  EXPECT_THAT(refused({"--igtl", "here"}), HasSubstr("no port, nor HOST:PORT"));
  EXPECT_THAT(refused({"--registration", "t.lua"}), HasSubstr("--igtl"));
  EXPECT_THAT(refused({"--igtl", "0", "--stamped"}), HasSubstr("--stamped"));
}

TEST(NetworkPlaces, WhatIsNoneSaysWhatOneIs) {
  EXPECT_EQ(read_network_place("18944")->host, "127.0.0.1");
  EXPECT_TRUE(read_network_place("*:18944")->is_here);
  EXPECT_FALSE(read_network_place("tracker:18944")->is_here);
  for (const char* text : {"", "x", "tracker", "tracker:", ":1", "a:b", "70000", "-1", "1.5"})
    EXPECT_FALSE(read_network_place(text)) << text;
  LiveMailbox mailbox;
  EXPECT_FALSE(InputFeed::open(
      "tcp:127.0.0.1:1", [](const std::string&) { return nullptr; }, mailbox));
}

}  // namespace
}  // namespace calot
