#pragma once
// steps = function(t): a coroutine that waits for the world and marks steps, holds and their metrics.

#include "lua/script_session.h"

namespace calot {

class StepsScript final : public ScriptSession {
 public:
  /// `function` is a registry reference.
  StepsScript(Sandbox& sandbox, const ExerciseDefinition& exercise, int function,
              const Parameters& parameters, std::vector<Problem>* problems = nullptr);

  /// See ExerciseScript::advance.
  Result<bool> advance(World& world, Progress& progress, double dt);

  /// What a dry run found. `complete`: the function ran to its end.
  struct Declared {
    std::vector<std::string> steps, holds, notes;  ///< holds are "step.hold"; notes those of numbers
    std::vector<std::string> waited;               ///< steps that ask no condition: time alone ends them
    std::vector<OrganDefinition> later;            ///< organs that may come: pieces of others too
    std::vector<TissueDefinition> later_tissues;   ///< likewise
    bool complete = false;
  };
  /// Runs the function with waits that return at once. A failure is the script's.
  Result<Declared> run_dry();

  double time() const override { return checking() ? dry_time() : now_; }
  int wait(lua_State* L, double duration) override;
  int wait_until(lua_State* L, int predicate) override;
  /// A step is about to be declared: what is said of it stands for what follows from it.
  void try_step() { step_tried_ = true; }
  void step(lua_State* L, const std::string& name, const std::string& title, const StepOptions& options);
  void missed(lua_State* L, const std::string& why);
  /// So far; in a dry run none.
  std::vector<SessionEvent> events(lua_State* L);
  void note(lua_State* L, const std::string& name, const Value& value, const std::string& unit);
  /// Events of a kind so far, of an organ or a piece of it unless that is empty; in a dry run a stand-in.
  int count(lua_State* L, const std::string& event, const std::string& organ);
  // What changes who is in the world, at once. In a dry run names are known from when they may come and are not forgotten.
  int divide(lua_State* L, const std::string& organ, double share);
  void clip(lua_State* L, const std::string& organ, double share, ClipSize size);
  void remove(lua_State* L, const std::string& organ, const std::string& why);
  void add(lua_State* L, const OrganDefinition& organ);
  void release(lua_State* L, const std::string& organ, const std::string& held);
  void add_tissue(lua_State* L, const TissueDefinition& tissue);
  void remove_tissue(lua_State* L, const std::string& name);
  /// Returns at which share of the tube.
  double bleed(lua_State* L, const std::string& organ, double share, double width);
  void tie(lua_State* L, const JointDefinition& joint);
  void untie(lua_State* L, const std::string& one, const std::string& other);
  int hold(lua_State* L, const std::string& name, int predicate, double duration);

 protected:
  const std::vector<OrganDefinition>& later_organs() const override {
    return checking() ? declared_.later : ScriptSession::later_organs();
  }
  const std::vector<TissueDefinition>& later_tissues() const override {
    return checking() ? declared_.later_tissues : ScriptSession::later_tissues();
  }

 private:
  struct Wait {
    enum class Kind { none, time, condition, hold } kind = Kind::none;
    double until = 0;     ///< time: s
    int predicate = 0;    ///< condition, hold: registry reference
    std::string metric;   ///< hold
    double duration = 0;  ///< hold: wanted, s
    double held = 0;      ///< hold: so far
    double last = 0;      ///< hold: when last asked, s
  };

  bool may_wait(lua_State* L, const char* method);
  bool is_name(lua_State* L, const std::string& what, const std::string& name);
  /// Complains of what no event's organ is called.
  void expect_place(lua_State* L, const std::string& name);
  int suspend(lua_State* L, Wait wait);
  int dry_wait(lua_State* L, std::optional<double> duration);
  std::optional<int> answered_at_once(lua_State* L, int predicate);
  /// Whether who is in the world may change: not while a predicate is asked, and not without one.
  bool may_change(lua_State* L, const char* method);
  void bring_later(const OrganDefinition& organ);
  /// Of a dry run: complains about what is no tube, see no_tube().
  void expect_tube(lua_State* L, const OrganDefinition& organ, const std::string& act,
                   const std::string& done);
  std::optional<Failure> start();
  Result<bool> ask(int predicate);
  /// Whether the wait is over. A hold's metric is brought up to date.
  Result<bool> is_over();
  std::optional<Failure> wake(bool answer);
  bool pass_limit();
  Result<bool> run();

  int function_;
  lua_State* thread_ = nullptr;
  Wait wait_;
  double now_ = 0;
  bool finished_ = false;
  bool timed_out_ =
      false;  ///< the step's limit has passed: conditions are not waited for until the next step
  Progress* progress_ = nullptr;
  World* changing_ = nullptr;  ///< the world of the call that is running
  Declared declared_;
  std::string current_;      ///< the step declared last
  double limit_ = 0;         ///< of that step, s; 0: none
  bool step_tried_ = false;  ///< one was, well or not
};

}  // namespace calot
