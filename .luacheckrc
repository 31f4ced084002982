-- Generated from the API's table (src/lua/api_*.cpp, src/anatomy/scene_keys.cpp); the tests hold it to that. Do not edit.
std = "calot"
max_line_length = 120
exclude_files = { "scripts/lua/calot.meta.lua" }
stds.calot = {
  read_globals = {
    "_VERSION",
    "assert",
    coroutine = { fields = { ["create"] = {}, ["isyieldable"] = {}, ["resume"] = {}, ["running"] = {}, ["status"] = {}, ["wrap"] = {}, ["yield"] = {} } },
    "error",
    "getmetatable",
    "ipairs",
    math = { fields = { ["abs"] = {}, ["acos"] = {}, ["asin"] = {}, ["atan"] = {}, ["ceil"] = {}, ["cos"] = {}, ["deg"] = {}, ["exp"] = {}, ["floor"] = {}, ["fmod"] = {}, ["huge"] = {}, ["log"] = {}, ["max"] = {}, ["maxinteger"] = {}, ["min"] = {}, ["mininteger"] = {}, ["modf"] = {}, ["pi"] = {}, ["rad"] = {}, ["random"] = {}, ["sin"] = {}, ["sqrt"] = {}, ["tan"] = {}, ["tointeger"] = {}, ["type"] = {}, ["ult"] = {} } },
    "pairs",
    "pcall",
    "print",
    "rawequal",
    "rawget",
    "rawlen",
    "rawset",
    "require",
    "select",
    "setmetatable",
    string = { fields = { ["byte"] = {}, ["char"] = {}, ["find"] = {}, ["format"] = {}, ["gmatch"] = {}, ["gsub"] = {}, ["len"] = {}, ["lower"] = {}, ["match"] = {}, ["pack"] = {}, ["packsize"] = {}, ["rep"] = {}, ["reverse"] = {}, ["sub"] = {}, ["unpack"] = {}, ["upper"] = {} } },
    table = { fields = { ["concat"] = {}, ["insert"] = {}, ["move"] = {}, ["pack"] = {}, ["remove"] = {}, ["sort"] = {}, ["unpack"] = {} } },
    "tonumber",
    "tostring",
    "type",
    utf8 = { fields = { ["char"] = {}, ["charpattern"] = {}, ["codepoint"] = {}, ["codes"] = {}, ["len"] = {}, ["offset"] = {} } },
    "xpcall",
  },
}
