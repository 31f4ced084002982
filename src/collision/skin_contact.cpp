#include "collision/skin_contact.h"

#include <algorithm>
#include <cmath>

#include "geometry/finite.h"

namespace calot {
namespace {

/// Places of a simplex's corners, or their motions; zero where there are none.
struct Corners {
  std::array<Vec3, 3> at{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::size_t count = 0;

  Corners(std::span<const int> corners, const std::vector<Vec3>* values) : count(corners.size()) {
    for (std::size_t k = 0; values && k < count; ++k) at[k] = (*values)[corners[k]];
  }
  std::span<const Vec3> span() const { return {at.data(), count}; }
};

Vec3 motion_of(const PlacedSkin& skin, int point) {
  return skin.motions ? (*skin.motions)[point] : Vec3::Zero().eval();
}

bool is_finite(const PlacedSkin& skin) {
  return (skin.points == nullptr || all_finite(*skin.points)) &&
         (skin.motions == nullptr || all_finite(*skin.motions));
}

std::vector<Vec3> centres(const ContactSkin& skin, const std::vector<Vec3>& rest) {
  std::vector<Vec3> out;
  for (int s = 0; s < skin.simplices(); ++s) {
    Vec3 sum = Vec3::Zero();
    for (int corner : skin.corners(s)) sum += rest[corner];
    out.push_back(sum / static_cast<double>(skin.corners(s).size()));
  }
  return out;
}

}  // namespace

Eigen::Matrix<double, 12, 1> touch_gradient(const SkinTouch& touch, const BarrierSample& at_gap) {
  Eigen::Matrix<double, 12, 1> out;
  for (int k = 0; k < 4; ++k)
    out.segment<3>(3 * k) = touch.area * at_gap.derivative * touch.sample.weight[k] * touch.sample.normal;
  return out;
}

Eigen::Matrix<double, 12, 12> touch_hessian(const SkinTouch& touch, std::span<const Vec3> corners,
                                            const BarrierSample& at_gap) {
  Eigen::Matrix<double, 12, 1> slope;
  for (int k = 0; k < 4; ++k) slope.segment<3>(3 * k) = touch.sample.weight[k] * touch.sample.normal;
  return touch.area * (at_gap.second * slope * slope.transpose() +
                       at_gap.derivative * flat_hessian(corners, touch.sample));
}

std::array<Vec3, 3> touch_corners(const SkinTouch& touch, const std::vector<Vec3>& other_points) {
  return Corners({touch.part.corner.data(), static_cast<std::size_t>(touch.part.corners)}, &other_points).at;
}

ContactSkin::ContactSkin(const std::vector<Vec3>& rest, std::vector<Triangle> triangles,
                         std::vector<Segment> segments, double radius, std::vector<double> areas)
    : triangles_(std::move(triangles)),
      segments_(std::move(segments)),
      radius_(radius),
      areas_(std::move(areas)),
      point_tree_({}, {}),
      simplex_tree_({}, {}) {
  for (Triangle& t : triangles_) std::sort(t.begin(), t.end());
  for (Segment& s : segments_) std::sort(s.begin(), s.end());
  std::vector<int> acting, all;
  for (std::size_t p = 0; p < rest.size(); ++p)
    if (areas_[p] > 0) acting.push_back(static_cast<int>(p));
  for (int s = 0; s < simplices(); ++s) all.push_back(s);
  point_tree_ = ItemTree(rest, std::move(acting));
  simplex_tree_ = ItemTree(centres(*this, rest), std::move(all));
}

std::vector<SkinTouch> skin_touches(std::span<const PlacedSkin> skins, std::span<const SkinPair> pairs,
                                    double range) {
  std::vector<SkinTouch> out;
  std::vector<Triangle> faces;
  std::vector<Segment> segments;
  const auto same_point = [](const SkinPair& a, const SkinPair& b) {
    return a.skin == b.skin && a.point == b.point && a.other == b.other;
  };
  for (std::size_t first = 0, last = 0; first < pairs.size(); first = last) {
    const SkinPair& pair = pairs[first];
    const PlacedSkin &one = skins[pair.skin], &other = skins[pair.other];
    const Vec3& p = (*one.points)[pair.point];
    const double radii = one.skin->radius() + other.skin->radius(), reach = range + radii;
    faces.clear();
    segments.clear();
    for (; last < pairs.size() && same_point(pairs[last], pair); ++last) {
      const int simplex = pairs[last].simplex;
      const Corners corners(other.skin->corners(simplex), other.points);
      if (nearest_point(p, corners.span()).distance >= reach) continue;
      if (other.skin->is_triangle(simplex))
        faces.push_back(other.skin->triangle(simplex));
      else
        segments.push_back(other.skin->segment(simplex));
    }
    const auto add = [&](const std::vector<SurfacePart>& parts) {
      for (const SurfacePart& part : parts) {
        SkinTouch touch{
            pair.skin, pair.point, pair.other, part, {}, 0, part.times * one.skin->area(pair.point)};
        const std::array<Vec3, 3> corners = touch_corners(touch, *other.points);
        touch.sample = sample_flat(p, {corners.data(), static_cast<std::size_t>(part.corners)});
        touch.gap = touch.sample.distance - radii;
        out.push_back(touch);
      }
    };
    if (!faces.empty()) add(surface_parts(p, faces, *other.points, reach));
    if (!segments.empty()) add(line_parts(p, segments, *other.points, reach));
  }
  return out;
}

double safe_share(std::span<const PlacedSkin> skins, std::span<const SkinPair> pairs, double keep) {
  for (const PlacedSkin& skin : skins)
    if (!is_finite(skin)) return 0;
  double share = 1;
  for (const SkinPair& pair : pairs) {
    const PlacedSkin &one = skins[pair.skin], &other = skins[pair.other];
    const std::span<const int> ids = other.skin->corners(pair.simplex);
    const Corners corners(ids, other.points);
    Corners motions(ids, other.motions);
    for (Vec3& m : motions.at) m *= share;
    share *= safe_share((*one.points)[pair.point], share * motion_of(one, pair.point), corners.span(),
                        motions.span(), keep, one.skin->radius() + other.skin->radius());
  }
  return share;
}

double line_clearance(double sum_of_radii, double spacing) {
  return std::sqrt(std::max(0.0, sum_of_radii * sum_of_radii - 0.25 * spacing * spacing));
}

}  // namespace calot
