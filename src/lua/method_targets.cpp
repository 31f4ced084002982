#include "lua/method_targets.h"

#include <fmt/format.h>

namespace calot {

void take_nothing(lua_State* L, ScriptSession& session, const char* method) {
  if (lua_gettop(L) > 1)
    session.complain(L, fmt::format("{} takes no arguments", method), "leave the brackets empty");
}

HandleTarget instrument_target(lua_State* L, const char* method) {
  const HandleTarget target = handle_target(L, method);
  if (target.instrument < 0 || target.instrument == target.session->laparoscope())
    luaL_error(L, "%s is a method of instruments: t.left:%s(...)", method, method);
  return target;
}

ScriptSession& laparoscope_target(lua_State* L, const char* method) {
  const HandleTarget target = handle_target(L, method);
  if (target.instrument != target.session->laparoscope())
    luaL_error(L, "%s is a method of the laparoscope: t.laparoscope:%s(...)", method, method);
  return *target.session;
}

ScriptSession& session_target(lua_State* L, const char* method) {
  const HandleTarget target = handle_target(L, method);
  if (target.instrument >= 0) luaL_error(L, "%s is a method of t: t:%s(...)", method, method);
  return *target.session;
}

void set_number(lua_State* L, const char* key, double number) {
  lua_pushnumber(L, number);
  lua_setfield(L, -2, key);
}

int push_vector(lua_State* L, const Vec3& vector) {
  lua_createtable(L, 3, 0);
  for (int i = 0; i < 3; ++i) {
    lua_pushnumber(L, vector[i]);
    lua_rawseti(L, -2, i + 1);
  }
  return 1;
}

std::optional<Vec3> place_argument(lua_State* L, ScriptSession& session, Arguments& arguments,
                                   const std::string& name) {
  const Value* place = arguments.read().take(name);
  if (place == nullptr || !place->is(Value::Kind::text)) {
    const std::optional<Vec3> point = place != nullptr ? arguments.point(*place, name) : std::nullopt;
    return arguments.finish() ? point : std::nullopt;
  }
  if (!arguments.finish() || !session.is_landmark(L, place->text)) return std::nullopt;
  return session.landmark(L, place->text);
}

}  // namespace calot
