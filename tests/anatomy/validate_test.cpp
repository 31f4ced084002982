#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

#include "anatomy/definitions.h"
#include "anatomy/scene_for_tests.h"
#include "base/units.h"

namespace calot {
namespace {

OrganDefinition duct(std::vector<Vec3> points) {
  OrganDefinition organ;
  organ.name = "duct";
  organ.shape = TubeShape{.points = std::move(points)};
  organ.wall.thickness = 1e-3;
  return organ;
}

/// A duct that joins the scene.
OrganDefinition& with_duct(SceneDefinition& scene) {
  return scene.anatomy.organs.emplace_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
}

/// A leaf over a duct and another one.
LeafDefinition& leaf_in(SceneDefinition& scene) {
  with_duct(scene);
  with_duct(scene).name = "other";
  return scene.anatomy.leaves.emplace_back(LeafDefinition{.from = "duct", .to = "other"});
}

/// Another one between the gallbladder and a duct.
TissueDefinition& tissue_in(SceneDefinition& scene) {
  if (scene.anatomy.organs.size() < 2) with_duct(scene);
  TissueDefinition& tissue = scene.anatomy.tissue.emplace_back();
  tissue.from = "gallbladder";
  tissue.to = "duct";
  return tissue;
}

using test::sound_scene;
using testing::HasSubstr;
using units::deg;
using units::mm;

using Change = std::function<void(SceneDefinition&)>;

std::vector<Problem> problems_after(const Change& change) {
  SceneDefinition scene = sound_scene();
  change(scene);
  return validate(scene);
}

OrganDefinition& organ(SceneDefinition& scene) { return scene.anatomy.organs[0]; }
PearShape& pear(SceneDefinition& scene) { return std::get<PearShape>(organ(scene).shape); }
FibreDefinition& fibres(SceneDefinition& scene) {
  std::optional<FibreDefinition>& fibres = organ(scene).wall.fibres;
  return fibres ? *fibres : fibres.emplace();
}
HeldRegion& held(SceneDefinition& scene) { return organ(scene).held[1]; }

/// One thing made wrong, and what must be said about it: exactly one problem, at this path.
struct Refusal {
  const char* name;
  Change change;
  std::string path, message, hint;
};

void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

const std::string organ_path = "scene.anatomy.organs[1]";

const std::vector<Refusal>& refusals() {
  static const std::vector<Refusal> list = {
      {"PearLength", [](auto& s) { pear(s).length = 70; }, organ_path + ".shape.length",
       "70 m is not a gallbladder's length", "did you mean 70 * mm?"},
      {"PearLengthInCm", [](auto& s) { pear(s).length = 8; }, organ_path + ".shape.length", "8 m is not",
       "did you mean 8 * cm? give 30 to 250 mm"},
      {"PearWidth", [](auto& s) { pear(s).width = 35; }, organ_path + ".shape.width", "35 m", "35 * mm"},
      {"PearWiderThanLong", [](auto& s) { pear(s).width = 90 * mm; }, organ_path + ".shape.width",
       "wider than long", "sphere"},
      {"PearRefine", [](auto& s) { pear(s).refine = 0.5; }, organ_path + ".shape.refine", "0.5 is not",
       "give 1 to"},
      {"PearRefineRadius", [](auto& s) { pear(s).refine_radius = 20; }, organ_path + ".shape.refine_radius",
       "20 m", "20 * mm"},
      {"VesselOnADuct",
       [](auto& s) {
         with_duct(s).vessels = {{{Vec3::Zero(), Vec3(1 * mm, 0, 0)}}};
       },
       "scene.anatomy.organs[2].vessels", "a tube has no wall to draw vessels on", "leave vessels out"},
      {"VesselOfOnePoint", [](auto& s) { organ(s).vessels = {{{Vec3::Zero()}}}; },
       organ_path + ".vessels[1].points", "a vessel along 1 points", "beginning and its end"},
      {"VesselTooWide",
       [](auto& s) {
         organ(s).vessels = {{{Vec3::Zero(), Vec3(1 * mm, 0, 0)}, 1}};
       },
       organ_path + ".vessels[1].radius", "1 m is not a small vessel's radius", "1 * mm"},
      {"RadiiAndPoints",
       [](auto& s) {
         std::get<TubeShape>(with_duct(s).shape).radii = {2 * mm, 2 * mm, 2 * mm};
       },
       "scene.anatomy.organs[2].shape.radii", "3 radii of a tube along 2 points", "one at each"},
      {"RadiiTooWide",
       [](auto& s) {
         std::get<TubeShape>(with_duct(s).shape).radii = {2 * mm, 2};
       },
       "scene.anatomy.organs[2].shape.radii[2]", "2 m is not a duct's radius", "2 * mm"},
      {"RadiiTooSteep",
       [](auto& s) {
         auto& tube = std::get<TubeShape>(with_duct(s).shape);
         tube.points = {Vec3::Zero(), Vec3(4 * mm, 0, 0), Vec3(30 * mm, 0, 0)};
         tube.radii = {2 * mm, 5 * mm, 5 * mm};
       },
       "scene.anatomy.organs[2].shape.radii[2]", "from 2 to 5 mm of radius over 4 mm", "half of the way"},
      {"RadiiAndEndRadius",
       [](auto& s) {
         auto& tube = std::get<TubeShape>(with_duct(s).shape);
         tube.radii = {2 * mm, 2 * mm};
         tube.end_radius = 2 * mm;
       },
       "scene.anatomy.organs[2].shape.end_radius", "both given", "leave one out"},
      {"InjuryNearStart",
       [](auto& s) {
         with_duct(s).injury.near_start = {{20 * mm, ""}};
       },
       "scene.anatomy.organs[2].injury.near_start[1].called", "the injury has no name", "an instructor"},
      {"InjuryNearNothing",
       [](auto& s) {
         with_duct(s).injury.near_start = {{0, "E2"}};
       },
       "scene.anatomy.organs[2].injury.near_start[1].within", "0 m", "0.1 to 200 mm"},
      {"InjuryNearNoStart",
       [](auto& s) {
         organ(s).injury.near_start = {{20 * mm, "E2"}};
       },
       organ_path + ".injury.near_start", "a pear has no start", "leave near_start out"},
      {"InjuryTogether",
       [](auto& s) {
         organ(s).injury.together = {{"duct", "E5"}};
       },
       organ_path + ".injury.together[1].with", "duct", ""},
      {"InjuryTogetherUnnamed",
       [](auto& s) {
         with_duct(s).injury.together = {{"gallbladder", ""}};
       },
       "scene.anatomy.organs[2].injury.together[1].called", "the injury has no name", "an instructor"},
      {"SphereRadius", [](auto& s) { organ(s).shape = SphereShape{20}; }, organ_path + ".shape.radius",
       "20 m", "20 * mm"},
      {"MeshPath", [](auto& s) { organ(s).shape = MeshFile{}; }, organ_path + ".shape.path", "no mesh file",
       "OBJ"},
      {"MeshScale",
       [](auto& s) {
         organ(s).shape = MeshFile{"a.obj", 0};
       },
       organ_path + ".shape.scale", "0 is not", "give"},
      {"TooFewNodes", [](auto& s) { organ(s).nodes = 11; }, organ_path + ".nodes", "11 is not",
       "give 12 to 1000"},
      {"TooManyNodes", [](auto& s) { organ(s).nodes = 1001; }, organ_path + ".nodes", "1001 is not",
       "12 to 1000"},
      {"ComparedWithItself", [](auto& s) { organ(s).compared_with = "gallbladder"; },
       organ_path + ".compared_with", "gallbladder", ""},
      {"ComparedWithAnotherShape",
       [](auto& s) {
         s.anatomy.organs.push_back(organ(s));
         s.anatomy.organs[1].name = "other";
         s.anatomy.organs[1].shape = SphereShape{};
         organ(s).compared_with = "other";
       },
       organ_path + ".compared_with", "another shape", "same shape"},
      {"ComparedWithAnotherPosture",
       [](auto& s) {
         s.anatomy.organs.push_back(organ(s));
         s.anatomy.organs[1].name = "other";
         s.anatomy.organs[1].neck.x() += 1 * mm;
         organ(s).compared_with = "other";
       },
       organ_path + ".compared_with", "posture", "neck to fundus"},
      {"Thickness", [](auto& s) { organ(s).wall.thickness = 2; }, organ_path + ".wall.thickness",
       "2 m is not a wall's thickness", "did you mean 2 * mm?"},
      {"NoThinShell",
       [](auto& s) {
         organ(s).shape = SphereShape{8 * mm};
         organ(s).wall.thickness = 5 * mm;
       },
       organ_path + ".wall.thickness", "5 mm is no thin shell", "at most 4 mm"},
      {"ShearModulus", [](auto& s) { organ(s).wall.shear_modulus = 100; }, organ_path + ".wall.shear_modulus",
       "100 Pa", "100 * kPa"},
      {"Stiffening", [](auto& s) { organ(s).wall.stiffening = -1; }, organ_path + ".wall.stiffening",
       "-1 is not an exponent", "give 0 to 100"},
      {"FibreStiffness", [](auto& s) { fibres(s).stiffness = -5e3; }, organ_path + ".wall.fibres.stiffness",
       "-5000 Pa", "give 0 to"},
      {"FibreStiffening", [](auto& s) { fibres(s).stiffening = 1001; },
       organ_path + ".wall.fibres.stiffening", "1001 is not an exponent", "give 0 to 1000"},
      {"FibreAngle", [](auto& s) { fibres(s).angle = 45; }, organ_path + ".wall.fibres.angle", "45 rad",
       "did you mean 45 * deg? give 0 to 90 deg"},
      {"Overstretch", [](auto& s) { organ(s).wall.overstretch = 0.6; }, organ_path + ".wall.overstretch",
       "0.6", "1.01"},
      {"BileDensity", [](auto& s) { organ(s).bile.density = 1.02; }, organ_path + ".bile.density",
       "1.02 kg/m^3", "500 to 2000 kg/m^3"},
      {"FillVolume",
       [](auto& s) {
         organ(s).bile = {};
         organ(s).bile.fill_volume = 40;
       },
       organ_path + ".bile.fill_volume", "40 m^3", "40 * mL"},
      {"FillPressure", [](auto& s) { organ(s).bile.fill_pressure = -5; }, organ_path + ".bile.fill_pressure",
       "-5 Pa", "give 0 to 40 kPa"},
      {"FilledTwice", [](auto& s) { organ(s).bile.fill_volume = 40e-6; }, organ_path + ".bile.fill_pressure",
       "both given", "give one"},
      {"Neck",
       [](auto& s) {
         organ(s).neck = {-50, 130, -110};
       },
       organ_path + ".neck", "(-50, 130, -110) m", "(-50, 130, -110) * mm"},
      {"Fundus",
       [](auto& s) {
         organ(s).fundus = {0, 0, -2};
       },
       organ_path + ".fundus", "(0, 0, -2) m", "500 mm"},
      {"NoAxis", [](auto& s) { organ(s).fundus = organ(s).neck; }, organ_path + ".fundus", "no axis",
       "apart"},
      {"NoLiverSide", [](auto& s) { organ(s).liver_side = Vec3::Zero(); }, organ_path + ".liver_side", "zero",
       "direction"},
      {"LiverSideAlongAxis", [](auto& s) { organ(s).liver_side = organ(s).fundus - organ(s).neck; },
       organ_path + ".liver_side", "along the organ's axis", "across"},
      {"HeldName", [](auto& s) { held(s).name = ""; }, organ_path + ".held[2].name", "no name", "letters"},
      {"HeldTwice", [](auto& s) { held(s).name = "bed"; }, organ_path + ".held[2].name",
       "\"bed\" is given twice", "rename"},
      {"HeldLandmark", [](auto& s) { held(s).landmark = "neckk"; }, organ_path + ".held[2].landmark",
       "unknown landmark \"neckk\"", "did you mean \"neck\"?"},
      {"HeldRadius", [](auto& s) { held(s).radius = 8; }, organ_path + ".held[2].radius", "8 m", "8 * mm"},
      {"HeldStiffness", [](auto& s) { held(s).stiffness = 0; }, organ_path + ".held[2].stiffness", "0 N/m^3",
       "give"},
      {"NoOrgan", [](auto& s) { s.anatomy.organs.clear(); }, "scene.anatomy.organs", "no organ",
       "calot.anatomy"},
      {"OrganName",
       [](auto& s) {
         organ(s).name = "gall.bladder";
         s.laparoscope.look_at = "gall.bladder.neck";
       },
       organ_path + ".name", "\"gall.bladder\"", "letters"},
      {"OrganTwice", [](auto& s) { s.anatomy.organs.push_back(organ(s)); }, "scene.anatomy.organs[2].name",
       "\"gallbladder\" is given twice", "rename"},
      {"SupportPoint",
       [](auto& s) {
         s.anatomy.support->point = {0, 0, -130};
       },
       "scene.anatomy.support.point", "(0, 0, -130) m", "* mm"},
      {"SupportNormal",
       [](auto& s) {
         s.anatomy.support->normal = {0, 0, 2};
       },
       "scene.anatomy.support.normal", "length must be 1", "give (0, 0, 1)"},
      {"SupportNormalZero", [](auto& s) { s.anatomy.support->normal = Vec3::Zero(); },
       "scene.anatomy.support.normal", "length must be 1", "such as"},
      {"HeadUp", [](auto& s) { s.anatomy.table_head_up = 15; }, "scene.anatomy.table_head_up", "15 rad",
       "15 * deg"},
      {"LeftDown", [](auto& s) { s.anatomy.table_left_down = 10; }, "scene.anatomy.table_left_down", "10 rad",
       "10 * deg"},
      {"PortName",
       [](auto& s) {
         s.ports = default_ports();
         s.ports[3].name = "";
       },
       "scene.ports[4].name", "no name", "letters"},
      {"PortTwice",
       [](auto& s) {
         s.ports = default_ports();
         s.ports[3].name = "umbilical";
       },
       "scene.ports[4].name", "\"umbilical\" is given twice", "rename"},
      {"PortPosition",
       [](auto& s) {
         s.ports = default_ports();
         s.ports[3].position = {-140, 10, -25};
       },
       "scene.ports.right_lateral", "(-140, 10, -25) m", "(-140, 10, -25) * mm"},
      {"InstrumentName", [](auto& s) { s.instruments[1].name = "2nd"; }, "scene.instruments[2].name",
       "\"2nd\"", "digit"},
      {"InstrumentTwice", [](auto& s) { s.instruments[1].name = "left"; }, "scene.instruments[2].name",
       "\"left\" is given twice", "rename"},
      {"InstrumentCalledAsTheLaparoscope", [](auto& s) { s.instruments[1].name = "laparoscope"; },
       "scene.instruments.laparoscope", "the laparoscope is called that already", "another name"},
      {"InstrumentPort", [](auto& s) { s.instruments[0].port = "right_subcostl"; },
       "scene.instruments.left.port", "unknown port \"right_subcostl\"", "did you mean \"right_subcostal\"?"},
      {"InstrumentPortOfNoOtherList",
       [](auto& s) {
         s.ports = {{"umbilical", Vec3::Zero()}, {"epigastric", {0, 0.1, 0}}};
       },
       "scene.instruments.left.port", "unknown port \"right_subcostal\"", "known: umbilical, epigastric"},
      {"PortUsedByTwoInstruments", [](auto& s) { s.instruments[1].port = "right_subcostal"; },
       "scene.instruments.right.port", "already used by instrument \"left\"", "free: epigastric"},
      {"InstrumentThatWaitsForNobody", [](auto& s) { s.instruments[1].waits = true; },
       "scene.instruments.right.waits", "in which no instrument is", "let one of that port's"},
      {"InstrumentThatWaitsForTheScope",
       [](auto& s) {
         s.instruments[1].port = "umbilical";
         s.instruments[1].waits = true;
       },
       "scene.instruments.right.port", "the laparoscope stays in its port", "free: epigastric"},
      {"PortUsedByTheScope", [](auto& s) { s.instruments[1].port = "umbilical"; },
       "scene.instruments.right.port", "already used by the laparoscope", "free:"},
      {"TubeOfOnePoint", [](auto& s) { s.anatomy.organs.push_back(duct({Vec3::Zero()})); },
       "scene.anatomy.organs[2].shape.points", "along 1 points", "its start and its end"},
      {"TubeThickerThanLong",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(3e-3, 0, 0)}));
       },
       "scene.anatomy.organs[2].shape.points", "shorter than it is thick", "longer or thinner"},
      {"TubeFarAway",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30, 0, 0)}));
       },
       "scene.anatomy.organs[2].shape.points[2]", "(30, 0, 0) m", "* mm"},
      {"TubeThatIsFilled",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
         s.anatomy.organs[1].bile.fill_volume = 1e-6;
       },
       "scene.anatomy.organs[2].bile", "keeps no filling", "a tube has a pressure"},
      {"TubeHeldAtANeck",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
         s.anatomy.organs[1].held = {{"root", "neck", 5e-3, 1e5}};
       },
       "scene.anatomy.organs[2].held[1].landmark", "unknown landmark \"neck\"", "start, middle, end"},
      {"StoneThatIsHeld",
       [](auto& s) {
         OrganDefinition stone = duct({});
         stone.shape = RigidShape{};
         stone.held = {{"root", "centre", 5e-3, 1e5}};
         s.anatomy.organs.push_back(stone);
       },
       "scene.anatomy.organs[2].held", "a rigid thing is not held", "support it"},
      {"JointToNowhere",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
         s.anatomy.joints = {{.from = "duct.start", .to = "gallbladder.nek"}};
       },
       "scene.anatomy.joints[1].to", "\"gallbladder.nek\"", "gallbladder.neck"},
      {"JointToItself",
       [](auto& s) { s.anatomy.joints = {{.from = "gallbladder.neck", .to = "gallbladder.fundus"}}; },
       "scene.anatomy.joints[1].to", "tied to itself", "another organ"},
      {"FilledHoldOfATube",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
         s.anatomy.organs[1].held = {{"root", "start", 5e-3, 1e5, true}};
       },
       "scene.anatomy.organs[2].held[1].while_filled", "a tube is not filled", "leave it out"},
      {"TissueToNowhere", [](auto& s) { tissue_in(s).to = "dcut"; }, "scene.anatomy.tissue[1].to",
       "unknown organ \"dcut\"", "duct"},
      {"TissueToItself", [](auto& s) { tissue_in(s).to = "gallbladder"; }, "scene.anatomy.tissue[1].to",
       "an organ and itself", "another organ"},
      {"TissueCalledAsAnOrgan", [](auto& s) { tissue_in(s).name = "duct"; }, "scene.anatomy.tissue[1].name",
       "an organ is called", "another name"},
      {"TissueTwice", [](auto& s) { tissue_in(s), tissue_in(s); }, "scene.anatomy.tissue[2].name",
       "\"tissue\" is given twice", "rename"},
      {"TissueOfNegativeStrength", [](auto& s) { tissue_in(s).strength = -30e3; },
       "scene.anatomy.tissue[1].strength", "not a tissue's strength", "kPa"},
      {"TissueThatEndsBeforeItBegins",
       [](auto& s) { tissue_in(s).start = 0.8, s.anatomy.tissue[0].stop = 0.2; },
       "scene.anatomy.tissue[1].stop", "before it begins", "more than its start"},
      {"LeafOverWhatIsNoTube", [](auto& s) { leaf_in(s).from = "gallbladder"; },
       "scene.anatomy.leaves[1].from", "unknown tube \"gallbladder\"", "duct"},
      {"LeafOverOneTube", [](auto& s) { leaf_in(s).to = "duct"; }, "scene.anatomy.leaves[1].to",
       "a tube and itself", "another tube"},
      {"LeafThatEndsBeforeItBegins", [](auto& s) { leaf_in(s).stop = 0; }, "scene.anatomy.leaves[1].stop",
       "before it begins", "more than its start"},
      {"LeafOfNegativeWidth", [](auto& s) { leaf_in(s).goes_on = -1e-3; }, "scene.anatomy.leaves[1].goes_on",
       "not a width", "mm"},
      {"TissuesOfTooManyStrands",
       [](auto& s) {
         tissue_in(s).strands = 1000;
         tissue_in(s).strands = 1000;
         s.anatomy.tissue[1].name = "more";
       },
       "scene.anatomy.tissue", "2000 strands", "at most"},
      {"GroundTwice", [](auto& s) { s.anatomy.ground.resize(2); }, "scene.anatomy.ground[2].name",
       "\"ground\" is given twice", "rename"},
      {"GroundLooks", [](auto& s) { s.anatomy.ground = {{.looks = GroundLooks::bowel}}; },
       "scene.anatomy.ground[1].looks", "only a capsule looks like bowel", "capsule"},
      {"OrganLooks",
       [](auto& s) {
         s.anatomy.organs.push_back(duct({Vec3::Zero(), Vec3(30e-3, 0, 0)}));
         s.anatomy.organs[1].looks = OrganLooks::pale;
       },
       "scene.anatomy.organs[2].looks", "is not filled with mucus", "leave looks out"},
      {"Light", [](auto& s) { s.laparoscope.light = 11; }, "scene.laparoscope.light", "a light's brightness",
       "10"},
      {"GroundNormal", [](auto& s) { s.anatomy.ground = {{.normal = Vec3(0, 0, 2)}}; },
       "scene.anatomy.ground[1].normal", "length must be 1", "give (0, 0, 1)"},
      {"SupportFriction", [](auto& s) { s.anatomy.support->friction = -0.1; },
       "scene.anatomy.support.friction", "coefficient of friction", "give 0 to 1"},
      {"Friction", [](auto& s) { s.instruments[0].friction = 1.5; }, "scene.instruments.left.friction",
       "coefficient of friction", "give 0 to 1"},
      {"ForceLimit", [](auto& s) { s.instruments[0].force_limit = 0; }, "scene.instruments.left.force_limit",
       "0 N", "give 0.05 to 100 N"},
      {"ScopePort", [](auto& s) { s.laparoscope.port = "umbilicus"; }, "scene.laparoscope.port",
       "unknown port \"umbilicus\"", "did you mean \"umbilical\"?"},
      {"ScopeAngle", [](auto& s) { s.laparoscope.angle = 30; }, "scene.laparoscope.angle", "30 rad",
       "30 * deg"},
      {"ScopeField", [](auto& s) { s.laparoscope.field_of_view = 10 * deg; },
       "scene.laparoscope.field_of_view", "rad", "20 to 120 deg"},
      {"ScopeDistance", [](auto& s) { s.laparoscope.distance = 90; }, "scene.laparoscope.distance", "90 m",
       "90 * mm"},
      {"ScopeLooksAtNoLandmark", [](auto& s) { s.laparoscope.look_at = "gallbladder.fundsu"; },
       "scene.laparoscope.look_at", "\"gallbladder.fundsu\"", "did you mean \"gallbladder.fundus\"?"},
      {"ScopeLooksAtOrgan", [](auto& s) { s.laparoscope.look_at = "liver"; }, "scene.laparoscope.look_at",
       "\"liver\"", "known: gallbladder.neck"},
      {"StagedWithMasses",
       [](auto& s) {
         s.solver.motion = SolverMotion::dynamics;
         s.solver.extension_scheme = ExtensionScheme::staged;
       },
       "scene.solver.extensions.scheme", "knows no masses", "condensed"},
      {"RetardationTooLong", [](auto& s) { organ(s).wall.retardation = 5; }, organ_path + ".wall.retardation",
       "5 s", "0 to 1 s"},
      {"BurnReachBelowZero", [](auto& s) { organ(s).wall.burn_reach = -1e-4; },
       organ_path + ".wall.burn_reach", "-0.0001 m", "0 to 5 mm"},
      {"BurnReachInMillimetres", [](auto& s) { organ(s).wall.burn_reach = 0.3; },
       organ_path + ".wall.burn_reach", "0.3 m", "0 to 5 mm"},
      {"BurnReachIsNoNumber", [](auto& s) { organ(s).wall.burn_reach = std::nan(""); },
       organ_path + ".wall.burn_reach", "nan", ""},
      {"RawEnergyBySquareMillimetres", [](auto& s) { organ(s).wall.raw_energy = 2.5; },
       organ_path + ".wall.raw_energy", "2.5 is not", "10000 to 1e+09"},
      {"WallDensityInGrams", [](auto& s) { organ(s).wall.density = 1.05e6; }, organ_path + ".wall.density",
       "1.05e+06 kg/m^3", "0 to 2000"},
      {"RateTooHigh", [](auto& s) { s.solver.rate = 2001; }, "scene.solver.rate", "2001 steps a second",
       "1 to 2000"},
      {"RateZero", [](auto& s) { s.solver.rate = 0; }, "scene.solver.rate", "0 steps a second", "1 to 2000"},
      {"ToleranceTooLoose", [](auto& s) { s.solver.tolerance = 0.1; }, "scene.solver.tolerance", "0.1",
       "0.01"},
      {"ToleranceTooTight", [](auto& s) { s.solver.tolerance = 1e-13; }, "scene.solver.tolerance", "1e-13",
       "1e-12"},
  };
  return list;
}

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, SaysWhereWhatAndHow) {
  const std::vector<Problem> problems = problems_after(GetParam().change);
  ASSERT_EQ(problems.size(), 1u) << to_text(Failure{FailureKind::scenario, problems});
  EXPECT_EQ(problems[0].place.path, GetParam().path);
  EXPECT_THAT(problems[0].message, HasSubstr(GetParam().message));
  EXPECT_THAT(problems[0].hint, HasSubstr(GetParam().hint));
}

