#include "geometry/shapes.h"

#include <gmock/gmock.h>

#include <map>
#include <numbers>
#include <set>

#include "base/units.h"
#include "support/long_run.h"

namespace calot::test::shapes_test {
namespace {

using namespace units;

std::vector<int> valences(const TriMesh& mesh) {
  std::vector<int> count(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int node : t) ++count[node];
  return count;
}

/// Smallest and largest corner angle, rad.
std::pair<double, double> angle_range(const TriMesh& mesh) {
  double least = 4, most = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]];
      const Vec3 v = mesh.points[t[(k + 2) % 3]] - mesh.points[t[k]];
      const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  return {least, most};
}

double pear_scale(const Vec3& p) { return pear_spacing(p, 80 * mm); }

struct Case {
  std::string name;
  int nodes;
  TriMesh mesh;
};

/// Made once: they are most of the time that these tests take.
const std::vector<Case>& cases() {
  static const std::vector<Case> list = [] {
    std::vector<Case> made;
    const auto add = [&](const std::string& name, const Profile& profile, int nodes,
                         const std::function<double(const Vec3&)>& spacing) {
      made.push_back(
          {name + " of " + std::to_string(nodes), nodes, revolve(profile, nodes, spacing).value()});
    };
    for (int nodes : {12, 20, 61, 120, 238, 946}) add("sphere", sphere_profile(20 * mm), nodes, {});
    for (int nodes : {100, 120, 160, 200, 240})
      add("pear", pear_profile(80 * mm, 35 * mm), nodes, pear_scale);
    add("even pear", pear_profile(80 * mm, 35 * mm), 946, {});
    return made;
  }();
  return list;
}

TEST(Revolve, GivesAClosedSphereOfTheNodesAskedFor) {
  CALOT_SLOW_WHEN_SANITIZED("spheres of up to thousands of nodes");
  for (const auto& [name, nodes, mesh] : cases()) {
    EXPECT_EQ(mesh.points.size(), nodes) << name;
    EXPECT_EQ(mesh.triangles.size(), 2 * nodes - 4) << name << ": Euler's 2 = V - E + F with E = 3/2 F";
    const std::vector<Problem> problems = check(mesh);
    EXPECT_TRUE(problems.empty()) << name << ": " << to_text(problems.front());
  }
}

TEST(Revolve, EveryNodeHasFiveToSevenTriangles) {
  for (const auto& [name, nodes, mesh] : cases())
    EXPECT_THAT(valences(mesh), ::testing::Each(::testing::AllOf(::testing::Ge(5), ::testing::Le(7))))
        << name;
}

TEST(Revolve, TrianglesStayWellShaped) {
  for (const auto& [name, nodes, mesh] : cases()) {
    // Half the angle of an equilateral triangle; repulsion alone stays above, flips are held to 25.
    const auto [least, most] = angle_range(mesh);
    EXPECT_GT(least, 30 * deg) << name;
    EXPECT_LT(most, 110 * deg) << name;
  }
}

TEST(Revolve, NodesLieOnTheSurface) {
  const TriMesh mesh = revolve(sphere_profile(20 * mm), 61).value();
  for (const Vec3& p : mesh.points) EXPECT_NEAR(p.norm(), 20 * mm, 1e-15);
}

TEST(Revolve, IsTheSameEveryTime) {
  const Profile pear = pear_profile(80 * mm, 35 * mm);
  const TriMesh a = revolve(pear, 160, pear_scale).value(), b = revolve(pear, 160, pear_scale).value();
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Revolve, EdgesFollowTheSpacingAskedFor) {
  const Vec3 centre(0, 0, 20 * mm);
  const auto spacing = [&](const Vec3& p) {
    return 0.5 + 0.5 * std::min(1.0, (p - centre).norm() / (20 * mm));
  };
  const TriMesh mesh = revolve(sphere_profile(20 * mm), 240, spacing).value();
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.points[t[k]], &b = mesh.points[t[(k + 1) % 3]];
      const double ratio = (a - b).norm() / spacing(0.5 * (a + b));
      const bool is_near = (0.5 * (a + b) - centre).norm() < 12 * mm;
      (is_near ? near : far) += ratio;
      ++(is_near ? near_count : far_count);
    }
  // The same multiple of the spacing everywhere, but for what repulsion smooths out where the spacing
  // changes.
  EXPECT_NEAR((near / near_count) / (far / far_count), 1, 0.1);
}

