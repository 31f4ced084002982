// What is wrong with a scene, all at once. The limits are those of sane anatomy and of what the solver can
// carry, wide enough for experiments: they catch forgotten units and slips, not unusual patients.

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "anatomy/definitions.h"
#include "anatomy/field_check.h"
#include "base/units.h"

namespace calot {
namespace {

using units::deg;
using units::kPa;
using units::mL;
using units::mm;

constexpr double reach = 500 * mm;  // of anything in an abdomen from the umbilicus

/// Names seen so far in one list; a second use is a problem at its own place.
class UniqueNames {
 public:
  UniqueNames(FieldCheck& check, std::string what) : check_(check), what_(std::move(what)) {}
  /// True when the name is fit and new: the entry can then be addressed by it.
  bool add(const std::string& path, const std::string& name) {
    if (!check_.identifier(path, name, what_)) return false;
    if (seen_.insert(name).second) return true;
    check_.problem(path, fmt::format("{} \"{}\" is given twice", what_, name),
                   "rename or remove one of them");
    return false;
  }

 private:
  FieldCheck& check_;
  std::string what_;
  std::set<std::string> seen_;
};

void check_pear(FieldCheck& check, const std::string& path, const PearShape& pear) {
  const bool length_good = check.in_range(path + ".length", pear.length, quantity::length, 30 * mm, 250 * mm,
                                          "a gallbladder's length");
  const bool width_good = check.in_range(path + ".width", pear.width, quantity::length, 10 * mm, 120 * mm,
                                         "a gallbladder's width");
  if (length_good && width_good && pear.width >= pear.length)
    check.problem(path + ".width",
                  fmt::format("a pear {:g} mm wide and {:g} mm long is wider than long", pear.width / mm,
                              pear.length / mm),
                  "make it narrower, or use a sphere");
  check.in_range(path + ".refine", pear.refine, quantity::number, 1, 8, "a refinement");
  check.in_range(path + ".refine_radius", pear.refine_radius, quantity::length, 1 * mm, 250 * mm,
                 "a radius of refinement");
}

void check_shape(FieldCheck& check, const std::string& path, const OrganShape& shape) {
  if (const auto* pear = std::get_if<PearShape>(&shape)) {
    check_pear(check, path, *pear);
  } else if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    check.in_range(path + ".radius", sphere->radius, quantity::length, 5 * mm, 100 * mm, "an organ's radius");
  } else {
    const auto& file = std::get<MeshFile>(shape);
    if (file.path.empty())
      check.problem(path + ".path", "no mesh file is named", "give the path of an OBJ file");
    check.in_range(path + ".scale", file.scale, quantity::number, 1e-9, 1e3,
                   "a scale from a mesh file to metres");
  }
}

/// The smallest radius a thin wall has to bend around; none for a mesh file, whose shape is not known here.
double radius_of(const OrganShape& shape) {
  if (const auto* pear = std::get_if<PearShape>(&shape)) return pear->width / 2;
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return sphere->radius;
  return std::numeric_limits<double>::infinity();
}

void check_fibres(FieldCheck& check, const std::string& path, const FibreDefinition& fibres) {
  check.in_range(path + ".stiffness", fibres.stiffness, quantity::pressure, 0, 100e3 * kPa,
                 "a stiffness of fibres");
  check.in_range(path + ".stiffening", fibres.stiffening, quantity::number, 0, 1000,
                 "an exponent of fibres' stiffening");
  check.in_range(path + ".angle", fibres.angle, quantity::angle, 0, 90 * deg,
                 "an angle of fibres from the organ's axis");
}

void check_wall(FieldCheck& check, const std::string& path, const WallDefinition& wall, double radius) {
  const bool good = check.in_range(path + ".thickness", wall.thickness, quantity::length, 0.1 * mm, 10 * mm,
                                   "a wall's thickness");
  if (good && radius >= 5 * mm && wall.thickness > radius / 2)
    check.problem(path + ".thickness",
                  fmt::format("a wall of {:g} mm is no thin shell on a radius of {:g} mm",
                              wall.thickness / mm, radius / mm),
                  fmt::format("give at most {:g} mm", radius / 2 / mm));
  check.in_range(path + ".shear_modulus", wall.shear_modulus, quantity::pressure, 1 * kPa, 100e3 * kPa,
                 "a soft tissue's shear modulus");
  check.in_range(path + ".stiffening", wall.stiffening, quantity::number, 0, 100,
                 "an exponent of a wall's stiffening");
  if (wall.fibres) check_fibres(check, path + ".fibres", *wall.fibres);
  check.in_range(path + ".overstretch", wall.overstretch, quantity::number, 1.01, 10, "a limit of stretch");
}

void check_bile(FieldCheck& check, const std::string& path, const BileDefinition& bile) {
  check.in_range(path + ".density", bile.density, quantity::density, 500, 2000, "bile's density");
  if (bile.fill_volume && bile.fill_pressure)
    check.problem(path + ".fill_pressure", "fill_volume and fill_pressure are both given",
                  "give one; the other follows and is reported");
  if (bile.fill_volume)
    check.in_range(path + ".fill_volume", *bile.fill_volume, quantity::volume, 0.5 * mL, 1000 * mL,
                   "a gallbladder's filling");
  if (bile.fill_pressure)
    check.in_range(path + ".fill_pressure", *bile.fill_pressure, quantity::pressure, 0, 40 * kPa,
                   "a pressure of bile");
}

void check_axis(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  const bool neck_good = check.place_within(path + ".neck", organ.neck, reach, "a place in the abdomen");
  const bool fundus_good =
      check.place_within(path + ".fundus", organ.fundus, reach, "a place in the abdomen");
  const Vec3 axis = organ.fundus - organ.neck, side = organ.liver_side;
  const bool axis_good = neck_good && fundus_good && axis.norm() >= 1 * mm;
  if (neck_good && fundus_good && !axis_good)
    check.problem(path + ".fundus", "neck and fundus are at one place, so the organ has no axis",
                  "move them at least 1 mm apart");
  if (!side.allFinite() || side.norm() < 1e-6) {
    check.problem(path + ".liver_side", "no direction to the liver: not finite, or zero",
                  "give a direction such as (0, 0.8, 0.6)");
  } else if (axis_good && side.cross(axis).norm() < 0.05 * side.norm() * axis.norm()) {
    check.problem(path + ".liver_side", "it points along the organ's axis, so no side is the liver's",
                  "give a direction across the line from neck to fundus");
  }
}

void check_organ(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  check_shape(check, path + ".shape", organ.shape);
  if (!std::holds_alternative<MeshFile>(organ.shape))
    check.in_range(path + ".nodes", organ.nodes, quantity::number, 12, 4000, "a number of control nodes");
  check_axis(check, path, organ);
  check_wall(check, path + ".wall", organ.wall, radius_of(organ.shape));
  check_bile(check, path + ".bile", organ.bile);
  UniqueNames names(check, "held region");
  for (std::size_t i = 0; i < organ.held.size(); ++i) {
    const HeldRegion& held = organ.held[i];
    const std::string at = fmt::format("{}.held[{}]", path, i + 1);
    names.add(at + ".name", held.name);
    check.known(at + ".landmark", held.landmark, organ_landmarks(), "landmark");
    check.in_range(at + ".radius", held.radius, quantity::length, 0.5 * mm, 250 * mm,
                   "a held region's radius");
    check.in_range(at + ".stiffness", held.stiffness, quantity::foundation, 1, 1e10,
                   "a foundation's stiffness a unit area");
  }
}

/// Two skins can be compared point by point where one is the other moved aside.
void check_compared(FieldCheck& check, const std::string& path, const OrganDefinition& organ,
                    const std::vector<OrganDefinition>& organs) {
  if (organ.compared_with.empty()) return;
  std::vector<std::string> others;
  for (const OrganDefinition& other : organs)
    if (&other != &organ) others.push_back(other.name);
  if (!check.known(path, organ.compared_with, others, "other organ")) return;
  constexpr double same = 1e-9;  // m: rounding
  for (const OrganDefinition& other : organs) {
    if (&other == &organ || other.name != organ.compared_with) continue;
    const Vec3 axis = organ.fundus - organ.neck, other_axis = other.fundus - other.neck;
    if (organ.shape == other.shape && (axis - other_axis).norm() < same &&
        (organ.liver_side - other.liver_side).norm() < same)
      return;
    check.problem(path, fmt::format("\"{}\" has another shape or posture", other.name),
                  "give both the same shape, liver_side and way from neck to fundus");
    return;
  }
}

void check_anatomy(FieldCheck& check, const AnatomyDefinition& anatomy) {
  const std::string path = "scene.anatomy";
  if (anatomy.organs.empty())
    check.problem(path + ".organs", "the anatomy has no organ",
                  "give one, or use calot.anatomy(\"standard\")");
  UniqueNames names(check, "organ");
  for (std::size_t i = 0; i < anatomy.organs.size(); ++i) {
    const std::string at = fmt::format("{}.organs[{}]", path, i + 1);
    names.add(at + ".name", anatomy.organs[i].name);
    check_organ(check, at, anatomy.organs[i]);
    check_compared(check, at + ".compared_with", anatomy.organs[i], anatomy.organs);
  }
  if (anatomy.support) {
    check.place_within(path + ".support.point", anatomy.support->point, reach, "a place in the abdomen");
    check.unit_direction(path + ".support.normal", anatomy.support->normal, "a unit normal");
    check.in_range(path + ".support.friction", anatomy.support->friction, quantity::number, 0, 1,
                   "a coefficient of friction of a support");
  }
  check.in_range(path + ".table_head_up", anatomy.table_head_up, quantity::angle, -60 * deg, 60 * deg,
                 "a tilt of an operating table");
  check.in_range(path + ".table_left_down", anatomy.table_left_down, quantity::angle, -60 * deg, 60 * deg,
                 "a tilt of an operating table");
}

/// Checks the ports given and returns the names that instruments may use.
std::vector<std::string> check_ports(FieldCheck& check, const std::vector<PortDefinition>& given) {
  UniqueNames unique(check, "port");
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::string at = fmt::format("scene.ports[{}]", i + 1);
    if (unique.add(at + ".name", given[i].name)) at = "scene.ports." + given[i].name;
    check.place_within(at, given[i].position, reach, "a place on the abdomen");
  }
  std::vector<std::string> names;
  for (const PortDefinition& port : given.empty() ? default_ports() : given) names.push_back(port.name);
  return names;
}

