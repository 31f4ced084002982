#include "fem/shell.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/areas.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot::shell_test {
namespace {

struct Body {
  TriMesh mesh;
  VecX rest;
  Shell shell;
  BlockMatrix matrix;
};

Body make_body(const TriMesh& mesh, const ShellMaterial& material, const std::vector<QuadraturePoint>& rule) {
  const LoopSurface surface = LoopSurface::create(mesh).value();
  std::vector<Vec2> places;
  for (const QuadraturePoint& q : rule) places.emplace_back(q.u, q.v);
  const StencilTable table =
      surface.evaluate(test::at_all_faces(surface.faces(), places), material.bends ? 2 : 1);
  const VecX rest = to_coordinates(mesh.points);
  Shell shell = Shell::create(face_by_face(table, rule), rest, material).value();
  BlockMatrix matrix(surface.nodes(), shell.cliques());
  return {mesh, rest, std::move(shell), std::move(matrix)};
}

Body make_body(const TriMesh& mesh, bool bends, const std::vector<QuadraturePoint>& rule) {
  return make_body(mesh, ShellMaterial{{100e3, 2e-3}, {100e3, 2e-3}, bends}, rule);
}

/// A stiffening wall with fibres that are oblique to everything.
ShellMaterial fibrous(bool bends, double angle = 0.6, const Vec3& axis = {0.5, 0.3, 1}) {
  ShellMaterial material{{100e3, 2e-3, 1.5}, {100e3, 2e-3}, bends};
  material.fibres = FibreLayout{{50e3, 0.8, 2e-3}, angle, axis};
  return material;
}

/// A closed and an open surface with irregular nodes, with and without bending and fibres.
std::vector<Body> bodies() {
  std::vector<Body> out;
  TriMesh sheet = rectangle(30e-3, 20e-3, 3, 2);
  Rng rng(7);
  for (Vec3& p : sheet.points) p += test::random_vector(rng, 1e-3);
  for (bool bends : {false, true}) {
    out.push_back(make_body(test::sphere(20), bends, three_point_rule()));
    out.push_back(make_body(sheet, bends, six_point_rule()));
    out.push_back(make_body(test::sphere(20), fibrous(bends), three_point_rule()));
    out.push_back(make_body(sheet, fibrous(bends), six_point_rule()));
  }
  return out;
}

VecX gradient_of(const Shell& shell, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  shell.add_gradient(x, g);
  return g;
}

/// Nodes some 15 mm apart, moved by up to 2 mm each way.
VecX deformed(const Body& body, Rng& rng) {
  return body.rest + test::random_coordinates(rng, static_cast<int>(body.rest.size()), 2e-3);
}

TEST(Shell, GradientIsTheDerivativeOfTheEnergy) {
  Rng rng(1);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const VecX by_difference =
        test::difference_gradient([&](const VecX& y) { return body.shell.value(y); }, x, 1e-7);
    // Central differences: (h / element)^2 = 1e-10 and rounding of the energy / h = 1e-8 of the forces.
    EXPECT_LT(test::relative_error(gradient_of(body.shell, x), by_difference), 1e-6);
  }
}

TEST(Shell, HessianIsTheDerivativeOfTheGradientAndSymmetric) {
  Rng rng(2);
  for (Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    body.matrix.set_zero();
    body.shell.add_hessian(x, body.matrix);
    const Eigen::MatrixXd by_difference =
        test::difference_hessian([&](const VecX& y) { return gradient_of(body.shell, y); }, x, 1e-7);
    EXPECT_LT(test::relative_error(test::dense(body.matrix), by_difference), 1e-6);
    const Eigen::MatrixXd kept = test::stored(body.matrix);
    EXPECT_GT(kept.norm(), 0);
    for (int i = 0; i < kept.rows(); i += 3) {
      const Mat3 block = kept.block<3, 3>(i, i);
      EXPECT_LT((block - block.transpose()).norm(), 1e-13 * kept.norm());
    }
  }
}

TEST(Shell, HessianHasTheSameBitsWhateverTheThreads) {
  Rng rng(3);
  std::vector<Body> all = bodies();
  all.push_back(
      make_body(test::sphere(238), fibrous(true), three_point_rule()));  // more than one filling of the cache
  for (int threads : {1, 2, 3}) {
    Workers workers(threads);
    Assembly assembly(workers);
    for (Body& body : all) {
      const VecX x = deformed(body, rng);
      body.matrix.set_zero();
      body.shell.add_hessian(x, body.matrix);
      BlockMatrix shared = body.matrix.pattern_only().blank();
      body.shell.add_hessian(x, shared, &assembly);
      EXPECT_EQ(shared.entries(), body.matrix.entries()) << threads;
    }
  }
}

