#include "session/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "acts/exchange.h"
#include "tools/tool.h"

namespace calot {
namespace {

constexpr double time_slack = 1e-9;  // s
constexpr double nap = 2e-3;         // s, between two looks into the mailbox
constexpr double long_silence = 5;   // s
constexpr int most_said = 20;        // refusals

class SteadyClock : public LiveClock {
 public:
  double now() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  void sleep(double duration) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(duration));
  }
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double most(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

struct Speed {
  double tip, turn;  ///< m/s; rad/s
};

/// Share of the way to `to` that an instrument may go in dt.
double share_within_speed(const LiveInstrument& instrument, const InstrumentPose& from,
                          const InstrumentPose& to, const Speed& speed, double dt) {
  const auto tip = [&](const InstrumentPose& pose) {
    return tip_position(instrument.trocar, pose, instrument.geometry);
  };
  const double way = (tip(to) - tip(from)).norm();
  const double turn = std::max(std::abs(to.roll - from.roll), std::abs(to.jaw - from.jaw));
  return std::min({1.0, way > 0 ? speed.tip * dt / way : 1.0, turn > 0 ? speed.turn * dt / turn : 1.0});
}

}  // namespace

const std::vector<std::string>& live_mode_names() {
  static const std::vector<std::string> names = {"practice", "exam"};
  return names;
}

std::string to_text(LiveMode mode) { return live_mode_names()[static_cast<std::size_t>(mode)]; }

const std::vector<std::string>& live_command_names() {
  static const std::vector<std::string> names = {"pause", "resume", "restart", "abandon", "end"};
  return names;
}

std::vector<LiveInstrument> live_instruments(const SceneDefinition& scene) {
  std::vector<LiveInstrument> instruments;
  for (const InstrumentDefinition& definition : scene.instruments)
    instruments.push_back({definition, instrument_geometry(definition.type)});
  InstrumentDefinition scope;
  scope.name = laparoscope_name;
  scope.port = scene.laparoscope.port;
  instruments.push_back({std::move(scope), laparoscope_geometry(), Vec3::Zero(), true});
  for (LiveInstrument& instrument : instruments)
    for (const PortDefinition& port : scene.ports.empty() ? default_ports() : scene.ports)
      if (port.name == instrument.definition.port) instrument.trocar = port.position;
  return instruments;
}

LiveClock& steady_clock() {
  static SteadyClock clock;
  return clock;
}

// ---- the mailbox

bool LiveMailbox::put(LiveEvent event) {
  std::unique_lock lock(mutex_);
  if (waiting_.size() >= capacity) ++times_full_;
  room_.wait(lock, [this] { return closed_ || waiting_.size() < capacity; });
  if (closed_) return false;
  waiting_.push_back({std::move(event), clock_.now()});
  return true;
}

bool LiveMailbox::offer(LiveEvent event) {
  const std::scoped_lock lock(mutex_);
  if (closed_ || waiting_.size() >= capacity) return false;
  waiting_.push_back({std::move(event), clock_.now()});
  return true;
}

std::optional<LiveMailbox::Sent> LiveMailbox::take() {
  const std::scoped_lock lock(mutex_);
  if (waiting_.empty()) return std::nullopt;
  Sent sent = std::move(waiting_.front());
  waiting_.pop_front();
  room_.notify_one();
  return sent;
}

void LiveMailbox::give_back(Sent sent) {
  const std::scoped_lock lock(mutex_);
  waiting_.push_front(std::move(sent));
}

void LiveMailbox::close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  room_.notify_all();
}

// ---- pictures

void LivePictures::note_shown(const std::vector<double>& inputs, double paused) {
  const std::scoped_lock lock(mutex_);
  const double now = clock_.now();
  if (shown_++ == 0) begun_ = now - paused;
  running_ = now - paused - begun_;
  for (const double at : inputs) waits_.push_back(now - at);
}

LivePictures::Figures LivePictures::figures() const {
  const std::scoped_lock lock(mutex_);
  return {shown_, running_, median(waits_), most(waits_)};
}

// ---- the source

LiveSource::LiveSource(std::vector<LiveInstrument> instruments, LiveMailbox& mailbox, LiveOptions options,
                       LiveClock& clock)
    : instruments_(std::move(instruments)), mailbox_(mailbox), options_(std::move(options)), clock_(clock) {
  figures_.mode = options_.mode;
  figures_.stamped = options_.stamped;
}

Result<std::optional<StepInput>> LiveSource::next(const World& world, double dt) {
  if (!begun_) begin(world);
  note_step();
  note_exchanges(world);
  const bool goes_on =
      options_.stamped ? take_stamped(world.report().time + dt + time_slack) : wait_until_due(dt);
  if (!goes_on) return conclude();
  step_began_ = clock_.now();
  if (fresh_) waits_.push_back(step_began_ - *fresh_);
  running_ = true;
  return std::optional<StepInput>(follow(dt));
}

