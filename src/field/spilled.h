#pragma once
// Bile and blood that have left the organs: how much, and where they are (spill.h moves them).

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/definitions.h"
#include "body/body.h"
#include "geometry/stencil.h"
#include "tools/step_report.h"

namespace calot {

inline constexpr int liquids = 2;  ///< in the order of Carries

struct Drop {
  Carries liquid = Carries::bile;
  Vec3 at = Vec3::Zero(), velocity = Vec3::Zero();  ///< m, m/s
  double volume = 0;                                ///< m^3
};
void visit_members(auto&& visit, MembersOf<Drop> auto& drop) {
  auto& [liquid, at, velocity, volume] = drop;
  visit(liquid, at, velocity, volume);
}

struct WetPoint {
  int point = 0;
  std::array<double, liquids> volume{};  ///< m^3
};
void visit_members(auto&& visit, MembersOf<WetPoint> auto& wet) {
  auto& [point, volume] = wet;
  visit(point, volume);
}

/// What a film lay on, and for how long, when a part of a step moved nothing of it. Where all this is the same the next
/// part moves nothing either.
struct FilmRest {
  double part = 0;  ///< s
  Vec3 up = Vec3::UnitZ();
  BodyPointer body;  ///< null: the ground, which stays
  VecX x;            ///< m, of the body's nodes
};

struct Film {
  int on = 0;                         ///< an organ by its place on the roll; below 0: ground -1 - on
  std::vector<WetPoint> wet;          ///< by increasing points
  std::optional<FilmRest> rest = {};  ///< remembered, no part of any result; none: it may flow
};
void visit_members(auto&& visit, MembersOf<Film> auto& film) {
  auto& [on, wet, rest] = film;  // the rest is found again
  visit(on, wet);
}

/// A clip that fell, where it lies.
struct FallenClip {
  ClipSize size = ClipSize::ml;
  int on = 0, point = 0;  ///< as a film's, and the point of that surface
  Vec3 legs = Vec3::
      UnitZ();  ///< unit: where its legs pointed when it fell, and lie along as far as the surface lets them
};
void visit_members(auto&& visit, MembersOf<FallenClip> auto& clip) {
  auto& [size, on, point, legs] = clip;
  visit(size, on, point, legs);
}

/// Where a film can be: points, and who is beside whom.
struct WetMesh {
  std::vector<Triangle> triangles;
  std::vector<double> areas;       ///< m^2, of each point
  std::vector<int> begin, beside;  ///< of point k: beside[begin[k]] to beside[begin[k + 1] - 1]
  std::vector<Vec3> at, normals;   ///< m, unit: of the ground, which stays
};
using WetMeshPointer = std::shared_ptr<const WetMesh>;

/// It as it is now.
struct WetSurface {
  WetMeshPointer mesh;
  std::vector<Vec3> at, normals;  ///< m, unit
};

struct Spill {
  std::vector<LostState> lost;  ///< by the organs of the scene
  std::array<double, liquids> given{}, drained{},
      out_of_sight{};  ///< m^3: by the patient, out of tubes, fallen away
  std::vector<Drop> drops;
  std::vector<Film> films;  ///< in the order in which they began
  std::vector<FallenClip> clips;
  /// Of what films are on: remembered, no part of any result. By place on the roll, and of the ground.
  std::vector<WetMeshPointer> skins = {}, ground = {};

  /// What has left the body of that name, m^3.
  void count(const std::string& body, Carries liquid, double volume);
  /// What was drawn out of the body of that name, m^3.
  void count_aspirated(const std::string& body, double volume);
  /// m^3 in drops and films.
  double lying(Carries liquid) const;
};
void visit_members(auto&& visit, MembersOf<Spill> auto& spill) {
  auto& [lost, given, drained, out_of_sight, drops, films, clips, skins, ground] = spill;
  visit(lost, given, drained, out_of_sight, drops, films, clips);
}

}  // namespace calot
