// The keys of scene's tables. Defaults come from the definitions themselves; limits are those of validate().

#include <limits>

#include "anatomy/definitions.h"
#include "base/units.h"
#include "lua/api_parts.h"
#include "sim/instrument.h"

namespace calot {
namespace {

using units::deg;
using units::kPa;
using units::mL;
using units::mm;

constexpr double reach = 500 * mm;

ApiKey length(std::string name, double low, double high, double fallback, std::string doc) {
  return number(std::move(name), quantity::length, low, high, written(fallback, quantity::length),
                std::move(doc));
}

ApiKey place(std::string name, const std::string& fallback, std::string doc) {
  return point(std::move(name), quantity::length, reach, fallback, std::move(doc));
}

ApiTable make(std::string name, std::string doc, std::vector<ApiKey> keys) {
  ApiTable result{std::move(name), std::move(doc), std::move(keys), {}};
  result.validated_elsewhere = true;
  return result;
}

std::vector<ApiTable> shape_tables() {
  const PearShape pear;
  const SphereShape sphere;
  const auto type = [](const std::string& name) {
    return choice("type", {"pear", "sphere", "obj"}, "\"pear\"", "which shape: this one is \"" + name + "\"");
  };
  return {
      make("shape_pear", "A gallbladder: round fundus, tapering body, slim neck.",
           {type("pear"),
            length("length", 30 * mm, 250 * mm, pear.length, "neck to fundus; 70 to 100 mm is usual"),
            length("width", 10 * mm, 120 * mm, pear.width, "largest diameter; 30 to 40 mm is usual"),
            number("refine", quantity::number, 1, 8, written(pear.refine, quantity::number),
                   "control nodes are closer by this factor near the fundus"),
            length("refine_radius", 1 * mm, 250 * mm, pear.refine_radius,
                   "how far from the fundus they are")}),
      make("shape_sphere", "A ball, as in the paper's experiments.",
           {type("sphere"), length("radius", 5 * mm, 100 * mm, sphere.radius, "radius at rest")}),
      make("shape_obj", "A closed control mesh from a Wavefront OBJ file.",
           {type("obj"),
            required(text("path", "", "file below the scenario's folder or the project's assets folder")),
            number("scale", quantity::number, 1e-9, 1e3, "1",
                   "the file's coordinates times this are metres")}),
  };
}

std::vector<ApiTable> organ_tables() {
  const OrganDefinition organ;
  const WallDefinition wall;
  const FibreDefinition fibres;
  const BileDefinition bile;
  const HeldRegion held;
  return {
      make(
          "organ", "A hollow organ. In calot.anatomy's overrides, only what differs.",
          {text("name", "\"gallbladder\"", "its name, unique; landmarks are written \"gallbladder.fundus\""),
           table("shape", "shape", "its shape at rest: type \"pear\", \"sphere\" or \"obj\" with their keys"),
           number("nodes", quantity::number, 12, 4000, std::to_string(organ.nodes),
                  "control nodes; more resolve finer folds and cost more"),
           place("neck", "{ -50 * mm, 130 * mm, -110 * mm }", "where the shape's lower pole lies"),
           place("fundus", "{ -80 * mm, 100 * mm, -60 * mm }", "where its upper pole points to"),
           point("liver_side", quantity::number, std::numeric_limits<double>::infinity(), "{ 0, 0.8, 0.6 }",
                 "direction from the organ's axis to its bed on the liver"),
           table("wall", "wall", "its wall"), table("bile", "bile", "what fills it"),
           list("held", "held", "elastic attachments; a list given here replaces the anatomy's own"),
           flag("extensions", "true", "false: no structural extensions on this organ"),
           text("compared_with", "",
                "another organ of the same shape; the metrics mean_difference_pct and "
                "largest_difference_pct then say how far this one's skin is from moving like that one's")}),
      make("wall", "The organ's wall.",
           {length("thickness", 0.1 * mm, 10 * mm, wall.thickness, "2 to 3 mm is usual"),
            number("shear_modulus", quantity::pressure, 1 * kPa, 100e3 * kPa,
                   written(wall.shear_modulus, quantity::pressure),
                   "shear modulus mu of the isotropic wall at rest"),
            number("stiffening", quantity::number, 0, 100, written(wall.stiffening, quantity::number),
                   "b of the exponential Fung (Demiray) law; 0: neo-Hookean"),
            table("fibres", "fibres",
                  "makes the wall anisotropic; {}: as measured in human gallbladders, whose shear_modulus is "
                  "85 * kPa"),
            number("overstretch", quantity::number, 1.01, 10, written(wall.overstretch, quantity::number),
                   "principal stretch above which the event overstretch is raised")}),
      make("fibres",
           "Two families of fibres (Holzapfel, Gasser, Ogden) on either side of the axis; they bear tension "
           "only.",
           {number("stiffness", quantity::pressure, 0, 100e3 * kPa,
                   written(fibres.stiffness, quantity::pressure),
                   "k1 of each family; each adds 4 k1 to Young's modulus along itself"),
            number("stiffening", quantity::number, 0, 1000, written(fibres.stiffening, quantity::number),
                   "exponent k2; 0: they do not stiffen"),
            number("angle", quantity::angle, 0, 90 * deg, written(fibres.angle, quantity::angle),
                   "from the axis, neck to fundus: 0 longitudinal, 90 * deg circumferential")}),
      make("bile",
           "The filling. Give the volume or the pressure, the other follows; neither: the unstressed volume.",
           {number("density", quantity::density, 500, 2000, written(bile.density, quantity::density),
                   "kg/m^3; 1010 to 1040 is usual"),
            number("fill_volume", quantity::volume, 0.5 * mL, 1000 * mL, "", "volume of the filling"),
            number("fill_pressure", quantity::pressure, 0, 40 * kPa, "",
                   "gauge pressure at the highest point; 10 to 15 mmHg is usual")}),
      make("held", "An elastic foundation under the skin near a landmark: the cystic plate, the duct's root.",
           {text("name", "\"bed\"", "its name, unique within the organ"),
            required(choice("landmark", organ_landmarks(), "", "the landmark it surrounds")),
            length("radius", 0.5 * mm, 250 * mm, held.radius, "how far it reaches"),
            number("stiffness", quantity::foundation, 1, 1e10, written(held.stiffness, quantity::foundation),
                   "N/m per m^2 of skin")}),
  };
}

std::vector<ApiTable> field_tables() {
  const AnatomyDefinition anatomy;
  const LaparoscopeDefinition scope;
  const SolverDefinition solver;
  const InstrumentDefinition instrument;
  const auto tilt = [](std::string name, double fallback, std::string doc) {
    return number(std::move(name), quantity::angle, -60 * deg, 60 * deg, written(fallback, quantity::angle),
                  std::move(doc));
  };
  return {
      make(
          "scene", "What scene = function(p) returns: the operating field at rest.",
          {required(table("anatomy", "anatomy", "organs and table: calot.anatomy(...) or a table")),
           map("ports", "point", "trocars by name, added to the usual ones or moved: { name = { x, y, z } }"),
           map("instruments", "instrument", "instruments by name: { left = { ... } }; they are t.left, ..."),
           table("laparoscope", "laparoscope", "the camera"),
           table("solver", "solver", "steps and tolerance")}),
      make("anatomy", "The organs and how the table is tilted.",
           {choice("base", anatomy_names(), "", "named anatomy to start from; calot.anatomy(name) sets it"),
            list("organs", "organ",
                 "the organs; with a base, the first overrides the base's first, and so on"),
            table("support", "support", "a plane that carries the organs"),
            tilt("table_head_up", anatomy.table_head_up, "reverse Trendelenburg tilt"),
            tilt("table_left_down", anatomy.table_left_down, "tilt to the patient's left")}),
      make(
          "support", "A plane; what is below it is solid.",
          {place("point", "{ 0, 0, 0 }", "a point on it"),
           point("normal", quantity::number, 1, "{ 0, 0, 1 }", "its unit normal, pointing out of the solid"),
           number("friction", quantity::number, 0, 1, written(SupportDefinition{}.friction, quantity::number),
                  "coefficient of friction of the skin on it; 0 to 0.3 for wet tissue")}),
      make(
          "instrument", "An instrument through a port.",
          {choice("type", instrument_type_names(), "\"atraumatic_grasper\"",
                  "which instrument; a bipolar_electrode (with channel) has no jaws and only pushes, the "
                  "semm_forceps have short broad flat ones"),
           required(text("port", "", "the port it goes through")),
           number("force_limit", quantity::force, 0.05, 100, written(instrument.force_limit, quantity::force),
                  "tip force above which the event overforce is raised"),
           number("pinch_force", quantity::force, 0.05, 100, written(instrument.pinch_force, quantity::force),
                  "force of each jaw on the fold it holds; a pull above 2 * pad_friction * pinch_force "
                  "slips; jaws only"),
           number(
               "pad_friction", quantity::number, 0.01, 5, written(instrument.pad_friction, quantity::number),
               "coefficient of friction of a pad; " +
                   written(default_instrument(InstrumentType::semm_forceps).pad_friction, quantity::number) +
                   " for semm_forceps; jaws only"),
           number("friction", quantity::number, 0, 1, written(instrument.friction, quantity::number),
                  "coefficient of friction of the skin that the shaft and what it ends in press on; 0 to 0.3 "
                  "for a smooth shaft on wet skin")}),
      make("laparoscope", "The camera and its light.",
           {text("port", "\"" + scope.port + "\"", "the port it goes through"),
            number("angle", quantity::angle, 0, 70 * deg, written(scope.angle, quantity::angle),
                   "of its optic: 0 or 30 deg are usual"),
            text("look_at", "\"" + scope.look_at + "\"", "landmark in the middle of the picture"),
            length("distance", 10 * mm, 400 * mm, scope.distance, "from its tip to what it looks at"),
            number("field_of_view", quantity::angle, 20 * deg, 120 * deg,
                   written(scope.field_of_view, quantity::angle), "across the round picture"),
            flag("show_structure", "false",
                 "draw elements and nodes on the organs, to look into the simulation")}),
      make("solver", "How the simulation steps.",
           {number("rate", quantity::rate, 1, 2000, written(solver.rate, quantity::rate), "steps a second"),
            number("tolerance", quantity::number, 1e-12, 1e-2, written(solver.tolerance, quantity::number),
                   "dimensionless residual of equilibrium"),
            table("extensions", "extensions", "structural extensions at contacts")}),
  };
}

}  // namespace

std::vector<ApiTable> scene_tables() {
  std::vector<ApiTable> all = field_tables();
  for (auto* more : {&organ_tables, &shape_tables})
    for (ApiTable& table : (*more)()) all.push_back(std::move(table));
  all.push_back(
      {"extensions",
       "Structural extensions: finer basis functions around each place that an instrument touches.",
       {number("levels", quantity::number, 0, most_extension_levels, "0",
               "subdivision levels added at a contact, each with 12 nodes; 0: none"),
        length("view", 0, 400 * mm, 0,
               "where the laparoscope looks at an organ from nearer than this it is refined too; 0: not"),
        choice("scheme", {"condensed", "staged"}, "\"condensed\"",
               "solved together with the organ, or after it as its boundary allows (the 1997 scheme, "
               "to compare with)")},
       {}});
  return all;
}

}  // namespace calot
