#include "lua/laparoscope_methods.h"

#include "lua/demo_methods.h"
#include "script/binding.h"

namespace calot {
namespace {

/// Where the laparoscope is, for a method without parameters.
LaparoscopeState lens_of(lua_State* L, const char* method) {
  ScriptSession& session = laparoscope_target(L, method);
  take_nothing(L, session, method);
  return session.lens(L);
}

int lens_tip(lua_State* L) { return push_vector(L, lens_of(L, "tip").view.position); }

int lens_direction(lua_State* L) { return push_vector(L, lens_of(L, "direction").view.direction); }

int lens_axis(lua_State* L) {
  const LaparoscopeState lens = lens_of(L, "axis");
  return push_vector(L, laparoscope_target(L, "axis").lens_axis(lens));
}

int lens_roll(lua_State* L) {
  lua_pushnumber(L, lens_of(L, "roll").pose.roll);
  return 1;
}

int lens_horizon(lua_State* L) {
  lua_pushnumber(L, horizon_off_level(lens_of(L, "horizon").view));
  return 1;
}

int lens_touching(lua_State* L) {
  const bool touches = !lens_of(L, "touching").touches.empty();
  ScriptSession& session = laparoscope_target(L, "touching");
  lua_pushboolean(L, session.checking() ? session.next_guess() : touches);
  return 1;
}

int lens_distance(lua_State* L) {
  ScriptSession& session = laparoscope_target(L, "distance");
  Arguments arguments(L, session, "Laparoscope", "distance");
  const std::optional<Vec3> place = place_argument(L, session, arguments, "place");
  lua_pushnumber(L, place ? (session.lens(L).view.position - *place).norm() : 0);
  return 1;
}

int lens_picture(lua_State* L) {
  ScriptSession& session = laparoscope_target(L, "picture");
  Arguments arguments(L, session, "Laparoscope", "picture");
  const std::optional<Vec3> place = place_argument(L, session, arguments, "place");
  std::optional<Vec2> shown;
  if (place)
    shown = place_in_picture(session.lens(L).view, session.scene().laparoscope.field_of_view, *place);
  if (!shown) return 0;
  lua_pushnumber(L, shown->x());
  lua_pushnumber(L, shown->y());
  return 2;
}

// ---- demos

DemoScript& mover(lua_State* L, const char* method) {
  return demo_of(L, laparoscope_target(L, method), method);
}

int lens_look_at(lua_State* L) {
  DemoScript& demo = mover(L, "look_at");
  Arguments arguments(L, demo, "DemoLaparoscope", "look_at");
  LookAt how{Vec3::Zero(), demo.scene().laparoscope.distance};
  arguments.options("look_options").read(how);
  const std::optional<Vec3> place = place_argument(L, demo, arguments, "place");
  if (!place) return 0;
  how.place = *place;
  return demo.look_at(L, how);
}

DemoCall lens_call(lua_State* L, const char* method) {
  DemoScript& demo = mover(L, method);
  return {demo, demo.laparoscope(), "DemoLaparoscope"};
}

int lens_move_to(lua_State* L) { return move_to(L, lens_call(L, "move_to")); }
int lens_move_by(lua_State* L) { return move_by(L, lens_call(L, "move_by")); }
int lens_rotate(lua_State* L) { return rotate(L, lens_call(L, "rotate")); }

}  // namespace

const std::vector<Method>& laparoscope_methods() {
  static const std::vector<Method> rows = {{"Laparoscope", "tip", guarded<lens_tip>},
                                           {"Laparoscope", "axis", guarded<lens_axis>},
                                           {"Laparoscope", "direction", guarded<lens_direction>},
                                           {"Laparoscope", "roll", guarded<lens_roll>},
                                           {"Laparoscope", "horizon", guarded<lens_horizon>},
                                           {"Laparoscope", "touching", guarded<lens_touching>},
                                           {"Laparoscope", "distance", guarded<lens_distance>},
                                           {"Laparoscope", "picture", guarded<lens_picture>},
                                           {"DemoLaparoscope", "look_at", guarded<lens_look_at>},
                                           {"DemoLaparoscope", "move_to", guarded<lens_move_to>},
                                           {"DemoLaparoscope", "move_by", guarded<lens_move_by>},
                                           {"DemoLaparoscope", "rotate", guarded<lens_rotate>}};
  return rows;
}

}  // namespace calot
