#include "lua/demo_methods.h"

#include "lua/demo_script.h"
#include "script/binding.h"

namespace calot {
namespace {

DemoCall demo_call(lua_State* L, const char* method) {
  const HandleTarget target = instrument_target(L, method);
  return {demo_of(L, *target.session, method), target.instrument, "DemoInstrument"};
}

int time_out(lua_State* L) {
  DemoScript& demo = demo_of(L, session_target(L, "time_out"), "time_out");
  const Arguments arguments(L, demo, "Demo", "time_out");
  if (arguments.good()) demo.act(L, EventKind::time_out, arguments.text("words"));
  return 0;
}

int bail_out(lua_State* L) {
  DemoScript& demo = demo_of(L, session_target(L, "bail_out"), "bail_out");
  const Arguments arguments(L, demo, "Demo", "bail_out");
  if (arguments.good()) demo.act(L, EventKind::bail_out, arguments.text("how"));
  return 0;
}

int together(lua_State* L) {
  DemoScript& demo = demo_of(L, session_target(L, "together"), "together");
  for (int i = 2; i <= lua_gettop(L) || i <= 3; ++i)
    if (!lua_isfunction(L, i)) {
      demo.complain(L, "t:together needs two functions or more",
                    "write t:together(function() ... end, function() ... end)");
      return 0;
    }
  return demo.together(L);
}

double speed_option(Arguments& arguments, const char* api, double usual) {
  arguments.options(api).take("speed", usual);
  return usual;
}

int approach(lua_State* L) {
  const DemoCall call = demo_call(L, "approach");
  Arguments arguments(L, call.demo, "DemoInstrument", "approach");
  Approach how;
  how.landmark = arguments.text("landmark");
  arguments.options("approach_options").read(how);
  if (!arguments.finish() || !call.demo.is_landmark(L, how.landmark)) return 0;
  return call.demo.approach(L, call.instrument, how);
}

int open(lua_State* L) {
  const DemoCall call = demo_call(L, "open");
  const Arguments arguments(L, call.demo, "DemoInstrument", "open");
  std::optional<double> angle;
  arguments.read().take("angle", angle);
  return call.demo.set_jaw(L, call.instrument, "open", angle);
}

int close(lua_State* L) {
  const DemoCall call = demo_call(L, "close");
  take_nothing(L, call.demo, "close");
  return call.demo.set_jaw(L, call.instrument, "close", 0.0);
}

int instrument_move_to(lua_State* L) { return move_to(L, demo_call(L, "move_to")); }

int instrument_move_by(lua_State* L) { return move_by(L, demo_call(L, "move_by")); }

int move_until(lua_State* L) {
  const DemoCall call = demo_call(L, "move_until");
  Arguments arguments(L, call.demo, "DemoInstrument", "move_until");
  MoveUntil how;
  how.predicate = arguments.function("predicate");
  const TableReader options = arguments.options("move_until_options");
  options.read(how);
  if (!arguments.finish()) return 0;
  if (options.has("along") && how.along.isZero()) {
    call.demo.complain(L, "along points nowhere", "give a direction such as { 0, 0, -1 }, or leave it out");
    return 0;
  }
  if (options.has("along") && options.has("towards")) {
    call.demo.complain(L, "along and towards are both given", "give one of them");
    return 0;
  }
  if (options.has("towards") && !call.demo.is_landmark(L, how.towards)) return 0;
  return call.demo.move_until(L, call.instrument, how);
}

int instrument_rotate(lua_State* L) { return rotate(L, demo_call(L, "rotate")); }

int aspirate(lua_State* L) {
  const DemoCall call = demo_call(L, "aspirate");
  const Arguments arguments(L, call.demo, "DemoInstrument", "aspirate");
  return call.demo.aspirate(L, call.instrument, arguments.number("duration"));
}

int activate(lua_State* L) {
  const DemoCall call = demo_call(L, "activate");
  const Arguments arguments(L, call.demo, "DemoInstrument", "activate");
  return call.demo.activate(L, call.instrument, arguments.number("duration"));
}

int fire(lua_State* L) {
  const DemoCall call = demo_call(L, "fire");
  take_nothing(L, call.demo, "fire");
  return call.demo.fire(L, call.instrument);
}

int exchange(lua_State* L) {
  const DemoCall call = demo_call(L, "exchange");
  Arguments arguments(L, call.demo, "DemoInstrument", "exchange");
  Exchange how;
  arguments.options("exchange_options").read(how);
  return arguments.finish() ? call.demo.exchange(L, call.instrument, how) : 0;
}

int instrument_wait(lua_State* L) {
  const DemoCall call = demo_call(L, "wait");
  const Arguments arguments(L, call.demo, "DemoInstrument", "wait");
  return call.demo.wait(L, arguments.number("duration"));
}

}  // namespace

DemoScript& demo_of(lua_State* L, ScriptSession& session, const char* method) {
  auto* demo = dynamic_cast<DemoScript*>(&session);
  if (demo == nullptr) luaL_error(L, "%s is available in demo only", method);
  return *demo;
}

int move_to(lua_State* L, const DemoCall& call) {
  Arguments arguments(L, call.demo, call.api, "move_to");
  const double speed = speed_option(arguments, "move_options", default_speed);
  const std::optional<Vec3> target = place_argument(L, call.demo, arguments, "target");
  return target ? call.demo.move_to(L, call.instrument, *target, speed) : 0;
}

int move_by(lua_State* L, const DemoCall& call) {
  Arguments arguments(L, call.demo, call.api, "move_by");
  const double speed = speed_option(arguments, "move_options", default_speed);
  Vec3 vector = Vec3::Zero();
  arguments.read().take("vector", vector);
  if (!arguments.finish()) return 0;
  return call.demo.move_by(L, call.instrument, vector, speed);
}

int rotate(lua_State* L, const DemoCall& call) {
  Arguments arguments(L, call.demo, call.api, "rotate");
  const double speed = speed_option(arguments, "rotate_options", default_turning_speed);
  if (!arguments.finish()) return 0;
  return call.demo.rotate(L, call.instrument, arguments.number("angle"), speed);
}

const std::vector<Method>& demo_methods() {
  static const std::vector<Method> rows = {{"Demo", "together", guarded<together>},
                                           {"Demo", "time_out", guarded<time_out>},
                                           {"Demo", "bail_out", guarded<bail_out>},
                                           {"DemoInstrument", "move_until", guarded<move_until>},
                                           {"DemoInstrument", "approach", guarded<approach>},
                                           {"DemoInstrument", "open", guarded<open>},
                                           {"DemoInstrument", "close", guarded<close>},
                                           {"DemoInstrument", "activate", guarded<activate>},
                                           {"DemoInstrument", "aspirate", guarded<aspirate>},
                                           {"DemoInstrument", "fire", guarded<fire>},
                                           {"DemoInstrument", "exchange", guarded<exchange>},
                                           {"DemoInstrument", "move_to", guarded<instrument_move_to>},
                                           {"DemoInstrument", "move_by", guarded<instrument_move_by>},
                                           {"DemoInstrument", "rotate", guarded<instrument_rotate>},
                                           {"DemoInstrument", "wait", guarded<instrument_wait>}};
  return rows;
}

}  // namespace calot