/// One shaft a port: who holds which.
class PortsInUse {
 public:
  PortsInUse(FieldCheck& check, std::vector<std::string> known) : check_(check), known_(std::move(known)) {}
  void take(const std::string& path, const std::string& port, const std::string& user) {
    if (!check_.known(path, port, known_, "port")) return;
    const auto [held, fresh] = users_.emplace(port, user);
    if (!fresh)
      check_.problem(path, fmt::format("port \"{}\" is already used by {}", port, held->second),
                     free_ports());
  }

 private:
  std::string free_ports() const {
    std::vector<std::string> names;
    for (const std::string& name : known_)
      if (!users_.contains(name)) names.push_back(name);
    return names.empty() ? "declare another port" : fmt::format("free: {}", fmt::join(names, ", "));
  }
  FieldCheck& check_;
  std::vector<std::string> known_;
  std::map<std::string, std::string> users_;
};

void check_instruments(FieldCheck& check, const std::vector<InstrumentDefinition>& instruments,
                       PortsInUse& ports) {
  UniqueNames names(check, "instrument");
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    const InstrumentDefinition& instrument = instruments[i];
    std::string at = fmt::format("scene.instruments[{}]", i + 1);
    if (names.add(at + ".name", instrument.name)) at = "scene.instruments." + instrument.name;
    ports.take(at + ".port", instrument.port, fmt::format("instrument \"{}\"", instrument.name));
    check.in_range(at + ".force_limit", instrument.force_limit, quantity::force, 0.05, 100,
                   "a limit of force on tissue");
    check.in_range(at + ".pinch_force", instrument.pinch_force, quantity::force, 0.05, 100,
                   "a force that a hand gives a jaw");
    check.in_range(at + ".pad_friction", instrument.pad_friction, quantity::number, 0.01, 5,
                   "a coefficient of friction");
    check.in_range(at + ".friction", instrument.friction, quantity::number, 0, 1,
                   "a coefficient of friction of a smooth tool");
  }
}

