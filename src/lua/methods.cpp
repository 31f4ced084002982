#include "lua/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/index_of.h"
#include "base/suggest.h"
#include "lua/demo_methods.h"
#include "lua/demo_script.h"
#include "lua/handles.h"
#include "lua/laparoscope_methods.h"
#include "lua/read_scene.h"
#include "lua/score_rules.h"
#include "lua/steps_script.h"
#include "script/binding.h"

namespace calot {
namespace {

// ---- both sessions

int wait(lua_State* L) {
  ScriptSession& session = session_target(L, "wait");
  const Arguments arguments(L, session, "Session", "wait");
  return session.wait(L, arguments.number("duration"));
}

int wait_until(lua_State* L) {
  ScriptSession& session = session_target(L, "wait_until");
  const Arguments arguments(L, session, "Session", "wait_until");
  return session.wait_until(L, arguments.function("predicate"));
}

int time(lua_State* L) {
  ScriptSession& session = session_target(L, "time");
  take_nothing(L, session, "time");
  lua_pushnumber(L, session.time());
  return 1;
}

/// The organ's state, or a stand-in in a dry run, or nothing after a complaint.
OrganState organ_state(lua_State* L, const char* method) {
  ScriptSession& session = session_target(L, method);
  const Arguments arguments(L, session, "Session", method);
  const int organ = arguments.good() ? session.organ(L, arguments.text("organ")) : -1;
  if (organ < 0) return {};
  session.expect_kind(L, organ, method);
  if (session.checking()) return session.stand_in_organ(organ);
  return session.world(L).report().organs[static_cast<std::size_t>(organ)];
}

int pressure(lua_State* L) {
  lua_pushnumber(L, organ_state(L, "pressure").pressure);
  return 1;
}

int volume(lua_State* L) {
  lua_pushnumber(L, organ_state(L, "volume").volume);
  return 1;
}

int raw(lua_State* L) {
  lua_pushnumber(L, organ_state(L, "raw").raw);
  return 1;
}

int torn(lua_State* L) {
  ScriptSession& session = session_target(L, "torn");
  const Arguments arguments(L, session, "Session", "torn");
  lua_pushnumber(L, arguments.good() ? session.torn(L, arguments.text("tissue")) : 0.0);
  return 1;
}

int lost(lua_State* L) {
  ScriptSession& session = session_target(L, "lost");
  const Arguments arguments(L, session, "Session", "lost");
  lua_pushnumber(L, arguments.good()
                        ? session.lost(L, arguments.text("liquid") == "blood", arguments.text("organ"))
                        : 0.0);
  return 1;
}

int divided(lua_State* L) {
  ScriptSession& session = session_target(L, "divided");
  const Arguments arguments(L, session, "Session", "divided");
  bool answer = arguments.good() && session.divided(L, arguments.text("organ"));
  if (session.checking()) answer = session.next_guess();
  lua_pushboolean(L, answer);
  return 1;
}

int clips(lua_State* L) {
  const OrganState state = organ_state(L, "clips");
  lua_createtable(L, static_cast<int>(state.clips.size()), 0);
  for (std::size_t i = 0; i < state.clips.size(); ++i) {
    lua_createtable(L, 0, 3);
    lua_pushnumber(L, state.clips[i].share);
    lua_setfield(L, -2, "place");
    lua_pushnumber(L, state.clips[i].opening);
    lua_setfield(L, -2, "opening");
    lua_pushstring(L, clip_row(state.clips[i].size).name);
    lua_setfield(L, -2, "size");
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return 1;
}

/// Where the landmark is; none after a complaint.
std::optional<Vec3> landmark_argument(lua_State* L, ScriptSession& session, const Arguments& arguments) {
  const std::string name = arguments.text("landmark");
  if (!arguments.good() || !session.is_landmark(L, name)) return std::nullopt;
  if (session.checking()) session.stand_in();  // what it belongs to will have moved
  return session.landmark(L, name);
}

int place(lua_State* L) {
  ScriptSession& session = session_target(L, "place");
  const Arguments arguments(L, session, "Session", "place");
  return push_vector(L, landmark_argument(L, session, arguments).value_or(Vec3::Zero()));
}

int along(lua_State* L) {
  ScriptSession& session = session_target(L, "along");
  const Arguments arguments(L, session, "Session", "along");
  if (!arguments.good()) return 0;
  const auto [place, way] = session.along(L, arguments.text("organ"), arguments.number("share"));
  push_vector(L, place);
  push_vector(L, way);
  return 2;
}

int seen_area(lua_State* L) {
  ScriptSession& session = session_target(L, "seen_area");
  Arguments arguments(L, session, "Session", "seen_area");
  std::array<Vec3, 3> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  arguments.read().take("a", corners[0]);
  arguments.read().take("b", corners[1]);
  arguments.read().take("c", corners[2]);
  lua_pushnumber(L, arguments.finish() ? session.seen_area(L, corners) : 0.0);
  return 1;
}

int sees(lua_State* L) {
  ScriptSession& session = session_target(L, "sees");
  Arguments arguments(L, session, "Session", "sees");
  const Value* asked = arguments.read().take("place");
  const std::string landmark = asked != nullptr && asked->is(Value::Kind::text) ? asked->text : std::string();
  const std::optional<Vec3> place = place_argument(L, session, arguments, "place");
  lua_pushboolean(L, place && (landmark.empty() ? session.sees(L, *place) : session.sees(L, landmark)));
  return 1;
}

/// Points are whole numbers, as tables and reports show them.
void set_count(lua_State* L, const char* key, int value) {
  lua_pushinteger(L, value);
  lua_setfield(L, -2, key);
}

int critical_view(lua_State* L) {
  ScriptSession& session = session_target(L, "critical_view");
  Arguments arguments(L, session, "Session", "critical_view");
  CriticalViewQuestion question;
  const TableReader options = arguments.options("critical_view_options");
  options.read(question);
  if (options.has("behind")) options.take("behind", question.behind.emplace(Vec3::Zero()));
  const CriticalView view = arguments.finish() ? session.critical_view(L, question) : CriticalView{};
  lua_createtable(L, 0, 4);
  lua_createtable(L, 0, 5);
  set_number(L, "front", view.front.cleared);
  set_number(L, "behind", view.back.cleared);
  set_number(L, "front_open", view.front.open);
  set_number(L, "behind_open", view.back.open);
  set_count(L, "points", view.triangle_points);
  lua_setfield(L, -2, "triangle");
  lua_createtable(L, 0, 2);
  set_number(L, "share", view.plate);
  set_count(L, "points", view.plate_points);
  lua_setfield(L, -2, "plate");
  lua_createtable(L, 0, 3);
  set_count(L, "count", view.structures);
  set_count(L, "free", view.free);
  set_count(L, "points", view.structure_points);
  lua_setfield(L, -2, "structures");
  set_count(L, "points", view.points());
  return 1;
}

int strands(lua_State* L) {
  ScriptSession& session = session_target(L, "strands");
  const Arguments arguments(L, session, "Session", "strands");
  std::vector<ScriptSession::PresentStrand> found;
  if (arguments.good()) found = session.strands(L, arguments.text("tissue"));
  lua_createtable(L, static_cast<int>(found.size()), 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    lua_createtable(L, 0, 5);
    push_vector(L, found[i].line.from);
    lua_setfield(L, -2, "from");
    push_vector(L, found[i].line.by);
    lua_setfield(L, -2, "middle");
    push_vector(L, found[i].line.to);
    lua_setfield(L, -2, "to");
    set_number(L, "share", found[i].share);
    set_number(L, "tension", found[i].tension);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return 1;
}

// ---- instruments

InstrumentState instrument_state(lua_State* L, const HandleTarget& target) {
  if (target.session->checking()) return target.session->stand_in_instrument(target.instrument);
  return target.session->world(L).report().instruments[static_cast<std::size_t>(target.instrument)];
}

/// The same for a method without parameters.
InstrumentState instrument_state(lua_State* L, const char* method) {
  const HandleTarget target = instrument_target(L, method);
  take_nothing(L, *target.session, method);
  return instrument_state(L, target);
}

/// None without a name, or after a complaint.
std::optional<ToolPart> part_called(const std::string& name) {
  return enumerator_called<ToolPart>(name, tool_part_names());
}

int holds(lua_State* L) {
  const HandleTarget target = instrument_target(L, "holds");
  const Arguments arguments(L, *target.session, "Instrument", "holds");
  const std::string organ = arguments.text("organ");
  const bool known = organ.empty() || target.session->organ(L, organ) >= 0;
  const std::string held = instrument_state(L, target).holds;
  bool answer = known && (organ.empty() ? !held.empty() : held == organ);
  if (target.session->checking()) answer = target.session->next_guess();
  lua_pushboolean(L, answer);
  return 1;
}

/// The load on the part that the call names, or on the whole instrument without a name.
struct Load {
  Vec3 force = Vec3::Zero();
  bool touching = false;
};
Load load_of(lua_State* L, const HandleTarget& target, const Arguments& arguments) {
  const InstrumentState state = instrument_state(L, target);
  const std::optional<ToolPart> part = part_called(arguments.text("part"));
  if (!part || target.session->checking()) return {state.force, state.touching};
  const PartLoad& of_part = state.load_on(*part);
  return {of_part.force, of_part.touches > 0};
}
Load load_of(lua_State* L, const char* method) {
  const HandleTarget target = instrument_target(L, method);
  return load_of(L, target, Arguments(L, *target.session, "Instrument", method));
}

/// N along the shaft, positive into the body; a dry run answers either way.
double along_shaft(lua_State* L, const char* method) {
  const Vec3 force = load_of(L, method).force;
  const HandleTarget target = instrument_target(L, method);
  if (target.session->checking()) return target.session->next_guess() ? force.norm() : -force.norm();
  return force.dot(target.session->shaft_axis(L, target.instrument));
}

int touching(lua_State* L) {
  const HandleTarget target = instrument_target(L, "touching");
  const Load load = load_of(L, target, Arguments(L, *target.session, "Instrument", "touching"));
  lua_pushboolean(L, target.session->checking() ? target.session->next_guess() : load.touching);
  return 1;
}

int active(lua_State* L) {
  const HandleTarget target = instrument_target(L, "active");
  target.session->can_act(L, target.instrument, InstrumentAction::activate, "active");
  const bool flows = instrument_state(L, "active").action == InstrumentAction::activate;
  lua_pushboolean(L, target.session->checking() ? target.session->next_guess() : flows);
  return 1;
}

int waits(lua_State* L) {
  const HandleTarget target = instrument_target(L, "waits");
  bool waits = instrument_state(L, "waits").waits;
  if (const auto* demo = dynamic_cast<const DemoScript*>(target.session); demo != nullptr)
    waits = demo->waits(target.instrument);
  else if (target.session->checking())
    waits = target.session->next_guess();
  lua_pushboolean(L, waits);
  return 1;
}

int clips_left(lua_State* L) {
  const HandleTarget target = instrument_target(L, "clips_left");
  target.session->can_act(L, target.instrument, InstrumentAction::fire, "clips_left");
  lua_pushinteger(L, instrument_state(L, "clips_left").clips);
  return 1;
}

int aspirated(lua_State* L) {
  const HandleTarget target = instrument_target(L, "aspirated");
  ScriptSession& session = *target.session;
  session.can_act(L, target.instrument, InstrumentAction::aspirate, "aspirated");
  lua_pushnumber(L, session.checking() ? session.guessed_loss() : instrument_state(L, "aspirated").aspirated);
  return 1;
}

int force(lua_State* L) {
  lua_pushnumber(L, load_of(L, "force").force.norm());
  return 1;
}

int force_vector(lua_State* L) { return push_vector(L, load_of(L, "force_vector").force); }

int pull(lua_State* L) {
  lua_pushnumber(L, std::max(0.0, along_shaft(L, "pull")));
  return 1;
}

int push(lua_State* L) {
  lua_pushnumber(L, std::max(0.0, -along_shaft(L, "push")));
  return 1;
}

int grip(lua_State* L) {
  const HandleTarget target = instrument_target(L, "grip");
  target.session->can_use_jaws(L, target.instrument, "grip");
  const GripState state = instrument_state(L, "grip").grip;
  lua_pushstring(L, grip_state_names()[static_cast<std::size_t>(state)].c_str());
  return 1;
}

void push_text_field(lua_State* L, const char* key, const std::string& text) {
  lua_pushstring(L, text.c_str());
  lua_setfield(L, -2, key);
}

/// The part that was asked for, or the one that is pressed hardest; the tip where it is the tip's hardest point.
ToolPart hardest_part(const InstrumentState& state, const std::optional<ToolPart>& asked) {
  ToolPart part = state.load_on(ToolPart::jaws).largest >= state.load_on(ToolPart::shaft).largest
                      ? ToolPart::jaws
                      : ToolPart::shaft;
  if (state.load_on(ToolPart::jaws).touches == 0) part = ToolPart::shaft;
  if (state.load_on(ToolPart::shaft).touches == 0) part = ToolPart::jaws;
  if (asked) part = *asked;
  const bool at_tip = state.load_on(ToolPart::tip).touches > 0 &&
                      state.load_on(ToolPart::tip).at == state.load_on(ToolPart::jaws).at;
  return part == ToolPart::jaws && at_tip ? ToolPart::tip : part;
}

int contact(lua_State* L) {
  const HandleTarget target = instrument_target(L, "contact");
  const Arguments arguments(L, *target.session, "Instrument", "contact");
  const std::optional<ToolPart> asked = part_called(arguments.text("part"));
  const TouchedPlace place = target.session->contact(
      L, target.instrument, [&](const InstrumentState& state) { return hardest_part(state, asked); });
  if (place.organ.empty()) {
    lua_pushnil(L);
    return 1;
  }
  lua_createtable(L, 0, 5);
  push_text_field(L, "part", tool_part_names()[static_cast<std::size_t>(place.part)]);
  push_text_field(L, "organ", place.organ);
  push_text_field(L, "landmark", place.landmark);
  push_vector(L, place.at);
  lua_setfield(L, -2, "place");
  lua_pushnumber(L, place.force);
  lua_setfield(L, -2, "force");
  return 1;
}

int handle_force(lua_State* L) {
  lua_pushnumber(L, instrument_state(L, "handle_force").handle_force.norm());
  return 1;
}

int torque(lua_State* L) {
  lua_pushnumber(L, instrument_state(L, "torque").roll_torque);
  return 1;
}

int tip(lua_State* L) {
  const HandleTarget target = instrument_target(L, "tip");
  take_nothing(L, *target.session, "tip");
  return push_vector(L, target.session->tip(L, target.instrument));
}

int distance(lua_State* L) {
  const HandleTarget target = instrument_target(L, "distance");
  const Arguments arguments(L, *target.session, "Instrument", "distance");
  const std::optional<Vec3> place = landmark_argument(L, *target.session, arguments);
  lua_pushnumber(L, place ? (target.session->tip(L, target.instrument) - *place).norm() : 0);
  return 1;
}

int clearance(lua_State* L) {
  const HandleTarget target = instrument_target(L, "clearance");
  const Arguments arguments(L, *target.session, "Instrument", "clearance");
  lua_pushnumber(L, target.session->clearance(L, target.instrument, arguments.text("organ")));
  return 1;
}

// ---- steps

StepsScript& steps_of(lua_State* L, const char* method) {
  auto* steps = dynamic_cast<StepsScript*>(&session_target(L, method));
  if (steps == nullptr) luaL_error(L, "t:%s is a method of the t of steps", method);
  return *steps;
}

/// The band that a step asks for; none where its three keys are not there, and complains where they do not fit.
std::optional<ForceBand> take_band(lua_State* L, ScriptSession& session, TableReader& options) {
  ForceBand band;
  std::optional<double> least, most;
  options.take("force_on", band.instrument);
  const bool named = !band.instrument.empty();
  options.take("least", least);
  options.take("most", most);
  if (!named && !least && !most) return std::nullopt;
  if (least && most && !(*least < *most)) {
    session.complain(L, fmt::format("least is {:g} N and most {:g} N", *least, *most),
                     "let least be below most");
    return std::nullopt;
  }
  if (!named || !least || !most) {
    session.complain(L, "force_on, least and most say together which force a step asks for",
                     "write force_on = \"left\", least = 1.5 * N, most = 3 * N");
    return std::nullopt;
  }
  std::vector<std::string> names;
  for (const InstrumentDefinition& instrument : session.scene().instruments) names.push_back(instrument.name);
  if (std::find(names.begin(), names.end(), band.instrument) == names.end()) {
    session.complain(L, fmt::format("there is no instrument \"{}\"", band.instrument),
                     suggestion(band.instrument, names));
    return std::nullopt;
  }
  band.least = *least;
  band.most = *most;
  return band;
}

int step(lua_State* L) {
  StepsScript& steps = steps_of(L, "step");
  steps.try_step();
  Arguments arguments(L, steps, "Steps", "step");
  StepOptions about;
  TableReader options = arguments.options("step_options");
  options.take("limit", about.limit);
  options.take("hint", about.hint);
  about.band = take_band(L, steps, options);
  if (arguments.finish()) steps.step(L, arguments.text("name"), arguments.text("title"), about);
  return 0;
}

int note(lua_State* L) {
  StepsScript& steps = steps_of(L, "note");
  const Arguments arguments(L, steps, "Steps", "note");
  if (!arguments.good()) return 0;
  steps.note(L, arguments.text("name"), *arguments.read().take("value"), arguments.text("unit"));
  return 0;
}

int count(lua_State* L) {
  StepsScript& steps = steps_of(L, "count");
  const Arguments arguments(L, steps, "Steps", "count");
  lua_pushinteger(L, arguments.good() ? steps.count(L, arguments.text("event"), arguments.text("organ")) : 0);
  return 1;
}

int missed(lua_State* L) {
  StepsScript& steps = steps_of(L, "missed");
  const Arguments arguments(L, steps, "Steps", "missed");
  if (arguments.good()) steps.missed(L, arguments.text("why"));
  return 0;
}

int events(lua_State* L) {
  StepsScript& steps = steps_of(L, "events");
  const Arguments arguments(L, steps, "Steps", "events");
  push_events(L, steps.events(L));
  return 1;
}

int hold(lua_State* L) {
  StepsScript& steps = steps_of(L, "hold");
  const Arguments arguments(L, steps, "Steps", "hold");
  return steps.hold(L, arguments.text("name"), arguments.function("predicate"), arguments.number("duration"));
}

int divide(lua_State* L) {
  StepsScript& steps = steps_of(L, "divide");
  const Arguments arguments(L, steps, "Steps", "divide");
  return arguments.good() ? steps.divide(L, arguments.text("organ"), arguments.number("share")) : 0;
}

int clip(lua_State* L) {
  StepsScript& steps = steps_of(L, "clip");
  const Arguments arguments(L, steps, "Steps", "clip");
  if (!arguments.good()) return 0;
  const std::string size = arguments.text("size");
  // No other name is fit; where it is left out it is ML.
  const ClipSize wanted =
      size.empty() ? ClipSize::ml : enumerator_called<ClipSize>(size, clip_names()).value();
  steps.clip(L, arguments.text("organ"), arguments.number("share"), wanted);
  return 0;
}

int remove(lua_State* L) {
  StepsScript& steps = steps_of(L, "remove");
  const Arguments arguments(L, steps, "Steps", "remove");
  if (arguments.good()) steps.remove(L, arguments.text("organ"), arguments.text("why"));
  return 0;
}

int add(lua_State* L) {
  StepsScript& steps = steps_of(L, "add");
  Arguments arguments(L, steps, "Steps", "add");
  if (!arguments.good()) return 0;
  const OrganDefinition organ = read_organ(arguments.check(), *arguments.read().take("organ"), "organ", {});
  if (arguments.finish()) steps.add(L, organ);
  return 0;
}

int release(lua_State* L) {
  StepsScript& steps = steps_of(L, "release");
  const Arguments arguments(L, steps, "Steps", "release");
  if (arguments.good()) steps.release(L, arguments.text("organ"), arguments.text("held"));
  return 0;
}

int add_tissue(lua_State* L) {
  StepsScript& steps = steps_of(L, "add_tissue");
  Arguments arguments(L, steps, "Steps", "add_tissue");
  TissueDefinition tissue;
  arguments.table("tissue", "tissue").read(tissue);
  if (arguments.finish()) steps.add_tissue(L, tissue);
  return 0;
}

int remove_tissue(lua_State* L) {
  StepsScript& steps = steps_of(L, "remove_tissue");
  const Arguments arguments(L, steps, "Steps", "remove_tissue");
  if (arguments.good()) steps.remove_tissue(L, arguments.text("tissue"));
  return 0;
}

int bleed(lua_State* L) {
  StepsScript& steps = steps_of(L, "bleed");
  const Arguments arguments(L, steps, "Steps", "bleed");
  constexpr double usual_width = 1e-3;  // m, as the API says
  double share = 0;
  if (arguments.good())
    share = steps.bleed(L, arguments.text("organ"), arguments.number("share"),
                        arguments.number("width", usual_width));
  lua_pushnumber(L, share);
  return 1;
}

int tie(lua_State* L) {
  StepsScript& steps = steps_of(L, "tie");
  Arguments arguments(L, steps, "Steps", "tie");
  JointDefinition joint;
  arguments.table("joint", "joint").read(joint);
  if (arguments.finish()) steps.tie(L, joint);
  return 0;
}

int untie(lua_State* L) {
  StepsScript& steps = steps_of(L, "untie");
  const Arguments arguments(L, steps, "Steps", "untie");
  if (arguments.good()) steps.untie(L, arguments.text("organ"), arguments.text("other"));
  return 0;
}

const Method own_methods[] = {{"Session", "wait", guarded<wait>},
                              {"Session", "wait_until", guarded<wait_until>},
                              {"Session", "time", guarded<time>},
                              {"Session", "pressure", guarded<pressure>},
                              {"Session", "volume", guarded<volume>},
                              {"Session", "torn", guarded<torn>},
                              {"Session", "raw", guarded<raw>},
                              {"Session", "divided", guarded<divided>},
                              {"Session", "clips", guarded<clips>},
                              {"Session", "lost", guarded<lost>},
                              {"Session", "place", guarded<place>},
                              {"Session", "along", guarded<along>},
                              {"Session", "seen_area", guarded<seen_area>},
                              {"Session", "sees", guarded<sees>},
                              {"Session", "critical_view", guarded<critical_view>},
                              {"Session", "strands", guarded<strands>},
                              {"Steps", "step", guarded<step>},
                              {"Steps", "missed", guarded<missed>},
                              {"Steps", "hold", guarded<hold>},
                              {"Steps", "note", guarded<note>},
                              {"Steps", "divide", guarded<divide>},
                              {"Steps", "clip", guarded<clip>},
                              {"Steps", "remove", guarded<remove>},
                              {"Steps", "add", guarded<add>},
                              {"Steps", "release", guarded<release>},
                              {"Steps", "add_tissue", guarded<add_tissue>},
                              {"Steps", "remove_tissue", guarded<remove_tissue>},
                              {"Steps", "bleed", guarded<bleed>},
                              {"Steps", "tie", guarded<tie>},
                              {"Steps", "untie", guarded<untie>},
                              {"Steps", "count", guarded<count>},
                              {"Steps", "events", guarded<events>},
                              {"Run", "count", guarded<count_events_of_run>},
                              {"Run", "times", guarded<times_of_events_of_run>},
                              {"Instrument", "holds", guarded<holds>},
                              {"Instrument", "force", guarded<force>},
                              {"Instrument", "handle_force", guarded<handle_force>},
                              {"Instrument", "torque", guarded<torque>},
                              {"Instrument", "touching", guarded<touching>},
                              {"Instrument", "active", guarded<active>},
                              {"Instrument", "waits", guarded<waits>},
                              {"Instrument", "tip", guarded<tip>},
                              {"Instrument", "distance", guarded<distance>},
                              {"Instrument", "clearance", guarded<clearance>},
                              {"Instrument", "force_vector", guarded<force_vector>},
                              {"Instrument", "pull", guarded<pull>},
                              {"Instrument", "push", guarded<push>},
                              {"Instrument", "grip", guarded<grip>},
                              {"Instrument", "clips_left", guarded<clips_left>},
                              {"Instrument", "aspirated", guarded<aspirated>},
                              {"Instrument", "contact", guarded<contact>}};

}  // namespace

lua_CFunction method_function(const std::string& class_name, const std::string& method) {
  const auto found = [&](const Method& candidate) {
    return class_name == candidate.class_name && method == candidate.name;
  };
  for (const Method& candidate : own_methods)
    if (found(candidate)) return candidate.function;
  for (const std::vector<Method>* more : {&demo_methods(), &laparoscope_methods()})
    for (const Method& candidate : *more)
      if (found(candidate)) return candidate.function;
  for (const ApiClass& handle : api_classes())
    if (handle.name == class_name && !handle.parent.empty()) return method_function(handle.parent, method);
  std::abort();  // declared but not bound
}

}  // namespace calot
