#pragma once
// What is drawn, as plain data: the renderer never sees the world.

#include <array>
#include <memory>
#include <vector>

#include "geometry/types.h"

namespace calot {

/// How a surface looks. Tissue patterns are fixed to the rest positions, so they stretch with the tissue.
enum class Material {
  gallbladder,  ///< bluish green, translucent; rest frame: neck at the origin, fundus along +z, liver along
                ///< +x
  membrane,     ///< the same wall without the gallbladder's own marks: test spheres
  liver,        ///< dark red-brown, glossy capsule
  fat,          ///< omentum: yellow, lobulated
  peritoneum,   ///< pinkish lining with fine vessels
  steel,        ///< bright instrument metal
  insulation,   ///< black coating of a shaft
  artery,       ///< pale red in a whitish sheath
  capsule,      ///< a lobe of the liver: dark red-brown, smooth, with a soft sheen
  bowel,        ///< pale pink; rest frame: its axis along z
  hydrops,  ///< a gallbladder full of mucus: pale, its vessels pressed empty; rest frame as the gallbladder's
  bile,     ///< film and drops: golden where thin, green where deep; rest positions: (0, 0, its depth, m)
  blood,    ///< likewise, red and dark red
  leaf,  ///< of peritoneum, with fine vessels; rest positions: along, across, 1 mm where it is whole, 2 full of fat
  board,    ///< a training box's floor and walls: grey, matt
  plastic,  ///< what lies and stands on it: blue, smooth, dry
  areolar,  ///< fibres of a loose plane; rest positions: along, beside others, and how taut, 1 mm: white; -1 mm: fat
  cobweb,  ///< films between these fibres; rest positions: along, across, how taut
};

/// What lies behind it shines through: drawn after all that does not.
inline bool shines_through(Material material) {
  return material == Material::bile || material == Material::blood || material == Material::leaf ||
         material == Material::cobweb;
}

/// Blood vessels as a volume over rest positions: the share of each voxel that they fill.
struct VesselMap {
  Vec3 lower = Vec3::Zero();  ///< m, corner of the first voxel
  double voxel = 0.45e-3;     ///< m, side
  std::array<int, 3> size{1, 1, 1};
  std::vector<unsigned char> share;  ///< 0 to 255; x runs fastest
};

struct SceneMesh {
  Material material = Material::gallbladder;
  std::vector<Vec3> positions;       ///< m, world
  std::vector<Vec3> normals;         ///< unit, one a position
  std::vector<Vec3> rest_positions;  ///< m, one a position, in the frame its material states
  std::vector<double> burnt;         ///< 0: as it is; 0.5: whitened; 1: charred; one a position, or none
  std::vector<Triangle> triangles;   ///< counter-clockwise seen from outside
  std::shared_ptr<const VesselMap> vessels;  ///< of gallbladder and membrane; may be null
};

/// The laparoscope: the view leaves the tip along `direction`; the light sits beside the lens.
struct SceneCamera {
  Vec3 position = Vec3::Zero();    ///< m
  Vec3 direction = Vec3::UnitY();  ///< unit
  Vec3 up = Vec3::UnitZ();         ///< not parallel to direction
  double field_of_view = 1.3;      ///< rad, diameter of the round field
  double light_intensity = 1.0;    ///< 1: well exposed at 90 mm
  double compensation = 1.0;  ///< share of light_intensity that the camera's exposure does not make up for
  Vec3 light_offset{0, 4e-3, 0};  ///< m, in camera axes (right, up, forward)
};

struct Scene {
  SceneCamera camera;
  std::vector<SceneMesh>
      meshes;  ///< drawn in this order, but what shines through last: near ones first is fastest
};

}  // namespace calot