void LiveSource::begin(const World& world) {
  begun_ = true;
  for (const InstrumentState& state : world.report().instruments) asked_.instruments.push_back(state.pose);
  asked_.instruments.push_back(world.report().laparoscope.pose);
  asked_.actions.assign(asked_.instruments.size(), InstrumentAction::none);
  given_ = asked_;
  states_now_ = world.report().instruments;
  told_to_wait_.assign(states_now_.size(), 0);
  catching_up_.assign(instruments_.size(), 0);
  started_ = options_.begins_at_once || options_.stamped;
  heard_ = options_.begins_at_once;
  last_input_ = due_ = clock_.now();
}

/// The step that was handed out has ended.
void LiveSource::note_step() {
  if (!running_) return;
  running_ = false;
  const double now = clock_.now();
  figures_.longest_step = std::max(figures_.longest_step, now - step_began_);
  if (fresh_) states_.push_back(now - *fresh_);
  fresh_.reset();
}

/// Until the step may begin; false where none will.
bool LiveSource::wait_until_due(double dt) {
  for (;;) {
    take_newest();
    if (over()) return false;
    const double now = clock_.now();
    const bool waits = paused_ || !started_;
    if (!waits && now >= due_) break;
    watch_silence();
    clock_.sleep(waits ? nap : std::min(nap, due_ - now));
  }
  // A step that begins late by less than its length is made up for; beyond that the session's time falls behind.
  const double behind = clock_.now() - due_;
  late_ = behind > dt;
  if (late_) {
    figures_.slowed += behind;
    ++figures_.slowed_steps;
    due_ += behind;
  }
  due_ += dt;
  return true;
}

/// No more than a full mailbox: who sends without end does not keep the step from its turn.
void LiveSource::take_newest() {
  for (std::size_t i = 0; i < LiveMailbox::capacity && !over(); ++i) {
    const std::optional<LiveMailbox::Sent> sent = mailbox_.take();
    if (!sent) return;
    apply(*sent);
  }
}

/// All that counts in the step that ends at `time`: what is known once something later has come. False where there is
/// no such step.
bool LiveSource::take_stamped(double time) {
  bool taken = false;
  while (!over()) {
    std::optional<LiveMailbox::Sent> sent = mailbox_.take();
    if (!sent) {
      watch_silence();
      clock_.sleep(nap);
      continue;
    }
    const auto* input = std::get_if<LiveInput>(&sent->event);
    const bool later = input != nullptr && input->time.value_or(0) > time && !paused_;
    // What ends a session counts after the inputs before it.
    const bool ends = taken && (std::holds_alternative<LiveCommand>(sent->event) ||
                                std::holds_alternative<LiveLoss>(sent->event));
    if (later || ends) {
      mailbox_.give_back(std::move(*sent));
      return true;
    }
    taken = taken || input != nullptr;
    apply(*sent);
    // Nothing need follow what ends the operation.
    if (const auto* act = std::get_if<SessionAct>(&sent->event);
        act != nullptr && act->kind == EventKind::bail_out && !asked_.acts.empty())
      return true;
  }
  return false;
}

void LiveSource::watch_silence() {
  const double now = clock_.now();
  if (lost_at_ && now - *lost_at_ > options_.return_within) return end_by("lost");
  if (paused_ || !started_ || said_silence_ || !options_.watch_silence) return;
  if (now - *last_input_ < long_silence) return;
  said_silence_ = true;
  say(fmt::format("Nothing has come for {:g} s: the instruments stay where they are.", long_silence));
}

void LiveSource::apply(const LiveMailbox::Sent& sent) {
  if (const auto* input = std::get_if<LiveInput>(&sent.event)) apply(*input, sent.at);
  if (const auto* command = std::get_if<LiveCommand>(&sent.event)) apply(*command);
  if (const auto* act = std::get_if<SessionAct>(&sent.event)) apply(*act, sent.at);
  if (const auto* loss = std::get_if<LiveLoss>(&sent.event)) apply(*loss);
  if (const auto* refusal = std::get_if<LiveRefusal>(&sent.event)) refuse(refusal->problem);
  if (const auto* remark = std::get_if<LiveRemark>(&sent.event)) say(remark->text);
}

bool LiveSource::is_drawn_back(int instrument) const {
  return std::any_of(exchanges_.begin(), exchanges_.end(),
                     [&](const Exchange& exchange) { return exchange.leaving == instrument; });
}

