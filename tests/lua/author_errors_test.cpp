// What an author gets wrong is reported all at once, each with file, line and what to do.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "base/log.h"
#include "lua/scenario_files.h"
#include "organs/body_kinds.h"

namespace calot::author_errors_test {
namespace {

using test::Folder;
using test::line_of;
using test::load_text;
using test::ScenarioText;
using test::with_anatomy;
using test::with_scene;
using test::with_steps;

Failure failure_of(const std::string& text, const LoadOptions& options = {}) {
  const Folder folder;
  Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text, options);
  if (loaded) {
    ADD_FAILURE() << "loaded without a complaint:\n" << text;
    return {};
  }
  return loaded.failure();
}

/// One mistake, and what its report must say: the line is the one on which `at` stands.
struct Mistake {
  std::string name;
  ScenarioText text;
  std::string at, message, hint;
};

ScenarioText with_instruments(const std::string& instruments) {
  return with_scene("return { anatomy = calot.anatomy('standard'),\n instruments = " + instruments + " }");
}
ScenarioText with_demo(const std::string& demo) {
  ScenarioText text;
  text.demo = demo;
  return text;
}
ScenarioText electrode_demo(const std::string& demo) {
  ScenarioText text = with_instruments("{ left = { type = 'bipolar_electrode', port = 'right_flank' } }");
  text.demo = demo;
  return text;
}
ScenarioText with_score(const std::string& parts) {
  ScenarioText text;
  text.score = "calot.score.weighted {\n" + parts + "}";
  return text;
}
ScenarioText with_more(const std::string& more) {
  ScenarioText text;
  text.more = more;
  return text;
}
ScenarioText with_head(const std::string& head) {
  ScenarioText text;
  text.head = head;
  return text;
}

ScenarioText noted_score(const std::string& metric) {
  ScenarioText text = with_score("{ calot.score.benchmark {\n metric = '" + metric +
                                 "', novice = 2, expert = 1 }, weight = 1 }");
  text.steps = "t:step('a', 'A') t:note('force', 1, 'N')";
  return text;
}
ScenarioText score_function(const std::string& score) {
  ScenarioText text;
  text.score = score;
  return text;
}
ScenarioText with_params(const std::string& params) {
  ScenarioText text;
  text.params = params;
  return text;
}

ScenarioText with_swept(const std::string& along, const std::string& more = "") {
  return with_anatomy("{ organs = { { " + more + "\nshape = { type = 'swept', along = {\n" + along +
                      "\n} } } } }");
}

ScenarioText part(const std::string& part) {
  return score_function("calot.score.weighted {\n{ calot.score." + part + ", weight = 1 } }");
}
ScenarioText rule(const std::string& body) {
  return part("rule(function(run) " + body + "\nend), name = 'own'");
}
ScenarioText gate(const std::string& keys) {
  return score_function(
      "calot.score.weighted {\n{ calot.score.penalty { event = 'slip' }, weight = 1 },\ngates = { { " + keys +
      " } } }");
}

std::vector<Mistake> mistakes() {
  const std::string whole_weight =
      "{ calot.score.benchmark { metric = 'total.time_s', novice = 2, expert = 1 }, weight = 1 }";
  return {
      {"SyntaxError", with_head("local x = = 1"), "local x = =", "unexpected symbol", ""},
      {"ErrorAtTopLevel", with_head("\nerror('no such luck')"), "error(", "no such luck", ""},
      {"UndeclaredName", with_head("local x = 5 * kPa"), "5 * kPa", "unknown name 'kPa'", "calot.units.kPa"},
      {"GlobalVariable", with_head("x = 5"), "x = 5", "local x", ""},
      {"UnknownUnit", with_head("local x = calot.units.mn"), "units.mn", "mn", "mN"},
      {"UnknownTopLevelKey", with_more("tme_limit = 10"), "tme_limit", "unknown key", "time_limit"},
      {"WrongTypeAtTopLevel", with_more("time_limit = 'long'"), "time_limit", "must be a number", "120 * s"},
      {"TimeOutOfRange", with_more("time_limit = 1e6 * s"), "time_limit", "1e+06 s", "3600"},
      {"UnknownSceneKey", with_scene("return { anatomy = calot.anatomy('standard'),\n lapraoscope = {} }"),
       "lapraoscope", "unknown key", "laparoscope"},
      {"UnknownAnatomy", with_anatomy("calot.anatomy('standrad')"), "standrad", "unknown base", "standard"},
      {"AxisThatFolds",
       with_swept("{ at = { 0, 0, 0 }, radius = 8 * mm },\n { at = { 20 * mm, 0, 0 }, radius = 12 * mm },\n"
                  " { at = { 22 * mm, 20 * mm, 0 }, radius = 8 * mm }"),
       "radius = 12", "12 mm thick about it", "make the organ thinner there"},
      {"AxisOfOnePlace",
       with_swept(
           "{ at = { 0, 0, 0 } },\n { at = { 0, 0, 0 }, radius = 4 * mm },\n { at = { 40 * mm, 0, 0 } }"),
       "radius = 4", "at one place", "1 mm apart"},
      {"AxisTooShortForItsEnds",
       with_swept("{ at = { 0, 0, 0 }, radius = 9 * mm }, { at = { 16 * mm, 0, 0 }, radius = 9 * mm }"),
       "along =", "too short for its round ends of 18 mm", "make it longer"},
      {"AxisBesideItsNeck",
       with_swept("{ at = { 0, 0, 0 } }, { at = { 40 * mm, 0, 0 } }", "\nneck = { 0, 0, 0 },"),
       "neck =", "a swept organ's neck is an end of its axis", "leave neck out"},
      {"UnknownPort", with_instruments("{ left = {\n port = 'right_subcostel' } }"), "right_subcostel",
       "unknown port", "right_subcostal"},
      {"MissingPort", with_instruments("{\n left = { force_limit = 5 * N } }"), "left = {",
       "\"port\" is missing", "port = "},
      {"UnknownInstrumentType", with_instruments("{ left = {\n type = 'grasper', port = 'right_flank' } }"),
       "'grasper'", "unknown type", "atraumatic_grasper"},
      {"InstrumentTypeSpeltNearly",
       with_instruments("{ left = {\n type = 'bipolar_electrod', port = 'right_flank' } }"),
       "'bipolar_electrod'", "unknown type", "bipolar_electrode"},
      {"PinchWithoutJaws",
       with_instruments(
           "{ left = { type = 'bipolar_electrode', port = 'right_flank',\n pinch_force = 3 * N } }"),
       "pinch_force", "no jaws", "leave pinch_force out"},
      {"FrictionWithoutJaws",
       with_instruments(
           "{ left = { type = 'bipolar_electrode', port = 'right_flank',\n pad_friction = 1 } }"),
       "pad_friction", "no jaws", "leave pad_friction out"},
      {"ClosingWithoutJaws", electrode_demo("\nt.left:close()"), "t.left:close()",
       "close is for jaws, and left is a bipolar_electrode", "push with approach"},
      {"ActivatingAGrasper", with_demo("\nt.left:activate(1 * s)"), "t.left:activate",
       "activate is for what can activate, which left cannot: its type is atraumatic_grasper",
       "bipolar_electrode, semm_forceps, l_hook"},
      {"MovingAGrasperWithCurrent",
       with_demo("\nt.left:move_until(function() return false end, { active = true })"), "t.left:move_until",
       "move_until's active is for what can activate, which left cannot",
       "bipolar_electrode, semm_forceps, l_hook"},
      {"AspiratingWithAGrasper", with_demo("\nt.left:aspirate(1 * s)"), "t.left:aspirate",
       "aspirate is for what can aspirate, which left cannot: its type is atraumatic_grasper",
       "another type: aspiration_needle"},
      {"SuctionOfAGrasper",
       with_instruments("{ left = { port = 'right_flank',\n suction = 10 * calot.units.kPa } }"), "suction",
       "its type atraumatic_grasper draws nothing out", "make it an aspiration_needle"},
      {"PowerOfAGrasper", with_instruments("{ left = { port = 'right_flank',\n power = 40 } }"), "power",
       "its type atraumatic_grasper carries no current", "make it an l_hook"},
      {"ABoreWiderThanItsNeedle",
       with_instruments("{ left = { type = 'aspiration_needle', port = 'right_flank',\n bore = 16 * mm } }"),
       "bore", "not a bore of a needle", "0.3 to 1.9 mm"},
      {"OpeningWithoutJaws", electrode_demo("\nt.left:open()"), "t.left:open()", "which has none",
       "another type"},
      {"ApproachingWithJawsItDoesNotHave",
       electrode_demo("\nt.left:approach('gallbladder.fundus', { jaw = 30 * deg })"), "t.left:approach",
       "approach's jaw", "another type"},
      {"UnknownLandmarkToLookAt",
       with_scene("return { anatomy = calot.anatomy('standard'), laparoscope = {\n look_at = "
                  "'gallbladder.fundas' } }"),
       "fundas", "unknown", "gallbladder.fundus"},
      {"UnknownOrganKey",
       with_anatomy("calot.anatomy('standard', { organs = {\n { nodes = 200,\n color = 3 } } })"), "color",
       "unknown key", "known"},
      {"MissingUnitScale",
       with_anatomy("{ organs = { { shape = { type = 'pear',\n length = 70, width = 35 * mm } } } }"),
       "length = 70", "70 m is not a gallbladder's length", "70 * mm"},
      {"MissingPressureScale",
       with_anatomy("calot.anatomy('standard', { organs = { {\n wall = { shear_modulus = 100 } } } })"),
       "shear_modulus", "100 Pa", "100 * kPa"},
      {"FibreAngleWithoutDegrees",
       with_anatomy("calot.anatomy('standard', { organs = { { wall = { fibres = {\n angle = 40 } } } } })"),
       "angle = 40", "40 rad is not an angle of fibres", "40 * deg"},
      {"SofteningWall",
       with_anatomy("calot.anatomy('standard', { organs = { { wall = {\n stiffening = -1 } } } })"),
       "stiffening = -1", "not an exponent", "0 to 100"},
      {"BurnReachWithoutMillimetres",
       with_anatomy("calot.anatomy('standard', { organs = { { wall = {\n burn_reach = 0.3 } } } })"),
       "burn_reach = 0.3", "0.3 m is not a reach of current's heat", "0.3 * mm"},
      {"RawEnergyOfNothing",
       with_anatomy("calot.anatomy('standard', { organs = { { wall = {\n raw_energy = 0 } } } })"),
       "raw_energy = 0", "0 is not an energy that takes a capsule off", "1e"},
      {"TissueToAnUnknownOrgan",
       with_anatomy("calot.anatomy('standard', { tissue = { { from = 'gallbladder',\n to = 'livr' } } })"),
       "livr", "unknown organ", "gallbladder"},
      {"TissueWithoutAnEnd",
       with_anatomy("calot.anatomy('standard', { tissue = {\n { from = 'gallbladder' } } })"), "from =", "to",
       ""},
      {"UnknownLooksOfTissue",
       with_anatomy("calot.anatomy('standard', { organs = { {}, { name = 'duct', shape = { type = 'tube', "
                    "points = { { 0, 0, 0 }, { 30 * mm, 0, 0 } } } } },\n tissue = { { from = 'gallbladder', "
                    "to = 'duct',\n looks = 'areola' } } })"),
       "looks =", "unknown looks", "areolar"},
      {"UnknownTissue", with_steps("\nlocal x = t:torn('plate')"), "t:torn", "unknown tissue", ""},
      {"StrandsOfAnUnknownTissue", with_steps("\nlocal x = t:strands('plate')"), "t:strands",
       "unknown tissue", ""},
      {"ACriticalViewOfAnUnknownCorner",
       with_steps("\nlocal x = t:critical_view { neck = 'cystic_dukt.start' }"), "t:critical_view",
       "unknown landmark", ""},
      {"BothFillings",
       with_anatomy("{ organs = { { bile = { fill_volume = 40e-6,\n fill_pressure = 1000 } } } }"),
       "fill_pressure", "both given", "give one"},
      {"UnknownShape", with_anatomy("{ organs = { { shape = {\n type = 'pair' } } } }"), "'pair'",
       "unknown shape", "pear"},
      {"MissingMesh", with_anatomy("{ organs = { { shape = {\n type = 'obj', path = '../secret.obj' } } } }"),
       "'obj'", "no mesh file", "below"},
      {"WrongTypeDeepDown", with_anatomy("{ organs = { { wall = {\n thickness = '2 mm' } } } }"), "thickness",
       "must be a number", "2 * mm"},
      {"PointOfTwo",
       with_scene("return { anatomy = calot.anatomy('standard'),\n ports = { here = { 0, 1 } } }"), "here",
       "no point", "three numbers"},
      {"TooManyExtensionLevels",
       with_scene(
           "return { anatomy = calot.anatomy('standard'),\n solver = { extensions = {\n levels = 7 } } }"),
       "levels = 7", "levels", "0 to 4"},
      {"InstrumentNamedLikeAMethod", with_instruments("{\n wait = { port = 'right_flank' } }"), "wait = {",
       "method of t", "another name"},
      {"ErrorInScene", with_scene("local q\n return q.x"), "return q.x", "nil value", ""},
      {"SceneThatIsNoTable", with_scene("return 5"), "scene = function", "must be a table", ""},
      {"ThroughALocalTable",
       with_scene(
           "local organ = {\n  wall = { thickness = 5 } }\n return { anatomy = { organs = { organ } } }"),
       "thickness = 5", "5 m", "5 * mm"},
      {"UnknownMetric",
       with_score("{ calot.score.benchmark {\n metric = 'left.path_lenght_mm', novice = 2, expert = 1 }, "
                  "weight = 1 }"),
       "path_lenght", "unknown metric", "left.path_length_mm"},
      {"UnknownEvent", with_score("{ calot.score.penalty {\n event = 'overfroce' }, weight = 1 }"),
       "overfroce", "unknown event", "overforce"},
      {"UnknownCriticalEvent", with_score(whole_weight + ",\n critical = { 'explosion' }"), "explosion",
       "unknown event", "overforce"},
      {"WeightsNotOne",
       with_score("{ calot.score.penalty { event = 'contact' }, weight = 0.5 },\n"
                  "{ calot.score.penalty { event = 'grasp' }, weight = 0.4 }"),
       "score =", "sum to 0.9", "sum to 1"},
      {"MissingWeight", with_score("\n{ calot.score.penalty { event = 'grasp' } }"), "event = 'grasp'",
       "\"weight\" is missing", "weight = "},
      {"PartWithoutScore", with_score("\n{ weight = 1 }"), "{ weight", "one of calot.score's", "write"},
      {"NoviceIsExpert",
       with_score(
           "{ calot.score.benchmark { metric = 'total.time_s', novice = 2,\n expert = 2 }, weight = 1 }"),
       "expert = 2", "both 2", "differ"},
      {"GoldenBeyondTheLimit", with_more("golden = { at = { 0,\n 500 * s } }"), "500 * s", "500 s", "120 s"},
      {"GoldenOfNothing", with_more("golden = {\n}"), "golden =", "no picture is asked for", "at ="},
      {"GoldenMomentOfAnUnknownStep", with_more("golden = { moments = {\n{ name = 'm', step = 'hodl' } } }"),
       "hodl", "unknown step", "known"},
      {"GoldenMomentOfAnUnknownEvent",
       with_more("golden = { moments = {\n{ name = 'm', event = 'grsp' } } }"), "grsp", "unknown event",
       "grasp"},
      {"GoldenMomentOfAnUnknownOrgan",
       with_more("golden = { moments = {\n{ name = 'm', event = 'grasp', organ = 'galbladder' } } }"),
       "galbladder", "unknown organ", "gallbladder"},
      {"GoldenMomentThatWaitsForNothing", with_more("golden = { moments = {\n{ name = 'm', delay = 1 } } }"),
       "delay = 1", "waits for nothing", "event ="},
      {"GoldenMomentsOfOneName",
       with_more(
           "golden = { moments = { { name = 'm', event = 'grasp' },\n{ name = 'm', event = 'slip' } } }"),
       "event = 'slip'", "another picture", "name of its own"},
      {"GoldenMomentThatCountsNoEvent",
       with_more("golden = { moments = {\n{ name = 'm', step = 'look', count = 2 } } }"), "count = 2",
       "there is none", "event"},
      {"UnknownMethod", with_steps("\nt:hodl('a', function() end, 1)"), "t:hodl", "t has no \"hodl\"",
       "hold"},
      {"UnknownInstrument", with_steps("t:wait_until(function() return true end)\nlocal x = t.lfet:force()"),
       "t.lfet", "t has no \"lfet\"", "left"},
      {"UnknownInstrumentMethod", with_demo("\nt.left:graps()"), "t.left:graps", "t.left has no \"graps\"",
       ""},
      {"UnknownOrgan", with_steps("\nlocal x = t:pressure('galbladder')"), "t:pressure", "unknown organ",
       "gallbladder"},
      {"RawOfWhatHasNoCapsule", with_steps("\nlocal x = t:raw('gallbladder')"), "t:raw", "is no lobe",
       "name a liver"},
      {"UnknownOrganOfACount",
       with_steps("t:step('a', 'A')\nt:wait_until(function() return t:count('clip', 'galbladder') > 0 end)"),
       "t:wait_until", "unknown organ \"galbladder\"", "gallbladder"},
      {"UnknownOrganInARule",
       with_score(
           "{ calot.score.rule(function(run)\n return run:count('clip', 'galbladder'), 'x' end), name = 'r', "
           "weight = 1 }"),
       "return run:count", "unknown organ \"galbladder\"", "gallbladder"},
      {"UnknownParameter", with_demo("\nif p.hurry then t:wait(1) end"), "p.hurry",
       "there is no parameter \"hurry\"", "declare it in params"},
      {"ConditionWithoutReturn", with_steps("t:step('a', 'A')\nt:wait_until(function() t.left:holds() end)"),
       "t:wait_until", "the condition returns nothing", "write return"},
      {"ConditionThatIsANumber", with_steps("t:step('a', 'A')\nt:wait_until(function() return 0 end)"),
       "t:wait_until", "the condition returns a number", "write return"},
      {"ConditionThatIsAMethod", with_steps("t:step('a', 'A')\nt:wait_until(t.left.holds)"), "t:wait_until",
       "predicate is a method", "function() return t.left:holds() end"},
      {"HoldLongerThanItsStep",
       with_steps("t:step('a', 'A', { limit = 1 * s })\nt:hold('b', function() return true end, 5 * s)"),
       "t:hold", "5 s are to be held in a step whose limit is 1 s", "longer limit"},
      {"ClipsOfWhatIsNoTube", with_steps("\nlocal x = t:clips('gallbladder')"), "t:clips",
       "'gallbladder' is no tube", "a duct or a vessel"},
      {"PassMarkAsAShare",
       with_more("score = calot.score.weighted { { calot.score.penalty { event = 'slip' }, weight = 1 },\n "
                 "pass = 0.8 }"),
       "pass = 0.8", "pass = 0.8 is less than one point", "did you mean 80?"},
      {"TurnInDegrees",
       with_scene("return { anatomy = { organs = { { name = 'ball', shape = { type = 'rigid', size = { 0.01, "
                  "0.01, 0.01 "
                  "},\n turn = { 0, 90, 0 } } } } }, laparoscope = { look_at = 'ball.centre' } }"),
       "turn =", "(0, 90, 0) rad is not a sensible turn", "(0, 90, 0) * deg"},
      {"UnknownLandmarkToApproach", with_demo("\nt.left:approach('gallbladder.fundis')"), "approach",
       "unknown landmark", "gallbladder.fundus"},
      {"UnknownOption", with_demo("\nt.left:approach('gallbladder.fundus', { sped = 1 })"), "approach",
       "unknown key", "speed"},
      {"DistanceWithoutUnit", with_demo("\nt.left:move_by({ 0, 10, 25 })"), "move_by", "(0, 10, 25)", "* mm"},
      {"SpeedWithoutUnit", with_demo("\nt.left:move_by({ 0, 0, 5 * mm }, { speed = 20 })"), "move_by",
       "20 m/s", "20 * mm / s"},
      {"AngleWithoutUnit", with_demo("\nt.left:rotate(60)"), "rotate", "60 rad", "60 * deg"},
      {"TooManyArguments", with_demo("\nt.left:close(1)"), "close(1)", "no arguments", "empty"},
      {"BandOnAnUnknownInstrument",
       with_steps("\nt:step('b', 'B', { force_on = 'lft', least = 1, most = 2 })"), "t:step",
       "there is no instrument \"lft\"", "left"},
      {"HalfABand", with_steps("\nt:step('b', 'B', { force_on = 'left', least = 1 })"), "t:step",
       "force_on, least and most say together", "most = 3 * N"},
      {"MissingArgument", with_steps("\nt:step('a')"), "t:step('a')", "title", "title"},
      {"WrongArgument", with_steps("\nt:wait('long')"), "t:wait('long')", "must be a number", ""},
      {"DotForColon", with_steps("\nt.wait(1)"), "t.wait(1)", "colon", "t:wait"},
      {"StepTwice", with_steps("t:step('a', 'A')\nt:step('a', 'A again')"), "A again", "already", "own name"},
      {"StepNamedLikeAnInstrument", with_steps("\nt:step('left', 'Left')"), "t:step('left'",
       "metrics of that name", "rename"},
      {"HoldBeforeAStep", with_steps("\nt:hold('a', function() end, 1 * s)"), "t:hold", "before the first",
       "start a step"},
      {"MetricWithoutAName",
       with_score("{ calot.score.benchmark {\n metric = '', novice = 2, expert = 1 }, weight = 1 }"),
       "metric = ''", "has no name", "left.path_length_mm"},
      {"InfiniteNovice",
       with_score("{ calot.score.benchmark { metric = 'total.time_s',\n novice = math.huge, expert = 1 }, "
                  "weight = 1 }"),
       "novice = math.huge", "novice = inf is no finite number", ""},
      {"ExpertThatIsNoNumber",
       with_score("{ calot.score.benchmark { metric = 'total.time_s', novice = 1,\n expert = 0 / 0 }, "
                  "weight = 1 }"),
       "expert = 0 / 0", "nan is no finite number", ""},
      {"WeightThatIsNoNumber", with_score("{ calot.score.penalty { event = 'grasp' },\n weight = 0 / 0 }"),
       "weight = 0 / 0", "no finite number", ""},
      {"InfiniteLimitOfAParameter",
       with_params("{ a = { type = 'number', default = 1,\n max = math.huge } }"), "max = math.huge",
       "no finite number", ""},
      {"LongText", with_more("golden = { at = {\n string.rep('x', 10000000) } }"), "string.rep",
       "a text of 10000000 bytes", "at most 4000"},
      {"WaitsOfNoTime", with_steps("t:step('a', 'A')\nwhile true do t:wait(0) end"), "while true",
       "no time passes", "t:wait(0.1 * s)"},
      {"WaitsOfHardlyAnyTimeInTheDemo", with_demo("\nwhile true do t.left:wait(1e-9) end"), "while true",
       "no time passes", "t:wait(0.1 * s)"},
      {"HoldAfterAMistakenStep", with_steps("\nt:step('a')\nt:hold('b', function() return true end, 1 * s)"),
       "t:step('a')", "title", "title"},
      {"WaitInAPredicate",
       with_steps("t:step('a', 'A')\nt:wait_until(function()\n t:wait(1) return true end)"), " t:wait(1)",
       "inside a predicate", "in steps itself"},
      {"MotionInAPredicate", with_demo("t:wait_until(function()\n t.left:close() return true end)"),
       "t.left:close", "in its own coroutine", "predicate"},
      {"ErrorBesideAnotherInTogether",
       with_demo("t:together(function() t.left:close() end,\n function() local x = nil + 1 end)"), "nil + 1",
       "arithmetic", ""},
      {"TooManyOrgans",
       with_scene("local o = {} for i = 1, 25 do o[i] = { name = 'o' .. i, nodes = 30, shape = { type = "
                  "'sphere' } } "
                  "end\nreturn {\n laparoscope = { look_at = 'o1.fundus' }, anatomy = { organs = o } }"),
       "organs = o", "25 organs", "at most 24"},
      {"TooManyNodesTogether",
       with_anatomy("{\n organs = { { nodes = 900 }, { name = 'other', nodes = 900 } } }"), "nodes = 900",
       "1800 control nodes", "at most 1000"},
      {"ErrorInSteps", with_steps("t:wait(1 * s)\nerror('broken')"), "error('broken')", "broken", ""},
      {"ErrorInDemo", with_demo("t:wait(1 * s)\nlocal x = nil + 1"), "nil + 1", "arithmetic", ""},
      {"NoteOfATable", with_steps("\nt:note('way', { 1, 2 })"), "t:note", "cannot be noted as a table",
       "give a number"},
      {"NoteThatIsNotFinite", with_steps("\nt:note('way', 1 / 0)"), "t:note", "cannot be noted", "finite"},
      {"NoteWithoutAName", with_steps("\nt:note('a way', 1)"), "t:note", "not a name", "letters"},
      {"NoteTooLong", with_steps("\nt:note('way', ('x'):rep(201))"), "t:note", "too long", "200"},
      {"NoteInADemo", with_demo("\nt:note('way', 1)"), "t:note", "t has no \"note\"", ""},
      {"MetricOfAnUnknownNote", noted_score("note.forse"), "note.forse", "unknown metric", "note.force"},
      {"UnknownPlace", with_steps("\nlocal x = t:place('gallbladder.infundibulm')"), "t:place",
       "unknown landmark", "gallbladder.infundibulum"},
      {"UnknownPlaceToMeasureTo", with_steps("\nlocal x = t.left:distance('gallbladder.fundas')"), "distance",
       "unknown landmark", "gallbladder.fundus"},
      {"UnknownOrganToBeClearOf", with_steps("\nlocal x = t.left:clearance('gallblader')"), "clearance",
       "unknown organ", "gallbladder"},
      {"UnknownPartToFeelWith", with_steps("\nlocal x = t.left:force('tipp')"), "t.left:force",
       "unknown part", "tip"},
      {"UnknownPartToTouchWith", with_steps("\nlocal x = t.left:contact('jaw')"), "t.left:contact",
       "unknown part", "jaws"},
      {"GripWithoutJaws", electrode_demo("\nlocal x = t.left:grip()"), "t.left:grip", "grip is for jaws",
       "another type"},
      {"MovingUntilNothing", with_demo("\nt.left:move_until()"), "t.left:move_until",
       "\"predicate\" is missing", "predicate"},
      {"MovingUntilTooFar", with_demo("\nt.left:move_until(function() return false end, { limit = 20 })"),
       "t.left:move_until", "20 m is not a sensible limit", "20 * mm"},
      {"MovingNowhere",
       with_demo("\nt.left:move_until(function() return false end, { along = { 0, 0, 0 } })"),
       "t.left:move_until", "points nowhere", "{ 0, 0, -1 }"},
      {"AnotherInterface",
       with_head("calot = { units = calot.units, score = calot.score, anatomy = calot.anatomy,\n"
                 "exercise = function(e) e.api = 3 return require('calot').exercise(e) end }"),
       "api = 1", "3 is not a sensible api", "give 1 to 2"},
      {"HoldAfterAStepThatIsRefused", with_steps("\nt:step('a b', 'A') t:hold('c', function() end, 1 * s)"),
       "t:step", "not a name", "letters"},
      {"MovingTwoWays",
       with_demo("\nt.left:move_until(function() return false end, { along = { 0, 0, -1 }, towards = "
                 "'gallbladder.neck' })"),
       "t.left:move_until", "both given", "give one"},
      {"MovingTowardsNowhere",
       with_demo("\nt.left:move_until(function() return false end, { towards = 'gallbladder.nek' })"),
       "t.left:move_until", "unknown landmark", "gallbladder.neck"},
      {"ScoreThatIsNeither", score_function("7"), "score = 7", "a table, or a function", ""},
      {"ErrorInTheScoresFunction", score_function("function(p)\nreturn nil + 1 end"), "nil + 1", "arithmetic",
       ""},
      {"ScoresFunctionThatReturnsNone", score_function("function(p) end"), "score = function", "no score",
       "calot.score.weighted"},
      {"UnknownMetricInTheScoresFunction",
       score_function("function(p) return calot.score.weighted {\n{ calot.score.benchmark {\n metric = "
                      "'total.tme_s', novice = 2, expert = 1 }, weight = 1 } } end"),
       "total.tme_s", "unknown metric", "total.time_s"},
      {"UnknownEventInARule", rule("return run:count(\n'ctu') / 9, 'x'"), "run:count",
       "unknown event \"ctu\"", "cut"},
      {"UnknownMetricInARule", rule("return run.metrics[\n'total.tme_s'] / 9, 'x'"), "'total.tme_s'",
       "unknown metric", "total.time_s"},
      {"UnknownMemberOfARun", rule("\nreturn run.evnts[1], 'x'"), "run.evnts", "run has no \"evnts\"",
       "events"},
      {"RuleThatReturnsNothing", rule("\nreturn nil, 'x'"), "score.rule", "no share but nil",
       "return a share"},
      {"RuleThatIsNone",
       score_function("calot.score.weighted {\n{ calot.score.rule { 1 },\nname = 'x', weight = 1 } }"),
       "score.rule {", "needs a function", ""},
      {"RuleWithoutAName",
       score_function(
           "calot.score.weighted {\n{ calot.score.rule(function() return 1, 'x' end), weight = 1 } }"),
       "score.rule", "a rule needs a name", "name = "},
      {"GateWithoutAReason", gate("event = 'cut'"), "event = 'cut'", "\"reason\" is missing", "trainee"},
      {"GateWithoutACondition", gate("reason = 'x'"), "reason = 'x'", "no condition", "event"},
      {"GateOnAnUnknownEvent", gate("event = 'ctu', reason = 'x'"), "event = 'ctu'", "ctu", "cut"},
      {"GateOnAnUnknownMetric", gate("metric = 'total.tme_s', below = 1, reason = 'x'"),
       "metric = 'total.tme", "unknown metric", "total.time_s"},
      {"GateOnAMetricAlone", gate("metric = 'total.time_s', reason = 'x'"), "metric = 'total",
       "needs below or above", "below = 5"},
      {"GateOnAnUnknownOrgan", gate("event = 'cut', organ = 'galbladder', reason = 'x'"), "organ = 'galb",
       "galbladder", "gallbladder"},
      {"GateAfterAnOrganAlone", gate("event = 'cut', after_organ = 'gallbladder', reason = 'x'"),
       "after_organ", "only_after", "give only_after"},
      {"ProcedureOfAnUnknownStep", part("procedure { steps = { 'lok' } }"), "procedure", "lok", "look"},
      {"ProcedureWithAnUnknownError", part("procedure { minor = { 'slp' } }"), "procedure", "slp", "slip"},
      {"TimeThatEndsBeforeItBegins", part("time { reference = 9 * s, limit = 3 * s }"), "limit = 3",
       "not after", "earns nothing"},
      {"CriticalViewThatIsNeverNoted", part("critical_view()"), "critical_view", "unknown metric", "known"},
      {"MissingModule", with_head("local g = require 'grips'"), "require 'grips'", "no module", "looked for"},
      {"ModuleUpward", with_head("local g = require '../grips'"), "require '../grips'", "no module's name",
       "letters"},
      {"AbsoluteModule", with_head("local g = require '/etc/passwd'"), "require '/etc", "no module's name",
       "letters"},
  };
}

class Mistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreReportedOnceWithTheirLineAndWhatToDo) {
  const Mistake& mistake = GetParam();
  const std::string text = mistake.text.text();
  const Failure failure = failure_of(text);
  ASSERT_EQ(failure.problems.size(), 1u) << to_text(failure);
  EXPECT_EQ(failure.kind, FailureKind::scenario);
  const Problem& problem = failure.problems[0];
  EXPECT_EQ(std::filesystem::path(problem.place.file).filename(), "test.lua");
  EXPECT_EQ(problem.place.line, line_of(text, mistake.at)) << to_text(problem) << "\n" << text;
  const std::string report = to_text(problem);
  EXPECT_NE(report.find(mistake.message), std::string::npos) << report;
  EXPECT_NE(report.find(mistake.hint), std::string::npos) << report;
}

