// What is wrong with a scene, all at once. The limits are those of sane anatomy and of what the solver can
// carry, wide enough for experiments: they catch forgotten units and slips, not unusual patients.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "anatomy/definitions.h"
#include "anatomy/key_table.h"
#include "base/units.h"

namespace calot {
namespace {

using units::mm;

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
  check_limits(check, path, "shape_pear", pear);
  if (check.is_fine(path + ".length") && check.is_fine(path + ".width") && pear.width >= pear.length)
    check.problem(path + ".width",
                  fmt::format("a pear {:g} mm wide and {:g} mm long is wider than long", pear.width / mm,
                              pear.length / mm),
                  "make it narrower, or use a sphere");
}

void check_swept(FieldCheck& check, const std::string& path, const SweptShape& shape, const Vec3& side) {
  const std::vector<SweptStation>& along = shape.along;
  bool good = true;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const std::string at = fmt::format("{}.along[{}]", path, i + 1);
    check_limits(check, at, "station", along[i]);
    for (const char* key : {".at", ".radius", ".refine"}) good &= check.is_fine(at + key);
    if (i == 0 || !good || (along[i].at - along[i - 1].at).norm() >= 1 * mm) continue;
    check.problem(at + ".at", "two stations of the axis are at one place", "move them at least 1 mm apart");
    good = false;
  }
  if (along.size() < 2)
    return check.problem(path + ".along", fmt::format("an axis of {} stations", along.size()),
                         "give the neck's end and the fundus' end at least");
  if (!good) return;
  const SweptForm form(along, side);
  const double ends = along.front().radius + along.back().radius;
  if (form.length() < ends)
    return check.problem(path + ".along",
                         fmt::format("an axis {:.3g} mm long is too short for its round ends of {:.3g} mm",
                                     form.length() / mm, ends / mm),
                         "make it longer, or the ends thinner");
  const SweptForm::Bend bend = form.sharpest();
  constexpr double folds = 0.9;  // of the radius: the control nodes stand in between
  if (bend.radius_by_curvature <= folds) return;
  const Vec3 place = form.bent({0, 0, bend.way});
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < along.size(); ++i)
    if ((along[i].at - place).norm() < (along[nearest].at - place).norm()) nearest = i;
  check.problem(
      fmt::format("{}.along[{}].radius", path, nearest + 1),
      fmt::format("the axis bends there by a radius of {:.3g} mm, and the organ is {:.3g} mm thick about it",
                  form.radius(bend.way) / bend.radius_by_curvature / mm, form.radius(bend.way) / mm),
      "make the organ thinner there, or bend its axis over a longer way");
}

/// Whether the list of a tube's radii, if there is one, fits its points.
bool check_radii(FieldCheck& check, const std::string& path, const TubeShape& tube) {
  if (tube.radii.empty()) return true;
  if (tube.end_radius > 0)
    check.problem(path + ".end_radius", "end_radius and radii are both given", "leave one out");
  if (tube.radii.size() != tube.points.size()) {
    check.problem(path + ".radii",
                  fmt::format("{} radii of a tube along {} points", tube.radii.size(), tube.points.size()),
                  "give one at each of its points");
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < tube.radii.size(); ++i) {
    const std::string at = fmt::format("{}.radii[{}]", path, i + 1);
    good &= check.in_range(at, tube.radii[i], quantity::length, 0.3 * mm, 20 * mm, "a duct's radius");
    if (!good || i == 0) continue;
    // Beyond that its skin, balls about its middle, would lie within the wider one's.
    const double way = (tube.points[i] - tube.points[i - 1]).norm();
    if (std::abs(tube.radii[i] - tube.radii[i - 1]) <= 0.5 * way) continue;
    check.problem(at,
                  fmt::format("from {:.3g} to {:.3g} mm of radius over {:.3g} mm", tube.radii[i - 1] / mm,
                              tube.radii[i] / mm, way / mm),
                  "let it widen by half of the way at most, or put the points further apart");
    good = false;
  }
  return good;
}

