#include "fem/bile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "fem/assembly.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot {
namespace {

constexpr double weight = 1020 * 9.80665;  // N/m^3
const Vec3 up = Vec3(0.2, -0.3, 0.9).normalized();

struct Body {
  Tessellation surface;
  VecX rest;
  Bile bile;
  BlockMatrix matrix;
  Vec3 datum;
};

/// The rule that structures use, on a tessellation with 4 consecutive triangles a face: 4/3 of these less 1/3 of the
/// whole face, whose corners are the points that one of the four alone has.
BileSurface extrapolated(const Tessellation& surface) {
  BileSurface out;
  out.points = surface.stencils;
  for (std::size_t first = 0; first < surface.triangles.size(); first += 4) {
    std::vector<BileSurface::Part> cell;
    std::map<int, int> uses;
    for (std::size_t t = first; t < first + 4; ++t) {
      cell.push_back({surface.triangles[t], 4.0 / 3.0});
      for (int p : surface.triangles[t]) ++uses[p];
    }
    std::vector<int> corners;  // in the face's sense, which each of the four has
    for (const BileSurface::Part& part : cell)
      for (int p : part.corners)
        if (uses[p] == 1) corners.push_back(p);
    EXPECT_EQ(corners.size(), 3u);
    cell.push_back({{corners[0], corners[1], corners[2]}, -1.0 / 3.0});
    out.cells.push_back(std::move(cell));
  }
  return out;
}

Body make_body(const TriMesh& mesh, const Vec3& datum) {
  const LoopSurface surface = LoopSurface::create(mesh).value();
  Tessellation skin = surface.tessellate(2);
  Bile bile = Bile::create(extrapolated(skin), weight, up, datum).value();
  BlockMatrix matrix(surface.nodes(), bile.cliques());
  return {std::move(skin), to_coordinates(mesh.points), std::move(bile), std::move(matrix), datum};
}

std::vector<Body> bodies() {
  std::vector<Body> out;
  out.push_back(make_body(test::sphere(14), {1e-3, 2e-3, -3e-3}));
  out.push_back(make_body(test::pear(30), {0, 0, 50e-3}));
  return out;
}

VecX deformed(const Body& body, Rng& rng) {
  return body.rest + test::random_coordinates(rng, static_cast<int>(body.rest.size()), 2e-3);
}

/// Volume and centroid of the tetrahedra between the summed triangles and a point.
struct Content {
  double volume = 0;
  Vec3 centroid = Vec3::Zero();
};
Content content(const Body& body, const VecX& x) {
  const std::vector<Vec3> p = blend_all(body.surface.stencils, body.surface.stencils.value, x);
  const Vec3 apex = p.front();
  Content out;
  for (const auto& [t, local, share] : body.bile.parts()) {
    const double v = share * (p[t[0]] - apex).dot((p[t[1]] - apex).cross(p[t[2]] - apex)) / 6;
    out.volume += v;
    out.centroid += v * (p[t[0]] + p[t[1]] + p[t[2]] + apex) / 4;
  }
  out.centroid /= out.volume;
  return out;
}

VecX load(const Bile& bile, const VecX& x, double datum_pressure) {
  VecX f = VecX::Zero(x.size());
  bile.add_load(x, datum_pressure, f);
  return f;
}
VecX volume_gradient(const Bile& bile, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  bile.add_volume_gradient(x, g);
  return g;
}

TEST(Bile, VolumeAndWeightAreThoseOfTheEnclosedLiquid) {
  Rng rng(1);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const Content inside = content(body, x);
    EXPECT_NEAR(body.bile.volume(x), inside.volume, 1e-13 * inside.volume);
    EXPECT_NEAR(body.bile.value(x), weight * inside.volume * up.dot(inside.centroid - body.datum),
                1e-12 * weight * inside.volume * 0.1);
    VecX g = VecX::Zero(x.size());
    // The same sum, rounded otherwise.
    EXPECT_NEAR(body.bile.add_volume_gradient(x, g), body.bile.volume(x), 1e-13 * body.bile.volume(x));
  }
}