INSTANTIATE_TEST_SUITE_P(AuthorErrors, Mistakes, ::testing::ValuesIn(mistakes()),
                         [](const auto& mistake) { return mistake.param.name; });

/// A misspelt method where only the first call of a function meets it; `at` is what is misspelt.
struct Misspelt {
  const char* name;
  const char* steps;
  const char* demo;
  const char* at;
  const char* meant;
};

class MisspeltMethods : public ::testing::TestWithParam<Misspelt> {};

TEST_P(MisspeltMethods, AreFoundWithoutPlaying) {
  ScenarioText text;
  text.steps = "t:step('a', 'A')\n" + std::string(GetParam().steps);
  text.demo = GetParam().demo;
  const Failure failure = failure_of(text.text());
  ASSERT_EQ(failure.problems.size(), 1u) << to_text(failure);
  EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), GetParam().at)) << to_text(failure);
  EXPECT_THAT(to_text(failure), ::testing::HasSubstr(fmt::format("has no \"{}\"", GetParam().at)));
  EXPECT_THAT(to_text(failure), ::testing::HasSubstr(fmt::format("\"{}\"?", GetParam().meant)));
}

INSTANTIATE_TEST_SUITE_P(
    AuthorErrors, MisspeltMethods,
    ::testing::Values(
        Misspelt{"InWaitUntil", "t:wait_until(function()\n return t.left:hold_s() end)", "", "hold_s",
                 "holds"},
        Misspelt{"InHold", "t:hold('b', function()\n return t.left:forse() > 1 end, 1 * s)", "", "forse",
                 "force"},
        Misspelt{"OfT", "t:wait_until(function()\n return t:timme() > 1 end)", "", "timme", "time"},
        Misspelt{"OfPressure", "t:wait_until(function()\n return t:presure('gallbladder') > 1 end)", "",
                 "presure", "pressure"},
        Misspelt{"OfAnInstrument", "t:wait_until(function()\n return t.lefft:holds() end)", "", "lefft",
                 "left"},
        Misspelt{"BehindAnd", "t:wait_until(function()\n return t.left:holds() and t.left:tuching() end)", "",
                 "tuching", "touching"},
        Misspelt{"BehindOr", "t:wait_until(function()\n return t.left:holds() or t.left:tuching() end)", "",
                 "tuching", "touching"},
        Misspelt{"BehindNot",
                 "t:wait_until(function()\n return not t.left:holds() and t.left:tipp()[1] > 0 end)", "",
                 "tipp", "tip"},
        Misspelt{"BehindTwo",
                 "t:wait_until(function()\n return t.left:holds() and t.left:touching() and "
                 "t.left:handle_forc() > 1 "
                 "end)",
                 "", "handle_forc", "handle_force"},
        Misspelt{"InABand",
                 "t:hold('b', function() local f = t.left:force()\n return f > 1.5 and f < 3 and "
                 "t.left:hols() end, "
                 "1 * s)",
                 "", "hols", "holds"},
        Misspelt{"BeyondALimit", "t:wait_until(function()\n return t.left:force() > 8 and t.left:hols() end)",
                 "", "hols", "holds"},
        Misspelt{"BelowALimit",
                 "t:wait_until(function()\n return t.left:force() < 0.1 and t.left:hols() end)", "", "hols",
                 "holds"},
        Misspelt{"InTheDemosPredicate", "t:wait(1 * s)",
                 "t:wait_until(function()\n return t.left:hols() end)", "hols", "holds"},
        Misspelt{"InMoveUntil", "t:wait(1 * s)",
                 "t.left:move_until(function()\n return t.left:forse() > 1 end)", "forse", "force"},
        Misspelt{"BeyondAPull", "t:wait_until(function()\n return t.left:pull() > 8 and t.left:hols() end)",
                 "", "hols", "holds"},
        Misspelt{"BeyondAPush",
                 "t:wait_until(function()\n return t.left:push('jaws') > 8 and t.left:hols() end)", "",
                 "hols", "holds"},
        Misspelt{"BehindAGrip",
                 "t:wait_until(function()\n return t.left:grip() == 'slipped' and t.left:hols() end)", "",
                 "hols", "holds"},
        Misspelt{"BehindAContact",
                 "t:wait_until(function()\n local c = t.left:contact() return c and c.force > 8 and "
                 "t.left:hols() end)",
                 "", "hols", "holds"},
        Misspelt{"AtAPlace",
                 "t:wait_until(function()\n return t.left:distance('gallbladder.fundus') < 5 * mm and "
                 "t.left:hols() end)",
                 "", "hols", "holds"},
        Misspelt{"InTogether", "t:wait(1 * s)",
                 "t:together(function() t.left:open() end,\n function() t.left:clos() end)", "clos",
                 "close"}),
    [](const auto& misspelt) { return std::string(misspelt.param.name); });