INSTANTIATE_TEST_SUITE_P(Validate, Refusals, testing::ValuesIn(refusals()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Validate, ASoundSceneHasNoProblem) {
  for (const Problem& problem : validate(sound_scene())) ADD_FAILURE() << to_text(problem);
}

TEST(Validate, SeveralOrgansAreWelcome) {
  SceneDefinition scene = sound_scene();
  scene.anatomy.organs.push_back(scene.anatomy.organs[0]);
  scene.anatomy.organs[1].name = "cyst";
  scene.anatomy.organs[1].shape = SphereShape{};
  scene.laparoscope.look_at = "cyst.fundus";
  for (const Problem& problem : validate(scene)) ADD_FAILURE() << to_text(problem);
}

TEST(Validate, AMeshFileBringsItsOwnNodes) {
  const std::vector<Problem> problems = problems_after([](auto& s) {
    organ(s).shape = MeshFile{"organ.obj", 1e-3};
    organ(s).nodes = 0;
  });
  EXPECT_TRUE(problems.empty());
}

TEST(Validate, AllThatIsWrongIsSaidAtOnce) {
  SceneDefinition scene = sound_scene();
  scene.solver.rate = 0;
  pear(scene).length = 70;
  organ(scene).wall.thickness = 2;
  held(scene).landmark = "nck";
  scene.instruments[0].port = "somewhere";
  scene.laparoscope.look_at = "gallbladder";
  std::vector<std::string> paths;
  for (const Problem& problem : validate(scene)) paths.push_back(problem.place.path);
  EXPECT_THAT(paths,
              testing::UnorderedElementsAre("scene.solver.rate", organ_path + ".shape.length",
                                            organ_path + ".wall.thickness", organ_path + ".held[2].landmark",
                                            "scene.instruments.left.port", "scene.laparoscope.look_at"));
}

TEST(Validate, EveryNumberMustBeFinite) {
  const std::vector<std::function<double&(SceneDefinition&)>> numbers = {
      [](auto& s) -> double& { return pear(s).length; },
      [](auto& s) -> double& { return pear(s).width; },
      [](auto& s) -> double& { return pear(s).refine; },
      [](auto& s) -> double& { return pear(s).refine_radius; },
      [](auto& s) -> double& { return std::get<SphereShape>(organ(s).shape = SphereShape{}).radius; },
      [](auto& s) -> double& {
        return std::get<MeshFile>(organ(s).shape = MeshFile{"a.obj", 1}).scale;
      },
      [](auto& s) -> double& { return organ(s).wall.thickness; },
      [](auto& s) -> double& { return organ(s).wall.shear_modulus; },
      [](auto& s) -> double& { return organ(s).wall.stiffening; },
      [](auto& s) -> double& { return fibres(s).stiffness; },
      [](auto& s) -> double& { return fibres(s).stiffening; },
      [](auto& s) -> double& { return fibres(s).angle; },
      [](auto& s) -> double& { return organ(s).wall.overstretch; },
      [](auto& s) -> double& { return organ(s).bile.density; },
      [](auto& s) -> double& { return *organ(s).bile.fill_pressure; },
      [](auto& s) -> double& {
        organ(s).bile.fill_pressure.reset();
        return organ(s).bile.fill_volume.emplace();
      },
      [](auto& s) -> double& { return organ(s).neck.x(); },
      [](auto& s) -> double& { return organ(s).fundus.z(); },
      [](auto& s) -> double& { return organ(s).liver_side.y(); },
      [](auto& s) -> double& { return held(s).radius; },
      [](auto& s) -> double& { return held(s).stiffness; },
      [](auto& s) -> double& { return s.anatomy.support->point.x(); },
      [](auto& s) -> double& { return s.anatomy.support->normal.z(); },
      [](auto& s) -> double& { return s.anatomy.table_head_up; },
      [](auto& s) -> double& { return s.anatomy.table_left_down; },
      [](auto& s) -> double& { return (s.ports = default_ports())[2].position.y(); },
      [](auto& s) -> double& { return s.instruments[1].force_limit; },
      [](auto& s) -> double& { return s.instruments[1].friction; },
      [](auto& s) -> double& { return s.anatomy.support->friction; },
      [](auto& s) -> double& { return s.laparoscope.angle; },
      [](auto& s) -> double& { return s.laparoscope.field_of_view; },
      [](auto& s) -> double& { return s.laparoscope.distance; },
      [](auto& s) -> double& { return s.solver.rate; },
      [](auto& s) -> double& { return s.solver.tolerance; },
  };
  using Limits = std::numeric_limits<double>;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (const double value : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
      const std::vector<Problem> problems = problems_after([&](auto& s) { numbers[i](s) = value; });
      EXPECT_EQ(problems.size(), 1u) << "number " << i << " = " << value;
    }
}

}  // namespace
}  // namespace calot