TEST(Bile, VolumeOfASphereConvergesToTheClosedFormWithTheFourthPowerOfTheEdges) {
  const double exact = 4.0 / 3.0 * M_PI * std::pow(20e-3, 3);
  const auto error = [&](int nodes) {
    const Body body = make_body(test::sphere(nodes), Vec3::Zero());
    return std::abs(body.bile.volume(body.rest) / exact - 1);
  };
  const double coarse = error(61), fine = error(238);
  // Edges are halved: a sixteenth. The limit surface itself is no exact sphere (and errs by the same order),
  // and the meshes are not nested, hence the slack.
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, coarse / 8);
  EXPECT_GT(fine, 0);
}

TEST(Bile, LoadAndVolumeGradientAreTheDerivativesOfTheirEnergies) {
  Rng rng(2);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const double datum_pressure = 1500;
    const auto energy = [&](const VecX& y) {
      return body.bile.value(y) - datum_pressure * body.bile.volume(y);
    };
    const auto volume = [&](const VecX& y) { return body.bile.volume(y); };
    // Cubic and quartic polynomials of x: differences are wrong by (h / size)^2 = 1e-9 and by rounding.
    EXPECT_LT(
        test::relative_error(load(body.bile, x, datum_pressure), test::difference_gradient(energy, x, 1e-6)),
        1e-7);
    EXPECT_LT(test::relative_error(volume_gradient(body.bile, x), test::difference_gradient(volume, x, 1e-6)),
              1e-7);
    VecX both_load = VecX::Zero(x.size()), both_gradient = both_load;
    EXPECT_NEAR(body.bile.add_load_and_volume_gradient(x, datum_pressure, both_load, both_gradient),
                body.bile.volume(x), 1e-13 * body.bile.volume(x));  // the same sum, rounded otherwise
    EXPECT_EQ(both_load, load(body.bile, x, datum_pressure));
    EXPECT_EQ(both_gradient, volume_gradient(body.bile, x));
  }
}

TEST(Bile, HessianIsTheDerivativeOfTheLoadAndSymmetric) {
  Rng rng(3);
  for (Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    for (double datum_pressure : {0.0, 1500.0}) {
      body.matrix.set_zero();
      body.bile.add_hessian(x, datum_pressure, body.matrix);
      const Eigen::MatrixXd by_difference = test::difference_hessian(
          [&](const VecX& y) { return load(body.bile, y, datum_pressure); }, x, 1e-6);
      EXPECT_LT(test::relative_error(test::dense(body.matrix), by_difference), 1e-7);
      const Eigen::MatrixXd kept = test::stored(body.matrix);
      EXPECT_GT(kept.norm(), 0);
      for (int i = 0; i < kept.rows(); i += 3) {
        const Mat3 block = kept.block<3, 3>(i, i);
        EXPECT_LT((block - block.transpose()).norm(), 1e-13 * kept.norm());
      }
    }
  }
}

TEST(Bile, HessianHasTheSameBitsWhateverTheThreads) {
  for (int threads : {1, 2, 3}) {
    Workers workers(threads);
    Assembly assembly(workers);
    for (Body& body : bodies()) {
      body.matrix.set_zero();
      body.bile.add_hessian(body.rest, 800, body.matrix);
      BlockMatrix shared = body.matrix.pattern_only().blank();
      body.bile.add_hessian(body.rest, 800, shared, &assembly);
      EXPECT_EQ(shared.entries(), body.matrix.entries()) << threads;
    }
  }
}

TEST(Bile, NetLoadIsItsWeightAtTheCentreOfBuoyancy) {
  Rng rng(4);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const Content inside = content(body, x);
    for (double datum_pressure : {0.0, 1600.0}) {
      // The gradient is minus the load on the wall: the liquid pulls down with its weight, whatever its
      // pressure.
      const VecX f = -load(body.bile, x, datum_pressure);
      const double scale = weight * inside.volume;
      const double rounding = 1e-13 * (scale + 1600 * 4e-3);  // pressure times area is what cancels
      EXPECT_LT((test::net_force(f) + scale * up).norm(), rounding);
      EXPECT_LT(test::net_torque(x, f, inside.centroid).norm(), rounding * 80e-3);
    }
  }
}