void check_tube(FieldCheck& check, const std::string& path, const TubeShape& tube) {
  check_limits(check, path, "shape_tube", tube);
  double length = 0;
  for (std::size_t i = 0; i < tube.points.size(); ++i) {
    const std::string at = fmt::format("{}.points[{}]", path, i + 1);
    if (!check.place_within(at, tube.points[i], abdomen_reach, "a place in the abdomen")) return;
    if (i > 0) length += (tube.points[i] - tube.points[i - 1]).norm();
  }
  if (tube.points.size() < 2)
    return check.problem(path + ".points", fmt::format("a tube along {} points", tube.points.size()),
                         "give its start and its end at least");
  if (!check_radii(check, path, tube)) return;
  const double widest =
      tube.radii.empty() ? tube.radius : *std::max_element(tube.radii.begin(), tube.radii.end());
  if (check.is_fine(path + ".radius") && length < 2 * widest)
    check.problem(path + ".points",
                  fmt::format("a tube {:.3g} mm long is shorter than it is thick ({:.3g} mm)", length / mm,
                              2 * widest / mm),
                  "make it longer or thinner");
}

void check_lobe(FieldCheck& check, const std::string& path, const LobeShape& lobe) {
  check_limits(check, path, "shape_lobe", lobe);
  if (check.is_fine(path + ".edge") && check.is_fine(path + ".thickness") && lobe.edge >= lobe.thickness)
    check.problem(path + ".edge",
                  fmt::format("an edge of {:g} mm is no thinner than the back, {:g} mm", lobe.edge / mm,
                              lobe.thickness / mm),
                  "make it thinner");
  if (check.is_fine(path + ".bed_width") && check.is_fine(path + ".width") &&
      lobe.bed_width > 0.5 * lobe.width)
    check.problem(path + ".bed_width",
                  fmt::format("a bed {:g} mm wide leaves too little of a lobe of {:g} mm",
                              lobe.bed_width / mm, lobe.width / mm),
                  "make the lobe at least twice as wide");
  if (check.is_fine(path + ".bed_depth") && check.is_fine(path + ".bed_width") &&
      lobe.bed_depth > 0.5 * lobe.bed_width)
    check.problem(path + ".bed_depth", "a bed deeper than half its width", "make it shallower");
}

void check_rigid(FieldCheck& check, const std::string& path, const RigidShape& rigid) {
  check_limits(check, path, "shape_rigid", rigid);
  if (rigid.size.minCoeff() < 0)
    check.problem(path + ".size", "a box has an edge below zero", "give edges of zero or more");
  if (rigid.ring > 0 && rigid.size != Vec3::Zero())
    check.problem(path + ".ring", "a box is no ring", "leave size out, or ring");
  if (!rigid.path.empty() && (rigid.ring > 0 || rigid.size != Vec3::Zero()))
    check.problem(path + ".path", "what a file holds is neither a box nor a ring", "leave size and ring out");
  // Its hole has to let the thinnest instrument through.
  constexpr double least_hole = 1e-3;  // m, radius
  if (rigid.ring > 0 && check.is_fine(path + ".ring") && check.is_fine(path + ".rounding") &&
      rigid.ring < rigid.rounding + least_hole)
    check.problem(path + ".ring",
                  fmt::format("a ring of radius {:g} mm, bent from a rod of radius {:g} mm, leaves no hole",
                              rigid.ring / mm, rigid.rounding / mm),
                  fmt::format("give at least {:g} mm", (rigid.rounding + least_hole) / mm));
}

void check_shape(FieldCheck& check, const std::string& path, const OrganShape& shape, const Vec3& side) {
  if (const auto* pear = std::get_if<PearShape>(&shape)) {
    check_pear(check, path, *pear);
  } else if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    check_limits(check, path, "shape_sphere", *sphere);
  } else if (const auto* swept = std::get_if<SweptShape>(&shape)) {
    check_swept(check, path, *swept, side);
  } else if (const auto* tube = std::get_if<TubeShape>(&shape)) {
    check_tube(check, path, *tube);
  } else if (const auto* rigid = std::get_if<RigidShape>(&shape)) {
    check_rigid(check, path, *rigid);
  } else if (const auto* lobe = std::get_if<LobeShape>(&shape)) {
    check_lobe(check, path, *lobe);
  } else {
    const auto& file = std::get<MeshFile>(shape);
    if (file.path.empty())
      check.problem(path + ".path", "no mesh file is named", "give the path of an OBJ file");
    check_limits(check, path, "shape_obj", file);
  }
}

