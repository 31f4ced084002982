#pragma once
// Lua's C API. The project links liblua5.4-c++, in which a Lua error is a C++ exception: destructors run. So
// never wrap calls of this API in catch (...), and let no exception of ours cross it (see binding.h).
// Debian's header declares it extern "C" for C++ too, and its library exports unmangled names.

#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
