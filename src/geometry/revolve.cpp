// Nodes on a surface of revolution. They live on the unit sphere to which the surface maps conformally: there
// steps keep their direction, and circles stay circles in the small, so the hull there is Delaunay here.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/units.h"
#include "geometry/edge_flips.h"
#include "geometry/shapes.h"
#include "geometry/sphere_hull.h"

namespace calot {

namespace {

constexpr int kSamples = 1024;  // of the profile; nodes lie on the profile itself, whatever this is
constexpr int kSteps = 200;     // of repulsion
constexpr double kReach = 2.5;  // spacings beyond which nodes do not repel

/// A place in a table: between entries i - 1 and i, a share t of the way.
struct Between {
  std::ptrdiff_t i = 1;
  double t = 0;
};

/// Where x lies in an increasing table.
Between find(const std::vector<double>& xs, double x) {
  const auto i = std::upper_bound(xs.begin() + 1, xs.end() - 1, x) - xs.begin();
  const double width = xs[i] - xs[i - 1];
  return {i, width > 0 ? std::clamp((x - xs[i - 1]) / width, 0.0, 1.0) : 0.0};
}

double mix(const std::vector<double>& ys, const Between& at) {
  return ys[at.i - 1] + at.t * (ys[at.i] - ys[at.i - 1]);
}

/// The conformal map between the unit sphere (angle from its lower pole) and the surface, and the profile,
/// sampled.
struct ConformalMap {
  std::vector<double> s, radius, height, angle;
  std::vector<double> stretch;  ///< m on the surface per rad
  std::vector<double> area;     ///< of the surface up to s, m^2

  explicit ConformalMap(const Profile& profile)
      : s(kSamples + 1), radius(s), height(s), angle(s), stretch(s), area(s) {
    std::vector<double> mercator(s);
    for (int i = 0; i <= kSamples; ++i) {
      s[i] = static_cast<double>(i) / kSamples;
      const Vec2 at = profile.point(s[i]);
      radius[i] = at.x();
      height[i] = at.y();
    }
    for (int i = 1; i <= kSamples; ++i) {
      const double arc = std::hypot(radius[i] - radius[i - 1], height[i] - height[i - 1]);
      const double mean = 0.5 * (radius[i] + radius[i - 1]);
      area[i] = area[i - 1] + 2 * std::numbers::pi * mean * arc;
      if (i > 1 && i < kSamples) mercator[i] = mercator[i - 1] + arc / mean;
    }
    const double middle = mix(mercator, find(area, 0.5 * area.back()));
    for (int i = 1; i < kSamples; ++i) {
      angle[i] = 2 * std::atan(std::exp(mercator[i] - middle));
      stretch[i] = radius[i] / std::sin(angle[i]);
    }
    angle.back() = std::numbers::pi;
    stretch.front() = stretch[1];
    stretch.back() = stretch[kSamples - 1];
  }

  /// Whether it rises from one pole to the other and keeps off the axis between them.
  bool is_closed_surface() const {
    const double size = height.back() - height.front();
    bool good = size > 0 && std::isfinite(area.back());
    for (int i = 1; i < kSamples; ++i) good = good && radius[i] > 0 && std::isfinite(height[i]);
    constexpr double rounding = 1e-6;
    return good && std::abs(radius.front()) < rounding * size && std::abs(radius.back()) < rounding * size;
  }
};

/// Angle from the lower pole of a point on the unit sphere; exact near the poles.
double polar_angle(const Vec3& q) { return std::atan2(std::hypot(q.x(), q.y()), -q.z()); }

Vec3 on_sphere(double angle, double longitude) {
  return {std::sin(angle) * std::cos(longitude), std::sin(angle) * std::sin(longitude), -std::cos(angle)};
}

/// Unit vectors at a longitude: outward from the axis, and around it.
Vec3 outward(double longitude) { return {std::cos(longitude), std::sin(longitude), 0}; }
Vec3 around(double longitude) { return {-std::sin(longitude), std::cos(longitude), 0}; }

class Spreader {
 public:
  /// The start is a spiral; `offset` in (0, 1) shifts it along itself, which ends in another arrangement.
  Spreader(const ConformalMap& map, int nodes, const std::function<double(const Vec3&)>& spacing,
           double offset)
      : map_(map), spacing_(spacing), sphere_(nodes), place_(nodes), between_(nodes), space_(nodes) {
    start(offset);
    locate();
    for (int step = 0; step < kSteps; ++step) relax(0.15 * (1 - 0.8 * step / kSteps));
  }

  const std::vector<Vec3>& sphere() const { return sphere_; }

  std::vector<Vec3> places(const Profile& profile) const {
    std::vector<Vec3> result(sphere_.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const Vec2 p = profile.point(mix(map_.s, between_[i]));
      result[i] = p.x() * outward(turn(sphere_[i])) + p.y() * Vec3::UnitZ();
    }
    return result;
  }

 private:
  static double turn(const Vec3& q) { return std::atan2(q.y(), q.x()); }
  double spacing(const Vec3& p) const { return spacing_ ? spacing_(p) : 1.0; }

  Vec3 place(const Between& at, double longitude) const {
    return mix(map_.radius, at) * outward(longitude) + mix(map_.height, at) * Vec3::UnitZ();
  }

