#include "liquid/spill_surface.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

constexpr double spacing = 1.3e-3;      // m
constexpr double plane_reach = 150e-3;  // m, to either side
constexpr int most_points = 120'000;

/// A grid over the sides of a box; only those points are there that are on it.
class BoxGrid {
 public:
  BoxGrid(const Pose& pose, const Vec3& half) : pose_(pose), half_(half) {
    double apart = spacing;
    const Vec3 size = 2 * half;
    const double area = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
    apart = std::max(apart, std::sqrt(area / most_points));
    for (int k = 0; k < 3; ++k) cells_[k] = std::max(1, static_cast<int>(std::ceil(size[k] / apart)));
    known_.assign(static_cast<std::size_t>(cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1), -1);
  }

  WetMesh mesh() {
    for (int way = 0; way < 3; ++way)
      for (int end = 0; end < 2; ++end) add_side(way, end);
    return std::move(out_);
  }

 private:
  void add_side(int way, int end) {
    const int u = (way + 1) % 3, v = (way + 2) % 3;
    std::array<int, 3> at{};
    at[way] = end == 0 ? 0 : cells_[way];
    const auto corner = [&](int i, int j) {
      at[u] = i, at[v] = j;
      return point(at);
    };
    for (int i = 0; i < cells_[u]; ++i)
      for (int j = 0; j < cells_[v]; ++j) {
        Triangle one{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)};
        Triangle other{corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)};
        if (end == 0) std::swap(one[1], one[2]), std::swap(other[1], other[2]);
        out_.triangles.push_back(one);
        out_.triangles.push_back(other);
      }
  }
  int point(const std::array<int, 3>& at) {
    int& known = known_[at[0] + static_cast<std::size_t>(cells_[0] + 1) * (at[1] + (cells_[1] + 1) * at[2])];
    if (known >= 0) return known;
    known = static_cast<int>(out_.at.size());
    Vec3 local;
    for (int k = 0; k < 3; ++k) local[k] = half_[k] * (2.0 * at[k] / cells_[k] - 1);
    out_.at.push_back(pose_ * local);
    return known;
  }

  Pose pose_;
  Vec3 half_;
  std::array<int, 3> cells_{};
  std::vector<int> known_;
  WetMesh out_;
};

WetMesh grid_about(const Shape& shape) {
  if (const auto* box = std::get_if<RoundedBox>(&shape))
    return BoxGrid(box->pose, box->half + Vec3::Constant(box->radius)).mesh();
  const auto& capsule = std::get<Capsule>(shape);
  const Vec3 way = capsule.b - capsule.a;
  const Vec3 axis = way.norm() > 0 ? way.normalized() : Vec3::UnitZ(), side = axis.unitOrthogonal();
  Pose pose = Pose::Identity();
  pose.linear() << side, axis.cross(side), axis;
  pose.translation() = 0.5 * (capsule.a + capsule.b);
  return BoxGrid(pose, Vec3(capsule.radius, capsule.radius, capsule.radius + 0.5 * way.norm())).mesh();
}

WetMesh grid_on(const Plane& plane, const Vec3& about) {
  const Vec3 a = plane.normal.unitOrthogonal(), b = plane.normal.cross(a);
  const Vec3 foot = about - plane.normal * plane.normal.dot(about - plane.point);
  const int cells = static_cast<int>(2 * plane_reach / spacing);
  WetMesh out;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      out.at.emplace_back(foot + (i * spacing - plane_reach) * a + (j * spacing - plane_reach) * b);
      if (i == cells || j == cells) continue;
      const int k = i * (cells + 1) + j;
      out.triangles.push_back({k, k + cells + 1, k + cells + 2});
      out.triangles.push_back({k, k + cells + 2, k + 1});
    }
  return out;
}

}  // namespace

WetMesh wet_mesh(const std::vector<Triangle>& triangles, std::vector<double> areas) {
  WetMesh out;
  out.triangles = triangles;
  std::vector<std::vector<int>> beside(areas.size());
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      beside[t[k]].push_back(t[(k + 1) % 3]);
      beside[t[k]].push_back(t[(k + 2) % 3]);
    }
  out.begin.push_back(0);
  for (std::vector<int>& all : beside) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    out.beside.insert(out.beside.end(), all.begin(), all.end());
    out.begin.push_back(static_cast<int>(out.beside.size()));
  }
  out.areas = std::move(areas);
  return out;
}

WetMesh wet_ground(const Shape& shape, const Vec3& about) {
  const auto* plane = std::get_if<Plane>(&shape);
  WetMesh grid = plane != nullptr ? grid_on(*plane, about) : grid_about(shape);
  std::vector<Vec3> normals;
  for (Vec3& p : grid.at) {
    const DistanceSlope slope = distance_slope(shape, p);
    p -= slope.distance * slope.gradient;
    normals.push_back(slope.gradient);
  }
  std::vector<double> areas(grid.at.size(), 0.0);
  for (const Triangle& t : grid.triangles) {
    const double area = 0.5 * (grid.at[t[1]] - grid.at[t[0]]).cross(grid.at[t[2]] - grid.at[t[0]]).norm();
    for (int corner : t) areas[corner] += area / 3;
  }
  WetMesh out = wet_mesh(grid.triangles, std::move(areas));
  out.at = std::move(grid.at);
  out.normals = std::move(normals);
  return out;
}

}  // namespace calot
