#pragma once
// Closed surfaces of revolution with evenly spread vertices: the sphere of the paper and the gallbladder.

#include <functional>

#include "geometry/tri_mesh.h"

namespace calot {

/// Profile of a closed surface of revolution about +z: radius and height (m) at s in [0, 1], from the lower
/// pole (s = 0, radius 0, smooth) to the upper (s = 1, radius 0, smooth).
struct Profile {
  std::function<Vec2(double s)> point;  ///< (radius, height), m
};

Profile sphere_profile(double radius);

/// A gallbladder: neck at z = 0, fundus (broad end) at z = length; largest diameter `width`. A closed
/// parametric shape: a round fundus, a body that tapers, a slim neck; 80 mm x 35 mm holds about 40 mL.
Profile pear_profile(double length, double width);

/// A relative spacing for revolve() on a pear: 1 on the body, 0.6 at the neck, so that from 100 nodes on five
/// or more go round the neck and every node keeps five to seven neighbours.
double pear_spacing(const Vec3& position, double length);

/// `nodes` vertices on the surface, spread by repulsion with target spacing proportional to
/// `spacing(position)` (constant when empty), triangulated on the sphere to which the surface maps
/// conformally. Deterministic. Fails when fewer than 12 nodes are asked for or the profile is not a closed
/// surface.
Result<TriMesh> revolve(const Profile& profile, int nodes,
                        const std::function<double(const Vec3&)>& spacing = {});

/// A flat rectangle in the xy plane, centred, of columns x rows cells each cut in two triangles (for tests
/// and tissue sheets), normal +z.
TriMesh rectangle(double width, double height, int columns, int rows);

}  // namespace calot