TEST(Shell, RigidMotionChangesNoEnergyAndTurnsTheForces) {
  Rng rng(3);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const Pose motion = test::random_motion(rng, 0.1);
    const VecX elsewhere = test::moved(motion, x);
    const VecX here = gradient_of(body.shell, x), there = gradient_of(body.shell, elsewhere);
    // Coordinates of 0.1 m are rounded at 1e-17 m, 1e-14 of an element.
    EXPECT_NEAR(body.shell.value(elsewhere), body.shell.value(x), 1e-12 * body.shell.value(x));
    EXPECT_LT(test::relative_error(there, test::turned(motion.linear(), here)), 1e-11);
    EXPECT_NEAR(body.shell.max_stretch(elsewhere), body.shell.max_stretch(x), 1e-12);
  }
}

TEST(Shell, ForcesOfAFreeBodyBalance) {
  Rng rng(4);
  for (const Body& body : bodies()) {
    const VecX x = deformed(body, rng);
    const VecX f = gradient_of(body.shell, x);
    const double scale = f.norm();
    EXPECT_LT(test::net_force(f).norm(), 1e-12 * scale);
    EXPECT_LT(test::net_torque(x, f, Vec3::Zero()).norm(), 1e-12 * scale * 20e-3);
  }
}

TEST(Shell, RestHoldsNoEnergyAndNoForce) {
  for (const Body& body : bodies()) {
    const double scale = 100e3 * 2e-3 * test::rest_area(body.shell);  // J at a strain of order 1
    EXPECT_NEAR(body.shell.value(body.rest), 0, 1e-13 * scale);
    EXPECT_LT(gradient_of(body.shell, body.rest).norm(), 1e-11 * scale / 20e-3);
    EXPECT_NEAR(body.shell.max_stretch(body.rest), 1.0, 1e-6);  // a root of rounding
  }
}

TEST(Shell, MembraneOfASheetBentWithoutStretchHoldsOnlyBendingEnergy) {
  // Bending can be left out, and is not when it is asked for: a flat sheet rolled in x.
  const TriMesh sheet = rectangle(30e-3, 20e-3, 12, 8);
  VecX rolled = to_coordinates(sheet.points);
  const double radius = 30e-3;
  for (int i = 0; i < rolled.size(); i += 3) {
    const double angle = rolled[i] / radius;
    rolled[i] = radius * std::sin(angle);
    rolled[i + 2] = radius * (1 - std::cos(angle));
  }
  const double membrane = make_body(sheet, false, three_point_rule()).shell.value(rolled);
  const double both = make_body(sheet, true, three_point_rule()).shell.value(rolled);
  EXPECT_GT(both, 50 * membrane);
}

/// Energy a unit area of a sheet stretched in its plane.
double energy_density(const Eigen::Matrix2d& f) {
  const double det = f.determinant();
  return 0.5 * 100e3 * 2e-3 * ((f.transpose() * f).trace() + 1 / (det * det) - 3);
}

VecX mapped(const VecX& x, const Eigen::Matrix2d& f) {
  VecX y = x;
  for (int i = 0; i < y.size(); i += 3) y.segment<2>(i) = (f * x.segment<2>(i)).eval();
  return y;
}

/// Largest nodal force on nodes whose basis functions vanish at the boundary, and on all.
std::pair<double, double> inner_and_outer_force(const Body& body, const VecX& x, double half_width,
                                                double half_height, double inset) {
  const VecX f = gradient_of(body.shell, x);
  double inner = 0, outer = 0;
  for (int i = 0; i < f.size(); i += 3) {
    const bool inside =
        std::abs(body.rest[i]) < half_width - inset && std::abs(body.rest[i + 1]) < half_height - inset;
    outer = std::max(outer, f.segment<3>(i).norm());
    if (inside) inner = std::max(inner, f.segment<3>(i).norm());
  }
  return {inner, outer};
}

TEST(Shell, ConstantStrainPatchIsExactOnARegularSheet) {
  Eigen::Matrix2d f;
  f << 1.3, 0.2, -0.1, 0.9;
  const TriMesh sheet = rectangle(80e-3, 60e-3, 8, 6);
  for (bool bends : {false, true}) {
    for (const auto& rule : {three_point_rule(), six_point_rule()}) {
      const Body body = make_body(sheet, bends, rule);
      const VecX x = mapped(body.rest, f);
      EXPECT_NEAR(test::rest_area(body.shell), 80e-3 * 60e-3, 1e-12 * 80e-3 * 60e-3);
      EXPECT_NEAR(body.shell.value(x), energy_density(f) * 80e-3 * 60e-3,
                  1e-12 * energy_density(f) * 80e-3 * 60e-3);
      const auto [inner, outer] = inner_and_outer_force(body, x, 40e-3, 30e-3, 15e-3);
      EXPECT_GT(outer, 0);
      EXPECT_LT(inner, 1e-12 * outer);
    }
  }
}

