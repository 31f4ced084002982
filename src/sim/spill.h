#pragma once
// What has left the organs, on its way and where it lies: drops that fall, and a film on skins and on the ground that
// runs down and gathers in the lowest places.
//
// A drop falls freely from its opening until it meets the skin of an organ or the ground (tubes let it pass: it would
// run off them); there it spreads to a film. The film has a volume at each point of the surface. By points it flows to
// where it stands lower, as fast as a liquid sheet of its thickness runs (rho g h^2 / 3 mu), but for what sticks to the
// surface, and it wets a dry point only once it stands high enough. Where it hangs it drops off.
// Nothing of this acts on the organs.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/definitions.h"
#include "geometry/stencil.h"
#include "sim/step_report.h"

namespace calot {

struct Field;

inline constexpr int liquids = 2;  ///< in the order of Carries

struct Drop {
  Carries liquid = Carries::bile;
  Vec3 at = Vec3::Zero(), velocity = Vec3::Zero();  ///< m, m/s
  double volume = 0;                                ///< m^3
};

struct WetPoint {
  int point = 0;
  std::array<double, liquids> volume{};  ///< m^3
};

struct Film {
  int on = 0;                 ///< an organ by its place on the roll; below 0: ground -1 - on
  std::vector<WetPoint> wet;  ///< by increasing points
};

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
  /// Of what films are on: remembered, no part of any result. By place on the roll, and of the ground.
  std::vector<WetMeshPointer> skins = {}, ground = {};

  /// What has left the body of that name, m^3.
  void count(const std::string& body, Carries liquid, double volume);
  /// m^3 in drops and films.
  double lying(Carries liquid) const;
};

/// Moves all of it on by `duration` s, and makes drops of what hangs on openings.
void spill(Field& field, double duration);

/// A film's surface; its mesh is null where the organ is gone.
WetSurface wet_surface(const Field& field, const Film& film);

}  // namespace calot