TEST(AuthorErrors, ChecksOfValuesThatOnlyAWorldKnowsAreNone) {
  const Folder folder;
  for (const char* body :
       {"if t.left:force() > 5 * N then error('too strong') end",
        "assert(t.left:force() > 1 * N, 'too weak')",
        "assert(t.left:pull() > 1 * N and t.left:grip() == 'holding')",
        "assert(t.left:distance('gallbladder.fundus') < 1 * mm)",
        "assert(t.left:clearance('gallbladder') < 1 * mm)", "assert(t.left:contact().force > 100 * N)",
        "local p = t:place('gallbladder.neck') assert(p[3] > 0)",
        "assert(t:pressure('gallbladder') > 100) assert(t:volume('gallbladder') > 10e-6)",
        "local p = t.left:tip() assert(math.abs(p[1]) < 0.3 and p[3] < 0.3)",
        "t:wait_until(function() if not t.left:holds() then error('lost it') end return true end)",
        "local n = 0 while t.left:force() < 5 * N do n = n + 1 t:wait(0.1 * s) end assert(n < 2)"}) {
    for (const bool demo : {false, true}) {
      ScenarioText text;
      (demo ? text.demo : text.steps) += "\n" + std::string(body);
      const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text.text());
      EXPECT_TRUE(loaded) << body << "\n" << to_text(loaded.failure());
    }
  }
}

