#pragma once
// What a script's t and its instruments answer to, in steps, in the demo, and while both are only being
// checked.

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lua/read_parameters.h"
#include "lua/table_reader.h"
#include "organs/tissue.h"
#include "script/sandbox.h"
#include "session/exercise.h"

namespace calot {

/// Where an instrument touches an organ.
struct TouchedPlace {
  ToolPart part = ToolPart::tip;
  Vec3 at = Vec3::Zero();  ///< m
  std::string organ;       ///< empty: nowhere
  std::string landmark;    ///< the nearest, "organ.landmark"
  double force = 0;        ///< N, on the whole part
};

/// One run of steps or demo. Handles in Lua point to it, so it lives at least as long as its sandbox's last
/// call.
class ScriptSession {
 public:
  /// `problems` set: a dry run, in which waits return at once and mistakes are collected instead of raised.
  ScriptSession(Sandbox& sandbox, const ExerciseDefinition& exercise, std::string class_name,
                std::string instrument_class, const Parameters& parameters, std::vector<Problem>* problems);
  virtual ~ScriptSession() = default;
  ScriptSession(const ScriptSession&) = delete;
  ScriptSession& operator=(const ScriptSession&) = delete;

  Sandbox& sandbox() const { return sandbox_; }
  const ExerciseDefinition& exercise() const { return exercise_; }
  const SceneDefinition& scene() const { return exercise_.scene; }
  const std::string& class_name() const { return class_name_; }
  const std::string& instrument_class() const { return instrument_class_; }
  /// What the handle of t.laparoscope has for its instrument, behind those of the scene; and its class.
  int laparoscope() const { return static_cast<int>(scene().instruments.size()); }
  std::string laparoscope_class() const { return class_name_ == "Demo" ? "DemoLaparoscope" : "Laparoscope"; }
  bool checking() const { return problems_ != nullptr; }

  /// Why handles no longer work; empty while they do.
  const std::string& ended() const { return ended_; }
  /// The world of the call that is running. Raises an error outside of one.
  const World& world(lua_State* L) const;
  /// s; in a dry run the sum of all waits.
  virtual double time() const = 0;
  /// t:wait and t:wait_until; what to return to Lua.
  virtual int wait(lua_State* L, double duration) = 0;
  virtual int wait_until(lua_State* L, int predicate) = 0;

  /// A mistake at the script's line: raised, or collected in a dry run.
  void complain(lua_State* L, const std::string& message, const std::string& hint);
  /// All of its problems as one.
  void complain(lua_State* L, const Failure& failure);
  /// Index of the organ among those of the world's report, in a dry run among known_organs(); or -1 after a complaint.
  int organ(lua_State* L, const std::string& name);
  /// What has left all organs, or one of the scene and its pieces, m^3; complains where there is none of that name.
  double lost(lua_State* L, bool blood, const std::string& organ);
  /// m^3, of a dry run: nothing, some, or all.
  double guessed_loss();
  /// Share of a tissue's strands that are torn; complains where there is none of that name.
  double torn(lua_State* L, const std::string& name);
  /// Of a triangle, m^2 (World::seen_area); in a dry run none, half or all of it.
  double seen_area(lua_State* L, const std::array<Vec3, 3>& corners);
  /// Whether the laparoscope sees a place, m (World::sees); a dry run answers either way.
  bool sees(lua_State* L, const Vec3& place);
  bool sees(lua_State* L, const std::string& landmark);
  /// Where the laparoscope is and what it touches; in a dry run stand-ins, near what it looks at and far, level and not.
  LaparoscopeState lens(lua_State* L);
  /// From its port to its lens there, unit.
  Vec3 lens_axis(const LaparoscopeState& lens) const;
  /// The critical view of safety (World::critical_view); in a dry run nothing, half or all of it. Complains about names.
  CriticalView critical_view(lua_State* L, const CriticalViewQuestion& question);
  /// A strand of a tissue that stands.
  struct PresentStrand {
    StrandLine line;
    double share = 0;    ///< of the first organ's way
    double tension = 0;  ///< N
  };
  /// All of a tissue; in a dry run none or one, a stand-in. Complains as torn() does.
  std::vector<PresentStrand> strands(lua_State* L, const std::string& tissue);
  /// "organ.landmark" of this scene; complains when it is none.
  bool is_landmark(lua_State* L, const std::string& name);
  /// Complains about what needs jaws, of an instrument that has none.
  bool can_use_jaws(lua_State* L, int instrument, const std::string& command);
  /// The same of current.
  bool can_act(lua_State* L, int instrument, InstrumentAction action, const std::string& command);
  /// A place on a tube, m, and its direction there, unit; of a stand-in where there is none, or after a complaint.
  std::pair<Vec3, Vec3> along(lua_State* L, const std::string& tube, double share);
  /// Complains about an organ that is not of the kind that a method asks about: clips and divided of tubes, raw of lobes,
  /// pressure and volume of hollow organs.
  void expect_kind(lua_State* L, int index, const std::string& method);
  /// Whether a tube has been divided; complains about what is none.
  bool divided(lua_State* L, const std::string& tube);
  /// Where a landmark of this scene is now, m; in a dry run without a world about where it will be.
  Vec3 landmark(lua_State* L, const std::string& name) const;
  /// The skin's outward normal there, unit; in a dry run needs a world.
  Vec3 landmark_normal(lua_State* L, const std::string& name) const;
  /// Where an instrument's tip is now, m; a stand-in where a dry run does not know it.
  Vec3 tip(lua_State* L, int instrument);
  /// How far an instrument's end is from an organ, m (World::clearance); complains where there is none of that name.
  double clearance(lua_State* L, int instrument, const std::string& organ);
  /// From its port to its tip, unit.
  Vec3 shaft_axis(lua_State* L, int instrument);
  /// Where the part that `choose` picks is pressed hardest; a stand-in in a dry run.
  TouchedPlace contact(lua_State* L, int instrument,
                       const std::function<ToolPart(const InstrumentState&)>& choose);

