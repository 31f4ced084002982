#pragma once
// Volume, centroid and second moments of solids of density one: all that a rigid motion's inertia and weight know of a
// shape.

#include "geometry/tri_mesh.h"

namespace calot {

/// Mass properties of a solid with a density of 1.
struct SolidMoments {
  double volume = 0;             ///< m^3
  Vec3 centroid = Vec3::Zero();  ///< m
  Mat3 second = Mat3::Zero();    ///< integral of (X - centroid)(X - centroid)', m^5
};

/// A box about the origin along the axes; half edges in m.
SolidMoments box_moments(const Vec3& half);
SolidMoments ball_moments(const Vec3& centre, double radius);
/// Between the middles of its flat ends, which must not coincide.
SolidMoments cylinder_moments(const Vec3& a, const Vec3& b, double radius);
/// A ball swept from a to b; from a to a the ball.
SolidMoments capsule_moments(const Vec3& a, const Vec3& b, double radius);
/// A closed mesh that faces outward, by the divergence theorem: exact for its flat triangles.
SolidMoments mesh_moments(const TriMesh& mesh);

/// The solid carried by a motion.
SolidMoments moved(const SolidMoments& solid, const Pose& motion);
/// Two solids as one. Where they overlap counts twice.
SolidMoments joined(const SolidMoments& a, const SolidMoments& b);

}  // namespace calot
