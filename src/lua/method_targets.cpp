#include "lua/method_targets.h"

#include <fmt/format.h>

namespace calot {

void take_nothing(lua_State* L, ScriptSession& session, const char* method) {
  if (lua_gettop(L) > 1)
    session.complain(L, fmt::format("{} takes no arguments", method), "leave the brackets empty");
}

HandleTarget instrument_target(lua_State* L, const char* method) {
  const HandleTarget target = handle_target(L, method);
  if (target.instrument < 0) luaL_error(L, "%s is a method of instruments: t.left:%s(...)", method, method);
  return target;
}

ScriptSession& session_target(lua_State* L, const char* method) {
  const HandleTarget target = handle_target(L, method);
  if (target.instrument >= 0) luaL_error(L, "%s is a method of t: t:%s(...)", method, method);
  return *target.session;
}

}  // namespace calot