TEST(AuthorErrors, OfAnotherVersionOfTheInterfaceAreClear) {
  ScenarioText text;
  std::string other = text.text();
  other.replace(other.find("api = 1"), 7, "api = 3");
  EXPECT_THAT(to_text(failure_of(other)), ::testing::HasSubstr("api: 3 is not a sensible api (give 1 to 2)"));
}

TEST(AuthorErrors, OfTextsThatAreTooDeepOrTooLargeNameALine) {
  std::string deep = "\n\nreturn ";
  for (int i = 0; i < 40'000; ++i) deep += "{a=";
  const Failure nested = failure_of(deep);
  EXPECT_EQ(nested.problems[0].place.line, 3) << to_text(nested);
  std::string lines;  // of a kibibyte each
  for (int i = 0; i < 2000; ++i) lines += std::string(1023, ' ') + "\n";
  EXPECT_THAT(to_text(failure_of(lines)),
              ::testing::HasSubstr("test.lua:1025: a script has at most 1 MiB, and this one has more"));
  // Keys whose paths together are as long as the square of the text.
  std::string wide = "local t = {";
  for (int i = 0; i < 30; ++i) wide.append(4000, 'a').append("={");
  for (int i = 0; i < 50'000; ++i) wide += "b=1,";
  wide.append(31, '}').append("\nreturn t");
  EXPECT_EQ(failure_of(wide).problems[0].place.line, 2);
}

TEST(AuthorErrors, AByteOrderMarkIsNone) {
  const Folder folder;
  EXPECT_TRUE(load_text(folder, "\xEF\xBB\xBF" + ScenarioText().text()));
}

TEST(AuthorErrors, AFileThatCannotBeReadIsAUsageFailure) {
  const Folder folder;
  std::filesystem::create_symlink("/proc/self/mem", folder.path() / "test.lua");
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_exercise(folder.path() / "test.lua");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.failure().kind, FailureKind::usage) << to_text(loaded.failure());
}

// ---- what only a world shows

/// A bipyramid of so many sides, 40 mm wide; `bad` is added to it.
std::string bipyramid(int sides, const std::string& bad = "") {
  std::string text;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * 3.141592653589793 * i / sides;
    text += fmt::format("v {} {} 0.02\n", 0.02 * std::cos(angle), 0.02 * std::sin(angle));
  }
  text += "v 0 0 0\nv 0 0 0.04\n";
  for (int i = 1; i <= sides; ++i) {
    const int next = i % sides + 1;
    text += fmt::format("f {} {} {}\nf {} {} {}\n", next, i, sides + 1, i, next, sides + 2);
  }
  return text + bad;
}

