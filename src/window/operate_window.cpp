#include "window/operate_window.h"

#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "window/draw_lists.h"
#include "window/overlay.h"
#include "window/window_system.h"

namespace calot {
namespace {

constexpr double wheel_notch = 2e-3;                                           // m
constexpr double finely = 0.25;                                                // with Shift
constexpr double jaw_speed = 120 * units::deg, roll_speed = 120 * units::deg;  // rad/s
constexpr double longest_turn = 0.1;  // s that held keys count for at once
constexpr double still_after = 1;     // s without a new state: time stands still
constexpr double idle_wait = 5e-3;    // s
/// s. Where nothing is new the window stays as it is for so long: without a graphics card a swap takes milliseconds of a
/// core, which the simulation needs.
constexpr double longest_stale = 0.1;

/// Where the picture is in the window, px from the upper left.
struct PicturePlace {
  int x = 0, y = 0, width = 0, height = 0;
};

PicturePlace place_picture(int window_width, int window_height, double ratio, const WindowOptions& options) {
  const int panel = std::min(static_cast<int>(ratio * panel_width), window_width / 2);
  const double scale = std::min(static_cast<double>(window_width - panel) / options.picture_width,
                                static_cast<double>(window_height) / options.picture_height);
  PicturePlace place;
  place.width = std::max(1, static_cast<int>(scale * options.picture_width));
  place.height = std::max(1, static_cast<int>(scale * options.picture_height));
  place.x = panel + (window_width - panel - place.width) / 2;
  place.y = (window_height - place.height) / 2;
  return place;
}

}  // namespace

struct OperateWindow::Impl {
  std::shared_ptr<Glfw> library;
  WindowOptions options;
  LiveMailbox& mailbox;
  GLFWwindow* window = nullptr;
  ImGuiContext* overlay_context = nullptr;
  std::optional<OffscreenRenderer> renderer;
  std::optional<DrawLists> lists;
  GlFunctions gl;
  std::shared_ptr<const LiveView> view;
  std::optional<HandControl> hands;
  OverlayState state;
  WindowEvents events;
  std::vector<GamepadState> pads;  ///< at the last turn
  std::optional<Vec2> pointer;
  double last_turn = 0, last_picture = 0, last_swap = 0;
  bool in_software = false;
  bool captured = false, was_acting = false;
  bool disturbed = true;  ///< pointer, keys or size have changed since the last swap

