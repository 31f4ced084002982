#pragma once
// The laparoscope's optics: a round field, wider than the picture is high, with a slight barrel distortion.

#include "geometry/types.h"
#include "render/scene.h"

namespace calot {

/// Planes of the drawn depth: the tip's own glass to the far wall of the abdomen (m).
inline constexpr double near_plane = 2e-3, far_plane = 0.6;

struct Lens {
  double field_diameter = 1.14;  ///< of the round field over the picture's height
  double barrel = 0.12;          ///< the centre is magnified by 1 / (1 - barrel) over the edge's mean scale
  double inner_scale = 0.86;     ///< pixels of the undistorted picture for one at the field's edge

  /// Radius of the round field in a picture of this height, px.
  double field_radius(int height) const { return 0.5 * field_diameter * height; }
  /// Half of the undistorted picture, as a share of the tangent of the field's half angle.
  Vec2 inner_extent(int width, int height) const;
};

/// Right, up (exactly orthogonal) and forward of a camera, as rows: takes world directions to camera axes.
Mat3 camera_axes(const SceneCamera& camera);

/// Clip space from places relative to the camera (m), for the undistorted picture.
Eigen::Matrix4d inner_projection(const SceneCamera& camera, const Lens& lens, int width, int height);

/// Clip space of the light's shadow map from places relative to the camera.
Eigen::Matrix4d shadow_projection(const SceneCamera& camera);

}  // namespace calot