TEST(Revolve, RefusesTooFewNodesAndProfilesThatAreNotClosed) {
  EXPECT_FALSE(revolve(sphere_profile(1), 11));
  EXPECT_FALSE(revolve({[](double s) { return Vec2(1, s); }}, 61)) << "a tube is open at its ends";
  EXPECT_FALSE(revolve({[](double s) { return Vec2(std::sin(2 * std::numbers::pi * s), s); }}, 61))
      << "crosses the axis";
  EXPECT_FALSE(revolve(sphere_profile(NAN), 61));
  EXPECT_FALSE(revolve(sphere_profile(-1), 61)) << "runs downward";
}

/// Integral of pi r^2 dz by trapezia in s.
double volume(const Profile& profile) {
  const int n = 20000;
  double sum = 0;
  for (int i = 1; i <= n; ++i) {
    const Vec2 a = profile.point((i - 1.0) / n), b = profile.point(static_cast<double>(i) / n);
    sum += std::numbers::pi * 0.5 * (a.x() * a.x() + b.x() * b.x()) * (b.y() - a.y());
  }
  return sum;
}

TEST(Profiles, ASphereHasItsVolume) {
  EXPECT_NEAR(volume(sphere_profile(20 * mm)) / (4 * std::numbers::pi / 3 * std::pow(20 * mm, 3)), 1, 1e-7);
}

TEST(Profiles, APearOf80By35MillimetresHoldsFortyMillilitres) {
  EXPECT_NEAR(volume(pear_profile(80 * mm, 35 * mm)), 40 * mL, 2 * mL);
}

TEST(Profiles, APearIsAsLongAndAsWideAsAskedAndItsVolumeGoesWithThem) {
  const double unit = volume(pear_profile(1, 1));
  for (const auto& [length, width] : {std::pair{80 * mm, 35 * mm}, {70 * mm, 40 * mm}, {120 * mm, 30 * mm}}) {
    const Profile pear = pear_profile(length, width);
    double widest = 0;
    for (int i = 0; i <= 100000; ++i) widest = std::max(widest, pear.point(i / 1e5).x());
    EXPECT_NEAR(2 * widest, width,
                1e-8 * width);  // the samples miss the maximum by the square of their spacing
    EXPECT_EQ(pear.point(0).y(), 0);
    EXPECT_NEAR(pear.point(1).y(), length, 1e-15);
    EXPECT_NEAR(volume(pear), unit * length * width * width, 1e-9 * volume(pear));
  }
}

TEST(Profiles, APearIsAPear) {
  const double length = 80 * mm;
  const Profile pear = pear_profile(length, 35 * mm);
  std::vector<Vec2> at;
  for (int i = 0; i <= 4000; ++i) at.push_back(pear.point(i / 4000.0));
  const auto widest = std::max_element(at.begin(), at.end(), [](auto& a, auto& b) { return a.x() < b.x(); });
  EXPECT_THAT(widest->y() / length, ::testing::AllOf(::testing::Gt(0.6), ::testing::Lt(0.66)));
  // Rising all the way, widening up to the widest place, narrowing after it.
  for (auto p = at.begin() + 1; p < at.end(); ++p) {
    EXPECT_GT(p->y(), (p - 1)->y());
    EXPECT_EQ(p->x() > (p - 1)->x(), p <= widest);
  }
  const auto diameter = [&](double share) {
    return 2 * std::find_if(at.begin(), at.end(), [&](auto& p) { return p.y() > share * length; })->x();
  };
  EXPECT_NEAR(diameter(0.08), 9 * mm, 1 * mm);  // the neck
  EXPECT_LT(diameter(0.15), 11 * mm);
}

TEST(Profiles, PolesAreRound) {
  for (const Profile& profile : {sphere_profile(20 * mm), pear_profile(80 * mm, 35 * mm)})
    for (double pole : {0.0, 1.0}) {
      // The squared radius over twice the distance from the pole is the radius of curvature: it has a limit.
      const auto curvature_radius = [&](double step) {
        const Vec2 p = profile.point(pole == 0 ? step : 1 - step);
        return p.x() * p.x() / (2 * std::abs(p.y() - profile.point(pole).y()));
      };
      EXPECT_GT(curvature_radius(1e-3), 2 * mm);
      EXPECT_NEAR(curvature_radius(1e-3) / curvature_radius(2e-3), 1, 1e-3);
    }
}

TEST(Rectangle, IsAFlatSheetOfItsAreaFacingUp) {
  const TriMesh mesh = rectangle(0.3, 0.2, 4, 3);
  EXPECT_THAT(check(mesh, {.closed = false}), ::testing::IsEmpty());
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 normal = (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
    EXPECT_GT(normal.z(), 0);
    area += 0.5 * normal.z();
  }
  EXPECT_NEAR(area, 0.06, 1e-15);
  EXPECT_EQ(mesh.points.front(), Vec3(-0.15, -0.1, 0));
}

}  // namespace
}  // namespace calot::test::shapes_test
