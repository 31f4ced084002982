#include "view/clip_mesh.h"

#include <numbers>

#include "body/rod_body.h"
#include "liquid/films.h"
#include "view/instrument_parts.h"
#include "view/surfaces.h"

namespace calot {
namespace {

/// Along x from leg to leg, with legs along z whose tips are `reach` past the origin.
SceneMesh clip_mesh(double apart, double leg, double reach, double wire) {
  const double crown = reach - leg + apart;
  std::vector<Vec3> line{{-apart, 0, reach - 0.5 * wire}};
  constexpr int parts = 8;
  for (int k = 0; k <= parts; ++k) {
    const double a = std::numbers::pi * k / parts;
    line.emplace_back(-apart * std::cos(a), 0, crown - apart * std::sin(a));
  }
  line.emplace_back(apart, 0, reach - 0.5 * wire);
  return bent_bar(Material::steel, line, 0.5 * wire);
}

}  // namespace

std::vector<SceneMesh> clip_meshes(const Organ& organ) {
  std::vector<SceneMesh> out;
  const RodBody* rod = organ.body->as_tube();
  for (const Clip& clip : organ.clips) {
    const ClipRow& row = clip_row(clip.size);
    const double apart = rod->flat_half_height(clip.at, clip.opening) + 0.5 * row.wire;
    const Mat3 frame = rod->frame_at(clip.at, organ.state.x);
    Pose pose = Pose::Identity();
    pose.translation() = rod->place_at(clip.at, organ.state.x);
    const Vec3 legs = frame * clip.legs, pressed = frame * clip.pressed;
    pose.linear() << pressed, legs.cross(pressed), legs;
    SceneMesh mesh = clip_mesh(apart, row.leg, clip.reach, row.wire);
    move(mesh, pose);
    out.push_back(std::move(mesh));
  }
  return out;
}

std::vector<SceneMesh> fallen_clips(const Field& field) {
  std::vector<SceneMesh> out;
  for (const FallenClip& clip : field.spill.clips) {
    const WetSurface surface = wet_surface(field, clip.on);
    if (!surface.mesh) continue;
    const ClipRow& row = clip_row(clip.size);
    const Vec3 &at = surface.at[clip.point], &out_of = surface.normals[clip.point];
    Vec3 legs = clip.legs - out_of * out_of.dot(clip.legs);
    legs = legs.norm() > 0.1 ? Vec3(legs.normalized()) : Vec3(out_of.unitOrthogonal());
    Pose pose = Pose::Identity();
    pose.translation() = at + 0.6 * row.wire * out_of;
    pose.linear() << out_of.cross(legs), out_of, legs;
    SceneMesh mesh = clip_mesh(0.6 * row.wire, row.leg, 0.5 * row.leg, row.wire);
    move(mesh, pose);
    out.push_back(std::move(mesh));
  }
  return out;
}

std::vector<SceneMesh> loaded_clip(const Tool& tool) {
  if (tool.clips == 0) return {};
  const ClipRow& row = clip_row(tool.definition.clip);
  const double tip = tool.geometry.jaw_length - 0.4e-3, x = 0.55 * row.wire;
  SceneMesh out;
  out.material = Material::steel;
  for (int jaw = 0; jaw < 2; ++jaw) {
    SceneMesh leg =
        bent_bar(Material::steel, {{x, 0, tip - row.leg}, {x, 0, tip - 0.5 * row.wire}}, 0.5 * row.wire);
    move(leg, jaw_frame(tool.trocar, tool.pose, tool.geometry, jaw));
    append(out, leg);
  }
  return {out};
}

}  // namespace calot