  Impl(std::shared_ptr<Glfw> owner, WindowOptions wanted, LiveMailbox& box)
      : library(std::move(owner)), options(std::move(wanted)), mailbox(box) {
    state.title = options.title;
    state.mode = options.mode;
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  std::optional<Failure> build();
  void listen();
  void set_captured(bool wanted);
  void send(const LiveEvent& event) { mailbox.offer(event); }
  void open_menu();
  void go_on();
  void choose(MenuChoice choice);
  HandMotion device_motion(double dt);
  HandMotion pad_motion(std::size_t pad, const std::vector<GamepadState>& now, double dt);
  void move_hands(double dt);
  bool key(int code) const { return glfwGetKey(window, code) == GLFW_PRESS; }
  bool button(int code) const { return captured && glfwGetMouseButton(window, code) == GLFW_PRESS; }
  double pixel_ratio() const;
  PicturePlace place() const;
  void take(std::shared_ptr<const LiveView> newest);
  void draw_frame();
};

OperateWindow::Impl::~Impl() {
  if (window != nullptr) glfwMakeContextCurrent(window);
  if (overlay_context != nullptr) {
    ImGui::SetCurrentContext(overlay_context);
    if (ImGui::GetIO().BackendPlatformUserData != nullptr) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(overlay_context);
  }
  renderer.reset();
  if (window != nullptr) glfwDestroyWindow(window);
}

std::optional<Failure> OperateWindow::Impl::build() {
  // Pixel for pixel: without a graphics card to enlarge a picture takes as long as to draw it.
  window =
      make_window(options.width > 0 ? options.width : options.picture_width + static_cast<int>(panel_width),
                  options.height > 0 ? options.height : options.picture_height, "Calot: " + options.title);
  if (window == nullptr) return no_window("no window with OpenGL 3.3 can be opened");
  auto context = std::make_unique<WindowContext>(window);
  if (!context->make_current()) return no_window("the window's OpenGL cannot be used");
  glfwSwapInterval(1);
  const Result<GlFunctions> functions = load_gl(context->loader());
  if (!functions) return functions.failure();
  gl = functions.value();
  const std::string_view draws = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  in_software = draws.starts_with("llvmpipe") || draws.starts_with("softpipe");
  Result<OffscreenRenderer> created =
      OffscreenRenderer::create(std::move(context), options.picture_width, options.picture_height,
                                options.quality.value_or(in_software ? live_quality : golden_quality));
  if (!created) return created.failure();
  renderer = std::move(created).value();
  listen();  // before ImGui, which passes on what it hears
  overlay_context = ImGui::CreateContext();
  ImGui::SetCurrentContext(overlay_context);
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  Result<DrawLists> made = DrawLists::create(gl);
  if (!made) return made.failure();
  lists = std::move(made).value();
  last_turn = last_picture = glfwGetTime();
  return std::nullopt;
}

void OperateWindow::Impl::listen() {
  glfwSetWindowUserPointer(window, this);
  static const auto self = [](GLFWwindow* from) {
    return static_cast<Impl*>(glfwGetWindowUserPointer(from));
  };
  glfwSetCursorPosCallback(window, [](GLFWwindow* from, double x, double y) {
    Impl& impl = *self(from);
    impl.disturbed = true;
    if (impl.pointer && impl.captured) {
      impl.events.right += x - impl.pointer->x();
      impl.events.down += y - impl.pointer->y();
    }
    impl.pointer = Vec2(x, y);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* from, double, double notches) {
    self(from)->disturbed = true;
    self(from)->events.wheel += notches;
  });
  glfwSetKeyCallback(window, [](GLFWwindow* from, int code, int, int action, int held) {
    self(from)->disturbed = true;
    if (action != GLFW_PRESS) return;
    if (code == GLFW_KEY_TAB) self(from)->events.next_hand = true;
    if (code == GLFW_KEY_C) self(from)->events.laparoscope = true;
    if (code == GLFW_KEY_X) self(from)->events.exchange = true;
    if (code == GLFW_KEY_T) self(from)->events.time_out = true;
    if (code == GLFW_KEY_B && (held & GLFW_MOD_CONTROL) != 0) self(from)->events.bail_out = true;
    if (code == GLFW_KEY_ESCAPE) self(from)->events.menu = true;
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* from, int, int action, int) {
    self(from)->disturbed = true;
    if (action == GLFW_PRESS) self(from)->events.click = true;
  });
  // Who looks elsewhere does not operate.
  glfwSetWindowFocusCallback(window, [](GLFWwindow* from, int focused) {
    if (focused == GLFW_FALSE) self(from)->events.menu = true;
    self(from)->disturbed = true;
  });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* from) { self(from)->disturbed = true; });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* from, int, int) { self(from)->disturbed = true; });
}

