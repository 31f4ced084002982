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

 private:
  int faces() const { return static_cast<int>(inverses_.size()); }
  /// The smallest barycentric weight of where the ray meets the face's plane.
  double depth(int face, const Vec3& direction) const;

  std::vector<Mat3> inverses_;  ///< of the matrix of each face's corners
};

}  // namespace calot
