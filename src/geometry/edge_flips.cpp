#include "geometry/edge_flips.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace calot {

namespace {

class Flipper {
 public:
  Flipper(TriMesh& mesh, double least_angle)
      : mesh_(mesh), least_angle_(least_angle), valence_(mesh.points.size(), 0) {
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      for (int k = 0; k < 3; ++k) owner_[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
      for (int node : mesh.triangles[t]) ++valence_[node];
    }
  }

  /// Whether an edge was flipped. Each flip lowers a sum of integers, so sweeps come to an end.
  bool sweep() {
    bool flipped = false;
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      for (int k = 0; k < 3; ++k)
        flipped = flip(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]) || flipped;
    }
    return flipped;
  }

 private:
  /// Replaces edge a-b between triangles (a, b, c) and (b, a, d) by c-d where that helps.
  bool flip(int a, int b) {
    const int t = owner_.at({a, b}), other = owner_.at({b, a});
    const int c = apex(t, a, b), d = apex(other, a, b);
    if (gain(a, b, c, d) <= 0 || owner_.contains({c, d})) return false;
    const Triangle first{c, d, b}, second{d, c, a};
    const Vec3 outside = normal({a, b, c}).normalized() + normal({b, a, d}).normalized();
    if (normal(first).dot(outside) <= 0 || normal(second).dot(outside) <= 0) return false;
    if (std::min(smallest_angle(first), smallest_angle(second)) < least_angle_) return false;
    owner_.erase({a, b});
    owner_.erase({b, a});
    place(t, first);
    place(other, second);
    --valence_[a], --valence_[b], ++valence_[c], ++valence_[d];
    return true;
  }

  void place(int t, const Triangle& corners) {
    mesh_.triangles[t] = corners;
    for (int k = 0; k < 3; ++k) owner_[{corners[k], corners[(k + 1) % 3]}] = t;
  }

  int apex(int t, int a, int b) const {
    const Triangle& c = mesh_.triangles[t];
    return *std::find_if(c.begin(), c.end(), [&](int n) { return n != a && n != b; });
  }

  int gain(int a, int b, int c, int d) const {
    const auto bad = [](int valence) {
      const int off = std::max({0, 5 - valence, valence - 7});
      return off * off;
    };
    return bad(valence_[a]) - bad(valence_[a] - 1) + bad(valence_[b]) - bad(valence_[b] - 1) +
           bad(valence_[c]) - bad(valence_[c] + 1) + bad(valence_[d]) - bad(valence_[d] + 1);
  }

  Vec3 normal(const Triangle& t) const {
    const auto& x = mesh_.points;
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  }

  double smallest_angle(const Triangle& t) const {
    double least = 4;
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = mesh_.points[t[(k + 1) % 3]] - mesh_.points[t[k]];
      const Vec3 v = mesh_.points[t[(k + 2) % 3]] - mesh_.points[t[k]];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
    return least;
  }

  TriMesh& mesh_;
  double least_angle_;
  std::vector<int> valence_;
  std::map<std::pair<int, int>, int> owner_;  ///< triangle of each directed edge
};

}  // namespace

void even_valences(TriMesh& mesh, double least_angle) {
  Flipper flipper(mesh, least_angle);
  while (flipper.sweep()) {
  }
}

}  // namespace calot
