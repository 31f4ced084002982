#include "geometry/radial_view.h"

#include <algorithm>
#include <limits>
#include <numeric>

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
  return on_plane(best, direction);
}

std::vector<FacePoint> RadialView::points(const std::vector<Vec3>& directions) const {
  std::vector<FacePoint> out;
  for (const Vec3& d : directions) out.push_back(point(d));
  return out;
}

std::vector<FacePoint> RadialView::nearest(const Vec3& direction, int count) const {
  std::vector<int> order(inverses_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return depth(a, direction) > depth(b, direction); });
  std::vector<FacePoint> out;
  for (int k = 0; k < count; ++k) out.push_back(on_plane(order[k], direction));
  return out;
}

FacePoint RadialView::on_plane(int face, const Vec3& direction) const {
  const Vec3 w = inverses_[face] * direction;
  return {face, w[1] / w.sum(), w[2] / w.sum()};
}

double RadialView::depth(int face, const Vec3& direction) const {
  const Vec3 w = inverses_[face] * direction;
  return w.sum() > 0 ? w.minCoeff() / w.sum() : -std::numeric_limits<double>::infinity();
}

}  // namespace calot
