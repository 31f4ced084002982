// A window on a screen that only memory has.

#include "window/operate_window.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <link.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "render/image_compare.h"
#include "render/offscreen.h"
#include "session/runner.h"
#include "session/session_for_tests.h"
#include "support/mock_organ.h"

namespace calot {
namespace {

/// An X server without a screen, for as long as this lives.
class Screen {
 public:
  Screen() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    server_ = fork();
    if (server_ == 0) {
      const std::string number = std::to_string(ends[1]);
      close(ends[0]);
      dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "800x600x24", "-nolisten", "tcp",
             static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    // Its number, once it answers. It writes for ever to a pipe that is closed before the line's end.
    std::string number;
    pollfd answer{ends[0], POLLIN, 0};
    for (char c = 0; poll(&answer, 1, 20'000) == 1 && read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    is_there_ = !number.empty();
    if (is_there_) setenv("DISPLAY", (":" + number).c_str(), 1);
  }
  ~Screen() {
    unsetenv("DISPLAY");
    if (server_ > 0) {
      kill(server_, SIGTERM);
      waitpid(server_, nullptr, 0);
    }
  }
  bool is_there() const { return is_there_; }

 private:
  pid_t server_ = -1;
  bool is_there_ = false;
};

/// What drivers keep for a process's life is lost, to who looks for leaks, where their libraries go before it ends.
void keep_libraries() {
  std::vector<std::string> names;
  const auto note = [](dl_phdr_info* info, std::size_t, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(info->dlpi_name);
    return 0;
  };
  dl_iterate_phdr(note, &names);
  for (const std::string& name : names)
    if (!name.empty()) dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}

std::shared_ptr<LiveView> small_view() {
  Pose frame = Pose::Identity();
  frame.translation() = Vec3(0, 90e-3, -40e-3);
  auto view = std::make_shared<LiveView>();
  view->scene.meshes.push_back(test::mock_pear(frame, Vec3(0, -12e-3, 70e-3), Vec3(4e-3, -8e-3, 10e-3)));
  view->step = "Do it";
  view->time_limit = 60;
  view->hands.push_back({"left", "", 1.5, 5, {0.4, 0.2, 0.12, 0, 0.5}});
  view->hands.push_back({"laparoscope", "", 0, 0, {0.9, 0.1, 0.1, 0, 0}});
  return view;
}

WindowOptions small_window() {
  SceneDefinition scene;
  InstrumentDefinition instrument;
  instrument.name = "left";
  instrument.port = "right_subcostal";
  scene.instruments.push_back(instrument);
  WindowOptions options;
  options.title = "A small exercise";
  // The panel takes 290 px, the picture what is left: it is shown pixel by pixel.
  options.width = 290 + 320;
  options.height = 180;
  options.picture_width = 320;
  options.picture_height = 180;
  options.instruments = live_instruments(scene);
  return options;
}

std::vector<LiveEvent> taken(LiveMailbox& mailbox) {
  std::vector<LiveEvent> events;
  while (std::optional<LiveMailbox::Sent> sent = mailbox.take()) events.push_back(std::move(sent->event));
  return events;
}

TEST(Window, WithoutADisplayItSaysWhatToDo) {
  unsetenv("DISPLAY");
  LiveMailbox mailbox;
  const Result<OperateWindow> window = OperateWindow::open(small_window(), mailbox);
  ASSERT_FALSE(window);
  EXPECT_EQ(window.failure().kind, FailureKind::resource);
  for (const char* said : {"DISPLAY", "--no-window", "xvfb-run"})
    EXPECT_THAT(to_text(window.failure()), testing::HasSubstr(said));
}

/// One window for all: opening one takes most of the time.
TEST(Window, ShowsTheOffscreenPictureTurnsTheMouseIntoMotionPausesAndGivesUpWhenItIsClosed) {
  const Screen screen;
  if (!screen.is_there()) GTEST_SKIP() << "there is no Xvfb (package xvfb)";
  const auto view = small_view();
  Result<OffscreenRenderer> offscreen = OffscreenRenderer::create(320, 180, live_quality);
  ASSERT_TRUE(offscreen);
  const Image expected = offscreen->render(view->scene).value();

  LiveMailbox mailbox;
  Result<OperateWindow> opened = OperateWindow::open(small_window(), mailbox);
  ASSERT_TRUE(opened) << to_text(opened.failure());
  keep_libraries();
  OperateWindow& window = opened.value();
  ASSERT_TRUE(window.turn(view).value());
  // The same shaders by another driver of the same library: single pixels on edges may round otherwise.
  CompareTolerance rounding;
  rounding.small_delta = rounding.large_delta = 2;
  rounding.differing_pixels = 0;
  const Result<ImageDifference> compared = compare(expected, window.shown(), rounding);
  ASSERT_TRUE(compared) << to_text(compared.failure());
  EXPECT_TRUE(compared->within) << compared->differing_pixels << " pixels by up to " << compared->max_delta;
  ASSERT_TRUE(window.turn(nullptr).value());
  EXPECT_EQ(window.shown().rgb, window.shown().rgb);
  rounding.differing_pixels = 100;
  const Image finer = OffscreenRenderer::create(320, 180)->render(view->scene).value();
  EXPECT_FALSE(compare(finer, window.shown(), rounding)->within) << "golden quality is another picture";

  window.events().right = 30;
  ASSERT_TRUE(window.turn(nullptr).value());
  EXPECT_THAT(taken(mailbox), testing::IsEmpty()) << "nobody has begun";
  window.go_on();
  view->pictures = std::make_shared<LivePictures>();
  view->time = 0.02;
  view->inputs = {steady_clock().now() - 1};
  ASSERT_TRUE(window.turn(view).value());
  EXPECT_EQ(view->pictures->figures().shown, 1);
  EXPECT_GE(view->pictures->figures().wait_most, 1) << "the input came a second before the picture";
  std::vector<LiveEvent> events = taken(mailbox);
  ASSERT_EQ(events.size(), 1u);
  const LiveInput start = std::get<LiveInput>(events[0]);
  EXPECT_EQ(start.pose, view->hands[0].pose);

  window.events().right = 30;
  ASSERT_TRUE(window.turn(nullptr).value());
  EXPECT_EQ(view->pictures->figures().shown, 1) << "nothing new was there to be shown";
  events = taken(mailbox);
  ASSERT_EQ(events.size(), 1u);
  const LiveInstrument left = small_window().instruments[0];
  const auto closed_tip = [&](InstrumentPose pose) {
    pose.jaw = 0;
    return tip_position(left.trocar, pose, left.geometry);
  };
  const Vec3 moved = closed_tip(std::get<LiveInput>(events[0]).pose) - closed_tip(start.pose);
  EXPECT_GT(moved.x(), 1e-3) << "to the right, which is +x for this camera";
  EXPECT_LT(moved.tail<2>().norm(), 1e-9);

  window.events().laparoscope = true;
  window.events().right = 10;
  ASSERT_TRUE(window.turn(nullptr).value());
  events = taken(mailbox);
  ASSERT_EQ(events.size(), 2u) << "the hand is let go, and the laparoscope moves";
  EXPECT_EQ(std::get<LiveInput>(events[0]).instrument, 0);
  EXPECT_EQ(std::get<LiveInput>(events[1]).instrument, 1);
  EXPECT_NE(std::get<LiveInput>(events[1]).pose, view->hands[1].pose);

  window.events().time_out = window.events().bail_out = true;
  ASSERT_TRUE(window.turn(nullptr).value());
  events = taken(mailbox);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(std::get<SessionAct>(events[0]).kind, EventKind::time_out);
  EXPECT_EQ(std::get<SessionAct>(events[1]).kind, EventKind::bail_out);

  window.events().menu = true;
  ASSERT_TRUE(window.turn(nullptr).value());
  window.go_on();
  events = taken(mailbox);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(std::get<LiveCommand>(events[0]), LiveCommand::pause);
  EXPECT_EQ(std::get<LiveCommand>(events[1]), LiveCommand::resume);

  window.close();
  EXPECT_FALSE(window.turn(nullptr).value());
  events = taken(mailbox);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::get<LiveCommand>(events[0]), LiveCommand::abandon);
}

/// A key that the screen's own keyboard presses and lets go: the pointer is where the window holds it.
bool press(const char* key) {
  const std::string command = std::string("xdotool key ") + key + " 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

/// What was put into the mailbox has the blades come in for the grasper.
void expect_exchange_in_a_session(const std::vector<LiveInstrument>& instruments, LiveMailbox& mailbox) {
  World world = World::create(test::shared_port()).value();
  ASSERT_TRUE(world.report().instruments[1].waits);
  LiveOptions options;
  options.begins_at_once = true;
  LiveSource hands(instruments, mailbox, options);
  ExerciseDefinition exercise = test::small_exercise();
  exercise.scene = world.scene();
  test::TimedScript script(0.2, exercise);
  const SessionResult result = run_session(world, script, hands, {});
  EXPECT_EQ(result.end, SessionEnd::steps_done) << to_text(result.failure);
  EXPECT_TRUE(world.report().instruments[0].waits);
  EXPECT_FALSE(world.report().instruments[1].waits);
}

TEST(Window, KeysOfTheKeyboardExchangeInstrumentsAndAskForATimeOut) {
  const Screen screen;
  if (!screen.is_there() || std::system("command -v xdotool >/dev/null") != 0)
    GTEST_SKIP() << "there is no Xvfb or no keyboard for it (packages xvfb, xdotool)";
  WindowOptions options = small_window();
  options.instruments = live_instruments(test::shared_port());
  const auto view = small_view();
  view->hands.insert(view->hands.begin() + 1, view->hands[0]);
  view->hands[1].name = "blades";
  view->hands[1].waits = true;
  LiveMailbox mailbox;
  Result<OperateWindow> opened = OperateWindow::open(options, mailbox);
  ASSERT_TRUE(opened) << to_text(opened.failure());
  keep_libraries();
  OperateWindow& window = opened.value();
  ASSERT_TRUE(window.turn(view).value());
  window.go_on();
  ASSERT_TRUE(window.turn(view).value());
  taken(mailbox);

  // The server hands a key on when it likes: a turn of the window takes what there is.
  const auto sent_by = [&](const char* key) {
    std::vector<LiveEvent> events;
    if (!press(key)) return events;
    for (int turns = 0; turns < 200 && events.empty(); ++turns) {
      if (!window.turn(nullptr).value()) break;
      events = taken(mailbox);
    }
    return events;
  };
  const std::vector<LiveEvent> exchanged = sent_by("x");
  ASSERT_EQ(exchanged.size(), 1u);
  EXPECT_EQ(std::get<LiveInput>(exchanged[0]).instrument, 1) << "the one that waits for this port";
  EXPECT_EQ(std::get<LiveInput>(exchanged[0]).action, InstrumentAction::exchange);
  mailbox.put(exchanged[0]);
  expect_exchange_in_a_session(options.instruments, mailbox);
  const std::vector<LiveEvent> stopped = sent_by("t");
  ASSERT_EQ(stopped.size(), 1u);
  EXPECT_EQ(std::get<SessionAct>(stopped[0]).kind, EventKind::time_out);
}

}  // namespace
}  // namespace calot