/// Whether the input is one of an instrument that waits, which asks for it to come in or changes nothing, or of one
/// that is being drawn back.
bool LiveSource::is_exchange(const LiveInput& input) {
  const auto i = static_cast<std::size_t>(input.instrument);
  if (i >= states_now_.size()) return false;
  for (const Exchange& exchange : exchanges_)
    if (exchange.coming == input.instrument || exchange.leaving == input.instrument) return true;
  if (!states_now_[i].waits) return false;
  const auto in_port = [&](std::size_t k) {
    return !states_now_[k].waits && instruments_[k].definition.port == instruments_[i].definition.port;
  };
  std::size_t there = 0;
  while (!in_port(there)) ++there;
  const std::string &name = instruments_[i].definition.name, &other = instruments_[there].definition.name;
  if (input.action != InstrumentAction::exchange) {
    if (std::exchange(told_to_wait_[i], 1) == 0)
      say(fmt::format("{} waits outside, and {} is in its port: the action exchange has it come in.", name,
                      other));
  } else if (!states_now_[there].holds.empty()) {
    say(fmt::format("{} cannot come in: {} holds {}.", name, other, states_now_[there].holds));
  } else {
    exchanges_.push_back({input.instrument, static_cast<int>(there)});
    asked_.instruments[there] = given_.instruments[there];
    asked_.instruments[there].insertion = std::min(port_depth, given_.instruments[there].insertion);
    asked_.actions[there] = InstrumentAction::none;
  }
  return true;
}

/// What came of those that were asked to come in; whoever changed places is where the world has it.
void LiveSource::note_exchanges(const World& world) {
  const StepReport& report = world.report();
  for (std::size_t i = 0; i < states_now_.size(); ++i)
    if (report.instruments[i].waits != states_now_[i].waits) {
      asked_.instruments[i] = given_.instruments[i] = report.instruments[i].pose;
      told_to_wait_[i] = 0;
    }
  states_now_ = report.instruments;
  for (const Exchange& exchange : exchanges_) {
    if (!exchange.asked) continue;
    const std::string& name = instruments_[static_cast<std::size_t>(exchange.coming)].definition.name;
    for (const WorldEvent& event : report.events) {
      if (event.instrument != name) continue;
      if (event.kind == EventKind::exchange) say(fmt::format("{} came in for {}.", name, event.text));
      if (event.kind == EventKind::blocked_exchange)
        say(fmt::format("{} cannot come in: {}.", name, event.text));
    }
  }
  std::erase_if(exchanges_, [](const Exchange& exchange) { return exchange.asked; });
}

void LiveSource::apply(const LiveInput& input, double at) {
  const auto i = static_cast<std::size_t>(input.instrument);
  if (!is_exchange(input)) {
    asked_.instruments[i] = input.pose;
    asked_.actions[i] = input.action;
  }
  ++figures_.inputs;
  heard_ = true;
  if (!started_) {
    started_ = true;
    due_ = clock_.now();
  } else if (!paused_) {
    figures_.longest_silence = std::max(figures_.longest_silence, at - *last_input_);
  }
  last_input_ = fresh_ = at;
  if (options_.pictures && !paused_) unseen_.push_back(at);
  said_silence_ = false;
  if (lost_at_) set_paused(false, "The input is back.");
}

/// It counts in the next step, and begins the session as an input does.
void LiveSource::apply(const SessionAct& act, double at) {
  if (paused_)
    return refuse(
        {{}, fmt::format("no {} while the session is paused", to_text(act.kind)), "`resume` first"});
  if (!started_) due_ = clock_.now();
  started_ = heard_ = true;
  asked_.acts.push_back(act);
  last_input_ = at;
  said_silence_ = false;
}

void LiveSource::apply(LiveCommand command) {
  const std::string& name = live_command_names()[static_cast<std::size_t>(command)];
  const bool ends = command == LiveCommand::end || command == LiveCommand::abandon;
  if (options_.mode == LiveMode::exam && !ends)
    return refuse(
        {{}, fmt::format("an exam knows no {}", name), "`abandon` ends it; it is scored as it stands"});
  if (command == LiveCommand::pause) return set_paused(true, "");
  if (command == LiveCommand::resume) return set_paused(false, "");
  end_by(name);
}

void LiveSource::apply(const LiveLoss& loss) {
  if (options_.mode == LiveMode::exam || !loss.may_return) {
    say(fmt::format("{}: the session ends here.", loss.why));
    return end_by("lost");
  }
  set_paused(true, fmt::format("{}: the session waits {:g} s for it to come back.", loss.why,
                               options_.return_within));
  lost_at_ = clock_.now();
}

void LiveSource::set_paused(bool paused, const std::string& why) {
  lost_at_.reset();
  if (paused == paused_) return;
  const double now = clock_.now();
  if (paused) {
    ++figures_.pauses;
    paused_since_ = now;
  } else {
    figures_.paused += now - paused_since_;
    due_ += now - paused_since_;
    last_input_ = now;
  }
  paused_ = paused;
  say((why.empty() ? "" : why + " ") + (paused ? "Paused." : "Going on."));
}

