#pragma once
// A session that somebody operates while it runs. Whatever a hand moves (a line of text, a mouse, a gamepad) is put into
// one mailbox as plain data; the simulating thread takes out what is there once a step. Nothing here knows a device, a
// terminal or a window, and time is asked of a clock that tests replace.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "session/acts.h"
#include "session/exercise.h"

namespace calot {

/// Practice says what to do next, and may be paused and begun again. An exam does neither.
enum class LiveMode { practice, exam };
std::string to_text(LiveMode mode);  ///< "practice", "exam"
const std::vector<std::string>& live_mode_names();

/// What a live session's instruments are, for who fills the mailbox.
struct LiveInstrument {
  InstrumentDefinition definition;
  InstrumentGeometry geometry;
  Vec3 trocar = Vec3::Zero();  ///< m
  bool is_laparoscope = false;
};
/// In the order of the scene, which is that of a step's input; the laparoscope is the last.
std::vector<LiveInstrument> live_instruments(const SceneDefinition& scene);

enum class LiveCommand { pause, resume, restart, abandon, end };
const std::vector<std::string>& live_command_names();  ///< in the order of the commands

/// The one door for whatever moves an instrument.
struct LiveInput {
  int instrument = 0;
  InstrumentPose pose;
  InstrumentAction action = InstrumentAction::none;  ///< until this instrument's next input
  std::optional<double>
      time;  ///< s, of the source's own clock; it decides the step where LiveOptions::stamped
};

/// Something that was sent and cannot be used: it changes nothing.
struct LiveRefusal {
  Problem problem;
};

/// What the operator should know of a source that is used all the same.
struct LiveRemark {
  std::string text;
};

/// The source is gone without having said `end`.
struct LiveLoss {
  std::string why;
  bool may_return = false;  ///< another input or command may still come
};

using LiveEvent = std::variant<LiveInput, LiveCommand, SessionAct, LiveRefusal, LiveRemark, LiveLoss>;

class LiveClock {
 public:
  virtual ~LiveClock() = default;
  virtual double now() const = 0;           ///< s, never backwards
  virtual void sleep(double duration) = 0;  ///< s; at most
};
LiveClock& steady_clock();

/// What is sent, in its order, until the session takes it. It holds so many and no more: who sends faster waits, which
/// a pipe or socket passes on to the sender.
class LiveMailbox {
 public:
  static constexpr std::size_t capacity = 4096;

  explicit LiveMailbox(LiveClock& clock = steady_clock()) : clock_(clock) {}
  /// Waits while the mailbox is full; false once it is closed.
  bool put(LiveEvent event);
  /// For who must not wait, as a window: false where there is no room.
  bool offer(LiveEvent event);
  struct Sent {
    LiveEvent event;
    double at = 0;  ///< s of the clock, when it was put in
  };
  std::optional<Sent> take();
  /// Puts back what was taken last.
  void give_back(Sent sent);
  /// Who waits to put something in is let go.
  void close();
  int times_full() const { return times_full_; }

 private:
  LiveClock& clock_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::deque<Sent> waiting_;
  std::atomic<int> times_full_ = 0;
  bool closed_ = false;
};

/// What was seen of a session's states, and how soon after the inputs that led to them: noted by who shows pictures, in
/// another thread than the session's.
class LivePictures {
 public:
  explicit LivePictures(LiveClock& clock = steady_clock()) : clock_(clock) {}
  /// A state is seen now that is the first one to follow these inputs; each by when it came, s of the clock. Until then the
  /// session had stood still for `paused` in all, s.
  void note_shown(const std::vector<double>& inputs, double paused = 0);
  struct Figures {
    int shown = 0;
    double running = 0;                     ///< s, from the first to the last of them, pauses left out
    double wait_median = 0, wait_most = 0;  ///< s, from an input to the first picture that follows it
  };
  Figures figures() const;