TEST(AuthorErrors, OfMeshesNameOrganFileAndLine) {
  struct Case {
    std::string mesh, scale, message;
  };
  std::string open = bipyramid(12);
  open.erase(open.rfind("f "));
  for (const Case& wrong :
       {Case{open, "1", "open boundary"}, Case{bipyramid(200), "1", "more than 40 triangles"},
        Case{bipyramid(12), "1e-6", "6.93e-08 m across"}, Case{bipyramid(12), "1e3", "m across"}}) {
    const Folder folder;
    folder.write("shape.obj", wrong.mesh);
    const std::string text =
        with_anatomy("{ organs = { { name = 'sac',\n shape = { type = 'obj', path = 'shape.obj', scale = " +
                     wrong.scale + " } } } }, laparoscope = { look_at = 'sac.fundus' }")
            .text();
    const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text);
    ASSERT_FALSE(loaded) << wrong.message;
    ASSERT_EQ(loaded.failure().problems.size(), 1u) << to_text(loaded.failure());
    EXPECT_EQ(loaded.failure().problems[0].place.line, line_of(text, "shape = {"));
    EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr(wrong.message));
    EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr("organ 'sac'"));
  }
}

TEST(AuthorErrors, AreNoPointsThatNoFaceUsesWhichAreLeftOutWithARemark) {
  const Folder folder;
  const std::string mesh = bipyramid(12);
  folder.write("good.obj", mesh);
  const auto scene = [&](const std::string& file) {
    const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(
        folder,
        with_anatomy("{ organs = { { name = 'sac',\n shape = { type = 'rigid', path = '" + file +
                     "', centre = { 0, 0, -100 * mm } } } } }, laparoscope = { look_at = 'sac.centre' }")
            .text());
    EXPECT_TRUE(loaded) << to_text(loaded.failure());
    return loaded ? loaded.value()->definition().scene : SceneDefinition{};
  };
  EXPECT_TRUE(mesh_remarks(scene("good.obj")).empty());
  folder.write("stray.obj", mesh + "v 2 2 2\n");
  const std::vector<std::string> said = mesh_remarks(scene("stray.obj"));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0],
              ::testing::HasSubstr(
                  "stray.obj: 1 of its points is left out, as no face uses it: the first is point 15"));
}

