#include "view/build_scene.h"

#include "anatomy/organ_frame.h"
#include "liquid/aspirate.h"
#include "view/clip_mesh.h"
#include "view/instrument_mesh.h"
#include "view/laparoscope.h"
#include "view/leaf_mesh.h"
#include "view/needle_mesh.h"
#include "view/spill_mesh.h"
#include "view/structure_mesh.h"
#include "view/tissue_mesh.h"
#include "view/vessels.h"

namespace calot {
namespace {

/// In the order of OrganShape.
Material material_of(const OrganDefinition& organ) {
  const OrganShape& shape = organ.shape;
  if (organ.looks == OrganLooks::pale && is_hollow(shape)) return Material::hydrops;
  if (organ.looks == OrganLooks::plastic) return Material::plastic;
  const auto* tube = std::get_if<TubeShape>(&shape);
  if (tube != nullptr && tube->carries == Carries::blood) return Material::artery;
  constexpr std::array materials = {Material::gallbladder, Material::membrane, Material::gallbladder,
                                    Material::gallbladder, Material::membrane, Material::fat,
                                    Material::capsule};
  return materials[shape.index()];
}

// m: a pixel of live quality sees 0.4 mm at 90 mm.
constexpr double coarse_error = 0.15e-3;
// Of the triangles of a surface that bends: they still are 1.3 mm long on a gallbladder.
constexpr double coarse_share = 0.25;

void make_coarse(SceneMesh& mesh) {
  if (!mesh.triangles.empty()) mesh = coarser(mesh, coarse_error, 0).mesh;
}

void make_coarse(InstrumentPart& part) {
  make_coarse(part.steel);
  make_coarse(part.insulation);
}

}  // namespace

SceneBuilder::SceneBuilder(const World& world, SceneDetail detail)
    : detail_(detail), still_(still_meshes(world.scene())), moulds_(world) {
  const bool coarse = detail == SceneDetail::coarse;
  if (coarse)
    for (SceneMesh& mesh : still_) make_coarse(mesh);
  for (const InstrumentDefinition& instrument : world.scene().instruments) {
    InstrumentModel& model = instruments_.emplace_back(instrument_model(instrument.type));
    if (!coarse) continue;
    for (InstrumentPart* part : {&model.shaft, &model.jaws[0], &model.jaws[1]}) make_coarse(*part);
  }
  for (const Organ& organ : world.field().organs) {
    const auto k = static_cast<std::size_t>(organ.record);
    if (k >= organs_.size()) organs_.resize(k + 1);
    SceneMesh mesh = organ_mesh(world, world.organ(organ.definition.name).value());
    // Of what is drawn around a line no point is a skin's, and there are few.
    if (!coarse || organ.body->is_line()) {
      organs_[k].mesh = std::move(mesh);
      continue;
    }
    CoarseMesh fewer = coarser(mesh, coarse_error, coarse_share);
    organs_[k] = {std::move(fewer.mesh), std::move(fewer.kept)};
  }
}

namespace {

/// One a drawn point, or one of each of these (null: all); none where nothing is burnt.
std::vector<double> burnt_shares(const Organ& organ, const std::vector<int>* points) {
  constexpr double wide = 1.6e-3;  // m, of a burn: the electrode's foot and what it heats around (d)
  if (organ.burns.empty()) return {};
  const std::vector<Vec3>& rest = organ.body->drawn_rest();
  std::vector<double> shares(points == nullptr ? rest.size() : points->size(), 0.0);
  for (const Burn& burn : organ.burns) {
    const double most = std::min(1.0, burn.energy / organ.definition.wall.burn_energy);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const Vec3& place = rest[points == nullptr ? i : static_cast<std::size_t>((*points)[i])];
      const double squared = (place - burn.at).squaredNorm() / (wide * wide);
      shares[i] = std::min(1.0, shares[i] + most * std::exp(-squared));
    }
  }
  return shares;
}

}  // namespace