/// Captured, the pointer is hidden and its way has no end.
void OperateWindow::Impl::set_captured(bool wanted) {
  captured = wanted;
  pointer.reset();
  glfwSetInputMode(window, GLFW_CURSOR, wanted ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigFlags =
      wanted ? io.ConfigFlags | ImGuiConfigFlags_NoMouse : io.ConfigFlags & ~ImGuiConfigFlags_NoMouse;
}

void OperateWindow::Impl::open_menu() {
  if (state.menu) return;
  state.menu = true;
  set_captured(false);
  if (options.mode == LiveMode::practice) send(LiveCommand::pause);
}

void OperateWindow::Impl::go_on() {
  if (!hands || !state.result.empty()) return;
  if (state.menu && state.started && options.mode == LiveMode::practice) send(LiveCommand::resume);
  state.menu = false;
  set_captured(true);
  if (state.started) return;
  state.started = true;
  send(hands->input());  // the clock begins with the first input
}

void OperateWindow::Impl::choose(MenuChoice choice) {
  const auto act = [this](EventKind kind, const char* text) {
    go_on();  // no act while time stands still
    send(SessionAct{kind, text});
  };
  if (choice == MenuChoice::time_out) act(EventKind::time_out, "");
  if (choice == MenuChoice::subtotal) act(EventKind::bail_out, "subtotal");
  if (choice == MenuChoice::convert) act(EventKind::bail_out, "convert");
  if (choice == MenuChoice::go_on) go_on();
  if (choice == MenuChoice::restart) send(LiveCommand::restart);
  if (choice == MenuChoice::abandon) send(LiveCommand::abandon);
  if (choice == MenuChoice::close) glfwSetWindowShouldClose(window, GLFW_TRUE);
}

HandMotion OperateWindow::Impl::device_motion(double dt) {
  const double fine = key(GLFW_KEY_LEFT_SHIFT) || key(GLFW_KEY_RIGHT_SHIFT) ? finely : 1.0;
  HandMotion motion;
  const double field = renderer->lens().field_diameter * place().height;
  const double pixel =
      fine * pixel_ratio() * metres_a_pixel(view->scene.camera, hands->grasped(view->scene.camera), field);
  motion.in_view = Vec3(pixel * events.right, -pixel * events.down, fine * wheel_notch * events.wheel);
  const auto held = [&](bool more, bool less) { return fine * dt * ((more ? 1 : 0) - (less ? 1 : 0)); };
  motion.roll = roll_speed * held(key(GLFW_KEY_E), key(GLFW_KEY_Q));
  motion.jaw = jaw_speed * held(button(GLFW_MOUSE_BUTTON_RIGHT), button(GLFW_MOUSE_BUTTON_LEFT));
  motion.activate = key(GLFW_KEY_SPACE);
  motion.next_hand = events.next_hand;
  motion.laparoscope = events.laparoscope;
  motion.exchange = events.exchange;
  motion.time_out = events.time_out;
  motion.bail_out = events.bail_out;
  return motion;
}

/// Nothing of one that was plugged in since the last turn.
HandMotion OperateWindow::Impl::pad_motion(std::size_t pad, const std::vector<GamepadState>& now, double dt) {
  if (pad >= now.size() || pad >= pads.size()) return {};
  const auto menu_button = static_cast<std::size_t>(options.gamepad.menu);
  if (options.gamepad.menu >= 0 && now[pad].buttons[menu_button] && !pads[pad].buttons[menu_button])
    events.menu = true;
  return gamepad_motion(options.gamepad, now[pad], pads[pad], dt);
}

/// Sends what has changed; a pedal that was let go is a change.
void OperateWindow::Impl::move_hands(double dt) {
  const std::vector<GamepadState> now = read_gamepads();
  HandMotion motion = device_motion(dt);
  motion += pad_motion(0, now, dt);
  const HandMotion assistant = pad_motion(1, now, dt);
  pads = now;
  if (motion.time_out) send(SessionAct{EventKind::time_out, {}});
  if (motion.bail_out) send(SessionAct{EventKind::bail_out, {}});
  const SceneCamera& camera = view->scene.camera;
  const bool changes = motion.next_hand || motion.laparoscope;
  if (motion.exchange)
    if (const std::optional<LiveInput> wanted = hands->exchange()) send(*wanted);
  if (changes) send(hands->held(hands->selected()));
  hands->move(motion, camera);
  if (motion.moves() || motion.activate || was_acting || changes) send(hands->input());
  was_acting = motion.activate;
  hands->move_laparoscope(assistant, camera);
  if (assistant.moves()) send(hands->held(hands->laparoscope()));
}

/// What is drawn now. At the begin of an attempt the hands are where its instruments are.
void OperateWindow::Impl::take(std::shared_ptr<const LiveView> newest) {
  const bool begins = !view || view->attempt != newest->attempt;
  view = std::move(newest);
  std::vector<InstrumentPose> poses;
  std::vector<char> waits, drawn;
  for (const HandView& hand : view->hands) {
    poses.push_back(hand.pose);
    waits.push_back(hand.waits ? 1 : 0);
    drawn.push_back(hand.drawn ? 1 : 0);
  }
  if (begins) hands.emplace(options.instruments, poses);
  hands->see(poses, waits, drawn);
  if (!begins) return;
  state.started = false;
  state.menu = true;
  set_captured(false);
}

/// Pixels that the pointer's unit covers: more than one on dense screens.
double OperateWindow::Impl::pixel_ratio() const {
  int pixels = 0, units = 0, ignored = 0;
  glfwGetFramebufferSize(window, &pixels, &ignored);
  glfwGetWindowSize(window, &units, &ignored);
  return units > 0 && pixels > 0 ? static_cast<double>(pixels) / units : 1;
}

PicturePlace OperateWindow::Impl::place() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  return place_picture(width, height, pixel_ratio(), options);
}