/// The smallest radius a thin wall has to bend around; none for a mesh file, whose shape is not known here.
double radius_of(const OrganShape& shape) {
  if (const auto* pear = std::get_if<PearShape>(&shape)) return pear->width / 2;
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return sphere->radius;
  if (const auto* swept = std::get_if<SweptShape>(&shape)) {
    double widest = 0;
    for (const SweptStation& station : swept->along) widest = std::max(widest, station.radius);
    if (widest > 0) return widest;
  }
  return std::numeric_limits<double>::infinity();
}

/// What the limits of single keys do not say.
void check_wall(FieldCheck& check, const std::string& path, const WallDefinition& wall, double radius) {
  if (check.is_fine(path + ".thickness") && radius >= 5 * mm && wall.thickness > radius / 2)
    check.problem(path + ".thickness",
                  fmt::format("a wall of {:g} mm is no thin shell on a radius of {:g} mm",
                              wall.thickness / mm, radius / mm),
                  fmt::format("give at most {:g} mm", radius / 2 / mm));
}

void check_bile(FieldCheck& check, const std::string& path, const BileDefinition& bile) {
  if (bile.fill_volume && bile.fill_pressure)
    check.problem(path + ".fill_pressure", "fill_volume and fill_pressure are both given",
                  "give one; the other follows and is reported");
}

