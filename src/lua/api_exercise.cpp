// The keys of an exercise's tables outside the scene, and of the options of t's methods.

#include "base/units.h"
#include "lua/api_parts.h"
#include "lua/demo_script.h"
#include "session/exercise.h"
#include "world/critical_view.h"

namespace calot {
namespace {

using units::deg;
using units::mm;
using units::s;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Left out, it is the shaft's own direction.
Key along() {
  Key key = direction("along", &MoveUntil::along,
                      "direction, patient's frame, of any length; left out: along the shaft, into the body");
  key.fallback.clear();
  return key;
}

KeyTable exercise_table() {
  using Exercise = ExerciseDefinition;
  return keys_of<Exercise>(
      "exercise", "An exercise: what a scenario returns.",
      {required(count(
           "api", &Exercise::api, 1, newest_api, "",
           "version of this interface: 2. In 1 parts of the score earn whether their steps were done or "
           "not, and any bail-out may complete")),
       required(text("id", &Exercise::id, "short name: small letters, digits and hyphens")),
       required(text("title", &Exercise::title, "one line for people")),
       number("time_limit", &Exercise::time_limit, quantity::time, 1 * s, 3600 * s, "",
              "the session ends then at the latest"),
       map("params", "param",
           "what can be chosen when it is started: the p of scene, steps, demo and a score's function"),
       required(function("scene", "fun(p: table<string, any>): calot.scene", "returns the operating field")),
       required(function("steps", "fun(t: calot.Steps, p: table<string, any>)",
                         "the operation's steps, a coroutine")),
       function("demo", "fun(t: calot.Demo, p: table<string, any>)",
                "an expert's instrument path, a coroutine"),
       made_table("score", "weighted",
                  "what counts: calot.score.weighted { ... }, or function(p) that returns it; left out: a "
                  "scene that "
                  "trains nothing, and has no score"),
       table("golden", "golden", "when pictures are compared")});
}

std::vector<KeyTable> score_tables() {
  using Score = ScoreDefinition;
  using Gate = GateDefinition;
  Key part = bound(text("name", "the metric or the event", "its name in the report"), &ScorePart::name);
  KeyTable weighted = keys_of<Score>(
      "weighted", "Parts of the score; their weights sum to 1, the total is 0 to 100.",
      {list("critical", "text", "events that cap the total and fail the exercise"),
       list("gates", "gate", "conditions that cap the total and fail the exercise"),
       number("cap", &Score::cap, quantity::points, 0, 100, "",
              "the total's largest value after a critical event, or behind a gate"),
       function("bail_out", "fun(run: calot.Run): boolean, string, number[]?",
                "says whether bailing out was right, and why: then the steps that are left need not "
                "be done; left out: it never is"),
       flag("bail_out_completes", &Score::bail_out_completes,
            "api 1: true: who bails out, at any time, may pass without the steps that are left"),
       number("pass", &Score::pass, quantity::points, 0, 100, "",
              "the total from which on the exercise is passed")});
  weighted.items = "part";
  KeyTable weight = keys_of<ScorePart>(
      "part", "A part of the score: { calot.score.benchmark { ... }, weight = 0.5 }.",
      {required(number("weight", &ScorePart::weight, quantity::number, 0, 1, "", "its share of the total")),
       part,
       list("steps", "text",
            "the steps that it judges: it earns by the share of them that was done; left out: all")});
  weight.items = "benchmark|penalty|procedure|time_score|critical_view|rule";
  Key view = bound(text("metric", "\"note.critical_view_points\"", "the metric that holds its points"),
                   &ScorePart::metric);
  return {
      weighted,
      weight,
      keys_of<ScorePart>(
          "benchmark", "A metric between a novice's value (no points) and an expert's (all points).",
          {required(text("metric", &ScorePart::metric, "the metric's name, such as \"left.path_length_mm\"")),
           required(number("novice", &ScorePart::novice, quantity::number, -infinity, infinity, "",
                           "earns nothing, in the metric's unit")),
           required(number("expert", &ScorePart::expert, quantity::number, -infinity, infinity, "",
                           "earns all, in the metric's unit"))}),
      keys_of<ScorePart>(
          "penalty", "Full marks, less a share for each event of a kind.",
          {required(choice("event", &ScorePart::event, event_names(), "the kind of event")),
           number("each", &ScorePart::each, quantity::number, 0, 1, "", "share lost with each")}),
      keys_of<ScorePart>(
          "procedure",
          "Steps done less weighted errors: 100 steps done / steps - costs of each error, not below 0.",
          {list("steps", "text", "the steps that earn; left out: all"),
           list("minor", "text", "events that are minor errors"),
           number("minor_costs", &ScorePart::minor_costs, quantity::points, 0, 100, "",
                  "points of 100 that each of these costs"),
           list("major", "text", "events that are major errors"),
           number("major_costs", &ScorePart::major_costs, quantity::points, 0, 100, "",
                  "points of 100 that each of these costs")}),
      keys_of<ScorePart>(
          "time_score",
          "The session's time, lengthened by errors, between a limit (no points) and a reference (all).",
          {required(number("reference", &ScorePart::reference, quantity::time, 0, 3600 * s, "", "earns all")),
           required(number("limit", &ScorePart::limit, quantity::time, 0, 3600 * s, "", "earns nothing")),
           list("errors", "text", "events that lengthen it"),
           number("each", &ScorePart::each_s, quantity::time, 0, 3600 * s, "", "by which each does")}),
      keys_of<ScorePart>(
          "critical_view", "The points of the critical view of safety, as steps noted them.",
          {view,
           number("satisfactory", &ScorePart::satisfactory, quantity::points, 0, 100, "",
                  "points from which on it is one"),
           number("full", &ScorePart::full, quantity::points, 0.1, 100, "", "points that earn all")}),
      {"rule",
       "A part that the author's own function judges.",
       {required(function("judge", "fun(run: calot.Run): number, string, number[]?", "the function"))}},
      keys_of<Gate>(
          "gate",
          "Caps the total, and fails the exercise, where all of its conditions hold: an event, one that came "
          "too early, a metric beyond a value. A metric that was never measured is beyond.",
          {required(text("reason", &Gate::reason, "one sentence for the trainee")),
           choice("event", &Gate::event, event_names(), "this happened"),
           text("organ", &Gate::organ, "to this organ or tissue, or a piece of it"),
           choice("only_after", &Gate::only_after, event_names(), "and this had not happened before"),
           text("after_organ", &Gate::after_organ, "to this organ or tissue, or a piece of it"),
           text("metric", &Gate::metric, "this metric is beyond a value"),
           number("below", &Gate::below, quantity::number, -infinity, infinity, "", "below this"),
           number("above", &Gate::above, quantity::number, -infinity, infinity, "", "above this"),
           choice("unless", &Gate::unless, event_names(), "an event that excuses it, such as bail_out"),
           number("cap", &Gate::cap, quantity::points, 0, 100, "",
                  "the total's largest value then; left out: the score's"),
           flag("fails", &Gate::fails, "false: it caps the total, and does not fail the exercise")}),
  };
}

std::vector<KeyTable> golden_tables() {
  using Moment = GoldenMoment;
  return {
      {"golden",
       "When pictures are compared with golden ones: at times, at moments, or at both; at most 100.",
       {list("at", "number", "times in s, within the time limit; a picture is of a hundredth of a second"),
        list("moments", "moment", "what happens, whenever that is")}},
      keys_of<Moment>(
          "moment",
          "A picture of something that happens: it stays the same picture where a demo takes another time.",
          {required(text("name", &Moment::name, "the picture's")),
           text("step", &Moment::step, "this step begins; with an event: that happens in this step"),
           choice("event", &Moment::event, event_names(), "this happens"),
           text("organ", &Moment::organ, "to this organ or tissue, or a piece of it"),
           count("count", &Moment::count, 1, 1000, "", "the first of these events, the second, ..."),
           number("delay", &Moment::delay, quantity::time, 0, 3600 * s, "", "so long after it")}),
  };
}

KeyTable critical_view_options() {
  using Question = CriticalViewQuestion;
  const auto share = [](const char* name, double Question::*member, const char* doc) {
    return number(name, member, quantity::number, 0, 1, "", doc);
  };
  return keys_of<Question>(
      "critical_view_options", "Options of t:critical_view.",
      {text("gallbladder", &Question::gallbladder, "the organ's name"),
       text("liver", &Question::liver, "the organ's name"),
       text("plate", &Question::plate, "the name of the tissue between the two"),
       text("neck", &Question::neck, "a landmark, the triangle's corner at the gallbladder"),
       text("junction", &Question::junction, "a landmark, its corner where the ducts meet"),
       text("hilum", &Question::hilum, "a landmark, its corner at the liver"),
       point("behind", quantity::length, 1.0, "",
             "a lens on the other side, {x, y, z} in m; left out: square to the triangle, 25 mm "
             "behind it, and the liver hides nothing"),
       share("lower_part", &Question::lower_part,
             "of the gallbladder's way from neck to fundus that has to be off the plate"),
       number("near", &Question::near, quantity::length, 0, 50 * mm, "",
              "how far off the gallbladder a structure has to be free around"),
       share("one_from", &Question::one_from, "from this share on a criterion earns a point"),
       share("two_from", &Question::two_from, "and from this on two")});
}

std::vector<KeyTable> option_tables() {
  const auto speed_of = [](double usual) {
    return number("speed", quantity::speed, 0.1 * mm / s, 500 * mm / s, written(usual, quantity::speed),
                  "largest speed of the tip");
  };
  const auto speed = [&] { return speed_of(default_speed); };
  return {
      {"step_options",
       "Options of t:step.",
       {number("limit", quantity::time, 0.1 * s, 3600 * s, "", "after it the step ends as timed out"),
        text("hint", "", "how it is done, shown to who practises and not in an exam"),
        text("force_on", "",
             "the instrument on whose jaws the step asks for a force from `least` to `most`: a page "
             "shows the band in its plot"),
        number("least", quantity::force, 0, 1000, "", "of that force"),
        number("most", quantity::force, 0, 1000, "", "of that force")}},
      critical_view_options(),
      {"move_options", "Options of motions.", {speed()}},
      {"rotate_options",
       "Options of a rotation.",
       {number("speed", quantity::angle, 1 * deg, 1000 * deg, written(default_turning_speed, quantity::angle),
               "largest angular speed, rad/s")}},
      keys_of<LookAt>("look_options", "Options of t.laparoscope:look_at.",
                      {bound(number("distance", quantity::length, 10 * mm, 400 * mm,
                                    "as the scene's laparoscope has it", "from the lens to the place"),
                             &LookAt::distance),
                       bound(speed_of(default_speed), &LookAt::speed)}),
      keys_of<Exchange>("exchange_options", "Options of an exchange.",
                        {bound(speed_of(Exchange{}.speed), &Exchange::speed),
                         number("duration", &Exchange::duration, quantity::time, 0, 60 * s, "",
                                "what an assistant takes to change one for the other")}),
      keys_of<MoveUntil>(
          "move_until_options", "Options of a motion that ends when a condition holds.",
          {along(), text("towards", &MoveUntil::towards, "a landmark to move towards, instead of along"),
           number("speed", &MoveUntil::speed, quantity::speed, 0.1 * mm / s, 500 * mm / s, "",
                  "largest speed of the tip"),
           number("limit", &MoveUntil::limit, quantity::length, 0.1 * mm, 200 * mm, "",
                  "how far the tip goes at most"),
           flag("active", &MoveUntil::active,
                "true: current flows until the motion ends; only for what can be activated")}),
      keys_of<Approach>(
          "approach_options", "Options of an approach.",
          {bound(speed(), &Approach::speed),
           number("depth", &Approach::depth, quantity::length, -20 * mm, 20 * mm, "",
                  "how far into the tissue's rest the tip presses; negative stops before it"),
           place("offset", &Approach::offset, 100 * mm, "", "added to the landmark, patient's frame"),
           number("clearance", &Approach::clearance, quantity::length, 0, 100 * mm, "",
                  "the last stretch is straight and this long"),
           bound(number("jaw", quantity::angle, 0, InstrumentGeometry{}.jaw_opening, "60 * deg",
                        "how far the jaws are open"),
                 &Approach::jaw)}),
  };
}

}  // namespace

std::vector<KeyTable> exercise_tables() {
  std::vector<KeyTable> all = {exercise_table()};
  Key fallback{"default", KeyKind::any, "the value when nothing is chosen"};
  all.push_back({"param",
                 "Something that can be chosen when the exercise is started (--param name=value).",
                 {required(choice("type", {"choice", "number", "boolean"}, "", "what kind of value")),
                  required(fallback), list("choices", "text", "what can be chosen, for a choice"),
                  number("min", quantity::number, -infinity, infinity, "", "smallest number"),
                  number("max", quantity::number, -infinity, infinity, "", "largest number"),
                  text("title", "", "one line for people")}});
  for (KeyTable& table : score_tables()) all.push_back(std::move(table));
  for (KeyTable& table : golden_tables()) all.push_back(std::move(table));
  for (KeyTable& table : option_tables()) all.push_back(std::move(table));
  return all;
}

}  // namespace calot
