// The keys of an exercise's tables outside the scene, and of the options of t's methods.

#include "base/units.h"
#include "lua/api_parts.h"
#include "session/progress.h"
#include "sim/instrument.h"

namespace calot {
namespace {

using units::deg;
using units::mm;
using units::s;

constexpr double infinity = std::numeric_limits<double>::infinity();

ApiTable exercise_table() {
  return {
      "exercise",
      "An exercise: what a scenario returns.",
      {required(number("api", quantity::number, 1, 1, "", "version of this interface: 1")),
       required(text("id", "", "short name: small letters, digits and hyphens")),
       required(text("title", "", "one line for people")),
       number("time_limit", quantity::time, 1 * s, 3600 * s, "120 * s",
              "the session ends then at the latest"),
       map("params", "param", "what can be chosen when it is started; scene gets the values"),
       required(function("scene", "fun(p: table<string, any>): calot.scene", "returns the operating field")),
       required(function("steps", "fun(t: calot.Steps)", "the operation's steps, a coroutine")),
       function("demo", "fun(t: calot.Demo)", "an expert's instrument path, a coroutine"),
       required(table("score", "weighted", "what counts: calot.score.weighted { ... }")),
       table("golden", "golden", "when pictures are compared")},
      {}};
}

std::vector<ApiTable> score_tables() {
  ApiKey part = {"name", ApiKind::text, "its name in the report"};
  part.fallback = "the metric or the event";
  return {
      {"weighted",
       "Parts of the score; their weights sum to 1, the total is 0 to 100.",
       {list("critical", "text", "events that cap the total and fail the exercise"),
        number("cap", quantity::points, 0, 100, "40", "the total's largest value after a critical event"),
        number("pass", quantity::points, 0, 100, "80", "the total from which on the exercise is passed")},
       "part"},
      {"part",
       "A part of the score: { calot.score.benchmark { ... }, weight = 0.5 }.",
       {required(number("weight", quantity::number, 0, 1, "", "its share of the total")), part},
       "benchmark|penalty"},
      {"benchmark",
       "A metric between a novice's value (no points) and an expert's (all points).",
       {required(text("metric", "", "the metric's name, such as \"left.path_length_mm\"")),
        required(number("novice", quantity::number, -infinity, infinity, "",
                        "earns nothing, in the metric's unit")),
        required(
            number("expert", quantity::number, -infinity, infinity, "", "earns all, in the metric's unit"))},
       {}},
      {"penalty",
       "Full marks, less a share for each event of a kind.",
       {required(choice("event", event_kinds(), "", "the kind of event")),
        number("each", quantity::number, 0, 1, "0.25", "share lost with each")},
       {}},
  };
}

std::vector<ApiTable> option_tables() {
  const auto speed = [](const std::string& fallback) {
    return number("speed", quantity::speed, 0.1 * mm / s, 500 * mm / s, fallback, "largest speed of the tip");
  };
  return {
      {"step_options",
       "Options of t:step.",
       {number("limit", quantity::time, 0.1 * s, 3600 * s, "", "after it the step ends as timed out")},
       {}},
      {"move_options", "Options of motions.", {speed("30 * mm / s")}, {}},
      {"rotate_options",
       "Options of a rotation.",
       {number("speed", quantity::angle, 1 * deg, 1000 * deg, "90 * deg", "largest angular speed, rad/s")},
       {}},
      {"approach_options",
       "Options of an approach.",
       {speed("30 * mm / s"),
        number("depth", quantity::length, -20 * mm, 20 * mm, "4 * mm",
               "how far into the tissue's rest the tip presses; negative stops before it"),
        point("offset", quantity::length, 100 * mm, "{ 0, 0, 0 }", "added to the landmark, patient's frame"),
        number("clearance", quantity::length, 0, 100 * mm, "25 * mm",
               "the last stretch is straight and this long"),
        number("jaw", quantity::angle, 0, InstrumentGeometry{}.jaw_opening, "60 * deg",
               "how far the jaws are open")},
       {}},
  };
}

}  // namespace

std::vector<ApiTable> exercise_tables() {
  std::vector<ApiTable> all = {exercise_table()};
  ApiKey fallback{"default", ApiKind::any, "the value when nothing is chosen"};
  all.push_back({"param",
                 "Something that can be chosen when the exercise is started (--param name=value).",
                 {required(choice("type", {"choice", "number", "boolean"}, "", "what kind of value")),
                  required(fallback), list("choices", "text", "what can be chosen, for a choice"),
                  number("min", quantity::number, -infinity, infinity, "", "smallest number"),
                  number("max", quantity::number, -infinity, infinity, "", "largest number"),
                  text("title", "", "one line for people")},
                 {}});
  for (ApiTable& table : score_tables()) all.push_back(std::move(table));
  all.push_back({"golden",
                 "When pictures are compared with golden ones.",
                 {required(list("at", "number", "times in s, within the time limit"))},
                 {}});
  for (ApiTable& table : option_tables()) all.push_back(std::move(table));
  return all;
}

}  // namespace calot
