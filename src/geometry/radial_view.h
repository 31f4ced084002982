#pragma once
// A mesh around the origin as it is seen from there.

#include "geometry/stencil.h"
#include "geometry/tri_mesh.h"

namespace calot {

/// Where rays from the origin meet a mesh that hides no part of itself from it.
class RadialView {
 public:
  explicit RadialView(const TriMesh& mesh);

  FacePoint point(const Vec3& direction) const;
  std::vector<FacePoint> points(const std::vector<Vec3>& directions) const;
  /// A point on each of the faces' planes; the nearer the ray passes to a face the earlier it comes.
  std::vector<FacePoint> nearest(const Vec3& direction, int count) const;

 private:
  int faces() const { return static_cast<int>(inverses_.size()); }
  FacePoint on_plane(int face, const Vec3& direction) const;
  /// The smallest barycentric weight of where the ray meets the face's plane.
  double depth(int face, const Vec3& direction) const;

  std::vector<Mat3> inverses_;  ///< of the matrix of each face's corners
};

}  // namespace calot
