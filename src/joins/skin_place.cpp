#include "joins/skin_place.h"

#include "collision/simplex_distance.h"

namespace calot {

SkinFinder::SkinFinder(const Body& body, std::vector<Vec3> skin) : body_(body), skin_(std::move(skin)) {
  const std::vector<Triangle>& triangles = body.skin().triangles;
  const auto each = static_cast<std::size_t>(body.triangles_each());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (t % each == 0) boxes_.emplace_back();
    double reach = 0;
    for (int corner : triangles[t]) {
      boxes_.back().extend(skin_[corner]);
      reach = std::max(reach, (skin_[corner] - skin_[triangles[t][0]]).norm());
    }
    reaches_.push_back(reach);
  }
}

NearestSkin SkinFinder::nearest(const Vec3& to, double within) const {
  NearestSkin out;
  out.distance = within;
  const auto each = static_cast<std::size_t>(body_.triangles_each());
  for (std::size_t patch = 0; patch < boxes_.size(); ++patch) {
    if (boxes_[patch].exteriorDistance(to) >= out.distance) continue;
    for (std::size_t k = patch * each; k < (patch + 1) * each; ++k) {
      const Triangle& t = body_.skin().triangles[k];
      const double far = out.distance + reaches_[k];
      if ((to - skin_[t[0]]).squaredNorm() > far * far) continue;
      const std::array<Vec3, 3> corners{skin_[t[0]], skin_[t[1]], skin_[t[2]]};
      const NearestPoint found = nearest_point(to, corners);
      if (found.distance >= out.distance) continue;
      out = {{}, found.distance, 0};
      for (std::size_t c = 0; c < 3; ++c) {
        if (found.weight[c] == 0) continue;
        out.place.points.push_back(t[c]);
        out.place.weights.push_back(found.weight[c]);
        if (body_.is_line()) out.radius += found.weight[c] * body_.skin_radii()[t[c]];
      }
    }
  }
  return out;
}

Vec3 SkinFinder::at(const CarriedPlace& place) const { return carried_to(place, skin_); }

}  // namespace calot