TEST(AuthorErrors, ThatShowWhileTheWorldIsBuiltNameOrganFileAndLine) {
  struct Case {
    std::string scene, at, message;
  };
  const std::string ball =
      "anatomy = { organs = { { name = 'ball', nodes = 61,\n shape = { type = 'sphere' }, ";
  const std::string rest = "laparoscope = { look_at = 'ball.fundus' } }";
  for (const Case& wrong :
       {Case{"return { " + ball +
                 "\n bile = { fill_volume = 900 * 1e-6 }, held = { { landmark = 'bed' } } } } }, " + rest,
             "bile =", "organ 'ball' holds"},
        Case{"return { " + ball +
                 "\n bile = { fill_pressure = 40e3 }, wall = { shear_modulus = 1000, thickness = "
                 "0.1 * mm },\n held = { { landmark = 'bed' } } } } }, " +
                 rest,
             "bile =", "organ 'ball' found no equilibrium while it was filled"},
        Case{"return { " + ball +
                 "neck = { 0, 0, 0 }, fundus = { 0, 0, 40 * mm } } },\n support = { point = { 0, 0, "
                 "20 * mm }, normal = { 0, 0, 1 } } }, " +
                 rest,
             "organs =", "organ 'ball' starts"},
        Case{"return { " + ball +
                 " neck = { 0, 0, 0 }, fundus = { 0, 0, 40 * mm }, held = { { landmark = 'bed' } } },\n { "
                 "name = 'stone', shape = { type = 'rigid',\n "
                 "rounding = 5 "
                 "* mm, centre = { 18 * mm, 0, 20 * mm } } } } }, " +
                 rest,
             "name = 'stone'", "organ 'ball' and organ 'stone' are "},
        Case{"return { " + ball +
                 " neck = { 0, 0, 0 }, fundus = { 0, 0, 40 * mm }, held = { { landmark = 'bed' } } },\n { "
                 "name = 'duct', "
                 "wall = { thickness = 0.4 * mm }, held = { { landmark = 'start' } }, shape = { type = "
                 "'tube', radius = 1 "
                 "* mm, points = { { 0, 0, 15 * mm }, { 0, 0, 28 * mm } } } } } }, " +
                 rest,
             "name = 'duct'", "organ 'ball' and organ 'duct' are "},
        Case{"return { " + ball + "\n held = { { landmark = 'bed', radius = 0.5 * mm } } } } }, " + rest,
             "held =", "of organ 'ball'"},
        Case{"return { " + ball + "} } }, " + rest, "name = 'ball'", "nothing holds the body"},
        Case{"return { anatomy = { ground = { { name = 'board', point = { 0, 0, -0.12 } } },\n organs = { { "
             "name = "
             "'bead', shape = { type = 'rigid', rounding = 6 * mm, centre = { 0, 0.1, -0.1 } } } } },\n "
             "solver = { "
             "motion = 'dynamic' }, laparoscope = { look_at = 'bead.centre' } }",
             "'bead', shape", "organ 'bead' never comes to rest: it has fallen or slid 3"}}) {
    const Folder folder;
    const std::string text = with_scene(wrong.scene).text();
    const Result<std::unique_ptr<ExerciseScript>> loaded = load_text(folder, text);
    ASSERT_TRUE(loaded) << to_text(loaded.failure());
    const Result<World> world = World::create(loaded.value()->definition().scene);
    ASSERT_FALSE(world) << wrong.message;
    const Failure failure = loaded.value()->located(world.failure());
    EXPECT_EQ(failure.kind, FailureKind::scenario) << to_text(failure);
    EXPECT_EQ(std::filesystem::path(failure.problems[0].place.file).filename(), "test.lua");
    EXPECT_EQ(failure.problems[0].place.line, line_of(text, wrong.at)) << to_text(failure);
    EXPECT_THAT(to_text(failure), ::testing::HasSubstr(wrong.message));
  }
}