  // A dry run has no world (but see set_world): what a script asks is answered by stand-ins, in turns, so that
  // loops for either end.
  bool next_guess();
  /// What was answered may differ from what the world will answer.
  void stand_in() { stood_in_ = true; }
  InstrumentState stand_in_instrument(int instrument);
  OrganState stand_in_organ(int organ);
  /// Calls the function once with each set of stand-ins; what fails is reported.
  void ask_dry(lua_State* L, int predicate);
  /// What a condition, a registry reference, answers: nil and false are no. Raises an error at its lines where it returns
  /// nothing, or what is neither true nor false nor something that may be missing: a number, a text.
  static bool ask_condition(lua_State* L, int predicate);
  /// In a dry run: whether the last failure need not be the author's mistake. It follows from one that is reported,
  /// or is the script's own check (error, assert) of a stand-in.
  bool is_no_mistake(const Failure& failure) {
    return failure.kind == FailureKind::scenario && (complained_ || (sandbox_.take_raised() && stood_in_));
  }

  /// The scene's organs and those that may come later.
  std::vector<OrganDefinition> known_organs() const;
  /// A copy, as steps that are being checked bring more of them.
  OrganDefinition known_organ(int index) const { return known_organs()[static_cast<std::size_t>(index)]; }

 protected:
  void set_world(const World* world) { world_ = world; }
  void end(const std::string& why) { ended_ = why; }
  bool has_world() const { return world_ != nullptr; }
  /// Whether the script has gone by stand-ins: what it does from then on need not be what it would do.
  bool stood_in() const { return stood_in_; }
  /// In a dry run: an instrument's tip where that is known.
  virtual std::optional<Vec3> known_tip(int /*instrument*/) const { return std::nullopt; }
  /// Of a dry run: what steps may bring, beside the scene's organs.
  virtual const std::vector<OrganDefinition>& later_organs() const { return exercise_.later_organs; }
  virtual const std::vector<TissueDefinition>& later_tissues() const { return exercise_.later_tissues; }
  /// Complains where no tissue has that name, or may have it later.
  bool is_tissue(lua_State* L, const std::string& name);
  /// In a dry run: counts a wait, and ends the run (by a yield) when it would last too long. True: it does.
  /// No duration: the wait lasts as long as the world makes it.
  bool end_dry_run(lua_State* L, std::optional<double> duration);
  static std::string waits_message();
  static std::string waits_hint();
  double dry_time() const { return dry_time_; }
  std::vector<Problem>* problems() const { return problems_; }
  /// Starts the coroutine of steps or demo, to be resumed with two arguments: t and p.
  Result<lua_State*> start_main(int function);

 private:
  /// Whether this was said of that line: a loop comes by it more than once.
  bool said_before(const Problem& problem) const;
  int next_level();
  /// Of the scene's ports or the usual ones, m.
  Vec3 port_position(const std::string& name) const;

  Sandbox& sandbox_;
  const ExerciseDefinition& exercise_;
  std::string class_name_, instrument_class_;
  const Parameters& parameters_;
  std::vector<Problem>* problems_;
  const World* world_ = nullptr;
  std::string ended_;
  double dry_time_ = 0;
  int dry_waits_ = 0;
  double stalled_since_ = 0;  ///< s, of the dry clock
  int stalled_waits_ = 0;
  bool stood_in_ = false, complained_ = false;
  bool guess_ = false;
  int level_ = 0;
  bool asking_ = false;  ///< with guess_ and level_ as they are
  int asked_ = 0;
};

/// A script may wait so often within one simulated step.
inline constexpr int most_waits_per_step = 1000;

/// The arguments of one method call, checked against the API's declaration. In a dry run unfit ones are
/// reported and read as absent.
class Arguments {
 public:
  Arguments(lua_State* L, ScriptSession& session, const std::string& owner, const std::string& method);

  bool good() const { return good_; }
  const TableReader& read() const { return reader_; }
  double number(const std::string& name, double fallback = 0) const;
  std::string text(const std::string& name) const;
  /// Registry reference of a function, or 0.
  int function(const std::string& name) const;
  /// The point in `value`, or nothing and a problem for finish().
  std::optional<Vec3> point(const Value& value, const std::string& name);
  /// Of a table of options; `api` is its declaration.
  TableReader options(const std::string& api) { return table("options", api); }
  TableReader table(const std::string& name, const std::string& api);
  FieldCheck& check() { return check_; }
  /// Raises or reports what options() and others found. True when all is well.
  bool finish();

 private:
  static Value values_of(lua_State* L, const ApiFunction& function, FieldCheck& check);
  static KeyTable table_of(const ApiFunction& function);

  lua_State* L_;
  ScriptSession& session_;
  const ApiFunction& function_;
  FieldCheck check_;
  Value values_;
  KeyTable api_;
  TableReader reader_;
  bool good_ = true;
};

}  // namespace calot
