// The keys of a scene's definitions, one row a key. Limits catch forgotten units and slips, not unusual patients.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

#include "anatomy/instruments.h"
#include "anatomy/key_table.h"
#include "base/units.h"

namespace calot {
namespace {

/// "an atraumatic_grasper has ..., ..."
std::string instruments_doc() {
  std::string all;
  for (const InstrumentRow& row : instrument_rows())
    all += std::string(all.empty() ? "" : "; ") + row.name + " " + row.doc;
  return all;
}

using units::deg;
using units::kPa;
using units::mL;
using units::mm;

std::vector<KeyTable> field_tables() {
  using Instrument = InstrumentDefinition;
  using Scope = LaparoscopeDefinition;
  using Anatomy = AnatomyDefinition;
  using Solver = SolverDefinition;
  const std::string semm =
      written(default_instrument(InstrumentType::semm_forceps).pad_friction, quantity::number);
  Key extensions = table("extensions", "extensions", "structural extensions at contacts");
  extensions.inner = [](void* solver, bool) { return solver; };  // its keys are the solver's own members
  return {
      keys_of<SceneDefinition>(
          "scene", "What scene = function(p) returns: the operating field at rest.",
          {required(table("anatomy", "anatomy", "organs and table: calot.anatomy(...) or a table")),
           map("ports", "point", "trocars by name, added to the usual ones or moved: { name = { x, y, z } }"),
           map("instruments", "instrument", "instruments by name: { left = { ... } }; they are t.left, ..."),
           table("laparoscope", &SceneDefinition::laparoscope, "laparoscope", "the camera"),
           table("solver", &SceneDefinition::solver, "solver", "steps and tolerance")}),
      keys_of<Anatomy>(
          "anatomy", "The organs and how the table is tilted.",
          {choice("base", anatomy_names(), "", "named anatomy to start from; calot.anatomy(name) sets it"),
           list("organs", "organ",
                "the organs; with a base, the first overrides the base's first, and so on"),
           list("joints", "joint", "what ties organs to each other: where a duct grows out of a gallbladder"),
           list("tissue", "tissue",
                "connective tissue between organs, which may be dissected: the cystic plate"),
           list("leaves", "leaf", "peritoneum that is only seen: over the hepatoduodenal ligament"),
           list("ground", "ground", "shapes that stay and are touched"),
           table("support", &Anatomy::support, "support", "a plane that carries the organs"),
           number(
               "friction", &Anatomy::friction, quantity::number, 0, 1,
               "a coefficient of friction of organs on each other",
               "coefficient of friction of the organs on each other; 0 to 0.3 for wet tissue, uncalibrated"),
           number("rest_within", &Anatomy::rest_within, quantity::length, 0, 1, "a distance",
                  "an organ that comes to rest further than this from where it is drawn is named in reports, "
                  "and by calot check --build"),
           number("heart_rate", &Anatomy::heart_rate, quantity::number, 20, 240, "a heart's rate",
                  "beats a minute, with which what bleeds pulses"),
           number("table_head_up", &Anatomy::table_head_up, quantity::angle, -60 * deg, 60 * deg,
                  "a tilt of an operating table", "reverse Trendelenburg tilt"),
           number("table_left_down", &Anatomy::table_left_down, quantity::angle, -60 * deg, 60 * deg,
                  "a tilt of an operating table", "tilt to the patient's left")}),
      keys_of<SupportDefinition>(
          "support", "A plane; what is below it is solid.",
          {place("point", &SupportDefinition::point, abdomen_reach, "a place in the abdomen",
                 "a point on it"),
           direction("normal", &SupportDefinition::normal, "its unit normal, pointing out of the solid"),
           number("friction", &SupportDefinition::friction, quantity::number, 0, 1,
                  "a coefficient of friction of a support",
                  "coefficient of friction of the skin on it; 0 to 0.3 for wet tissue")}),
      keys_of<JointDefinition>(
          "joint",
          "Ties a place on one organ to one on another: its end keeps its place and direction there.",
          {required(text("from", &JointDefinition::from, "\"organ.landmark\", the end that is tied")),
           required(text("to", &JointDefinition::to, "\"organ.landmark\", what it is tied to")),
           number("radius", &JointDefinition::radius, quantity::length, 0.5 * mm, 50 * mm, "a joint's radius",
                  "of what is held at either side"),
           number("stiffness", &JointDefinition::stiffness, quantity::number, 1, 1e6, "a joint's stiffness",
                  "of all of it, N/m")}),
      keys_of<TissueDefinition>(
          "tissue",
          "Connective tissue: strands from one organ's surface to the nearest place of another's, slack "
          "until they "
          "are stretched. Pulled past their strength they give way one after another.",
          {text("name", &TissueDefinition::name, "its name, unique"),
           required(text("from", &TissueDefinition::from, "the organ whose surface it covers")),
           required(text("to", &TissueDefinition::to, "the organ that it hangs on")),
           number("within", &TissueDefinition::within, quantity::length, 0.1 * mm, 40 * mm,
                  "a tissue's reach", "it is where their surfaces are nearer than this at rest"),
           number("start", &TissueDefinition::start, quantity::number, 0, 1, "a share of a way",
                  "where it begins, as a share of a tube's length, or of the way from neck to fundus"),
           number("stop", &TissueDefinition::stop, quantity::number, 0, 1, "a share of a way",
                  "where it ends"),
           count("strands", &TissueDefinition::strands, 1, most_strands, "a number of strands",
                 "at most; how many share the area changes nothing but how finely it tears"),
           number("slack", &TissueDefinition::slack, quantity::number, 0, 3, "a strand's slack",
                  "by which share of its length at rest a strand is longer"),
           number("stiffness", &TissueDefinition::stiffness, quantity::pressure, 0.1 * kPa, 10000 * kPa,
                  "a tissue's stiffness", "tension by area and strain as strands become taut"),
           number("stiffening", &TissueDefinition::stiffening, quantity::number, 0, 20, "a stiffening",
                  "exponent of the tension a strain; 0: it does not stiffen"),
           number("strength", &TissueDefinition::strength, quantity::pressure, 0.1 * kPa, 10000 * kPa,
                  "a tissue's strength", "largest tension by area; uncalibrated"),
           number("break_energy", &TissueDefinition::break_energy, quantity::number, 0.1, 1e5,
                  "a break energy", "to tear it, J/m^2: as a peel's force by width, N/m; uncalibrated"),
           number("density", &TissueDefinition::density, quantity::density, 100, 2000, "a density", "kg/m^3"),
           number("radius", &TissueDefinition::radius, quantity::length, 0, 2 * mm, "a strand's radius",
                  "of a strand, in its middle, as instruments feel it; 0: they pass through; uncalibrated"),
           number(
               "divide_energy", &TissueDefinition::divide_energy, quantity::number, 1e3, 1e8,
               "an energy to divide tissue",
               "of an instrument's current that divides it, J/m^2; 1 mm of water takes 2.5e6 to boil away; "
               "uncalibrated"),
           flag("covered", &TissueDefinition::covered,
                "true: a leaf of peritoneum covers it towards the front, to be seen, and opens where it is "
                "torn"),
           choice("looks", &TissueDefinition::looks, {"fat", "areolar"},
                  "how its strands are drawn: as yellow lobules of fat, or as the loose tissue of a plane, "
                  "whose "
                  "fine fibres whiten as they are stretched")}),
      keys_of<LeafDefinition>(
          "leaf",
          "A leaf of peritoneum over two tubes and what is between them, towards the front. It is seen, and "
          "carries "
          "nothing.",
          {required(text("from", &LeafDefinition::from, "the tube along which it lies")),
           required(text("to", &LeafDefinition::to, "the tube that it reaches over to")),
           number("start", &LeafDefinition::start, quantity::number, 0, 1, "a share of a way",
                  "where it begins, as a share of the first tube's length"),
           number("stop", &LeafDefinition::stop, quantity::number, 0, 1, "a share of a way", "where it ends"),
           number("free_edge", &LeafDefinition::free_edge, quantity::length, 0, 40 * mm, "a width",
                  "how far it goes on past the first tube"),
           number("goes_on", &LeafDefinition::goes_on, quantity::length, 0, 40 * mm, "a width",
                  "how far it goes on past the second tube")}),
      keys_of<GroundDefinition>(
          "ground", "A shape that stays and is touched. Instruments stop at it.",
          {text("name", &GroundDefinition::name, "its name, unique"),
           choice(
               "type", &GroundDefinition::type, {"plane", "capsule", "box"},
               "a plane (point, normal), a capsule (point, to, radius), a box with round edges (point, size, "
               "radius)"),
           place("point", &GroundDefinition::point, abdomen_reach, "a place in the abdomen",
                 "on the plane, a capsule's beginning, a box' centre"),
           direction("normal", &GroundDefinition::normal, "the plane's unit normal, out of the solid"),
           place("to", &GroundDefinition::to, abdomen_reach, "a place in the abdomen", "a capsule's end"),
           place("size", &GroundDefinition::size, abdomen_reach, "a size in the abdomen",
                 "a box' edges along x, y and z, without its rounding"),
           number("radius", &GroundDefinition::radius, quantity::length, 0.5 * mm, 250 * mm,
                  "a ground's radius", "of a capsule, and of a box' edges"),
           number("friction", &GroundDefinition::friction, quantity::number, 0, 1,
                  "a coefficient of friction of ground", "coefficient of friction of what touches it"),
           choice("looks", &GroundDefinition::looks,
                  {"usual", "liver", "bowel", "fat", "peritoneum", "board", "plastic"},
                  "how it is drawn; usual: beside a lobe as peritoneum, else as liver, a plane as "
                  "peritoneum; a bowel has to be a capsule; board and plastic are of a training box, whose "
                  "walls "
                  "are then around"),
           text("injury", &GroundDefinition::injury,
                "what it is called when it is hurt by blades, clips, current or a thrust; left out: liver "
                "and bowel "
                "by their looks, "
                "and nothing else"),
           number("thrust_limit", &GroundDefinition::thrust_limit, quantity::force, 0.1, 1000,
                  "a thrust that hurts",
                  "the force of jaws, or of what a shaft ends in, that hurts it; uncalibrated")}),
      keys_of<Instrument>(
          "instrument", "An instrument through a port.",
          {choice("type", &Instrument::type, instrument_type_names(),
                  "which instrument: " + instruments_doc()),
           required(text("port", &Instrument::port, "the port it goes through")),
           flag("waits", &Instrument::waits,
                "true: it waits outside while another instrument is in its port, until it is exchanged for "
                "that"),
           number(
               "force_limit", &Instrument::force_limit, quantity::force, 0.05, 100,
               "a limit of force on tissue",
               "force on its jaws, or on what its shaft ends in, above which the event overforce is raised"),
           number("hand_force", &Instrument::hand_force, quantity::force, 0.05, 100,
                  "a force that a hand holds against",
                  "force at the tip up to which its hand holds it where it is commanded to be; beyond, it "
                  "gives way"),
           number("port_friction", &Instrument::port_friction, quantity::force, 0, 10,
                  "a friction of a port's seal",
                  "friction of the seal of its port on the shaft that slides through, which its hand feels; "
                  "0.25 to 3 N"),
           only_of(
               KeyOwner::jaws,
               number(
                   "pinch_force", &Instrument::pinch_force, quantity::force, 0.05, 100,
                   "a force that a hand gives a jaw",
                   "force that each jaw closes with: it stops where tissue carries that; jaws at an angle of "
                   "2 a "
                   "hold a pull of 2 * pinch_force * (pad_friction * cos a - sin a), beyond which it slips")),
           only_of(KeyOwner::jaws, number("pad_friction", &Instrument::pad_friction, quantity::number, 0.01,
                                          5, "a coefficient of friction",
                                          "coefficient of friction of a pad; " + semm + " for semm_forceps")),
           number("friction", &Instrument::friction, quantity::number, 0, 1,
                  "a coefficient of friction of a smooth tool",
                  "coefficient of friction of the skin that the shaft and what it ends in press on; 0 to 0.3 "
                  "for a smooth shaft on wet skin"),
           only_of(KeyOwner::current,
                   number("power", &Instrument::power, quantity::number, 1, 120, "a power of a generator, W",
                          "W of its current: what strands of tissue it touches then share it, and are "
                          "divided by it")),
           only_of(KeyOwner::clips,
                   choice("clip", &Instrument::clip, clip_names(),
                          "the size of its clips, for vessels of 2 to 4 mm (M) or 3.5 to 7 mm (ML)")),
           only_of(KeyOwner::clips, count("clips", &Instrument::clips, 0, most_clips, "a number of clips",
                                          "how many it carries")),
           only_of(KeyOwner::needle,
                   number("bore", &Instrument::bore, quantity::length, 0.3 * mm, 1.9 * mm,
                          "a bore of a needle 2.1 mm thick", "its bore, across; 1.6 mm is 14 gauge")),
           only_of(KeyOwner::needle,
                   number("bore_length", &Instrument::bore_length, quantity::length, 20 * mm, 1000 * mm,
                          "a length of a needle's bore",
                          "from its mouth to where the suction's pressure is; uncalibrated")),
           only_of(KeyOwner::needle,
                   number("suction", &Instrument::suction, quantity::pressure, 0, 80 * kPa,
                          "a pressure of a suction pump",
                          "how far its pressure is below that outside of the organs; uncalibrated")),
           only_of(
               KeyOwner::needle,
               number("pinhole", &Instrument::pinhole, quantity::length, 0, 2 * mm,
                      "a width of what a needle leaves open",
                      "across what stays open of a wall that it was through, 0: nothing; uncalibrated"))}),
      keys_of<Scope>("laparoscope", "The camera and its light.",
                     {text("port", &Scope::port, "the port it goes through"),
                      number("angle", &Scope::angle, quantity::angle, 0, 70 * deg,
                             "an angle of view of a laparoscope", "of its optic: 0 or 30 deg are usual"),
                      text("look_at", &Scope::look_at, "landmark in the middle of the picture"),
                      number("distance", &Scope::distance, quantity::length, 10 * mm, 400 * mm,
                             "a distance to look from", "from its tip to what it looks at"),
                      number("field_of_view", &Scope::field_of_view, quantity::angle, 20 * deg, 120 * deg,
                             "a laparoscope's field of view", "across the round picture"),
                      number("light", &Scope::light, quantity::number, 0, 10, "a light's brightness",
                             "brightness of its light; 1: what it looks at is well lit; 0: it is off"),
                      number("exposure", &Scope::exposure, quantity::number, 0.05, 20, "a camera's exposure",
                             "of the camera, which adapts to bright and dark pictures by itself; what it "
                             "makes of them is then as bright as light times exposure"),
                      choice("horizon", &Scope::horizon, {"level", "held"},
                             "who keeps it level: the camera, or who turns the shaft that it is fixed to"),
                      flag("show_structure", &Scope::show_structure,
                           "draw elements and nodes on the organs, to look into the simulation")}),
      keys_of<Solver>(
          "solver", "How the simulation steps.",
          {number("rate", &Solver::rate, quantity::rate, 1, 2000, "a step rate", "steps a second"),
           choice(
               "motion", &Solver::motion, {"static", "dynamic"},
               "each step is a rest under its loads, or a time in which walls and bile move by their masses"),
           number("tolerance", &Solver::tolerance, quantity::number, 1e-12, 1e-2, "a solver tolerance",
                  "dimensionless residual of equilibrium"),
           flag("skip_still", &Solver::skip_still,
                "do not compute again steps that change nothing; off only to measure what they cost"),
           extensions}),
      keys_of<Solver>(
          "extensions",
          "Structural extensions: finer basis functions around each place that an instrument touches.",
          {count("levels", &Solver::extension_levels, 0, most_extension_levels,
                 "the levels of a structural extension",
                 "subdivision levels added at a contact, each with 12 nodes; 0: none"),
           number("view", &Solver::extension_view, quantity::length, 0, 400 * mm,
                  "a distance of the laparoscope",
                  "where the laparoscope looks at an organ from nearer than this it is refined too; 0: not"),
           choice("scheme", &Solver::extension_scheme, {"condensed", "staged"},
                  "solved together with the organ, or after it as its boundary allows (the 1997 scheme, "
                  "to compare with)")}),
  };
}

std::vector<KeyTable> organ_tables() {
  using Organ = OrganDefinition;
  using Wall = WallDefinition;
  using Fibres = FibreDefinition;
  using Bile = BileDefinition;
  return {
      keys_of<Organ>(
          "organ",
          "A hollow organ, a duct or vessel, a rigid thing, or a lobe of the liver. In calot.anatomy's "
          "overrides, only what "
          "differs.",
          {text("name", &Organ::name, "its name, unique; landmarks are written \"gallbladder.fundus\""),
           table("shape", "shape",
                 fmt::format("its shape at rest: type \"{}\" with its keys",
                             fmt::join(shape_names(), "\", \""))),
           count("nodes", &Organ::nodes, 12, most_nodes, "a number of control nodes",
                 "control nodes; more resolve finer folds and cost more"),
           place("neck", &Organ::neck, abdomen_reach, "a place in the abdomen",
                 "where the shape's lower pole lies"),
           place("fundus", &Organ::fundus, abdomen_reach, "a place in the abdomen",
                 "where its upper pole points to"),
           direction("liver_side", &Organ::liver_side,
                     "direction from the organ's axis to its bed on the liver"),
           table("wall", &Organ::wall, "wall", "its wall"),
           table("bile", &Organ::bile, "bile", "what fills it"),
           list("held", "held", "elastic attachments; a list given here replaces the anatomy's own"),
           choice(
               "looks", &Organ::looks, {"bile", "pale", "plastic"},
               "how a gallbladder is drawn: full of bile, or pale, as one that mucus has filled (hydrops); a "
               "rigid thing is a stone, or plastic"),
           flag("extensions", &Organ::extensions, "false: no structural extensions on this organ"),
           text("compared_with", &Organ::compared_with,
                "another organ of the same shape; the metrics mean_difference_pct and "
                "largest_difference_pct then say how far this one's skin is from moving like that one's"),
           table("injury", "injury", "what it is called when this organ, which should be kept, is hurt"),
           number("keep_clear", &Organ::keep_clear, quantity::length, 0, 100 * mm, "a distance to keep",
                  "current that flows nearer to it is the event activation_beside; 0: it may"),
           list(
               "vessels", "wall_vessel",
               "an artery's branches on a hollow organ's wall, drawn there, from which finer vessels grow")}),
      keys_of<WallVessel>(
          "wall_vessel", "A branch of an artery that is drawn on a wall: it looks, and does nothing.",
          {required(
               list("points", "point",
                    "its course on the skin or near it, from where the artery comes: two points or more")),
           number("radius", &WallVessel::radius, quantity::length, 0.1 * mm, 2 * mm,
                  "a small vessel's radius", "at its beginning; it tapers")}),
      keys_of<InjuryDefinition>(
          "injury",
          "What an instructor calls an injury of this organ, such as \"Strasberg E\": the text of the event "
          "injury. What is left out is none.",
          {text("cut", &InjuryDefinition::cut, "it is divided"),
           text("closed", &InjuryDefinition::closed, "a clip shuts it"),
           text("partly", &InjuryDefinition::partly,
                "a clip holds a part of its width, or current goes through its wall"),
           text("unclipped", &InjuryDefinition::unclipped,
                "it is divided without a shut clip on the patient's side"),
           list("near_start", "injury_near_start",
                "what cut and closed are called near a tube's start: of those that hold, the one that "
                "reaches least far"),
           list("together", "injury_together",
                "what cut, closed and unclipped are called where another organ is hurt too: the first that "
                "holds")}),
      keys_of<InjuryNearStart>(
          "injury_near_start",
          "A part of a duct that has a class of its own, such as Strasberg's E2 instead of E1.",
          {required(number("within", &InjuryNearStart::within, quantity::length, 0.1 * mm, 200 * mm,
                           "a way along a duct", "along it at rest, from its start: up to there")),
           required(text("called", &InjuryNearStart::called, "what it is called there"))}),
      keys_of<InjuryTogether>(
          "injury_together", "Injuries that have a class together, such as Strasberg's E5.",
          {required(
               text("with", &InjuryTogether::with, "the other organ: it is divided, or a clip shuts it")),
           required(text("called", &InjuryTogether::called, "what it is called then, whichever was first"))}),
      keys_of<Wall>(
          "wall", "The organ's wall.",
          {number("thickness", &Wall::thickness, quantity::length, 0.1 * mm, 10 * mm, "a wall's thickness",
                  "2 to 3 mm is usual"),
           number("shear_modulus", &Wall::shear_modulus, quantity::pressure, 1 * kPa, 100e3 * kPa,
                  "a soft tissue's shear modulus", "shear modulus mu of the isotropic wall at rest"),
           number("stiffening", &Wall::stiffening, quantity::number, 0, 100,
                  "an exponent of a wall's stiffening",
                  "b of the exponential Fung (Demiray) law; 0: neo-Hookean"),
           table("fibres", &Wall::fibres, "fibres",
                 "makes the wall anisotropic; {}: as measured in human gallbladders, whose shear_modulus is "
                 "85 * kPa"),
           number("overstretch", &Wall::overstretch, quantity::number, 1.01, 10, "a limit of stretch",
                  "principal stretch above which the event overstretch is raised"),
           number("perforation_stretch", &Wall::perforation_stretch, quantity::number, 1.01, 20,
                  "a limit of stretch",
                  "principal stretch above which a hollow organ's wall is opened: the event perforation"),
           number("pinch_limit", &Wall::pinch_limit, quantity::force, 0.5, 100, "a pinch",
                  "jaws that pinch harder open a hollow organ's wall: 15 to 37 N by jaw"),
           number("burn_energy", &Wall::burn_energy, quantity::number, 0.1, 1000, "an energy of current",
                  "J of current in one place that go through the wall"),
           number("density", &Wall::density, quantity::density, 0, 2000, "a wall's density",
                  "kg/m^3; 1050 is usual; 0: without weight and inertia"),
           number("retardation", &Wall::retardation, quantity::time, 0, 1, "a time of retardation",
                  "how long stress lags behind a change of shape where motion is dynamic: it damps"),
           number("burn_reach", &Wall::burn_reach, quantity::length, 0, 5 * mm, "a reach of current's heat",
                  "current that flows nearer to it heats it, the more the nearer; 0: only where it is "
                  "touched; uncalibrated"),
           number("raw_energy", &Wall::raw_energy, quantity::number, 1e4, 1e9,
                  "an energy that takes a capsule off",
                  "J/m^2 of current that leave a lobe's surface raw; 1 mm of water takes 2.5e6 to boil away; "
                  "uncalibrated")}),
      keys_of<Fibres>(
          "fibres",
          "Two families of fibres (Holzapfel, Gasser, Ogden) on either side of the axis; they bear tension "
          "only.",
          {number("stiffness", &Fibres::stiffness, quantity::pressure, 0, 100e3 * kPa,
                  "a stiffness of fibres",
                  "k1 of each family; each adds 4 k1 to Young's modulus along itself"),
           number("stiffening", &Fibres::stiffening, quantity::number, 0, 1000,
                  "an exponent of fibres' stiffening", "exponent k2; 0: they do not stiffen"),
           number("angle", &Fibres::angle, quantity::angle, 0, 90 * deg,
                  "an angle of fibres from the organ's axis",
                  "from the axis, neck to fundus: 0 longitudinal, 90 * deg circumferential")}),
      keys_of<Bile>(
          "bile",
          "The filling. Give the volume or the pressure, the other follows; neither: the unstressed volume.",
          {number("density", &Bile::density, quantity::density, 500, 2000, "bile's density",
                  "kg/m^3; 1010 to 1040 is usual"),
           number("fill_volume", &Bile::fill_volume, quantity::volume, 0.5 * mL, 1000 * mL,
                  "a gallbladder's filling", "volume of the filling"),
           number("fill_pressure", &Bile::fill_pressure, quantity::pressure, 0, 40 * kPa,
                  "a pressure of bile", "gauge pressure at the highest point; 10 to 15 mmHg is usual")}),
      keys_of<HeldRegion>(
          "held", "An elastic foundation under the skin near a landmark: the cystic plate, the duct's root.",
          {text("name", &HeldRegion::name, "its name, unique within the organ"),
           required(
               choice("landmark", &HeldRegion::landmark, organ_landmarks(), "the landmark it surrounds")),
           number("radius", &HeldRegion::radius, quantity::length, 0.5 * mm, 250 * mm,
                  "a held region's radius", "how far it reaches"),
           number("stiffness", &HeldRegion::stiffness, quantity::foundation, 1, 1e10,
                  "a foundation's stiffness a unit area", "N/m per m^2 of skin"),
           flag("while_filled", &HeldRegion::while_filled,
                "true: only until the organ is filled; then it is held by what it is tied to, such as "
                "tissue")}),
  };
}

std::vector<KeyTable> shape_tables() {
  const auto type = [](const std::string& name) {
    return choice("type", shape_names(), "\"pear\"", "which shape: this one is \"" + name + "\"");
  };
  return {
      keys_of<PearShape>("shape_pear", "A gallbladder: round fundus, tapering body, slim neck.",
                         {type("pear"),
                          number("length", &PearShape::length, quantity::length, 30 * mm, 250 * mm,
                                 "a gallbladder's length", "neck to fundus; 70 to 100 mm is usual"),
                          number("width", &PearShape::width, quantity::length, 10 * mm, 120 * mm,
                                 "a gallbladder's width", "largest diameter; 30 to 40 mm is usual"),
                          number("refine", &PearShape::refine, quantity::number, 1, 8, "a refinement",
                                 "control nodes are closer by this factor near the fundus"),
                          number("refine_radius", &PearShape::refine_radius, quantity::length, 1 * mm,
                                 250 * mm, "a radius of refinement", "how far from the fundus they are")}),
      keys_of<SphereShape>("shape_sphere", "A ball, as in the paper's experiments.",
                           {type("sphere"), number("radius", &SphereShape::radius, quantity::length, 5 * mm,
                                                   100 * mm, "an organ's radius", "radius at rest")}),
      keys_of<SweptShape>(
          "shape_swept",
          "A hollow organ along a curved axis, such as a gallbladder with its pouch; its stations are its "
          "neck and "
          "its fundus too.",
          {type("swept"),
           required(
               list("along", "station",
                    "its axis from the neck's end to the fundus' end, two stations or more; the ends are "
                    "rounded off"))}),
      keys_of<SweptStation>(
          "station", "A place on a swept organ's axis.",
          {required(place("at", &SweptStation::at, abdomen_reach, "a place in the abdomen", "the place")),
           number("radius", &SweptStation::radius, quantity::length, 1 * mm, 60 * mm,
                  "a hollow organ's radius", "of the organ about its axis there"),
           number("refine", &SweptStation::refine, quantity::number, 1, 8, "a refinement",
                  "control nodes are closer by this factor around it")}),
      keys_of<MeshFile>(
          "shape_obj", "A closed control mesh from a Wavefront OBJ file.",
          {type("obj"),
           required(text("path", "", "file below the scenario's folder or the project's assets folder")),
           number("scale", &MeshFile::scale, quantity::number, 1e-9, 1e3,
                  "a scale from a mesh file to metres", "the file's coordinates times this are metres"),
           bound(point("turn", quantity::angle, 2 * std::numbers::pi, "{ 0 * deg, 0 * deg, 0 * deg }",
                       "these are turned about this axis by its length first: { 0, 0, 90 * deg } about z"),
                 &MeshFile::turn),
           place("offset", &MeshFile::offset, abdomen_reach, "a place in the abdomen",
                 "and then moved by this"),
           choice("axes", &MeshFile::axes, {"organ", "scene"},
                  "along what these are: the organ's own axes, with its neck in the origin, +z towards its "
                  "fundus and +x "
                  "towards its liver side, or the scene's axes and origin"),
           flag("through_points", &MeshFile::through_points,
                "the wall passes through the file's points; without it they are control points, and the wall "
                "lies inside "
                "of them where it bulges")}),
      keys_of<TubeShape>(
          "shape_tube",
          "A duct or a vessel: a tube along a line; solid where its wall is as thick as its radius.",
          {type("tube"),
           required(
               list("points", "point", "its middle at rest, from its start to its end: two points or more")),
           number("radius", &TubeShape::radius, quantity::length, 0.3 * mm, 20 * mm, "a duct's radius",
                  "outer radius"),
           number("end_radius", &TubeShape::end_radius, quantity::length, 0, 20 * mm, "a duct's radius",
                  "outer radius at its end; 0: as at its start"),
           list("radii", "number",
                "instead of both: outer radii at each of its points, straight in between; other organs feel "
                "it "
                "everywhere as thick as where it is thickest"),
           count("nodes", &TubeShape::nodes, 5, 60, "a number of control nodes", "of its middle line"),
           number("pressure", &TubeShape::pressure, quantity::pressure, -10 * kPa, 40 * kPa,
                  "a pressure in a duct", "gauge pressure of what it carries"),
           choice("carries", &TubeShape::carries, {"bile", "blood"}, "a duct's bile, or an artery's blood"),
           number("feed_pressure", &TubeShape::feed_pressure, quantity::pressure, 0, 40 * kPa,
                  "a pressure that feeds a tube",
                  "gauge pressure with which the patient feeds it where it is cut open; usually 12 kPa of "
                  "blood, "
                  "1 kPa of bile; uncalibrated"),
           number("feed_resistance", &TubeShape::feed_resistance, quantity::number, 0, 1e15,
                  "a resistance of what feeds a tube",
                  "of the way to where it is cut open, Pa s/m^3; usually such that an open cystic artery "
                  "loses some 45 mL "
                  "a minute, a cystic duct 3 of what the patient feeds, and 18 of a gallbladder's; "
                  "uncalibrated"),
           choice(
               "patient_end", &TubeShape::patient_end, {"held", "start", "end"},
               "the end that stays with the patient where it is divided: what is held, itself or by what it "
               "is tied to (its end where both ends are, or neither), or always the start or the end")}),
      keys_of<RigidShape>(
          "shape_rigid",
          "A rigid thing, such as a stone: a box with round edges, a ball, a ring, or what an OBJ file "
          "holds.",
          {type("rigid"),
           place("size", &RigidShape::size, 200 * mm, "a size of a rigid thing",
                 "edges of the box without its rounding; { 0, 0, 0 }: a ball"),
           number("rounding", &RigidShape::rounding, quantity::length, 0.5 * mm, 50 * mm,
                  "a rigid thing's rounding",
                  "radius of its edges, of the ball, or of the rod that a ring is bent from"),
           number("ring", &RigidShape::ring, quantity::length, 0, 100 * mm, "a ring's radius",
                  "radius of the circle in the middle of a ring about z; 0: it is no ring"),
           text("path", "", "a closed OBJ file below the scenario's folder or the project's assets folder"),
           number("scale", &RigidShape::scale, quantity::number, 1e-9, 1e3,
                  "a scale from a mesh file to metres", "the file's coordinates times this are metres"),
           bound(point("turn", quantity::angle, 2 * std::numbers::pi, "{ 0 * deg, 0 * deg, 0 * deg }",
                       "it is turned about this axis by its length: { 90 * deg, 0, 0 } stands a ring up"),
                 &RigidShape::turn),
           place("centre", &RigidShape::centre, abdomen_reach, "a place in the abdomen",
                 "where its middle is then; of a file, its origin"),
           number("density", &RigidShape::density, quantity::density, 100, 20000, "a density", "kg/m^3"),
           number("stiffness", &RigidShape::stiffness, quantity::pressure, 10 * kPa, 1e10,
                  "a Young's modulus of a rigid thing",
                  "a stone's is some 0.8 GPa, a lymph node's below 100 kPa; it strains alike everywhere")}),
      keys_of<LobeShape>(
          "shape_lobe",
          "A lobe of the liver, held at its back. Give it the neck, fundus and liver_side of the gallbladder "
          "in "
          "its bed.",
          {type("lobe"),
           number("width", &LobeShape::width, quantity::length, 60 * mm, 300 * mm, "a lobe's width",
                  "across"),
           number("depth", &LobeShape::depth, quantity::length, 40 * mm, 200 * mm, "a lobe's depth",
                  "from its back to its edge"),
           number("thickness", &LobeShape::thickness, quantity::length, 15 * mm, 120 * mm,
                  "a lobe's thickness", "about, at its back"),
           number("edge", &LobeShape::edge, quantity::length, 4 * mm, 40 * mm, "a lobe's edge",
                  "thickness of its edge"),
           number("edge_angle", &LobeShape::edge_angle, quantity::angle, 10 * deg, 70 * deg,
                  "an angle of a lobe's edge", "between underside and upper side at its edge"),
           number("overhang", &LobeShape::overhang, quantity::length, -100 * mm, 100 * mm,
                  "a fundus' way beyond the edge", "by which the fundus stands out beyond its edge"),
           number("bed_length", &LobeShape::bed_length, quantity::length, 30 * mm, 250 * mm,
                  "a gallbladder's length", "of the gallbladder whose bed it has"),
           number("bed_width", &LobeShape::bed_width, quantity::length, 0, 120 * mm, "a gallbladder's width",
                  "of that gallbladder; 0: no bed"),
           number("bed_depth", &LobeShape::bed_depth, quantity::length, 0, 40 * mm, "a bed's depth",
                  "how deep the gallbladder lies in it"),
           number("young", &LobeShape::young, quantity::pressure, 0.5 * kPa, 1000 * kPa,
                  "a liver's Young's modulus", "Young's modulus; 2 to 20 kPa were measured"),
           number("poisson", &LobeShape::poisson, quantity::number, 0, 0.47, "a Poisson's ratio",
                  "Poisson's ratio; beyond 0.45 the elements begin to lock"),
           number("density", &LobeShape::density, quantity::density, 0, 2000, "a liver's density",
                  "kg/m^3; 1050 to 1060 is usual; 0: without weight and inertia"),
           number("capsule", &LobeShape::capsule, quantity::number, 0, 100e3, "a capsule's stiffness, in N/m",
                  "N/m of its capsule by stretch, once that is straight; 0: it has none"),
           number("capsule_slack", &LobeShape::capsule_slack, quantity::number, 1, 3, "a stretch",
                  "up to which its capsule is slack"),
           flag("sags", &LobeShape::sags,
                "true: its weight acts; false: as drawn it is in balance with its weight"),
           number("hold", &LobeShape::hold, quantity::foundation, 1, 1e10,
                  "a foundation's stiffness a unit area", "of its back, N/m per m^2")}),
  };
}

}  // namespace

const std::vector<KeyTable>& scene_key_tables() {
  static const std::vector<KeyTable> tables = [] {
    std::vector<KeyTable> all;
    for (auto* some : {&field_tables, &organ_tables, &shape_tables})
      for (KeyTable& table : (*some)()) {
        table.checked_by_validate = true;
        all.push_back(std::move(table));
      }
    return all;
  }();
  return tables;
}

}  // namespace calot