TEST(AuthorErrors, AreReportedAllAtOnceInTheOrderOfLines) {
  ScenarioText text;
  text.params = "{ a = { type = 'choice', default = 'x', choices = { 'y' } } }";
  text.scene =
      "return { anatomy = calot.anatomy('standard', {\n organs = { { wall = { thickness = 2 } } } }),\n"
      " instruments = {\n left = { port = 'nowhere' } }, colour = 1 }";
  text.steps = "t:step('a', 'A')\n t:hold('b', function() end, 10 * s)\n t.left:lift()\n t.right:force()";
  text.demo = "t.left:approach('liver.fundus')\n t.left:move_by({ 1, 2 })";
  text.score =
      "calot.score.weighted {\n { calot.score.benchmark { metric = 'a.c.time_in_s', novice = 1, expert = 2 "
      "},\n weight = 0.5 } }";
  text.more = "goldn = {}";
  const Failure failure = failure_of(text.text());
  // params.a.default, thickness, port, colour, condition, lift, right, landmark, point, metric, weights, goldn
  EXPECT_EQ(failure.problems.size(), 12u) << to_text(failure);
  for (std::size_t i = 1; i < failure.problems.size(); ++i)
    EXPECT_LE(failure.problems[i - 1].place.line, failure.problems[i].place.line);
}

