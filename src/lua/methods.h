#pragma once
// The functions behind the methods that the API declares.

#include <string>

#include "script/lua_headers.h"

namespace calot {

/// The function of a class's method, its own or inherited. Every declared method has one; the tests check it.
lua_CFunction method_function(const std::string& class_name, const std::string& method);

}  // namespace calot
