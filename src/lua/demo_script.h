#pragma once
// demo = function(t): a coroutine whose motions become the inputs of the session. Its clock is its own:
// motions begin where the last ended, not at the simulation's steps, so the path is the same at every rate.
// Only what asks the world (landmarks, conditions) sees it as of the last step.

#include "lua/motion.h"
#include "lua/script_session.h"
#include "session/acts.h"

namespace calot {

inline constexpr double default_speed = 30e-3;                       ///< m/s
inline constexpr double default_turning_speed = 1.5707963267948966;  ///< rad/s: 90 deg/s

struct Approach {
  std::string landmark;
  double speed = default_speed;
  double depth = 4e-3;        ///< m
  double clearance = 25e-3;   ///< m
  std::optional<double> jaw;  ///< rad; none: as far as they open
  Vec3 offset = Vec3::Zero();
};

struct MoveUntil {
  int predicate = 0;          ///< registry reference
  Vec3 along = Vec3::Zero();  ///< direction; zero: along the shaft, into the body
  std::string towards;        ///< a landmark, instead of a direction; may be empty
  double speed = 5e-3;        ///< m/s
  double limit = 20e-3;       ///< m
  bool active = false;        ///< current flows until it ends
};

/// Of the laparoscope.
struct LookAt {
  Vec3 place = Vec3::Zero();     ///< m, to be in the middle of the picture
  double distance = 0;           ///< m, from the lens to it
  double speed = default_speed;  ///< m/s, of the lens
};

struct Exchange {
  double speed = 150e-3;  ///< m/s, of the tip of the instrument that is drawn out
  double duration = 3;    ///< s that an assistant takes to change one for the other (d)
};

class DemoScript final : public ScriptSession, public InputSource {
 public:
  /// `function` is a registry reference; 0: there is no demo, and the source ends at once.
  DemoScript(Sandbox& sandbox, const ExerciseDefinition& exercise, int function, const Parameters& parameters,
             std::vector<Problem>* problems = nullptr);

  Result<std::optional<StepInput>> next(const World& world, double dt) override;

  /// Runs the function with motions that return at once; with a world, from its state at rest, motions out of
  /// reach are found too.
  std::optional<Failure> run_dry(const World* world = nullptr);

  double time() const override;
  int wait(lua_State* L, double duration) override;
  int wait_until(lua_State* L, int predicate) override;
  int together(lua_State* L);
  int approach(lua_State* L, int instrument, const Approach& how);
  /// `method` for the complaint about an instrument without jaws; no angle: as far as they open.
  int set_jaw(lua_State* L, int instrument, const std::string& method, std::optional<double> angle);
  /// This and the next, and rotate(): of the laparoscope too.
  int move_to(lua_State* L, int instrument, const Vec3& tip, double speed);
  int move_by(lua_State* L, int instrument, const Vec3& vector, double speed);
  int look_at(lua_State* L, const LookAt& how);
  /// Returns to Lua whether the predicate came to hold, and how far the tip was moved, m.
  int move_until(lua_State* L, int instrument, const MoveUntil& how);
  /// Lets current flow for a duration, s, and waits for that.
  int activate(lua_State* L, int instrument, double duration);
  /// The same of suction.
  int aspirate(lua_State* L, int instrument, double duration);
  /// Sets a clip, and waits until the trigger is let go.
  int fire(lua_State* L, int instrument);
  /// Has an instrument that waits come in: the one in its port is drawn back there, taken out, and this one brought in.
  int exchange(lua_State* L, int instrument, const Exchange& how);
  /// Whether it waits outside, as far as the script has come.
  bool waits(int instrument) const { return waits_[static_cast<std::size_t>(instrument)] != 0; }
  void act(lua_State* L, EventKind kind, const std::string& text);
  int rotate(lua_State* L, int instrument, double angle, double speed);

 protected:
  std::optional<Vec3> known_tip(int instrument) const override;

 private:
  /// A coroutine: the demo itself, or a function given to t:together.
  struct Task {
    lua_State* thread = nullptr;
    int parent = -1;
    int open_children = 0;
    double clock = 0;  ///< s
    int arguments = 0;
    int predicate = 0;  ///< of a condition waited for
    /// Of an instrument that moves until the condition holds; -1: none moves.
    int moving = -1;
    Vec3 moved_from = Vec3::Zero();  ///< m, its tip's place when it set out
    double arrives = 0;              ///< s, when it has gone as far as it may
    bool active = false;             ///< current flows until then
    enum { ready, until, condition, children, finished } state = ready;
  };

  int act_for(lua_State* L, int instrument, InstrumentAction action, double duration);
  int task_of(lua_State* L) const;
  /// The running task, if it may move or wait; complains otherwise.
  Task* current(lua_State* L);
  int dry_wait(lua_State* L, std::optional<double> duration);
  int dry_move_until(lua_State* L, const MoveUntil& how);
  int sleep_until(lua_State* L, double time);
  int run_children_dry(lua_State* L, std::size_t first);
  void make_paths(const World& world);
  /// What a method does that moves an instrument and waits for the end. `motion` is told the instrument's path and
  /// the time, and says when it will have ended, s; none: it complained. It is not asked where a dry run knows no
  /// world: that counts `dry_duration`, s.
  template <typename Motion>
  int play_motion(lua_State* L, int instrument, double dry_duration, const Motion& motion);
  InstrumentPath* free_path(lua_State* L, int instrument);
  /// The instrument in the port of one that waits.
  int in_port_of(int waiting) const;
  bool is_in_port(lua_State* L, int instrument);
  std::optional<Failure> check_exchanges(const World& world);
  bool can_reach(lua_State* L, const InstrumentPath& path, const Vec3& tip);
  bool can_open(lua_State* L, int instrument, double jaw);
  std::vector<InstrumentAction> actions(double end);
  std::optional<Failure> start();
  std::optional<Failure> ask_conditions(double now);
  /// Whether the wait of a task whose condition was just answered is over; pushes what it returns.
  bool end_condition(Task& task, bool answer, double now);
  std::optional<Failure> run_until(double end);
  std::optional<Failure> resume(std::size_t task);
  void finish(std::size_t task);

  InstrumentGeometry geometry(int instrument) const;

  int function_;
  std::vector<Task> tasks_;
  std::vector<InstrumentPath> paths_;  ///< one an instrument, and the laparoscope's
  /// When each instrument acts, s: in the steps that end within it.
  struct Flow {
    double from = 0, to = 0;
    InstrumentAction action = InstrumentAction::none;
  };
  std::vector<Flow> flows_;
  std::vector<SessionAct> acts_;              ///< since the last step
  std::vector<std::optional<double>> fires_;  ///< s, one an instrument: when its trigger is pulled next
  std::vector<char> waits_;                   ///< one an instrument; the laparoscope never does
  /// Of an instrument that comes in: when, s, and where the script says so.
  struct Coming {
    std::optional<double> at;  ///< none once it was asked for
    Place place;
  };
  std::vector<std::optional<Coming>> comings_;  ///< one an instrument
  int running_ = -1;
  double step_start_ = 0;  ///< s: the world's time in the present call
};

}  // namespace calot