void check_axis(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  const bool neck_good = check.is_fine(path + ".neck"), fundus_good = check.is_fine(path + ".fundus");
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

void check_vessels(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  if (!organ.vessels.empty() && !is_hollow(organ.shape))
    return check.problem(path, fmt::format("a {} has no wall to draw vessels on", shape_name(organ.shape)),
                         "leave vessels out");
  for (std::size_t i = 0; i < organ.vessels.size(); ++i) {
    const WallVessel& vessel = organ.vessels[i];
    const std::string at = fmt::format("{}[{}]", path, i + 1);
    check_limits(check, at, "wall_vessel", vessel);
    for (std::size_t k = 0; k < vessel.points.size(); ++k)
      check.place_within(fmt::format("{}.points[{}]", at, k + 1), vessel.points[k], abdomen_reach,
                         "a place in the abdomen");
    if (vessel.points.size() < 2)
      check.problem(at + ".points", fmt::format("a vessel along {} points", vessel.points.size()),
                    "give its beginning and its end at least");
  }
}

/// What an injury is called has to be said.
void check_called(FieldCheck& check, const std::string& path, const std::string& called) {
  if (called.empty())
    check.problem(path + ".called", "the injury has no name", "say what an instructor calls it");
}

void check_near_start(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  const std::vector<InjuryNearStart>& near = organ.injury.near_start;
  if (!near.empty() && !std::holds_alternative<TubeShape>(organ.shape))
    return check.problem(path + ".near_start", fmt::format("a {} has no start", shape_name(organ.shape)),
                         "leave near_start out; a tube has one");
  for (std::size_t i = 0; i < near.size(); ++i) {
    const std::string at = fmt::format("{}.near_start[{}]", path, i + 1);
    check_limits(check, at, "injury_near_start", near[i]);
    check_called(check, at, near[i].called);
  }
}

/// Names of all organs but one.
std::vector<std::string> others_than(const OrganDefinition& organ,
                                     const std::vector<OrganDefinition>& organs) {
  std::vector<std::string> others;
  for (const OrganDefinition& other : organs)
    if (&other != &organ) others.push_back(other.name);
  return others;
}

void check_together(FieldCheck& check, const std::string& path, const OrganDefinition& organ,
                    const std::vector<OrganDefinition>& organs) {
  for (std::size_t i = 0; i < organ.injury.together.size(); ++i) {
    const InjuryTogether& both = organ.injury.together[i];
    const std::string at = fmt::format("{}.together[{}]", path, i + 1);
    check.known(at + ".with", both.with, others_than(organ, organs), "other organ");
    check_called(check, at, both.called);
  }
}

void check_organ(FieldCheck& check, const std::string& path, const OrganDefinition& organ) {
  const bool has_own_nodes = !is_hollow(organ.shape) || std::holds_alternative<MeshFile>(organ.shape);
  check_limits(check, path, "organ", organ, has_own_nodes ? "nodes" : "");
  check_shape(check, path + ".shape", organ.shape, organ.liver_side);
  if (is_hollow(organ.shape) || std::holds_alternative<LobeShape>(organ.shape))
    check_axis(check, path, organ);
  if (organ.looks == OrganLooks::pale && !is_hollow(organ.shape))
    check.problem(path + ".looks", fmt::format("a {} is not filled with mucus", shape_name(organ.shape)),
                  "leave looks out");
  if (organ.looks == OrganLooks::plastic && !std::holds_alternative<RigidShape>(organ.shape))
    check.problem(path + ".looks", fmt::format("a {} is not of plastic", shape_name(organ.shape)),
                  "leave looks out");
  if (!is_hollow(organ.shape) && (organ.bile.fill_volume || organ.bile.fill_pressure))
    check.problem(path + ".bile", fmt::format("a {} keeps no filling", shape_name(organ.shape)),
                  "leave fill_volume and fill_pressure out; a tube has a pressure");
  if (std::holds_alternative<RigidShape>(organ.shape) && !organ.held.empty())
    check.problem(path + ".held", "a rigid thing is not held",
                  "let something support it, or tie it by a joint");
  check_near_start(check, path + ".injury", organ);
  check_vessels(check, path + ".vessels", organ);
  check_wall(check, path + ".wall", organ.wall, radius_of(organ.shape));
  check_bile(check, path + ".bile", organ.bile);
  UniqueNames names(check, "held region");
  for (std::size_t i = 0; i < organ.held.size(); ++i) {
    const HeldRegion& held = organ.held[i];
    const std::string at = fmt::format("{}.held[{}]", path, i + 1);
    names.add(at + ".name", held.name);
    if (held.while_filled && !is_hollow(organ.shape))
      check.problem(at + ".while_filled", fmt::format("a {} is not filled", shape_name(organ.shape)),
                    "leave it out");
    check.known(at + ".landmark", held.landmark, landmarks_of(organ.shape), "landmark");
    check_limits(check, at, "held", held);
  }
}

/// Two skins can be compared point by point where one is the other moved aside.
void check_compared(FieldCheck& check, const std::string& path, const OrganDefinition& organ,
                    const std::vector<OrganDefinition>& organs) {
  if (organ.compared_with.empty()) return;
  if (!check.known(path, organ.compared_with, others_than(organ, organs), "other organ")) return;
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

/// As far as the definition tells.
int nodes_of(const OrganDefinition& organ) {
  if (const auto* tube = std::get_if<TubeShape>(&organ.shape)) return tube->nodes;
  if (std::holds_alternative<RigidShape>(organ.shape)) return 4;
  if (std::holds_alternative<LobeShape>(organ.shape)) return lobe_nodes;
  return std::holds_alternative<MeshFile>(organ.shape) || organ.nodes > most_nodes ? 0 : organ.nodes;
}

/// Checks what is called by its kind and lies between two of `known`, each `what`: that both are there, and its limits.
bool check_between(FieldCheck& check, const std::string& at, const std::string& kind, const auto& lies,
                   const std::vector<std::string>& known, const std::string& what) {
  const bool from = check.known(at + ".from", lies.from, known, what);
  const bool both = check.known(at + ".to", lies.to, known, what) && from;
  check_limits(check, at, kind, lies);
  return both;
}

void check_joints(FieldCheck& check, const AnatomyDefinition& anatomy) {
  const std::vector<std::string> places = landmark_names(anatomy.organs);
  for (std::size_t i = 0; i < anatomy.joints.size(); ++i) {
    const JointDefinition& joint = anatomy.joints[i];
    const std::string at = fmt::format("scene.anatomy.joints[{}]", i + 1);
    const bool known = check_between(check, at, "joint", joint, places, "place on an organ");
    if (known && joint.from.substr(0, joint.from.find('.')) == joint.to.substr(0, joint.to.find('.')))
      check.problem(at + ".to", "an organ is tied to itself", "name a place on another organ");
  }
}

/// Where what lies along an organ begins and ends on it.
void check_part(FieldCheck& check, const std::string& at, const auto& lies) {
  if (lies.start >= lies.stop && check.is_fine(at + ".start") && check.is_fine(at + ".stop"))
    check.problem(at + ".stop", fmt::format("it ends at {:.3g}, before it begins", lies.stop),
                  fmt::format("give more than its start, {:.3g}", lies.start));
}

/// `organs`: that there are.
void check_one_tissue(FieldCheck& check, const std::string& at, const TissueDefinition& tissue,
                      const std::vector<std::string>& organs) {
  if (std::find(organs.begin(), organs.end(), tissue.name) != organs.end())
    check.problem(at + ".name", fmt::format("an organ is called \"{}\" too", tissue.name),
                  "give the tissue another name");
  const bool known = check_between(check, at, "tissue", tissue, organs, "organ");
  if (known && tissue.from == tissue.to)
    check.problem(at + ".to", "the tissue is between an organ and itself", "name another organ");
  check_part(check, at, tissue);
}

void check_tissue(FieldCheck& check, const AnatomyDefinition& anatomy) {
  std::vector<std::string> organs;
  for (const OrganDefinition& organ : anatomy.organs) organs.push_back(organ.name);
  UniqueNames names(check, "tissue");
  int strands = 0;
  for (std::size_t i = 0; i < anatomy.tissue.size(); ++i) {
    const TissueDefinition& tissue = anatomy.tissue[i];
    const std::string at = fmt::format("scene.anatomy.tissue[{}]", i + 1);
    names.add(at + ".name", tissue.name);
    check_one_tissue(check, at, tissue, organs);
    strands += tissue.strands;
  }
  if (strands > most_strands && anatomy.tissue.size() > 1)
    check.problem("scene.anatomy.tissue", fmt::format("the tissues have {} strands together", strands),
                  fmt::format("give them at most {}", most_strands));
}

void check_leaves(FieldCheck& check, const AnatomyDefinition& anatomy) {
  std::vector<std::string> tubes;
  for (const OrganDefinition& organ : anatomy.organs)
    if (std::holds_alternative<TubeShape>(organ.shape)) tubes.push_back(organ.name);
  for (std::size_t i = 0; i < anatomy.leaves.size(); ++i) {
    const LeafDefinition& leaf = anatomy.leaves[i];
    const std::string at = fmt::format("scene.anatomy.leaves[{}]", i + 1);
    const bool known = check_between(check, at, "leaf", leaf, tubes, "tube");
    if (known && leaf.from == leaf.to)
      check.problem(at + ".to", "the leaf is between a tube and itself", "name another tube");
    check_part(check, at, leaf);
  }
}

void check_ground(FieldCheck& check, const AnatomyDefinition& anatomy) {
  UniqueNames names(check, "ground");
  for (std::size_t i = 0; i < anatomy.ground.size(); ++i) {
    const GroundDefinition& ground = anatomy.ground[i];
    const std::string at = fmt::format("scene.anatomy.ground[{}]", i + 1);
    names.add(at + ".name", ground.name);
    check_limits(check, at, "ground", ground);
    if (ground.type == GroundType::plane)
      check.unit_direction(at + ".normal", ground.normal, "a unit normal");
    if (ground.looks == GroundLooks::bowel && ground.type != GroundType::capsule)
      check.problem(at + ".looks", "only a capsule looks like bowel",
                    "give it type = \"capsule\", or other looks");
    if (ground.size.minCoeff() < 0)
      check.problem(at + ".size", "a box has an edge below zero", "give edges of zero or more");
  }
}

void check_size(FieldCheck& check, const std::string& path, const std::vector<OrganDefinition>& organs) {
  if (organs.size() > most_organs)
    check.problem(path, fmt::format("{} organs", organs.size()), fmt::format("give at most {}", most_organs));
  double nodes = 0;
  for (const OrganDefinition& organ : organs) nodes += nodes_of(organ);
  if (nodes > most_nodes)
    check.problem(path, fmt::format("the organs have {:g} control nodes together", nodes),
                  fmt::format("give them at most {}", most_nodes));
}

void check_anatomy(FieldCheck& check, const AnatomyDefinition& anatomy) {
  const std::string path = "scene.anatomy";
  check_limits(check, path, "anatomy", anatomy);
  if (anatomy.organs.empty())
    check.problem(path + ".organs", "the anatomy has no organ",
                  "give one, or use calot.anatomy(\"standard\")");
  check_size(check, path + ".organs", anatomy.organs);
  UniqueNames names(check, "organ");
  for (std::size_t i = 0; i < anatomy.organs.size(); ++i) {
    const std::string at = fmt::format("{}.organs[{}]", path, i + 1);
    names.add(at + ".name", anatomy.organs[i].name);
    check_organ(check, at, anatomy.organs[i]);
    check_compared(check, at + ".compared_with", anatomy.organs[i], anatomy.organs);
    check_together(check, at + ".injury", anatomy.organs[i], anatomy.organs);
  }
  check_joints(check, anatomy);
  check_tissue(check, anatomy);
  check_leaves(check, anatomy);
  check_ground(check, anatomy);
  if (anatomy.support)
    check.unit_direction(path + ".support.normal", anatomy.support->normal, "a unit normal");
}

/// Checks the ports given and returns the names that instruments may use.
std::vector<std::string> check_ports(FieldCheck& check, const std::vector<PortDefinition>& given) {
  UniqueNames unique(check, "port");
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::string at = fmt::format("scene.ports[{}]", i + 1);
    if (unique.add(at + ".name", given[i].name)) at = "scene.ports." + given[i].name;
    check.place_within(at, given[i].position, abdomen_reach, "a place on the abdomen");
  }
  std::vector<std::string> names;
  for (const PortDefinition& port : given.empty() ? default_ports() : given) names.push_back(port.name);
  return names;
}

/// One shaft a port: who is in which. Others may wait for it.
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
  void wait_for(const std::string& path, const std::string& port) {
    if (!check_.known(path + ".port", port, known_, "port")) return;
    const auto used = users_.find(port);
    if (used == users_.end())
      check_.problem(path + ".waits",
                     fmt::format("it waits for the port \"{}\", in which no instrument is", port),
                     "let one of that port's instruments not wait");
    else if (used->second == laparoscope)
      check_.problem(path + ".port", "the laparoscope stays in its port", free_ports());
  }
  static constexpr const char* laparoscope = "the laparoscope";

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
  if (instruments.size() > most_instruments)
    check.problem("scene.instruments", fmt::format("{} instruments", instruments.size()),
                  fmt::format("give at most {}", most_instruments));
  UniqueNames names(check, "instrument");
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    const InstrumentDefinition& instrument = instruments[i];
    std::string at = fmt::format("scene.instruments[{}]", i + 1);
    if (names.add(at + ".name", instrument.name)) at = "scene.instruments." + instrument.name;
    if (instrument.name == laparoscope_name)
      check.problem(at, "the laparoscope is called that already", "give the instrument another name");
    if (!instrument.waits)
      ports.take(at + ".port", instrument.port, fmt::format("instrument \"{}\"", instrument.name));
    check_limits(check, at, "instrument", instrument);
  }
  for (const InstrumentDefinition& instrument : instruments)
    if (instrument.waits) ports.wait_for("scene.instruments." + instrument.name, instrument.port);
}

