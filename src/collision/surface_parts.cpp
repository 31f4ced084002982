#include "collision/surface_parts.h"

#include <algorithm>

#include "collision/simplex_distance.h"

namespace calot {
namespace {

/// Parts as they are counted.
class Sum {
 public:
  Sum(const Vec3& p, const std::vector<Vec3>& points, double range) : p_(p), points_(points), range_(range) {}

  /// Counts the part that the simplex' nearest point lies on, if that is in range.
  void add(const int* corners, int count, int times) {
    if (times == 0) return;
    std::array<Vec3, 3> at;
    for (int k = 0; k < count; ++k) at[k] = points_[corners[k]];
    const NearestPoint nearest = nearest_point(p_, {at.data(), static_cast<std::size_t>(count)});
    if (nearest.distance >= range_) return;
    SurfacePart part;
    part.times = times;
    for (int k = 0; k < count; ++k)
      if (nearest.weight[k] > 0) part.corner[part.corners++] = corners[k];
    parts_.push_back(part);
  }

  std::vector<SurfacePart> merged() {
    std::sort(parts_.begin(), parts_.end(),
              [](const SurfacePart& a, const SurfacePart& b) { return a.corner < b.corner; });
    std::vector<SurfacePart> out;
    for (const SurfacePart& part : parts_) {
      if (!out.empty() && out.back().corner == part.corner)
        out.back().times += part.times;
      else
        out.push_back(part);
    }
    std::erase_if(out, [](const SurfacePart& part) { return part.times == 0; });
    return out;
  }

 private:
  const Vec3& p_;
  const std::vector<Vec3>& points_;
  double range_;
  std::vector<SurfacePart> parts_;
};

/// Counts each corner so that with what meets there it comes to one.
void add_corners(std::vector<std::pair<int, int>>& corners, Sum& sum) {
  std::sort(corners.begin(), corners.end());
  for (std::size_t first = 0, last = 0; first < corners.size(); first = last) {
    int met = 0;
    for (; last < corners.size() && corners[last].first == corners[first].first; ++last)
      met += corners[last].second;
    sum.add(&corners[first].first, 1, 1 - met);
  }
}

}  // namespace

std::vector<SurfacePart> surface_parts(const Vec3& p, const std::vector<Triangle>& faces,
                                       const std::vector<Vec3>& points, double range) {
  Sum sum(p, points, range);
  // An edge or corner in range has all its triangles in range: what is counted here is complete for those.
  std::vector<std::array<int, 2>> edges;
  std::vector<std::pair<int, int>> corners;  // and what the parts that meet there come to
  for (const Triangle& t : faces) {
    sum.add(t.data(), 3, 1);
    edges.push_back({t[0], t[1]});
    edges.push_back({t[0], t[2]});
    edges.push_back({t[1], t[2]});
    for (int corner : t) corners.emplace_back(corner, 1);
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last] == edges[first]) ++last;
    const int times = 1 - static_cast<int>(last - first);
    sum.add(edges[first].data(), 2, times);
    for (int corner : edges[first]) corners.emplace_back(corner, times);
  }
  add_corners(corners, sum);
  return sum.merged();
}

std::vector<SurfacePart> line_parts(const Vec3& p, const std::vector<std::array<int, 2>>& segments,
                                    const std::vector<Vec3>& points, double range) {
  Sum sum(p, points, range);
  std::vector<std::pair<int, int>> corners;
  for (const std::array<int, 2>& segment : segments) {
    sum.add(segment.data(), 2, 1);
    for (int corner : segment) corners.emplace_back(corner, 1);
  }
  add_corners(corners, sum);
  return sum.merged();
}

}  // namespace calot
