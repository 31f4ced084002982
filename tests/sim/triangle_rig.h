#pragma once
// Calot's triangle from simple shapes: a gallbladder, ducts, an artery, a liver, and tissue between them.

#include "rig.h"

namespace calot::test {

inline const Vec3 ball_neck(-80e-3, 70e-3, -150e-3);
/// Of the patient's, m.
inline Vec3 beside_neck(double x, double y, double z) { return ball_neck + 1e-3 * Vec3(x, y, z); }

inline OrganDefinition straight_tube(const std::string& name, const Vec3& from, const Vec3& to,
                                     double radius) {
  OrganDefinition organ;
  organ.name = name;
  organ.shape = TubeShape{.points = {from, 0.5 * (from + to), to}, .radius = radius};
  organ.wall.thickness = 0.5 * radius;
  organ.wall.density = 1050;
  organ.held = {{"first", "start", 4e-3, 1e7}, {"last", "end", 4e-3, 1e7}};
  return organ;
}

inline TissueDefinition tissue_between(const std::string& name, const std::string& from,
                                       const std::string& to, double within, int strands) {
  TissueDefinition tissue;
  tissue.name = name;
  tissue.from = from;
  tissue.to = to;
  tissue.within = within;
  tissue.strands = strands;
  tissue.slack = 0;
  tissue.strength = 12e3;
  tissue.stiffness = 4e3;
  tissue.break_energy = 400;
  return tissue;
}

/// A ball as the gallbladder, a duct from its neck to a duct that stands upright beside it, an artery to it, all in a plane
/// across y, and behind them a thick round bar as the liver.
inline SceneDefinition triangle_scene() {
  OrganDefinition gallbladder = bedded_ball();
  gallbladder.name = "gallbladder";
  SceneDefinition scene = ball_scene(gallbladder);
  const OrganDefinition liver =
      straight_tube("liver", beside_neck(-40, 40, 8), beside_neck(80, 40, 8), 17e-3);
  scene.anatomy.organs.push_back(liver);
  scene.anatomy.organs.push_back(
      straight_tube("common_duct", beside_neck(40, 0, 25), beside_neck(40, 0, -30), 3e-3));
  scene.anatomy.organs.push_back(
      straight_tube("cystic_duct", beside_neck(0, 0, -1.8), beside_neck(33, 0, -18.5), 1.8e-3));
  scene.anatomy.organs.push_back(
      straight_tube("cystic_artery", beside_neck(34, 0, 18), beside_neck(20.5, 0, 18), 0.8e-3));
  scene.anatomy.joints = {{"cystic_duct.start", "gallbladder.neck", 4e-3},
                          {"cystic_artery.end", "gallbladder.neck", 4e-3}};
  scene.anatomy.tissue = {tissue_between("cystic_plate", "gallbladder", "liver", 12e-3, 30),
                          tissue_between("fat", "cystic_duct", "common_duct", 30e-3, 24)};
  return scene;
}

/// A lobe instead of the bar.
inline OrganDefinition lobe_behind() {
  OrganDefinition liver;
  liver.name = "liver";
  liver.shape = LobeShape{.bed_width = 0, .bed_depth = 0};
  liver.neck = beside_neck(0, 26, 0);
  liver.fundus = beside_neck(0, 26, 40);
  liver.liver_side = Vec3::UnitY();
  return liver;
}

}  // namespace calot::test