void check_look_at(FieldCheck& check, const std::string& look_at,
                   const std::vector<OrganDefinition>& organs) {
  if (organs.empty()) return;  // said already
  std::vector<std::string> targets;
  for (const OrganDefinition& organ : organs)
    for (const std::string& landmark : organ_landmarks()) targets.push_back(organ.name + "." + landmark);
  check.known("scene.laparoscope.look_at", look_at, targets, "place to look at");
}

void check_laparoscope(FieldCheck& check, const LaparoscopeDefinition& scope) {
  const std::string path = "scene.laparoscope";
  check.in_range(path + ".angle", scope.angle, quantity::angle, 0, 70 * deg,
                 "an angle of view of a laparoscope");
  check.in_range(path + ".field_of_view", scope.field_of_view, quantity::angle, 20 * deg, 120 * deg,
                 "a laparoscope's field of view");
  check.in_range(path + ".distance", scope.distance, quantity::length, 10 * mm, 400 * mm,
                 "a distance to look from");
}

}  // namespace

std::vector<Problem> validate(const SceneDefinition& scene) {
  FieldCheck check;
  check_anatomy(check, scene.anatomy);
  PortsInUse ports(check, check_ports(check, scene.ports));
  ports.take("scene.laparoscope.port", scene.laparoscope.port, "the laparoscope");
  check_instruments(check, scene.instruments, ports);
  check_laparoscope(check, scene.laparoscope);
  check_look_at(check, scene.laparoscope.look_at, scene.anatomy.organs);
  check.in_range("scene.solver.rate", scene.solver.rate, quantity::rate, 1, 2000, "a step rate");
  check.in_range("scene.solver.extensions.view", scene.solver.extension_view, quantity::length, 0, 400 * mm,
                 "a distance of the laparoscope");
  check.in_range("scene.solver.extensions.levels", scene.solver.extension_levels, quantity::number, 0,
                 most_extension_levels, "the levels of a structural extension");
  check.in_range("scene.solver.tolerance", scene.solver.tolerance, quantity::number, 1e-12, 1e-2,
                 "a solver tolerance");
  return check.take();
}

}  // namespace calot
