// A field's path leads to the line on which its author wrote it.

#include "script/source_map.h"

#include <gtest/gtest.h>

#include "script/lexer.h"
#include "support/text_files.h"

namespace calot {
namespace {

using test::line_of;

const std::string scenario = R"lua(local calot = require "calot"
local mm = 1e-3 -- not this: scene = { rate = 5 }
local wall = {
  thickness = 2 * mm,
}
local function shape()
  return {
    width = 35 * mm,
  }
end

return calot.exercise {
  api = 1,
  ["title"] = [[a long
    title, with scene = "nothing"]],
  scene = function(p)
    local ports = {
      here = { 0, 0, 0 },
    }
    if p.tilted then
      for i = 1, 3 do print({ rate = i }) end
    end
    return {
      anatomy = calot.anatomy("standard", {
        organs = {
          { wall = wall, name = "a" },
          {
            shape = shape(),
            name = "b",
          },
        },
        table_head_up = 0,
      }),
      ports = ports,
      solver = { rate = 50,
                 tolerance = 1e-6 },
    }
  end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "x",
        novice = 1 }, weight = 0.5 },
    { calot.score.penalty { event = "y" },
      weight = 0.5 },
    critical = { "overforce",
                 "contact" },
  },
}
)lua";

struct Known {
  const char* path;
  const char* text;
};

class Paths : public ::testing::TestWithParam<Known> {};

TEST_P(Paths, LeadToTheirLine) {
  EXPECT_EQ(SourceMap(scenario).line_of(GetParam().path), line_of(scenario, GetParam().text));
}

INSTANTIATE_TEST_SUITE_P(
    SourceMap, Paths,
    ::testing::Values(
        Known{"api", "api = 1"}, Known{"title", "[\"title\"]"}, Known{"scene", "scene = function"},
        Known{"scene.anatomy", "anatomy = calot"}, Known{"scene.anatomy.organs", "organs = {"},
        Known{"scene.anatomy.organs[1].name", "name = \"a\""},
        Known{"scene.anatomy.organs[2].name", "name = \"b\""},
        Known{"scene.anatomy.organs[1].wall.thickness", "thickness = 2"},  // through a variable
        Known{"scene.anatomy.organs[2].shape.width", "width = 35"},        // through a function
        Known{"scene.anatomy.table_head_up", "table_head_up"}, Known{"scene.ports.here", "here = {"},
        Known{"scene.solver.rate", "rate = 50"}, Known{"scene.solver.tolerance", "tolerance"},
        Known{"score[1][1].metric", "metric = "}, Known{"score[1][1].novice", "novice = 1"},
        Known{"score[1].weight", "weight = 0.5 },\n    { calot.score.p"},
        Known{"score[2].weight", "weight = 0.5 },\n    critical"}, Known{"score.critical[2]", "\"contact\""},
        // not written: the nearest that encloses it
        Known{"scene.solver.extensions.levels", "solver = {"},
        Known{"scene.anatomy.organs[2].bile.density", "          {\n            shape"},
        Known{"scene.laparoscope.port", "scene = function"}));

TEST(SourceMap, LeadsToTheReturnWhatIsNowhere) {
  EXPECT_EQ(SourceMap(scenario).line_of("golden.at"), line_of(scenario, "return calot.exercise"));
  EXPECT_EQ(SourceMap("local a = 1").line_of("golden.at"), 0);
}

TEST(SourceMap, FollowsAnExerciseInAVariable) {
  const std::string text =
      "local e = {\n  id = 1,\n  scene = build,\n}\nfunction build()\n  return {\n    solver = 1 "
      "}\nend\nreturn e\n";
  EXPECT_EQ(SourceMap(text).line_of("id"), 2);
  EXPECT_EQ(SourceMap(text).line_of("scene.solver"), 7);
}

TEST(SourceMap, EndsOnAnyText) {
  for (std::size_t cut = 0; cut < scenario.size(); ++cut) {
    const SourceMap map(scenario.substr(0, cut));
    EXPECT_GE(map.line_of("scene.solver.rate"), 0);
  }
  for (const char* text :
       {"}}}}", "))))", "end end end", "return return", "local", "a = a", "return { a = a }", "function",
        "local a = b local b = a return a", "[[", "\"", "--[==[", "{[", "f{f{f{"})
    EXPECT_GE(SourceMap(text).line_of("a.b[3].c"), 0) << text;
}

TEST(Lexer, SkipsCommentsAndKeepsTexts) {
  const std::vector<Token> tokens =
      tokens_of("a --[[ b\n ]] 'c\\'d' --e\n [==[f]]\ng]==] 0x1p-4 3..4 ~= nil");
  std::vector<std::string> texts;
  for (const Token& token : tokens) texts.push_back(token.text);
  const std::vector<std::string> wanted = {"a", "c\\'d", "f]]\ng", "0x1p-4", "3..4", "~=", "nil"};
  EXPECT_EQ(texts, wanted);
  EXPECT_EQ(tokens[0].line, 1);
  EXPECT_EQ(tokens[1].line, 2);
  EXPECT_EQ(tokens[2].line, 3);
  EXPECT_EQ(tokens[3].line, 4);
}

}  // namespace
}  // namespace calot
