#include "geometry/radial_view.h"

#include <limits>

namespace calot {

RadialView::RadialView(const TriMesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    Mat3 corners;
    corners << mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]];
    inverses_.push_back(corners.inverse());
  }
}

FacePoint RadialView::point(const Vec3& direction) const {
  int best = 0;
  double deepest = depth(0, direction);
  for (int f = 1; f < faces(); ++f) {
    const double here = depth(f, direction);
    if (here > deepest) best = f, deepest = here;
  }
  const Vec3 w = inverses_[best] * direction;
  return {best, w[1] / w.sum(), w[2] / w.sum()};
}

std::vector<FacePoint> RadialView::points(const std::vector<Vec3>& directions) const {
  std::vector<FacePoint> out;
  for (const Vec3& d : directions) out.push_back(point(d));
  return out;
}

double RadialView::depth(int face, const Vec3& direction) const {
  const Vec3 w = inverses_[face] * direction;
  return w.sum() > 0 ? w.minCoeff() / w.sum() : -std::numeric_limits<double>::infinity();
}

}  // namespace calot