TEST(Bile, PressureAloneHasNoNetForceAndNoTorque) {
  Rng rng(5);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const VecX g = volume_gradient(body.bile, x);
    EXPECT_LT(test::net_force(g).norm(), 1e-13 * g.norm());
    EXPECT_LT(test::net_torque(x, g, Vec3::Zero()).norm(), 1e-13 * g.norm() * 80e-3);
  }
}

TEST(Bile, PressureGrowsWithDepthByTheSpecificWeight) {
  Rng rng(6);
  for (const Body& body : bodies()) {
    EXPECT_EQ(body.bile.specific_weight(), weight);
    EXPECT_EQ(body.bile.weight().up, up);
    const VecX x = deformed(body, rng);
    const std::vector<Vec3> skin = blend_all(body.surface.stencils, body.surface.stencils.value, x);
    const double datum_pressure = 1200, top = body.bile.pressure_at_top(x, datum_pressure);
    double least = INFINITY;
    for (const Vec3& p : skin) {
      const double deeper = body.bile.pressure_at(p - 7e-3 * up, datum_pressure);
      const double aside = body.bile.pressure_at(p + up.unitOrthogonal() * 7e-3, datum_pressure);
      const double pressure = body.bile.pressure_at(p, datum_pressure);
      EXPECT_NEAR(deeper - pressure, weight * 7e-3, 1e-10 * datum_pressure);
      EXPECT_NEAR(aside, pressure, 1e-10 * datum_pressure);
      least = std::min(least, pressure);
    }
    EXPECT_NEAR(top, least, 1e-12 * datum_pressure);
  }
}

TEST(Bile, LoadIsThePressureOnEachTriangle) {
  // The integral of pressure times outward normal times corner function, which is linear times linear.
  Rng rng(7);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const double datum_pressure = 1500;
    const std::vector<Vec3> skin = blend_all(body.surface.stencils, body.surface.stencils.value, x);
    std::vector<Vec3> by_point(skin.size(), Vec3::Zero());
    for (const auto& [t, local, share] : body.bile.parts()) {
      const Vec3 area = 0.5 * share * (skin[t[1]] - skin[t[0]]).cross(skin[t[2]] - skin[t[0]]);
      double sum = 0;
      for (int corner : t) sum += body.bile.pressure_at(skin[corner], datum_pressure);
      for (int corner : t)
        by_point[corner] += area * (sum + body.bile.pressure_at(skin[corner], datum_pressure)) / 12;
    }
    VecX expected = VecX::Zero(x.size());
    spread(body.surface.stencils, by_point, expected);
    EXPECT_LT(test::relative_error(-load(body.bile, x, datum_pressure), expected), 1e-12);
  }
}

TEST(Bile, VolumeGradientIntegratesToTheChangeOfVolume) {
  Rng rng(8);
  for (const Body& body : bodies()) {
    const VecX step = deformed(body, rng) - body.rest;
    const auto rate = [&](double s) { return volume_gradient(body.bile, body.rest + s * step).dot(step); };
    // The volume is cubic along a line, its rate quadratic: Simpson's rule is exact.
    const double by_gradient = (rate(0) + 4 * rate(0.5) + rate(1)) / 6;
    const double change = body.bile.volume(body.rest + step) - body.bile.volume(body.rest);
    EXPECT_NEAR(by_gradient, change, 1e-12 * body.bile.volume(body.rest));
  }
}

const Vec3 aside(4e3, -7e3, -2e3);  // N/m^3: of a liquid that is pushed about