void LiveSource::end_by(const std::string& how) {
  if (paused_) figures_.paused += clock_.now() - paused_since_;
  paused_ = false;
  ended_by_ = how;
}

void LiveSource::refuse(const Problem& problem) {
  ++figures_.refused;
  if (figures_.refused <= most_said) say(to_text(problem));
  if (figures_.refused == most_said) say("Whatever else is refused is only counted.");
}

void LiveSource::say(const std::string& text) const {
  if (options_.say) options_.say(text);
}

/// Each instrument goes on towards what is asked of it; the laparoscope is named only where it moves.
StepInput LiveSource::follow(double dt) {
  bool lags = false;
  const InstrumentPose scope_before = given_.instruments.back();
  for (std::size_t i = 0; i < instruments_.size(); ++i) {
    InstrumentPose& pose = given_.instruments[i];
    const InstrumentPose& to = asked_.instruments[i];
    const bool drawn_back = std::any_of(exchanges_.begin(), exchanges_.end(), [&](const Exchange& exchange) {
      return exchange.leaving == static_cast<int>(i);
    });
    if (late_) catching_up_[i] = 1;
    Speed speed{most_tip_speed, most_turn_speed};
    const bool in_tissue =
        i < states_now_.size() && (states_now_[i].touching || !states_now_[i].holds.empty());
    if (catching_up_[i])
      speed = in_tissue ? Speed{late_tissue_speed, late_tissue_turn} : Speed{late_tip_speed, late_turn_speed};
    if (drawn_back) speed.tip = withdrawing_speed;
    const double share = share_within_speed(instruments_[i], pose, to, speed, dt);
    if (share >= 1) catching_up_[i] = 0;
    lags = lags || (share < 1 && !drawn_back);
    pose = share < 1 ? interpolate(pose, to, share) : to;
  }
  given_.actions = asked_.actions;
  for (Exchange& exchange : exchanges_) {
    const auto leaving = static_cast<std::size_t>(exchange.leaving);
    if (given_.instruments[leaving] != asked_.instruments[leaving]) continue;
    given_.actions[static_cast<std::size_t>(exchange.coming)] = InstrumentAction::exchange;
    exchange.asked = true;
  }
  given_.acts = std::exchange(asked_.acts, {});
  figures_.following_steps += lags ? 1 : 0;
  StepInput input = given_;
  if (input.instruments.back() != scope_before) input.laparoscope = input.instruments.back();
  input.instruments.pop_back();
  input.actions.pop_back();
  return input;
}

Result<std::optional<StepInput>> LiveSource::conclude() const {
  const bool scored = options_.mode == LiveMode::exam && !stopped();
  const bool counts = ended_by_ == "end" || (scored && !ended_by_.empty());
  if (counts && !never_began()) return std::optional<StepInput>();
  return fail(FailureKind::interrupted, "the session was ended by its operator");
}

LiveFigures LiveSource::figures() const {
  LiveFigures figures = figures_;
  figures.ended_by = ended_by_;
  figures.full = mailbox_.times_full();
  figures.wait_median = median(waits_);
  figures.wait_most = most(waits_);
  figures.state_median = median(states_);
  figures.state_most = most(states_);
  if (options_.pictures) figures.pictures = options_.pictures->figures();
  return figures;
}

std::vector<std::string> LiveSource::notes() const {
  std::vector<std::string> notes;
  const LiveFigures f = figures();
  if (never_began()) notes.emplace_back("the exam ended before it began: nothing had come");
  if (f.ended_by == "abandon") notes.emplace_back("the session was abandoned by its operator");
  if (f.ended_by == "restart") notes.emplace_back("the session was begun again by its operator");
  if (f.ended_by == "lost") notes.emplace_back("the input was lost before it said `end`");
  if (f.pauses > 0)
    notes.push_back(fmt::format("the session was paused {} times, for {:.1f} s in all", f.pauses, f.paused));
  if (f.slowed_steps > 0)
    notes.push_back(
        fmt::format("this machine was too slow for real time: {} steps began late, and the session's clock "
                    "fell {:.2f} s behind; no step was left out",
                    f.slowed_steps, f.slowed));
  if (f.following_steps > 0)
    notes.push_back(fmt::format(
        "in {} steps an instrument went after a jump of its input, at {:g} m/s or {:g} rad/s, or after late "
        "steps at {:g} m/s and {:g} rad/s, in tissue {:g} and {:g}",
        f.following_steps, most_tip_speed, most_turn_speed, late_tip_speed, late_turn_speed,
        late_tissue_speed, late_tissue_turn));
  if (f.refused > 0)
    notes.push_back(fmt::format("{} lines of input were refused, and changed nothing", f.refused));
  if (f.full > 0)
    notes.push_back(
        fmt::format("input came faster than it could be taken: the sender was held up {} times", f.full));
  return notes;
}

}  // namespace calot