 private:
  LiveClock& clock_;
  mutable std::mutex mutex_;
  int shown_ = 0;
  double begun_ = 0, running_ = 0;
  std::vector<double> waits_;
};

struct LiveOptions {
  LiveMode mode = LiveMode::practice;
  /// The inputs' times decide in which step they count, and steps follow each other as fast as they can. Else a step
  /// takes 1 / rate of the clock, or longer where the machine is too slow, and the newest input counts.
  bool stamped = false;
  bool begins_at_once = false;  ///< else the session's time begins with the first input
  bool watch_silence = false;   ///< say when nothing has come for long
  double return_within = 30;    ///< s that a lost source has to come back, in practice
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> say;  ///< what the operator should know, as it happens
  std::shared_ptr<LivePictures> pictures;       ///< of who shows the session; none: nobody does
};

/// How a live session went besides what happened in it. Times are of the clock, s.
struct LiveFigures {
  LiveMode mode = LiveMode::practice;
  bool stamped = false;
  std::string ended_by;  ///< "end", "abandon", "restart", "lost"; empty: by the exercise, or interrupted
  int inputs = 0, refused = 0, full = 0, pauses = 0;
  double paused = 0;
  double slowed = 0;           ///< by which the clock was behind in all: the machine could not keep up
  int slowed_steps = 0;        ///< after which it was
  double longest_step = 0;     ///< from one step's begin to the next one's, waiting left out
  double longest_silence = 0;  ///< between inputs
  int following_steps = 0;     ///< in which an instrument had not reached what was asked: see most_tip_speed
  double wait_median = 0, wait_most = 0;    ///< from an input's coming to the step that takes it
  double state_median = 0, state_most = 0;  ///< from there to the state that it led to, pictures left out
  std::optional<LivePictures::Figures> pictures;  ///< where they were shown
};

/// Takes the place of a demo. `next` waits until its step is due.
class LiveSource : public InputSource {
 public:
  /// An instrument goes after what is asked of it at this speed and no faster: a jump of a tracker or the first place of
  /// all is not a blow. m/s at the tip; rad/s about the shaft and between the jaws.
  static constexpr double most_tip_speed = 1.0, most_turn_speed = 12.0;
  /// And where a step has taken longer than it lasts, until it is where it is asked to be: the hand went on meanwhile, and its
  /// whole way in one step would be a blow, whose step takes longer still.
  static constexpr double late_tip_speed = 0.1, late_turn_speed = 3.0;
  /// Of these one that touches or holds tissue: as a careful hand, which closes jaws in half a second.
  static constexpr double late_tissue_speed = 0.02, late_tissue_turn = 1.6;
  /// m/s, of an instrument that is drawn back into its port for another one to come in.
  static constexpr double withdrawing_speed = 0.15;

  LiveSource(std::vector<LiveInstrument> instruments, LiveMailbox& mailbox, LiveOptions options,
             LiveClock& clock = steady_clock());

  /// Fails (interrupted) where the session was abandoned, begun again or stopped; ends where the operator says so.
  Result<std::optional<StepInput>> next(const World& world, double dt) override;
  std::vector<std::string> notes() const override;
  LiveFigures figures() const;
  /// Whether an instrument goes back into its port for another one: what is asked of it does not count.
  bool is_drawn_back(int instrument) const;
  /// When the inputs came that the present state is the first to follow: those since it was asked last, but for those that
  /// came while it stood still. s of the clock; kept only where pictures are shown.
  std::vector<double> take_unseen() { return std::exchange(unseen_, {}); }
  /// How long it has stood still until now, s.
  double paused() const { return figures_.paused; }
  bool wants_restart() const { return ended_by_ == "restart"; }

 private:
  void begin(const World& world);
  void note_step();
  bool wait_until_due(double dt);
  void take_newest();
  bool take_stamped(double time);
  void watch_silence();
  void apply(const LiveMailbox::Sent& sent);
  void apply(const LiveInput& input, double at);
  void apply(LiveCommand command);
  void apply(const SessionAct& act, double at);
  void apply(const LiveLoss& loss);
  void set_paused(bool paused, const std::string& why);
  void end_by(const std::string& how);
  bool stopped() const { return options_.stop != nullptr && *options_.stop; }
  /// An exam that ended before anything had come: it has no score.
  bool never_began() const { return options_.mode == LiveMode::exam && !heard_ && !ended_by_.empty(); }
  bool over() const { return !ended_by_.empty() || stopped(); }
  void refuse(const Problem& problem);
  bool is_exchange(const LiveInput& input);
  void note_exchanges(const World& world);
  void say(const std::string& text) const;
  Result<std::optional<StepInput>> conclude() const;
  StepInput follow(double dt);

  std::vector<LiveInstrument> instruments_;
  LiveMailbox& mailbox_;
  LiveOptions options_;
  LiveClock& clock_;
  StepInput asked_, given_;  ///< the laparoscope is the last of their instruments
  /// An instrument that comes in, and the one that is drawn back for it.
  struct Exchange {
    int coming = 0, leaving = 0;
    bool asked = false;  ///< of the world, in the running step
  };
  std::vector<Exchange> exchanges_;
  std::vector<InstrumentState> states_now_;  ///< of the world, but for the laparoscope
  std::vector<char> told_to_wait_;           ///< the operator knows that it waits
  bool begun_ = false, started_ = false;     ///< called at all; an input has come, or need not
  bool heard_ = false;                       ///< an input or an act has come, or none need come
  bool paused_ = false;
  std::optional<double> lost_at_;
  std::string ended_by_;
  double due_ = 0;                 ///< when the present step may begin, on the clock
  bool late_ = false;              ///< it begins later than it should by more than its length
  std::vector<char> catching_up_;  ///< instruments that go after their hands since a late step
  double paused_since_ = 0, step_began_ = 0;
  std::optional<double> last_input_;
  std::optional<double> fresh_;  ///< when the newest input came that the running step took
  bool running_ = false;         ///< a step was handed out
  bool said_silence_ = false;
  LiveFigures figures_;
  std::vector<double> waits_, states_, unseen_;
};

}  // namespace calot
