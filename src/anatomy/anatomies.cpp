// The ports and the anatomies an author names.

#include "anatomy/definitions.h"
#include "base/suggest.h"
#include "base/units.h"

namespace calot {
namespace {

using units::mL;
using units::mm;
using units::mmHg;

/// A pear held along the liver and at its neck. The stiffnesses are design values: pulled up by its fundus
/// with 3 N it follows the jaws by about 20 mm, as a gallbladder retracted over the liver does.
OrganDefinition gallbladder(double length, double width) {
  OrganDefinition organ;
  PearShape pear;
  pear.length = length;
  pear.width = width;
  pear.refine = 2.0;  // a fold between 5 mm jaws needs nodes about 4 mm apart
  organ.shape = pear;
  organ.held = {{"bed", "bed", 25 * mm, 3e5}, {"cystic_duct", "neck", 8 * mm, 2e6}};
  return organ;
}

AnatomyDefinition standard() {
  AnatomyDefinition anatomy;
  anatomy.organs = {gallbladder(80 * mm, 35 * mm)};
  anatomy.organs[0].bile.fill_pressure = 12 * mmHg;  // 10 to 15 mmHg (c)
  return anatomy;
}

AnatomyDefinition hydrops() {
  AnatomyDefinition anatomy;
  anatomy.organs = {gallbladder(95 * mm, 40 * mm)};
  anatomy.organs[0].bile.fill_volume = 70 * mL;
  return anatomy;
}

}  // namespace

std::vector<PortDefinition> default_ports() {
  return {{"umbilical", {0, 0, 0}},
          {"epigastric", {-10 * mm, 120 * mm, -5 * mm}},
          {"right_subcostal", {-80 * mm, 70 * mm, -5 * mm}},
          {"right_lateral", {-140 * mm, 10 * mm, -25 * mm}},
          {"left_upper", {80 * mm, 80 * mm, -5 * mm}},
          {"right_flank", {-110 * mm, 20 * mm, -15 * mm}},
          {"subcostal", {-80 * mm, 80 * mm, -5 * mm}}};
}

const std::vector<Landmark>& landmark_rows() {
  static const std::vector<Landmark> rows = {
      {"neck", "the end at the cystic duct", 0, 0},
      {"fundus", "the free, round end", 1, 0},
      {"infundibulum", "Hartmann's pouch: next to the neck, on the free side", 0.2, -1},
      {"free_side", "the middle of the body on its free (peritoneal) side", 0.5, -1},
      {"liver_side", "the middle of the body on the liver's side", 0.5, 1},
      {"body", "another name of free_side", 0.5, -1},
      {"bed", "another name of liver_side", 0.5, 1},
      {"start", "of a tube", 0, 0, Landmark::Of::tube},
      {"middle", "of a tube", 0.5, 0, Landmark::Of::tube},
      {"end", "of a tube", 1, 0, Landmark::Of::tube},
      {"centre", "of a rigid thing, in its middle; joints tie a point of its surface", 0.5, 0,
       Landmark::Of::rigid},
      {"rim_1", "of a ring: on the circle in its middle, towards its own +x", 0, 0, Landmark::Of::ring},
      {"rim_2", "of a ring: a quarter further round, towards its own +y", 0.25, 0, Landmark::Of::ring},
      {"rim_3", "of a ring: opposite to rim_1", 0.5, 0, Landmark::Of::ring},
      {"rim_4", "of a ring: opposite to rim_2", 0.75, 0, Landmark::Of::ring},
      {"back", "of a lobe: the middle of where it is held", 0, 0, Landmark::Of::lobe},
      {"edge", "of a lobe: the middle of its edge", 1, 0, Landmark::Of::lobe},
      {"underside", "of a lobe: the middle of its underside, where its bed is", 0.5, -1, Landmark::Of::lobe},
      {"upper_side", "of a lobe: the middle of its upper side", 0.5, 1, Landmark::Of::lobe}};
  return rows;
}

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names = {"pear", "sphere", "swept", "obj", "tube", "rigid", "lobe"};
  return names;
}

const std::string& shape_name(const OrganShape& shape) { return shape_names()[shape.index()]; }

const std::string* mesh_path(const OrganShape& shape) {
  if (const auto* file = std::get_if<MeshFile>(&shape)) return &file->path;
  const auto* rigid = std::get_if<RigidShape>(&shape);
  return rigid != nullptr && !rigid->path.empty() ? &rigid->path : nullptr;
}

bool has_landmark(const OrganShape& shape, const Landmark& landmark) {
  if (is_hollow(shape)) return landmark.of == Landmark::Of::hollow;
  if (std::holds_alternative<TubeShape>(shape)) return landmark.of == Landmark::Of::tube;
  if (std::holds_alternative<LobeShape>(shape)) return landmark.of == Landmark::Of::lobe;
  return landmark.of == Landmark::Of::rigid ||
         (landmark.of == Landmark::Of::ring && std::get<RigidShape>(shape).ring > 0);
}

std::vector<std::string> landmarks_of(const OrganShape& shape) {
  std::vector<std::string> names;
  for (const Landmark& landmark : landmark_rows())
    if (has_landmark(shape, landmark)) names.emplace_back(landmark.name);
  return names;
}

std::vector<std::string> organ_landmarks() {
  std::vector<std::string> names;
  for (const Landmark& landmark : landmark_rows()) names.emplace_back(landmark.name);
  return names;
}

std::vector<std::string> landmark_names(const std::vector<OrganDefinition>& organs) {
  std::vector<std::string> names;
  for (const OrganDefinition& organ : organs)
    for (const std::string& landmark : landmarks_of(organ.shape))
      names.push_back(organ.name + "." + landmark);
  return names;
}

const std::vector<std::string>& anatomy_names() {
  static const std::vector<std::string> names = {"standard", "hydrops"};
  return names;
}

Result<AnatomyDefinition> named_anatomy(const std::string& name) {
  if (name == "standard") return standard();
  if (name == "hydrops") return hydrops();
  return fail(FailureKind::scenario, "unknown anatomy \"" + name + "\"", suggestion(name, anatomy_names()));
}

}  // namespace calot