TEST(Shell, ConstantStrainPatchOnAnIrregularSheetIsExactInEnergyAndBalancedToQuadrature) {
  Eigen::Matrix2d f;
  f << 1.3, 0.2, -0.1, 0.9;
  TriMesh sheet = rectangle(80e-3, 60e-3, 8, 6);
  // Flipping a cell's diagonal makes nodes of valence 5 and 7; each cell is two triangles (a, b, c), (a, c,
  // d).
  for (int cell : {8 * 2 + 3, 8 * 3 + 5}) {
    Triangle &one = sheet.triangles[2 * cell], &two = sheet.triangles[2 * cell + 1];
    one = {one[0], one[1], two[2]};
    two = {one[1], two[1], two[2]};
  }
  Rng rng(5);
  for (Vec3& p : sheet.points) {
    const bool inside = std::abs(p.x()) < 39e-3 && std::abs(p.y()) < 29e-3;
    if (inside) p += Vec3(rng.uniform(-2e-3, 2e-3), rng.uniform(-2e-3, 2e-3), 0);
  }
  double inner_of_rule[2] = {0, 0};
  for (int k = 0; k < 2; ++k) {
    const Body body = make_body(sheet, true, k == 0 ? three_point_rule() : six_point_rule());
    const VecX x = mapped(body.rest, f);
    // An affine map of control points maps the limit surface alike: the strain is constant to rounding.
    EXPECT_NEAR(body.shell.value(x), energy_density(f) * test::rest_area(body.shell),
                1e-12 * energy_density(f) * test::rest_area(body.shell));
    // Interior forces vanish as far as the rule integrates products of the basis' derivatives. (Where all
    // valences are six they vanish to rounding under any symmetric rule.)
    const auto [inner, outer] = inner_and_outer_force(body, x, 40e-3, 30e-3, 15e-3);
    inner_of_rule[k] = inner / outer;
  }
  RecordProperty("inner_force_three_points", fmt::format("{:.3g}", inner_of_rule[0]));
  RecordProperty("inner_force_six_points", fmt::format("{:.3g}", inner_of_rule[1]));
  EXPECT_LT(inner_of_rule[0], 1e-2);
  EXPECT_LT(inner_of_rule[1], 0.5 * inner_of_rule[0]);
}

/// A flat irregular sheet, its nodes displaced in its plane.
TriMesh irregular_sheet() {
  TriMesh sheet = rectangle(80e-3, 60e-3, 8, 6);
  Rng rng(8);
  for (Vec3& p : sheet.points) p += Vec3(rng.uniform(-2e-3, 2e-3), rng.uniform(-2e-3, 2e-3), 0);
  return sheet;
}

/// What one family of fibrous() adds to the energy a unit area at the stretch squared I4.
double fibre_density(double i4) {
  const double y = std::max(0.0, i4 - 1);
  return 2e-3 * 50e3 / (2 * 0.8) * std::expm1(0.8 * y * y);
}

TEST(Shell, FibresOfAFlatSheetRunAtTheirAngleFromTheProjectedAxis) {
  Eigen::Matrix2d f;
  f << 1.3, 0.2, -0.1, 1.1;
  const Vec3 axis = Vec3(1, 2, 1).normalized();
  const double projected = axis.head<2>().norm(), turn = std::atan2(axis.y(), axis.x());
  for (double angle : {0.0, 0.6, 0.5 * M_PI}) {
    const Body body = make_body(irregular_sheet(), fibrous(false, angle, 3 * axis), three_point_rule());
    ShellMaterial plain = fibrous(false);
    plain.fibres.reset();
    const Body bare = make_body(irregular_sheet(), plain, three_point_rule());
    const VecX x = mapped(body.rest, f);
    double density = 0;
    for (double side : {angle, -angle})
      density +=
          fibre_density((f * Eigen::Vector2d(std::cos(turn + side), std::sin(turn + side))).squaredNorm());
    const double expected = projected * projected * density * test::rest_area(body.shell);
    EXPECT_GT(expected, 0);
    // The isotropic energy, which the difference cancels, is rounded at 1e-14 of itself.
    EXPECT_NEAR(body.shell.value(x) - bare.shell.value(x), expected, 1e-12 * bare.shell.value(x));
  }
}

TEST(Shell, FibresCarryNothingInASheetThatShrinksOnAllSides) {
  ShellMaterial plain = fibrous(true);
  plain.fibres.reset();
  const Body body = make_body(irregular_sheet(), fibrous(true), three_point_rule());
  const Body bare = make_body(irregular_sheet(), plain, three_point_rule());
  const VecX x = 0.9 * body.rest;
  EXPECT_GT(body.shell.value(x), 0);
  EXPECT_EQ(body.shell.value(x), bare.shell.value(x));
  EXPECT_EQ(gradient_of(body.shell, x), gradient_of(bare.shell, x));
}