void OperateWindow::Impl::draw_frame() {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.ClearColor(0, 0, 0, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  const PicturePlace where = place();
  if (view) renderer->show(where.x, height - where.y - where.height, where.width, where.height);
  ImGui::SetCurrentContext(overlay_context);
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  static const LiveView nothing;
  if (hands) state.selected = hands->selected(), state.out_of_reach = hands->out_of_reach();
  const bool goes_on = state.started && (!state.menu || options.mode == LiveMode::exam);
  // A program may move the instruments too, whatever is done here.
  state.runs = goes_on || (view && view->time > 0 && glfwGetTime() - last_picture < still_after);
  const std::optional<MenuChoice> chosen =
      lay_out(state, view ? *view : nothing, ImGui::GetIO().DisplaySize.y);
  ImGui::Render();
  lists->draw(*ImGui::GetDrawData());
  if (chosen) choose(*chosen);
}

OperateWindow::OperateWindow(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OperateWindow::OperateWindow(OperateWindow&&) noexcept = default;
OperateWindow& OperateWindow::operator=(OperateWindow&&) noexcept = default;
OperateWindow::~OperateWindow() = default;

Result<OperateWindow> OperateWindow::open(WindowOptions options, LiveMailbox& mailbox) {
  Result<std::shared_ptr<Glfw>> library = Glfw::start();
  if (!library) return library.failure();
  auto impl = std::make_unique<Impl>(std::move(library).value(), std::move(options), mailbox);
  if (std::optional<Failure> failure = impl->build()) return *failure;
  return OperateWindow(std::move(impl));
}

Result<bool> OperateWindow::turn(std::shared_ptr<const LiveView> newest) {
  Impl& self = *impl_;
  glfwMakeContextCurrent(self.window);
  if (newest)
    glfwPollEvents();
  else
    glfwWaitEventsTimeout(idle_wait);
  if (glfwWindowShouldClose(self.window) == GLFW_TRUE) {
    self.send(LiveCommand::abandon);
    return false;
  }
  const double now = glfwGetTime();
  const double dt = std::min(now - self.last_turn, longest_turn);
  self.last_turn = now;
  const bool is_new = newest != nullptr;
  self.disturbed |= is_new;
  if (is_new) {
    const Result<bool> drawn = self.renderer->draw(newest->scene);
    if (!drawn) return drawn.failure();
    self.state.pictures_a_second +=
        0.1 * (1 / std::max(1e-3, now - self.last_picture) - self.state.pictures_a_second);
    self.last_picture = now;
    self.take(std::move(newest));
  }
  const bool clicks_on = self.events.click && self.state.menu && !ImGui::GetIO().WantCaptureMouse;
  const bool operates = self.hands && self.state.started && !self.state.menu && self.state.result.empty();
  if (operates) self.move_hands(dt);
  if (operates && self.events.menu) self.open_menu();
  self.events = {};
  if (clicks_on) self.go_on();
  if (!self.disturbed && now - self.last_swap < longest_stale) return true;
  self.last_swap = now;
  self.disturbed = false;
  self.draw_frame();
  glfwSwapBuffers(self.window);
  // The first view waits for who operates: time has not begun.
  if (is_new && self.view->pictures && self.view->time > 0)
    self.view->pictures->note_shown(self.view->inputs, self.view->paused);
  return true;
}

void OperateWindow::set_result(const std::string& lines) {
  impl_->set_captured(false);
  impl_->state.menu = true;
  impl_->state.result = lines;
  impl_->disturbed = true;
}

WindowEvents& OperateWindow::events() { return impl_->events; }
void OperateWindow::go_on() { impl_->go_on(); }
void OperateWindow::wake() { glfwPostEmptyEvent(); }
void OperateWindow::close() { glfwSetWindowShouldClose(impl_->window, GLFW_TRUE); }

Image OperateWindow::shown() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(impl_->window, &width, &height);
  impl_->draw_frame();  // what a swap left in the framebuffer is not defined
  const PicturePlace where = impl_->place();
  return impl_->renderer->shown(where.x, height - where.y - where.height, where.width, where.height);
}

bool OperateWindow::in_software() const { return impl_->in_software; }

const DrawQuality& OperateWindow::quality() const { return impl_->renderer->quality(); }

std::string OperateWindow::description() const { return impl_->renderer->description(); }

}  // namespace calot
