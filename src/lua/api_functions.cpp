// Every function a script can call.

#include <numbers>

#include "base/units.h"
#include "lua/api_parts.h"
#include "tools/events.h"
#include "tools/instrument.h"
#include "tools/part_load.h"

namespace calot {
namespace {

using units::mm;
using units::ms;
using units::s;

Key seconds(std::string name, double low, std::string doc) {
  return required(number(std::move(name), quantity::time, low, 3600 * s, "", std::move(doc)));
}

Key predicate(std::string doc) { return required(function("predicate", "fun(): boolean", std::move(doc))); }

Key organ(bool needed) {
  Key key = text("organ", "", "an organ's name");
  key.required = needed;
  return key;
}

Key tube() { return required(text("organ", "", "a tube's name")); }

/// A place on a tube, and what is asked for beside it.
std::vector<Key> place_on_tube(std::vector<Key> more = {}) {
  more.insert(more.begin(), {tube(), required(number("share", quantity::number, 0, 1, "a share of a length",
                                                     "from its start, 0, to its end, 1"))});
  return more;
}

/// A point, or a landmark.
Key place_or_landmark(std::string name, std::string doc) {
  Key key{std::move(name), KeyKind::place, std::move(doc), true};
  key.quantity = &quantity::length;
  key.low = -500 * mm;
  key.high = 500 * mm;
  return key;
}

Key turn() {
  return required(number("angle", quantity::angle, -2 * std::numbers::pi, 2 * std::numbers::pi, "",
                         "right-handed about the direction of the tip"));
}

Key landmark() { return required(text("landmark", "", "a landmark such as \"gallbladder.fundus\"")); }

std::vector<ApiFunction> module_functions() {
  return {
      {"calot",
       "exercise",
       "Declares the exercise; the scenario returns its result.",
       {required(table("definition", "exercise", "the exercise"))},
       "calot.exercise"},
      {"calot",
       "anatomy",
       "A named anatomy, with what differs in a table.",
       {required(text("name", "", "the anatomy's name: standard, hydrops")),
        table("overrides", "anatomy", "what differs")},
       "calot.anatomy"},
      {"calot",
       "refuse",
       "For modules: says as error() does that what was given to a function is wrong; calot check then says "
       "it too, where "
       "an error may only come of nothing having happened yet.",
       {required(text("message", "", "what is wrong, and what is wanted")),
        number("level", quantity::number, 1, 20, "1",
               "who is to blame: 1 who calls this, 2 who called that function, and so on")},
       ""},
      {"score",
       "weighted",
       "The parts of the score.",
       {required(table("definition", "weighted", "the parts"))},
       "calot.weighted"},
      {"score",
       "benchmark",
       "Scores a metric between a novice's and an expert's value.",
       {required(table("definition", "benchmark", "the metric and its two values"))},
       "calot.benchmark"},
      {"score",
       "penalty",
       "Takes off a share for each event.",
       {required(table("definition", "penalty", "the event"))},
       "calot.penalty"},
      {"score",
       "procedure",
       "Scores the steps that were done less errors by their severity.",
       {required(table("definition", "procedure", "steps and errors"))},
       "calot.procedure"},
      {"score",
       "time",
       "Scores the session's time less penalties for errors.",
       {required(table("definition", "time_score", "the times, and errors"))},
       "calot.time_score"},
      {"score",
       "critical_view",
       "Scores the points of the critical view that steps noted.",
       {table("definition", "critical_view", "the metric and its points")},
       "calot.critical_view"},
      {"score",
       "rule",
       "A part of the author's own; it needs a name. The function is asked when the session has ended, and "
       "whenever a "
       "recording is scored, in a Lua state of its own: it sees what was measured, and no world. It returns "
       "the share "
       "of "
       "the part that was earned, 0 to 1, the reason in a sentence, and the times (s) behind it.",
       {required(function("judge", "fun(run: calot.Run): number, string, number[]?", "judges a session"))},
       "calot.rule"},
  };
}

std::vector<ApiFunction> session_functions() {
  const Key noted{"value", KeyKind::any, "a finite number, a text of up to 200 bytes, or true or false"};
  return {
      {"Session", "wait", "Waits.", {seconds("duration", 0, "how long")}, ""},
      {"Session",
       "wait_until",
       "Waits until the predicate holds, or the step's limit has passed. Returns whether it held.",
       {predicate("asked after every simulated step")},
       "boolean"},
      {"Session", "time", "Time since the start, s.", {}, "number"},
      {"Session",
       "pressure",
       "Pressure of the organ's filling at its highest point, gauge, Pa.",
       {organ(true)},
       "number"},
      {"Session", "volume", "Volume the organ encloses, m^3.", {organ(true)}, "number"},
      {"Session",
       "torn",
       "Share of a tissue's strands that are torn, 0 to 1; 1 as well where an organ that it held on to is "
       "gone.",
       {required(text("tissue", "", "its name"))},
       "number"},
      {"Session",
       "raw",
       "Surface of a liver's lobe that has lost its capsule to current until now, m^2.",
       {organ(true)},
       "number"},
      {"Session",
       "divided",
       "Whether a tube, a duct or a vessel, has been divided. Its pieces then are organs of their own, "
       "\"cystic_duct.patient\" and \"cystic_duct.specimen\".",
       {tube()},
       "boolean"},
      {"Session",
       "clips",
       "The clips on a tube, or on a piece of one, from its start to its end: each { place = a share of its "
       "length, opening = the share of its width that is not held, 0 where it is shut, size = \"ML\" }.",
       {tube()},
       "calot.clip[]"},
      {"Session",
       "lost",
       "What has left the organs by openings until now, m^3: of one organ with its pieces, or of all. "
       "Not what was drawn out.",
       {required(choice("liquid", {"bile", "blood"}, "", "which")),
        text("organ", "", "an organ of the scene; without it, all")},
       "number"},
      {"Session",
       "place",
       "Where a landmark is now on the skin, {x, y, z} in m.",
       {landmark()},
       "calot.point"},
      {"Session", "along",
       "A place on the middle of a tube, a duct or a vessel, now, and the direction from its start to its "
       "end "
       "there, of length 1: {x, y, z} each, the place in m.",
       place_on_tube(), "calot.point, number[]"},
      {"Session",
       "seen_area",
       "How much of a triangle the laparoscope sees past organs and instruments, m^2, across its line of "
       "sight: from its "
       "edge it is seen as none.",
       {required(point("a", quantity::length, 1.0, "", "a corner, {x, y, z} in m")),
        required(point("b", quantity::length, 1.0, "", "the next")),
        required(point("c", quantity::length, 1.0, "", "the last"))},
       "number"},
      {"Session",
       "sees",
       "Whether the laparoscope sees a place: it is in the round picture, and no organ, instrument or ground "
       "lies "
       "before it. What is within 2 mm of it does not hide it.",
       {place_or_landmark("place", "a point, m, or a landmark such as \"gallbladder.fundus\"")},
       "boolean"},
      {"Session",
       "critical_view",
       "The critical view of safety as it is now, measured: the hepatocystic triangle cleared of tissue, by "
       "rays "
       "from the laparoscope and from behind; the plate's strands on the gallbladder's lower third torn; two "
       "structures and no more still enter the gallbladder, each seen and free. 0 to 2 points each, 0 to 6 "
       "in all; from which share on is uncalibrated.",
       {table("options", "critical_view_options", "what the parts are called, and what earns points")},
       "calot.critical_view"},
      {"Session",
       "strands",
       "The strands of a tissue that stand, as they lie now: none where an organ that it held on to is gone.",
       {required(text("tissue", "", "its name"))},
       "calot.strand[]"},
      {"Steps",
       "step",
       "Ends the running step as done and starts the next.",
       {required(text("name", "", "short name, for metrics: letters, digits and _")),
        required(text("title", "", "one line for people")),
        table("options", "step_options", "a limit in time, a hint")},
       ""},
      {"Steps",
       "missed",
       "Ends the running step as missed: what it asks for can no longer be done. Nothing happens where its "
       "limit has "
       "ended it.",
       {required(text("why", "", "in a few words, for people"))},
       ""},
      {"Steps",
       "hold",
       "Waits until the predicate has held for a duration in all; metric <step>.<name>.time_in_s. Returns "
       "whether it "
       "did before the step's limit.",
       {required(text("name", "", "short name, for the metric: letters, digits and _")),
        predicate("asked after every simulated step"), seconds("duration", 1 * ms, "time in all")},
       "boolean"},
      {"Steps",
       "note",
       "Puts a value into the report, its time and step with it. A number is the metric note.<name> too: its "
       "last "
       "value, to score by.",
       {required(text("name", "", "its name: letters, digits and _")), required(noted),
        text("unit", "", "its unit, for people")},
       ""},
      {"Steps", "divide",
       "Divides a tube, a duct or a vessel, at about a share of its length (a mm or two off at most), "
       "not where a clip lies. Its "
       "pieces are "
       "organs of their own, \"cystic_duct.patient\" and \"cystic_duct.specimen\", each with the landmarks "
       "start, "
       "middle and end; the tube's patient_end says which is which. Returns their names, the patient's "
       "first, and "
       "the share where it was divided.",
       place_on_tube(), "string, string, number"},
      {"Steps", "clip",
       "Sets a clip that shuts a tube, a duct or a vessel, at about a share of its length: in a field that "
       "is prepared "
       "for a later step, as nobody sets it. Refused where a clip lies.",
       place_on_tube({choice("size", clip_names(), "ML", "the clip's")}), ""},
      {"Steps",
       "remove",
       "Takes an organ out of the field, with its joints. What asks for it later is told when and why it "
       "went.",
       {organ(true), text("why", "", "such as \"taken out\"")},
       ""},
      {"Steps",
       "add",
       "Brings an organ into the field, where its definition has it; mesh files are not read here.",
       {required(table("organ", "organ", "as in the scene's anatomy"))},
       ""},
      {"Steps",
       "release",
       "Lets an organ go where one of its held regions holds it, such as the assistant's hand at the fundus.",
       {organ(true), required(text("held", "", "the held region's name"))},
       ""},
      {"Steps",
       "add_tissue",
       "Lays the strands of a tissue between two organs where they are now.",
       {required(table("tissue", "tissue", "as in the scene's anatomy"))},
       ""},
      {"Steps",
       "remove_tissue",
       "Takes a tissue out of the field, with all of its strands; t:torn says 1 of it then.",
       {required(text("tissue", "", "its name"))},
       ""},
      {"Steps", "bleed",
       "Opens a hole in the wall of a tube at about a share of its length, not where a clip lies: a vessel "
       "bleeds there and a duct leaks, until clips or jaws shut it on both sides. Returns the share where it "
       "is.",
       place_on_tube({number("width", quantity::length, 0.1 * mm, 10 * mm, "1 * mm", "across the hole")}),
       "number"},
      {"Steps",
       "tie",
       "Ties a place on one organ to one on another where they are now.",
       {required(table("joint", "joint", "as in the scene's anatomy"))},
       ""},
      {"Steps",
       "untie",
       "Undoes all joints of two organs.",
       {required(text("organ", "", "an organ's name")), required(text("other", "", "the other's name"))},
       ""},
      {"Steps",
       "count",
       "How many events of a kind there have been, such as time_out; those of this step come before it.",
       {required(choice("event", event_names(), "", "the kind of event")),
        text("organ", "", "only those of this organ or tissue, or a piece of it")},
       "number"},
      {"Steps", "events", "What has happened so far, as the rules of a score see it.", {}, "calot.event[]"},
      {"Demo",
       "time_out",
       "A time-out: the act of stopping to say what is seen. The event time_out has the words as its text.",
       {text("words", "", "what is said, up to 200 bytes")},
       ""},
      {"Demo",
       "bail_out",
       "Ends the operation otherwise than planned: the session ends in this step, and is scored.",
       {text("how", "", "how, such as subtotal or convert, up to 200 bytes")},
       ""},
      {"Demo",
       "together",
       "Runs functions side by side, one for each instrument say, until all have ended.",
       {required(function("first", "fun()", "runs side by side with the others")),
        required(function("second", "fun()", "runs side by side with the others"))},
       ""},
  };
}

std::vector<ApiFunction> run_functions() {
  const Key kind = required(choice("event", event_names(), "", "the kind of event"));
  const Key on = text("organ", "", "only those of this organ or tissue, or a piece of it");
  return {{"Run", "count", "How many events of a kind there were.", {kind, on}, "integer"},
          {"Run", "times", "When there were events of a kind, s, ascending.", {kind, on}, "number[]"}};
}

std::vector<ApiFunction> laparoscope_functions() {
  const Key seen = place_or_landmark("place", "a point, m, or a landmark such as \"gallbladder.fundus\"");
  const Key options = table("options", "move_options", "how fast");
  return {
      {"Laparoscope", "tip", "The place of its lens, {x, y, z} in m.", {}, "calot.point"},
      {"Laparoscope", "axis", "The direction of its shaft into the body, of length 1.", {}, "number[]"},
      {"Laparoscope",
       "direction",
       "Where it looks, of length 1: along its shaft, or with an angled optic that angle off it.",
       {},
       "number[]"},
      {"Laparoscope",
       "roll",
       "How far it is turned about its shaft from where it started, rad, right-handed about the way into the "
       "body.",
       {},
       "number"},
      {"Laparoscope",
       "horizon",
       "How far the picture's horizon is from level, rad, clockwise for who stands behind the camera. 0 "
       "unless the "
       "scene says horizon = \"held\".",
       {},
       "number"},
      {"Laparoscope", "touching", "Whether its end touched an organ when it was moved last.", {}, "boolean"},
      {"Laparoscope", "distance", "How far its lens is from a place, m.", {seen}, "number"},
      {"Laparoscope",
       "picture",
       "Where a place is in the picture, hidden or not: to the right and up from the middle, as shares of "
       "the round "
       "picture's radius (without the lens's slight barrel distortion). Nothing where it is not before the "
       "lens.",
       {seen},
       "number?, number?"},
      {"DemoLaparoscope",
       "look_at",
       "Goes where a place is in the middle of the picture, with the optic down from the shaft.",
       {seen, table("options", "look_options", "from how far, and how fast")},
       ""},
      {"DemoLaparoscope",
       "move_to",
       "Moves the lens straight to a place.",
       {place_or_landmark("target", "a point, m, or a landmark"), options},
       ""},
      {"DemoLaparoscope",
       "move_by",
       "Moves the lens straight by a vector, patient's frame.",
       {required(point("vector", quantity::length, 300 * mm, "", "how far, {x, y, z} in m")), options},
       ""},
      {"DemoLaparoscope",
       "rotate",
       "Turns about the shaft.",
       {turn(), table("options", "rotate_options", "how fast")},
       ""},
  };
}

std::vector<ApiFunction> instrument_functions() {
  const Key options = table("options", "move_options", "how fast");
  const double open = InstrumentGeometry{}.jaw_opening;
  const Key part =
      choice("part", tool_part_names(), "",
             "shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip");
  const Key target = place_or_landmark("target", "a point, m, or a landmark such as \"gallbladder.fundus\"");
  return {
      {"Instrument",
       "holds",
       "Whether it holds the organ, or anything when none is named; grip says why not.",
       {organ(false)},
       "boolean"},
      {"Instrument",
       "force",
       "Force of the tissue on it, N: on the whole instrument, or on the part named.",
       {part},
       "number"},
      {"Instrument",
       "force_vector",
       "The same with its direction, {x, y, z} in N, patient's frame.",
       {part},
       "number[]"},
      {"Instrument",
       "pull",
       "How hard it is drawn along its shaft into the body, N: what it holds resists being drawn towards the "
       "port. 0 "
       "where it is pushed back.",
       {part},
       "number"},
      {"Instrument",
       "push",
       "How hard it is pushed back along its shaft, N: it presses into the tissue. 0 where it is drawn in.",
       {part},
       "number"},
      {"Instrument", "handle_force", "Force felt at its handle, N.", {}, "number"},
      {"Instrument",
       "torque",
       "The tissue's torque on it about its shaft, N m, above 0 where the tissue would turn it the way that "
       "a positive "
       "angle of rotate() does.",
       {},
       "number"},
      {"Instrument", "touching", "Whether it touches tissue, or the part named does.", {part}, "boolean"},
      {"Instrument",
       "waits",
       "Whether it waits outside, while another instrument is in its port.",
       {},
       "boolean"},
      {"Instrument",
       "active",
       "Whether current flows in it. An error for an instrument without current.",
       {},
       "boolean"},
      {"Instrument",
       "clips_left",
       "How many clips it still carries. An error for an instrument without clips.",
       {},
       "number"},
      {"Instrument",
       "aspirated",
       "What it has drawn out until now, m^3. An error for an instrument that draws nothing out.",
       {},
       "number"},
      {"Instrument",
       "contact",
       "Where it touches, or the part named does, at the point that is pressed hardest; nil where it does "
       "not.",
       {part},
       "calot.contact?"},
      {"Instrument",
       "grip",
       "What its jaws are doing: \"holding\"; \"open\", or not yet closed; closed and \"empty\", with "
       "nothing "
       "between them; closed \"beside\" what they touch; or \"slipped\", after what they held slid off. It "
       "says "
       "why holds is false.",
       {},
       "string"},
      {"Instrument", "tip", "Its tip's place, {x, y, z} in m.", {}, "calot.point"},
      {"Instrument", "distance", "How far its tip is from a landmark, m.", {landmark()}, "number"},
      {"Instrument",
       "clearance",
       "How far its jaws, or the electrode that it ends in, are from an organ's surface, m; 0 where they "
       "touch.",
       {organ(true)},
       "number"},
      {"DemoInstrument",
       "approach",
       "Opens the jaws, if it has any, and goes to a landmark from outside, ending pressed onto the tissue, "
       "ready to "
       "close.",
       {landmark(), table("options", "approach_options", "how")},
       ""},
      {"DemoInstrument",
       "open",
       "Opens the jaws. An error without jaws.",
       {number("angle", quantity::angle, 0, open, "60 * deg", "angle between the jaws")},
       ""},
      {"DemoInstrument", "close", "Closes the jaws on what is between them. An error without jaws.", {}, ""},
      {"DemoInstrument",
       "activate",
       "Lets current flow for a while, and waits for that. An error for an instrument without current.",
       {seconds("duration", 1 * ms, "how long")},
       ""},
      {"DemoInstrument",
       "fire",
       "Sets a clip on what is between its jaws. An error for an instrument without clips.",
       {},
       ""},
      {"DemoInstrument",
       "exchange",
       "Has it come in, where it waits outside while another one is in its port: that one is drawn back "
       "along its "
       "shaft, closed and taken out, and this one comes in closed and not turned, 30 mm deep, on the same "
       "way.",
       {table("options", "exchange_options", "how fast")},
       ""},
      {"DemoInstrument",
       "aspirate",
       "Draws out what is behind the wall that its tip is pushed on, or is in, for a while, and waits for "
       "that. "
       "An error for an instrument that draws nothing out.",
       {seconds("duration", 1 * ms, "how long")},
       ""},
      {"DemoInstrument", "move_to", "Moves the tip straight to a place.", {target, options}, ""},
      {"DemoInstrument",
       "move_by",
       "Moves the tip straight by a vector, patient's frame.",
       {required(point("vector", quantity::length, 300 * mm, "", "how far, {x, y, z} in m")), options},
       ""},
      {"DemoInstrument",
       "move_until",
       "Moves the tip straight on until the predicate holds, and stops there; the limit ends it too. Returns "
       "whether it "
       "held, and how far the tip went, m.",
       {predicate("asked after every simulated step"), table("options", "move_until_options", "where to")},
       "boolean, number"},
      {"DemoInstrument",
       "rotate",
       "Turns about the shaft.",
       {turn(), table("options", "rotate_options", "how fast")},
       ""},
      {"DemoInstrument", "wait", "Waits.", {seconds("duration", 0, "how long")}, ""},
  };
}

}  // namespace

std::vector<ApiFunction> all_functions() {
  std::vector<ApiFunction> all = module_functions();
  for (auto* more : {&session_functions, &instrument_functions, &laparoscope_functions, &run_functions})
    for (ApiFunction& function : (*more)()) all.push_back(std::move(function));
  return all;
}

}  // namespace calot