TEST(Shell, FibresFadeWhereTheAxisMeetsTheSurfaceAtRightAngles) {
  // A sheet across the axis is all pole: no direction, no fibres, and nothing undefined.
  ShellMaterial plain = fibrous(true);
  plain.fibres.reset();
  const Body body = make_body(irregular_sheet(), fibrous(true, 0.6, Vec3::UnitZ()), three_point_rule());
  const Body bare = make_body(irregular_sheet(), plain, three_point_rule());
  const VecX x = 1.2 * body.rest;
  // An axis off the normal by rounding, 1e-16, leaves the square of it.
  EXPECT_NEAR(body.shell.value(x), bare.shell.value(x), 1e-14 * bare.shell.value(x));
  EXPECT_TRUE(gradient_of(body.shell, x).allFinite());
}

TEST(Shell, FibresOfAGrowingSphereHoldTwoThirdsOfTheEnergyTheyHadWithoutFading) {
  // At stretch L every fibre has I4 = L^2, and |p|^2 = sin^2 of the polar angle has the mean 2 / 3.
  const double stretch = 1.2;
  std::vector<double> errors;
  for (int nodes : {40, 160}) {
    ShellMaterial plain = fibrous(false);
    plain.fibres.reset();
    const Body body = make_body(test::sphere(nodes), fibrous(false), three_point_rule());
    const Body bare = make_body(test::sphere(nodes), plain, three_point_rule());
    const VecX x = stretch * body.rest;
    const double exact = 2.0 / 3.0 * 2 * fibre_density(stretch * stretch) * test::rest_area(body.shell);
    errors.push_back(std::abs((body.shell.value(x) - bare.shell.value(x)) / exact - 1));
  }
  // Measured 4.0e-4 and 2.3e-5: the quadrature's order, 4 in the mesh size, which is halved.
  EXPECT_LT(errors[0], 1e-3);
  EXPECT_LT(errors[1], errors[0] / 8);
}

TEST(Shell, FibresTurnWithTheRestShapeAndItsAxis) {
  Rng rng(9);
  const Vec3 axis(0.5, 0.3, 1);
  const Pose motion = test::random_motion(rng, 0.1);
  TriMesh here = test::sphere(20), there = here;
  for (Vec3& p : there.points) p = motion * p;
  const Body one = make_body(here, fibrous(true, 0.6, axis), three_point_rule());
  const Body other = make_body(there, fibrous(true, 0.6, motion.linear() * axis), three_point_rule());
  const VecX x = deformed(one, rng);
  // Coordinates of 0.1 m are rounded at 1e-17 m, 1e-14 of an element.
  EXPECT_NEAR(other.shell.value(test::moved(motion, x)), one.shell.value(x), 1e-12 * one.shell.value(x));
  // It is the axis that must turn along: with the first one's, the fibres would lie elsewhere.
  const Body left_behind = make_body(there, fibrous(true, 0.6, axis), three_point_rule());
  EXPECT_GT(std::abs(left_behind.shell.value(test::moved(motion, x)) / one.shell.value(x) - 1), 1e-3);
}

TEST(Shell, FibresWithoutAnAxisAreRefused) {
  const TriMesh sheet = rectangle(30e-3, 20e-3, 3, 2);
  const LoopSurface surface = LoopSurface::create(sheet).value();
  const StencilTable table = surface.evaluate(test::at_all_faces(surface.faces(), {{0.3, 0.3}}), 2);
  const Result<Shell> shell = Shell::create(face_by_face(table, {{0.3, 0.3, 0.5}}),
                                            to_coordinates(sheet.points), fibrous(true, 0.6, Vec3::Zero()));
  ASSERT_FALSE(shell);
  EXPECT_EQ(shell.failure().kind, FailureKind::scenario);
}

TEST(Shell, DegenerateRestIsRefused) {
  TriMesh sheet = rectangle(30e-3, 20e-3, 3, 2);
  const LoopSurface surface = LoopSurface::create(sheet).value();
  const StencilTable table = surface.evaluate(test::at_all_faces(surface.faces(), {{0.3, 0.3}}), 2);
  for (Vec3& p : sheet.points) p.y() = 0;
  const Result<Shell> shell =
      Shell::create(face_by_face(table, {{0.3, 0.3, 0.5}}), to_coordinates(sheet.points), {});
  ASSERT_FALSE(shell);
  EXPECT_EQ(shell.failure().kind, FailureKind::scenario);
}

TEST(Shell, CollapsedSurfaceHasInfiniteEnergy) {
  const Body body = make_body(test::sphere(20), true, three_point_rule());
  EXPECT_EQ(body.shell.value(VecX::Zero(body.rest.size())), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace calot::shell_test
