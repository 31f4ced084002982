#include "sim/skin_place.h"

#include <algorithm>
#include <limits>

#include "collision/simplex_distance.h"

namespace calot {

NearestSkin nearest_on_skin(const Body& body, const std::vector<Vec3>& skin, const Vec3& to) {
  NearestSkin out;
  out.distance = std::numeric_limits<double>::infinity();
  for (const Triangle& t : body.skin().triangles) {
    const std::array<Vec3, 3> corners{skin[t[0]], skin[t[1]], skin[t[2]]};
    const double reach =
        out.distance + std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm());
    if ((to - corners[0]).squaredNorm() > reach * reach) continue;
    const NearestPoint found = nearest_point(to, corners);
    if (found.distance >= out.distance) continue;
    out = {{}, found.distance, 0};
    for (std::size_t c = 0; c < 3; ++c) {
      if (found.weight[c] == 0) continue;
      out.place.points.push_back(t[c]);
      out.place.weights.push_back(found.weight[c]);
      if (!body.skin_radii().empty()) out.radius += found.weight[c] * body.skin_radii()[t[c]];
    }
  }
  return out;
}

}  // namespace calot
