// clang-format off
#include "script/sandbox_library.h"

namespace calot {

const std::vector<std::string>& library_names() {
  static const std::vector<std::string> names = {
      "_VERSION", "assert", "coroutine", "coroutine.create", "coroutine.isyieldable", "coroutine.resume",
      "coroutine.running", "coroutine.status", "coroutine.wrap", "coroutine.yield", "error", "getmetatable",
      "ipairs", "math", "math.abs", "math.acos", "math.asin", "math.atan", "math.ceil", "math.cos",
      "math.deg", "math.exp", "math.floor", "math.fmod", "math.huge", "math.log", "math.max",
      "math.maxinteger", "math.min", "math.mininteger", "math.modf", "math.pi", "math.rad", "math.random",
      "math.sin", "math.sqrt", "math.tan", "math.tointeger", "math.type", "math.ult", "pairs", "pcall",
      "print", "rawequal", "rawget", "rawlen", "rawset", "require", "select", "setmetatable", "string",
      "string.byte", "string.char", "string.find", "string.format", "string.gmatch", "string.gsub",
      "string.len", "string.lower", "string.match", "string.pack", "string.packsize", "string.rep",
      "string.reverse", "string.sub", "string.unpack", "string.upper", "table", "table.concat",
      "table.insert", "table.move", "table.pack", "table.remove", "table.sort", "table.unpack", "tonumber",
      "tostring", "type", "utf8", "utf8.char", "utf8.charpattern", "utf8.codepoint", "utf8.codes",
      "utf8.len", "utf8.offset", "xpcall",
  };
  return names;
}

}  // namespace calot