TEST(AuthorErrors, OfAFileThatReturnsNoExercise) {
  EXPECT_THAT(to_text(failure_of("return 5")), ::testing::HasSubstr("return calot.exercise"));
  EXPECT_THAT(to_text(failure_of("")), ::testing::HasSubstr("return calot.exercise"));
  EXPECT_THAT(to_text(failure_of("return { api = 1 }")), ::testing::HasSubstr("return calot.exercise"));
}

TEST(AuthorErrors, OfAnEmptyExerciseNameEveryKeyItNeeds) {
  const Failure failure = failure_of("return require('calot').exercise {}");
  for (const char* key : {"api", "id", "title", "scene", "steps"})
    EXPECT_THAT(to_text(failure), ::testing::HasSubstr(fmt::format("\"{}\" is missing", key)));
}

TEST(AuthorErrors, OfBytecodeAreClear) {
  const Failure failure = failure_of(std::string("\x1bLua", 4));
  EXPECT_EQ(failure.kind, FailureKind::scenario);
  EXPECT_THAT(to_text(failure), ::testing::HasSubstr("bytecode"));
}

TEST(AuthorErrors, OfEndlessLoopsAreResourceFailuresWherever) {
  for (const ScenarioText& text : {with_head("while true do end"), with_scene("while true do end"),
                                   with_steps("while true do end"), with_demo("while true do end")}) {
    const Failure failure = failure_of(text.text());
    EXPECT_EQ(failure.kind, FailureKind::resource);
    EXPECT_EQ(failure.problems[0].place.line, line_of(text.text(), "while true")) << to_text(failure);
  }
}

TEST(AuthorErrors, AMissingFileIsAUsageFailureWithASuggestion) {
  const Folder folder;
  folder.write("grasp.lua", "");
  const Result<std::unique_ptr<ExerciseScript>> loaded = load_exercise(folder.path() / "garsp.lua");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.failure().kind, FailureKind::usage);
  EXPECT_THAT(to_text(loaded.failure()), ::testing::HasSubstr("grasp.lua"));
}

}  // namespace
}  // namespace calot::author_errors_test