  /// A golden-angle spiral with equal shares of area over squared spacing; sets the unit of spacing.
  void start(double offset) {
    const int sectors = spacing_ ? 64 : 1;
    const auto longitude = [&](double sector) { return 2 * std::numbers::pi * sector / sectors; };
    std::vector<double> share(kSamples + 1, 0.0), longitudes(sectors + 1);
    std::vector<std::vector<double>> turns(kSamples + 1, std::vector<double>(sectors + 1, 0.0));
    for (int k = 0; k <= sectors; ++k) longitudes[k] = longitude(k);
    for (int i = 1; i <= kSamples; ++i) {
      for (int k = 0; k < sectors; ++k) {
        const double h = spacing(place({i, 0.5}, longitude(k + 0.5)));
        turns[i][k + 1] = turns[i][k] + 1 / (h * h);
      }
      share[i] = share[i - 1] + (map_.area[i] - map_.area[i - 1]) * turns[i].back() / sectors;
    }
    const double n = static_cast<double>(sphere_.size());
    for (std::size_t i = 0; i < sphere_.size(); ++i) {
      const Between at = find(share, share.back() * (static_cast<double>(i) + offset) / n);
      double whole = 0;
      const double fraction = std::modf(static_cast<double>(i) * std::numbers::phi, &whole);
      const auto& row = turns[at.i];
      sphere_[i] = on_sphere(mix(map_.angle, at), mix(longitudes, find(row, fraction * row.back())));
    }
    // A node of a triangular lattice of spacing h has an area of sqrt(3)/2 h^2.
    unit_ = std::sqrt(share.back() / n * 2 / std::numbers::sqrt3);
  }

  void locate() {
    for (std::size_t i = 0; i < sphere_.size(); ++i) {
      between_[i] = find(map_.angle, polar_angle(sphere_[i]));
      place_[i] = place(between_[i], turn(sphere_[i]));
      space_[i] = unit_ * spacing(place_[i]);
    }
  }

  /// Inverse-power repulsion that vanishes at kReach; every node moves along it by at most `share` spacings.
  void relax(double share) {
    std::vector<Vec3> push(sphere_.size(), Vec3::Zero());
    std::vector<int> order(sphere_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return place_[a].z() != place_[b].z() ? place_[a].z() < place_[b].z() : a < b;
    });
    const double largest = kReach * *std::max_element(space_.begin(), space_.end());
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        if (place_[order[j]].z() - place_[order[i]].z() > largest) break;
        repel(order[i], order[j], push);
      }
    }
    for (std::size_t i = 0; i < sphere_.size(); ++i) move(static_cast<int>(i), share, push[i]);
    locate();
  }

  void repel(int a, int b, std::vector<Vec3>& push) const {
    const Vec3 gap = place_[b] - place_[a];
    const double wanted = 0.5 * (space_[a] + space_[b]), squared = gap.squaredNorm();
    if (squared == 0 || squared > kReach * kReach * wanted * wanted) return;
    const double ratio2 = wanted * wanted / squared;
    const double strength = ratio2 * ratio2 - 1 / (kReach * kReach * kReach * kReach);
    const Vec3 force = strength / std::sqrt(squared) * gap;
    push[a] -= force;
    push[b] += force;
  }

  void move(int i, double share, const Vec3& push) {
    const Between& at = between_[i];
    const double angle = polar_angle(sphere_[i]);
    const Vec3 out = outward(turn(sphere_[i])), round = around(turn(sphere_[i]));
    const Vec2 along =
        Vec2(map_.radius[at.i] - map_.radius[at.i - 1], map_.height[at.i] - map_.height[at.i - 1])
            .normalized();
    Vec2 step(push.dot(along.x() * out + along.y() * Vec3::UnitZ()), push.dot(round));
    step *= share;
    if (step.norm() > share) step *= share / step.norm();
    step *= space_[i] / mix(map_.stretch, at);
    const Vec3 meridian = std::cos(angle) * out + std::sin(angle) * Vec3::UnitZ();
    sphere_[i] = (sphere_[i] + step.x() * meridian + step.y() * round).normalized();
  }

  const ConformalMap& map_;
  const std::function<double(const Vec3&)>& spacing_;
  std::vector<Vec3> sphere_, place_;
  std::vector<Between> between_;
  std::vector<double> space_;
  double unit_ = 1;  ///< m of spacing per unit of spacing()
};

/// Points with fewer than 5 or more than 7 triangles: there the limit surface's curvature is least well
/// behaved.
int count_odd_valences(const TriMesh& mesh) {
  std::vector<int> valence(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int node : t) ++valence[node];
  return static_cast<int>(
      std::count_if(valence.begin(), valence.end(), [](int v) { return v < 5 || v > 7; }));
}

}  // namespace

Result<TriMesh> revolve(const Profile& profile, int nodes,
                        const std::function<double(const Vec3&)>& spacing) {
  if (nodes < 12) {
    return fail(FailureKind::scenario, fmt::format("{} nodes cannot carry a closed smooth surface", nodes),
                "ask for 12 or more");
  }
  const ConformalMap map(profile);
  if (!map.is_closed_surface()) {
    return fail(FailureKind::scenario, "the profile is not a closed surface of revolution",
                "it must rise from radius 0 to radius 0 with a positive, finite radius between");
  }
  TriMesh best;
  for (double offset : {0.5, 0.3, 0.7}) {
    const Spreader spreader(map, nodes, spacing, offset);
    auto hull = sphere_hull(spreader.sphere());
    if (!hull) return hull.failure();
    TriMesh mesh{spreader.places(profile), std::move(hull).value()};
    even_valences(mesh, 25 * units::deg);
    if (best.points.empty() || count_odd_valences(mesh) < count_odd_valences(best)) best = std::move(mesh);
    if (count_odd_valences(best) == 0) break;
  }
  return best;
}

}  // namespace calot