SceneMesh SceneBuilder::organ_mesh(const World& world, OrganIndex organ) {
  const OrganDefinition& definition = world.field().organ(organ).definition;
  const Pose to_organ = organ_frame(definition).inverse();
  std::vector<Vec3> rest = world.drawn_rest(organ);
  for (Vec3& p : rest) p = to_organ * p;
  SceneMesh mesh;
  mesh.material = material_of(definition);
  mesh.triangles = world.drawn_triangles(organ);
  if (is_hollow(definition.shape)) {
    std::vector<VesselTrunk> trunks;
    for (const WallVessel& vessel : definition.vessels) {
      VesselTrunk& trunk = trunks.emplace_back(VesselTrunk{vessel.points, vessel.radius});
      for (Vec3& p : trunk.line) p = to_organ * p;
    }
    mesh.vessels = grow_vessels(rest, mesh.triangles, trunks);
  }
  mesh.rest_positions = std::move(rest);
  return mesh;
}

Scene SceneBuilder::build(const World& world) const {
  const SceneDefinition& definition = world.scene();
  Scene scene;
  scene.camera = laparoscope_camera(definition.laparoscope, world.report().laparoscope);
  for (std::size_t i = 0; i < definition.instruments.size(); ++i) {
    if (world.report().instruments[i].waits) continue;
    const Vec3 trocar = world.port_position(definition.instruments[i].port);
    for (SceneMesh& mesh : posed(instruments_[i], trocar, world.report().instruments[i].pose))
      scene.meshes.push_back(std::move(mesh));
    const Tool& tool = world.field().tools[i];
    for (SceneMesh& mesh : loaded_clip(tool)) scene.meshes.push_back(std::move(mesh));
    if (tool.needle.record >= 0)
      scene.meshes.push_back(needle_end_mesh(trocar, tool.pose, tool.geometry, needle_depth));
  }
  for (const Organ& organ : world.field().organs)
    for (SceneMesh& mesh : clip_meshes(organ)) scene.meshes.push_back(std::move(mesh));
  for (SceneMesh& mesh : fallen_clips(world.field())) scene.meshes.push_back(std::move(mesh));
  for (std::size_t i = 0; i < world.field().organs.size(); ++i) {
    const OrganIndex index(i);
    const auto record = static_cast<std::size_t>(world.field().organs[i].record);
    // One that came since is laid out anew for each picture: a duct or a stone takes no time.
    OrganMesh drawn = record < organs_.size() ? organs_[record] : OrganMesh{organ_mesh(world, index), {}};
    DrawnSkin skin = drawn.kept ? moulds_.skin(world, index, *drawn.kept, drawn.mesh.triangles)
                                : moulds_.skin(world, index);
    drawn.mesh.positions = std::move(skin.positions);
    drawn.mesh.normals = std::move(skin.normals);
    drawn.mesh.burnt = burnt_shares(world.field().organs[i], drawn.kept ? &*drawn.kept : nullptr);
    scene.meshes.push_back(std::move(drawn.mesh));
  }
  if (SceneMesh tissue = tissue_mesh(world, detail_); !tissue.triangles.empty())
    scene.meshes.push_back(std::move(tissue));
  if (SceneMesh leaf = leaf_mesh(world); !leaf.triangles.empty()) scene.meshes.push_back(std::move(leaf));
  for (SceneMesh& mesh : spill_meshes(world)) scene.meshes.push_back(std::move(mesh));
  for (const Organ& organ : world.field().organs) {
    if (!definition.laparoscope.show_structure || organ.body->as_shell() == nullptr) continue;
    for (SceneMesh& mesh : structure_meshes(draw_structure(*organ.body->as_shell(), organ.state.x)))
      scene.meshes.push_back(std::move(mesh));
  }
  scene.meshes.insert(scene.meshes.end(), still_.begin(), still_.end());
  return scene;
}

Scene build_scene(const World& world) { return SceneBuilder(world).build(world); }

}  // namespace calot