TEST(Bile, AWeightToAnySideIsThatOfALiquidThatHasIt) {
  Rng rng(10);
  for (Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const LiquidWeight other = LiquidWeight::pulling(aside);
    EXPECT_LT((other.vector() - aside).norm(), 1e-12 * aside.norm());
    const Bile bile = Bile::create(extrapolated(body.surface), other.size, other.up, body.datum).value();
    const double datum_pressure = 900;
    EXPECT_EQ(body.bile.value(x, other), bile.value(x));
    VecX own_load = VecX::Zero(x.size()), own_volume = own_load, next = own_load, next_volume = own_load;
    body.bile.add_load(x, datum_pressure, other, own_load);
    EXPECT_EQ(own_load, load(bile, x, datum_pressure));
    body.bile.add_load_and_volume_gradient(x, datum_pressure, other, next, next_volume);
    EXPECT_EQ(next, own_load);
    EXPECT_EQ(next_volume, volume_gradient(bile, x));
    BlockMatrix matrix = body.matrix;
    body.matrix.set_zero();
    matrix.set_zero();
    body.bile.add_hessian(x, datum_pressure, other, body.matrix);
    bile.add_hessian(x, datum_pressure, matrix);
    EXPECT_EQ(test::stored(body.matrix), test::stored(matrix));
    const Vec3 at = x.head<3>();
    EXPECT_EQ(body.bile.pressure_at(at, datum_pressure, other), bile.pressure_at(at, datum_pressure));
    EXPECT_NEAR(body.bile.pressure_at(at, datum_pressure, other), datum_pressure + aside.dot(at - body.datum),
                1e-9);
  }
  EXPECT_EQ(LiquidWeight::pulling(Vec3::Zero()).vector(), Vec3::Zero());
}

TEST(Bile, TheFirstMomentIsTheCentroidTimesTheVolumeAndItsDerivativesAreAWeights) {
  Rng rng(11);
  for (Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const Content inside = content(body, x);
    const LiquidMoments moments = body.bile.moments(x);
    EXPECT_EQ(moments.volume, body.bile.volume(x));
    EXPECT_LT((moments.first / inside.volume - (inside.centroid - body.datum)).norm(), 1e-13);
    const Eigen::MatrixX3d gradients = body.bile.moment_gradients(x);
    for (int c = 0; c < 3; ++c) {
      const VecX by_difference =
          test::difference_gradient([&](const VecX& y) { return body.bile.moments(y).first[c]; }, x, 1e-6);
      EXPECT_LT(test::relative_error(gradients.col(c), by_difference), 1e-7) << c;
    }
    const LiquidWeight other = LiquidWeight::pulling(aside);
    EXPECT_NEAR(body.bile.value(x, other), -aside.dot(moments.first),
                1e-12 * aside.norm() * moments.first.norm());
    VecX by_weight = VecX::Zero(x.size());
    body.bile.add_load(x, 0, other, by_weight);
    EXPECT_LT(test::relative_error(-gradients * aside, by_weight), 1e-12);
    body.matrix.set_zero();
    body.bile.add_hessian(x, 0, other, body.matrix);
    const Eigen::MatrixXd second = test::difference_hessian(
        [&](const VecX& y) { return VecX(-body.bile.moment_gradients(y) * aside); }, x, 1e-6);
    EXPECT_GT(second.norm(), 0);
    EXPECT_LT(test::relative_error(test::dense(body.matrix), second), 1e-7);
  }
}

TEST(Bile, RigidMotionTurnsThePressuresLoadAndLiftsTheWeight) {
  Rng rng(9);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const Pose motion = test::random_motion(rng, 0.1);
    const VecX elsewhere = test::moved(motion, x);
    const double volume = body.bile.volume(x);
    EXPECT_NEAR(body.bile.volume(elsewhere), volume, 1e-12 * volume * 10);  // 10: how far it went
    EXPECT_LT(test::relative_error(volume_gradient(body.bile, elsewhere),
                                   test::turned(motion.linear(), volume_gradient(body.bile, x))),
              1e-11);
    const double lift = up.dot(content(body, elsewhere).centroid - content(body, x).centroid);
    EXPECT_NEAR(body.bile.value(elsewhere) - body.bile.value(x), weight * volume * lift,
                1e-11 * weight * volume * 0.1);
  }
}

}  // namespace
}  // namespace calot
