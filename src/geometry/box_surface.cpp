#include "geometry/box_surface.h"

#include <algorithm>
#include <cmath>

namespace calot {

std::vector<Triangle> BoxSurface::triangles() const {
  std::vector<Triangle> out;
  const std::array<int, 3> all = all_cells();
  for (int way = 0; way < 3; ++way)
    for (int end = 0; end < 2; ++end) {
      const int p = (way + 1) % 3, q = (way + 2) % 3;
      for (int b = 0; b < all[q]; ++b)
        for (int a = 0; a < all[p]; ++a) {
          const auto corner = [&](int along_p, int along_q) {
            std::array<int, 3> at{};
            at[way] = end * all[way], at[p] = a + along_p, at[q] = b + along_q;
            return point(at);
          };
          const int least = corner(0, 0), one = corner(1, 0), most = corner(1, 1), other = corner(0, 1);
          if (end == 1) {
            out.push_back({least, one, most});
            out.push_back({least, most, other});
          } else {
            out.push_back({least, most, one});
            out.push_back({least, other, most});
          }
        }
    }
  return out;
}

int BoxSurface::first_face(int way, int end) const {
  const std::array<int, 3> all = all_cells();
  int first = 0;
  for (int before = 0; before < way; ++before) first += 4 * all[(before + 1) % 3] * all[(before + 2) % 3];
  return first + 2 * end * all[(way + 1) % 3] * all[(way + 2) % 3];
}

bool BoxSurface::on_side(int triangle, int way, int end) const {
  const std::array<int, 3> all = all_cells();
  const int first = first_face(way, end);
  return triangle >= first && triangle < first + 2 * all[(way + 1) % 3] * all[(way + 2) % 3];
}

FacePoint BoxSurface::place(const Vec3& at) const {
  const std::array<int, 3> all = all_cells();
  for (int way = 0; way < 3; ++way)
    for (int end = 0; end < 2; ++end) {
      if (at[way] != end * all[way]) continue;
      const int p = (way + 1) % 3, q = (way + 2) % 3;
      const int a = std::clamp(static_cast<int>(std::floor(at[p])), 0, all[p] - 1),
                b = std::clamp(static_cast<int>(std::floor(at[q])), 0, all[q] - 1);
      const double s = at[p] - a, t = at[q] - b;
      const int face = first_face(way, end) + 2 * (a + all[p] * b);
      if (s >= t) return end == 1 ? FacePoint{face, s - t, t} : FacePoint{face, t, s - t};
      return end == 1 ? FacePoint{face + 1, s, t - s} : FacePoint{face + 1, t - s, s};
    }
  return {};
}

}  // namespace calot