void check_look_at(FieldCheck& check, const std::string& look_at,
                   const std::vector<OrganDefinition>& organs) {
  if (organs.empty()) return;  // said already
  check.known("scene.laparoscope.look_at", look_at, landmark_names(organs), "place to look at");
}

void check_solver(FieldCheck& check, const SolverDefinition& solver) {
  if (solver.motion == SolverMotion::dynamics && solver.extension_scheme == ExtensionScheme::staged)
    check.problem("scene.solver.extensions.scheme", "the staged scheme knows no masses",
                  "give scheme = \"condensed\", or motion = \"static\"");
}

}  // namespace

std::vector<Problem> validate(const SceneDefinition& scene) {
  FieldCheck check;
  check_limits(check, "scene", "scene", scene);
  check_anatomy(check, scene.anatomy);
  PortsInUse ports(check, check_ports(check, scene.ports));
  ports.take("scene.laparoscope.port", scene.laparoscope.port, PortsInUse::laparoscope);
  check_instruments(check, scene.instruments, ports);
  check_look_at(check, scene.laparoscope.look_at, scene.anatomy.organs);
  check_solver(check, scene.solver);
  return check.take();
}

std::vector<Problem> validate(const OrganDefinition& organ) {
  FieldCheck check;
  check.identifier("organ.name", organ.name, "organ");
  check_organ(check, "organ", organ);
  if (!organ.compared_with.empty())
    check.problem("organ.compared_with", "only organs that the scene has from the start are compared",
                  "leave compared_with out");
  return check.take();
}

std::vector<Problem> validate(const TissueDefinition& tissue, const std::vector<std::string>& organs) {
  FieldCheck check;
  check.identifier("tissue.name", tissue.name, "tissue");
  check_one_tissue(check, "tissue", tissue, organs);
  return check.take();
}

}  // namespace calot
