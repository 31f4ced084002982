#include "lua/handles.h"

#include <fmt/format.h>

#include "base/suggest.h"
#include "lua/methods.h"
#include "lua/mistakes.h"
#include "script/binding.h"

namespace calot {
namespace {

std::string registry_name(const std::string& class_name) { return fmt::format("calot.{}", class_name); }

/// In a dry run, of an unknown member of t: works as an instrument and as a method.
std::string stand_in(const std::string& class_name) { return class_name + " or method"; }

const HandleTarget* target_at(lua_State* L, int index) {
  const void* data = lua_touserdata(L, index);
  if (data == nullptr || lua_getmetatable(L, index) == 0) return nullptr;
  const bool known = lua_getfield(L, -1, "calot.handle") == LUA_TBOOLEAN;
  lua_pop(L, 2);
  return known ? static_cast<const HandleTarget*>(data) : nullptr;
}

std::string name_of(const HandleTarget& target) {
  if (target.instrument < 0) return "t";
  if (target.instrument == target.session->laparoscope()) return std::string("t.") + laparoscope_name;
  return "t." + target.session->scene().instruments[static_cast<std::size_t>(target.instrument)].name;
}

void push_handle(lua_State* L, const HandleTarget& target, const std::string& class_name, int user_values) {
  void* data = lua_newuserdatauv(L, sizeof(HandleTarget), user_values);
  *static_cast<HandleTarget*>(data) = target;
  luaL_setmetatable(L, registry_name(class_name).c_str());
}

int describe_handle(lua_State* L) {
  const HandleTarget* target = target_at(L, 1);
  lua_pushstring(L, target != nullptr ? name_of(*target).c_str() : "a handle");
  return 1;
}

int do_nothing(lua_State*) { return 0; }

std::string class_of(const HandleTarget& target) {
  const ScriptSession& session = *target.session;
  if (target.instrument < 0) return session.class_name();
  return target.instrument == session.laparoscope() ? session.laparoscope_class()
                                                    : session.instrument_class();
}

/// Method, or instrument of t. Upvalue 1: the class's methods. In a dry run an unknown name is reported and
/// stands for something harmless, so that what follows is checked too.
int index_handle(lua_State* L) {
  const HandleTarget* target = target_at(L, 1);
  if (target == nullptr) return luaL_error(L, "not a handle");
  lua_settop(L, 2);
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  const bool is_session = target->instrument < 0;
  if (is_session) {
    lua_getiuservalue(L, 1, 1);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, -2) != LUA_TNIL) return 1;
  }
  ScriptSession& session = *target->session;
  std::vector<std::string> names = method_names(class_of(*target));
  if (is_session) {
    names.insert(names.begin(), laparoscope_name);
    for (const InstrumentDefinition& instrument : session.scene().instruments)
      names.insert(names.begin(), instrument.name);
  }
  const std::string wanted = text_or_type(L, 2);
  session.complain(L, fmt::format("{} has no \"{}\"", name_of(*target), wanted), suggestion(wanted, names));
  if (is_session && !session.scene().instruments.empty()) {
    push_handle(L, {&session, 0}, stand_in(session.instrument_class()), 0);
  } else {
    lua_pushcfunction(L, do_nothing);
  }
  return 1;
}

void push_methods(lua_State* L, const std::string& class_name) {
  lua_newtable(L);
  for (const std::string& name : method_names(class_name)) {
    lua_pushcfunction(L, method_function(class_name, name));
    lua_setfield(L, -2, name.c_str());
  }
}

void make_class(lua_State* L, const std::string& name, const std::string& class_name) {
  luaL_newmetatable(L, registry_name(name).c_str());
  push_methods(L, class_name);
  lua_pushcclosure(L, guarded<index_handle>, 1);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, guarded<describe_handle>);
  lua_setfield(L, -2, "__tostring");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pushboolean(L, 1);
  lua_setfield(L, -2, "calot.handle");
}

}  // namespace

void open_handles(lua_State* L) {
  for (const ApiClass& handle : api_classes()) {
    make_class(L, handle.name, handle.name);
    lua_pop(L, 1);
    make_class(L, stand_in(handle.name), handle.name);
    lua_pushcfunction(L, do_nothing);
    lua_setfield(L, -2, "__call");
    lua_pop(L, 1);
  }
}

void push_session_handle(lua_State* L, ScriptSession& session) {
  push_handle(L, {&session, -1}, session.class_name(), 1);
  lua_newtable(L);
  int index = 0;
  for (const InstrumentDefinition& instrument : session.scene().instruments) {
    push_handle(L, {&session, index++}, session.instrument_class(), 0);
    lua_setfield(L, -2, instrument.name.c_str());
  }
  push_handle(L, {&session, index}, session.laparoscope_class(), 0);
  lua_setfield(L, -2, laparoscope_name);
  lua_setiuservalue(L, -2, 1);
}

HandleTarget handle_target(lua_State* L, const char* method) {
  const HandleTarget* target = target_at(L, 1);
  if (target == nullptr)
    luaL_error(L, "%s must be called with a colon, of what it is asked: t:%s(...), or t.left:%s(...)", method,
               method, method);
  if (!target->session->ended().empty())
    luaL_error(L, "%s can no longer be used: %s", name_of(*target).c_str(), target->session->ended().c_str());
  return *target;
}

}  // namespace calot
