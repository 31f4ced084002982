// The arrows of the house: a source includes its own room and those below it, as calot_room() in
// CMakeLists.txt says, and a library's headers only in the room that wraps it.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/paths.h"

namespace calot::test {
namespace {

namespace fs = std::filesystem;
using Rooms = std::map<std::string, std::set<std::string>>;  // a room, and every room it may include

std::string read(const fs::path& path) {
  std::ifstream in(path);
  EXPECT_TRUE(in) << path;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Rooms from lines such as calot_room(fem calot_numerics), each with itself and all below, however deep. A
/// room must come after those it names, so that the arrows make no circle.
Rooms parse_rooms(const std::string& cmake) {
  Rooms rooms;
  const std::regex line(R"(\n\s*calot_room\((\w+)([^)]*)\))"), name(R"(\bcalot_(\w+))");
  for (std::sregex_iterator it(cmake.begin(), cmake.end(), line), end; it != end; ++it) {
    std::set<std::string> below = {(*it)[1]};
    const std::string arguments = (*it)[2];
    for (std::sregex_iterator dep(arguments.begin(), arguments.end(), name); dep != end; ++dep) {
      const auto found = rooms.find((*dep)[1]);
      if (found == rooms.end()) {
        ADD_FAILURE() << (*it)[1] << " stands before " << (*dep)[1] << ", which it names";
        continue;
      }
      below.insert(found->second.begin(), found->second.end());
    }
    rooms[(*it)[1]] = below;
  }
  return rooms;
}

/// Libraries that few rooms wrap for all others.
const std::vector<std::pair<std::regex, std::set<std::string>>>& wrapped() {
  static const std::vector<std::pair<std::regex, std::set<std::string>>> list = {
      {std::regex(R"((.*/)?(lua|lauxlib|lualib|luaconf)\.h(pp)?)"), {"script", "lua"}},
      {std::regex("GL/.*"), {"render"}},
      {std::regex("(GLFW|backends)/.*|imgui.*"), {"window"}},
      {std::regex("opensubdiv/.*"), {"skin"}},
      {std::regex("(openigtlink/)?igtl.*"), {"input"}},
      {std::regex("CLI/.*"), {"app"}}};
  return list;
}

/// One line a wrong include of `source`, a file of `room`.
std::vector<std::string> violations(const Rooms& rooms, const std::string& room, const std::string& source) {
  std::vector<std::string> wrong;
  const std::regex include(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*(["<])([^">\n]*)[">])");
  for (std::sregex_iterator it(source.begin(), source.end(), include), end; it != end; ++it) {
    const std::string header = (*it)[2];
    const std::string from = header.substr(0, header.find('/'));
    const bool is_own = (*it)[1] == "\"";
    if (is_own && header.find('/') == std::string::npos)
      wrong.push_back(header + ": name the room, as in \"" + room + "/" + header + "\"");
    else if (rooms.contains(from) && header.find('/') != std::string::npos && !rooms.at(room).contains(from))
      wrong.push_back(header + ": " + room + " does not stand on " + from);
    else if (is_own && !rooms.contains(from))
      wrong.push_back(header + ": there is no room " + from);
    for (const auto& [pattern, owners] : wrapped())
      if (!is_own && !owners.contains(room) && std::regex_match(header, pattern))
        wrong.push_back(header + ": only " + testing::PrintToString(owners) + " may include it");
  }
  return wrong;
}

const fs::path kRoot = source_dir();

Rooms house() { return parse_rooms(read(kRoot / "CMakeLists.txt")); }

TEST(IncludeDirection, EverySourceIncludesOnlyItsOwnRoomAndThoseBelow) {
  const Rooms rooms = house();
  std::set<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "src"))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.insert(entry.path());
  ASSERT_GT(files.size(), 20u);
  for (const fs::path& file : files) {
    const fs::path inside = fs::relative(file, kRoot / "src");
    const std::string room = *inside.begin();
    ASSERT_TRUE(rooms.contains(room)) << inside << " is in no room of CMakeLists.txt";
    for (const std::string& wrong : violations(rooms, room, read(file)))
      ADD_FAILURE() << inside << " includes " << wrong;
  }
}

/// The units (a header and its source) of a room that lead back to themselves, from what each includes.
std::set<std::string> in_circles(const std::map<std::string, std::set<std::string>>& includes) {
  std::set<std::string> out;
  for (const auto& [unit, direct] : includes) {
    std::set<std::string> reached;
    std::vector<std::string> next(direct.begin(), direct.end());
    while (!next.empty()) {
      const std::string at = next.back();
      next.pop_back();
      if (!reached.insert(at).second || !includes.contains(at)) continue;
      next.insert(next.end(), includes.at(at).begin(), includes.at(at).end());
    }
    if (reached.contains(unit)) out.insert(unit);
  }
  return out;
}

/// The rooms of what moves, from below to above.
const std::vector<std::string>& moving_rooms() {
  static const std::vector<std::string> rooms = {"body",  "group",  "joins",  "tools", "organs",
                                                 "field", "motion", "liquid", "acts",  "world"};
  return rooms;
}

TEST(IncludeDirection, TheUnitsOfARoomDoNotIncludeEachOtherInCircles) {
  EXPECT_EQ(in_circles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), (std::set<std::string>{"b", "c"}));
  for (const std::string& room : moving_rooms()) {
    std::map<std::string, std::set<std::string>> includes;
    const std::regex own("#include \"" + room + R"(/(\w+)\.h")");
    for (const auto& entry : fs::directory_iterator(kRoot / "src" / room)) {
      const std::string unit = entry.path().stem(), source = read(entry.path());
      for (std::sregex_iterator it(source.begin(), source.end(), own), end; it != end; ++it)
        if ((*it)[1] != unit) includes[unit].insert((*it)[1]);
    }
    EXPECT_GT(includes.size(), 2u) << room;
    EXPECT_EQ(in_circles(includes), std::set<std::string>()) << room;
  }
}

TEST(IncludeDirection, WhatMovesIsBuiltFloorByFloor) {
  const Rooms rooms = house();
  for (auto room = moving_rooms().begin(); room != moving_rooms().end(); ++room) {
    ASSERT_TRUE(rooms.contains(*room)) << *room;
    for (auto other = room + 1; other != moving_rooms().end(); ++other)
      EXPECT_FALSE(rooms.at(*room).contains(*other)) << *room << " sees " << *other;
    EXPECT_TRUE(rooms.at("world").contains(*room)) << *room;
    for (const char* above : {"session", "render", "view", "script", "lua", "process", "app"})
      EXPECT_FALSE(rooms.at(*room).contains(above)) << *room << " sees " << above;
  }
  EXPECT_FALSE(rooms.at("liquid").contains("motion")) << "what leaks settles nothing";
}

TEST(IncludeDirection, TheTableIsTheHouseOfTheDesign) {
  const Rooms rooms = house();
  const std::map<std::string, std::set<std::string>> hidden = {
      {"base",
       {"geometry", "numerics", "fem", "skin", "collision", "anatomy", "body", "world", "session", "render",
        "view", "script"}},
      {"geometry", {"numerics", "fem", "skin", "collision", "anatomy", "body", "world"}},
      {"fem", {"skin", "collision", "anatomy", "body", "world"}},
      {"skin", {"fem", "collision", "anatomy", "body", "world"}},
      {"collision", {"fem", "skin", "anatomy", "body", "world"}},
      {"anatomy", {"fem", "skin", "collision", "body", "world"}},
      {"session", {"render", "view", "window", "script", "input", "lua", "process", "app"}},
      {"process", {"render", "view", "window", "script", "input", "lua", "play", "app"}},
      {"input", {"render", "view", "window", "script", "lua", "process", "app"}},
      {"paper", {"render", "view", "window", "script", "input", "lua", "play", "app"}},
      {"play", {"window", "page", "paper", "grading", "goldens", "app"}},
      {"grading", {"window", "paper", "goldens", "app"}},
      {"goldens", {"window", "paper", "grading", "app"}},
      {"render",
       {"window", "numerics", "fem", "skin", "collision", "anatomy", "body", "world", "session", "view",
        "lua", "app"}},
      {"view", {"window", "session", "script", "lua", "app"}},
      {"window", {"view", "script", "input", "lua", "process", "app"}},
      {"script",
       {"geometry", "numerics", "fem", "skin", "collision", "anatomy", "body", "world", "session", "render",
        "view", "lua"}},
      {"lua", {"render", "view", "window", "process", "app"}}};
  for (const auto& [room, others] : hidden) {
    ASSERT_TRUE(rooms.contains(room)) << room;
    for (const std::string& other : others)
      EXPECT_FALSE(rooms.at(room).contains(other)) << room << " sees " << other;
  }
  for (const auto& [room, below] : rooms) EXPECT_TRUE(below.contains("base")) << room;
}

TEST(IncludeDirection, TheCheckCatchesWrongIncludesAndPassesRightOnes) {
  const Rooms rooms = parse_rooms(
      "\ncalot_room(base fmt::fmt)\ncalot_room(geometry calot_base)\n"
      "calot_room(fem calot_geometry)\ncalot_room(skin calot_geometry)\n"
      "calot_room(lua calot_fem)\n");
  const auto caught = [&](const std::string& room, const std::string& source) {
    return violations(rooms, room, source).size();
  };
  EXPECT_EQ(caught("fem", "#include \"skin/subdivision.h\"\n"), 1u) << "sideways";
  EXPECT_EQ(caught("base", "int a;\n  #  include \"geometry/types.h\"\n"), 1u) << "upward, oddly spaced";
  EXPECT_EQ(caught("fem", "#include <skin/subdivision.h>\n"), 1u) << "in angle brackets";
  EXPECT_EQ(caught("fem", "#include \"types.h\"\n"), 1u) << "without its room";
  EXPECT_EQ(caught("fem", "#include \"attic/old.h\"\n"), 1u) << "a room that is not there";
  EXPECT_EQ(caught("fem", "#include <lua.h>\n#include <lualib.h>\n#include <GL/gl.h>\n"), 3u)
      << "wrapped libraries";
  EXPECT_EQ(caught("lua", "#include <lua.h>\n#include \"geometry/types.h\"\n#include <vector>\n"), 0u);
  EXPECT_EQ(caught("fem", "#include \"base/status.h\"\n#include \"fem/shell.h\"\n"), 0u) << "two floors down";
  EXPECT_EQ(caught("base", "// see #include \"fem/shell.h\"\n"), 0u) << "a comment";
}

}  // namespace
}  // namespace calot::test
