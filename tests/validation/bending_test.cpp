// Bending against closed forms of plates, cylinders and spheres.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bodies.h"
#include "fem/shell.h"
#include "support/areas.h"

namespace calot {
namespace {

constexpr double shear_modulus = 100e3, thickness = 2e-3;
const KoiterBending bending{shear_modulus, thickness};

std::vector<Vec2> places_of(const std::vector<QuadraturePoint>& rule) {
  std::vector<Vec2> out;
  for (const QuadraturePoint& q : rule) out.emplace_back(q.u, q.v);
  return out;
}

/// Bending energy of a sheet rolled onto a cylinder, on `columns` x `columns` cells some way from its edges
/// (the edges' own rule disturbs a few rows, less by a factor with each); relative error.
double cylinder_error(int columns) {
  constexpr int margin = 8;
  const double side = 20e-3, curvature = 1 / 15e-3;
  const double whole = side * (columns + 2 * margin) / columns;
  const TriMesh flat = rectangle(whole, whole, columns + 2 * margin, columns + 2 * margin);
  const LoopSurface surface = LoopSurface::create(flat).value();
  std::vector<Vec3> rolled;
  for (const Vec3& p : flat.points)
    rolled.emplace_back(std::sin(curvature * p.x()) / curvature, p.y(),
                        (1 - std::cos(curvature * p.x())) / curvature);
  std::vector<FacePoint> points;
  for (std::size_t f = 0; f < flat.triangles.size(); ++f) {
    Vec3 middle = Vec3::Zero();
    for (int corner : flat.triangles[f]) middle += flat.points[corner] / 3;
    if (std::max(std::abs(middle.x()), std::abs(middle.y())) > 0.5 * side) continue;
    for (const Vec2& place : places_of(three_point_rule()))
      points.push_back({static_cast<int>(f), place.x(), place.y()});
  }
  const StencilTable table = surface.evaluate(points, 2);
  const VecX rest = to_coordinates(fit_to_limit(surface, flat.points).value());
  const Shell shell =
      Shell::create(face_by_face(table, three_point_rule()), rest, {{0, thickness}, bending, true}).value();
  const double energy = shell.value(to_coordinates(fit_to_limit(surface, rolled).value()));
  EXPECT_NEAR(test::rest_area(shell), side * side, 1e-9 * side * side);
  return std::abs(energy / (0.5 * bending.rigidity() * curvature * curvature * side * side) - 1);
}

TEST(Validation, SheetRolledOnACylinderHoldsHalfRigidityTimesSquaredCurvature) {
  std::vector<double> errors;
  for (int columns : {4, 8, 16}) {
    errors.push_back(cylinder_error(columns));
    fmt::print("cylinder, {} columns: {:.2e}\n", columns, errors.back());
  }
  fmt::print("order {:.2f}, {:.2f}\n", test::order(errors[0], errors[1]), test::order(errors[1], errors[2]));
  EXPECT_LT(errors[0], 0.02);
  EXPECT_GT(test::order(errors[0], errors[1]), 1.8);  // at least a quartic's second derivatives: second order
}

TEST(Validation, SphereGrownAtConstantShapeHoldsTheClosedFormsBendingEnergy) {
  // Curvature tensor b = -a / R: b - B = -(L - 1) / R A, so k:k = 2 ((L - 1) / R)^2 and (tr k)^2 twice that.
  const double radius = 20e-3, stretch = 1.2;
  const double change = (stretch - 1) / radius;
  const double exact = 1.5 * bending.rigidity() * change * change * 4 * M_PI * radius * radius;
  std::vector<double> errors;
  for (const TriMesh& mesh : test::nested_spheres(3, radius)) {
    const LoopSurface surface = LoopSurface::create(mesh).value();
    const StencilTable table =
        surface.evaluate(test::at_all_faces(surface.faces(), places_of(three_point_rule())), 2);
    const VecX rest = to_coordinates(mesh.points);
    const Shell shell =
        Shell::create(face_by_face(table, three_point_rule()), rest, {{0, thickness}, bending, true}).value();
    errors.push_back(std::abs(shell.value(stretch * rest) / exact - 1));
    fmt::print("sphere, {} nodes: {:.2e}\n", mesh.points.size(), errors.back());
  }
  fmt::print("order {:.2f}, {:.2f}\n", test::order(errors[0], errors[1]), test::order(errors[1], errors[2]));
  // The curvature of a Loop surface does not converge at its nodes of valence 5 and 7, but the share of the
  // surface that they spoil does.
  EXPECT_LT(errors[0], 0.02);
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_GT(test::order(errors[1], errors[2]), 0.9);
}

/// A plate pinned at points, under dead nodal loads.
class PlateProblem : public BodyEnergy {
 public:
  PlateProblem(const Shell& shell, const Links& pins, const StencilTable& table, const VecX& load,
               double size)
      : shell_(shell), pins_(pins), table_(table), load_(load), size_(size) {}
  bool constrained() const override { return false; }
  double value(const VecX& x) const override {
    return shell_.value(x) + pins_.value(table_, x) - load_.dot(x);
  }
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
    gradient.setZero(x.size());
    shell_.add_gradient(x, gradient);
    pins_.add_gradient(table_, x, gradient);
    gradient -= load_;
    largest_internal = load_.lpNorm<Eigen::Infinity>();
  }
  void hessian(const VecX& x, double, BlockMatrix& matrix) const override {
    matrix.set_zero();
    shell_.add_hessian(x, matrix);
    pins_.add_hessian(table_, matrix);
  }
  double constraint(const VecX&, VecX&) const override { return 0; }
  double constraint_value(const VecX&) const override { return 0; }
  double constraint_scale() const override { return 1; }
  double length_scale() const override { return size_; }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

 private:
  const Shell& shell_;
  const Links& pins_;
  const StencilTable& table_;
  const VecX& load_;
  double size_;
};

/// Deflection at the centre of a simply supported square plate under a small uniform pressure, over
/// q a^4 / D.
double plate_deflection(int columns) {
  const double side = 100e-3,
               pressure = 5e-3;  // deflects by 8e-6 m, far below the thickness: the answer is linear
  const TriMesh flat = rectangle(side, side, columns, columns);
  const LoopSurface surface = LoopSurface::create(flat).value();
  const auto rule = six_point_rule();
  const StencilTable table = surface.evaluate(test::at_all_faces(surface.faces(), places_of(rule)), 2);
  const VecX rest = to_coordinates(fit_to_limit(surface, flat.points).value());
  const Shell shell =
      Shell::create(face_by_face(table, rule), rest, {{shear_modulus, thickness}, bending, true}).value();
  VecX load = VecX::Zero(rest.size());
  const std::vector<double> areas = shell.point_areas();
  for (int r = 0; r < table.rows(); ++r) spread(table, r, pressure * areas[r] * Vec3::UnitZ(), load);
  // Edges are held along their length and in height, free to turn; stiff against the plate, D / side^2.
  const StencilTable vertices = surface.tessellate(2).stencils;
  const std::vector<Vec3> at = blend_all(vertices, vertices.value, rest);
  Links pins;
  int centre = 0;
  for (int r = 0; r < vertices.rows(); ++r) {
    if (at[r].norm() < at[centre].norm()) centre = r;
    if (std::max(std::abs(at[r].x()), std::abs(at[r].y())) < 0.5 * side - 1e-6) continue;
    pins.row.push_back(r);
    pins.target.push_back(at[r]);
    pins.stiffness.push_back(1e4);
  }
  std::vector<std::vector<int>> cliques = shell.cliques();
  BlockMatrix pattern(surface.nodes(), cliques);
  NewtonWorkspace work(std::move(pattern));
  const PlateProblem problem(shell, pins, vertices, load, side);
  VecX x = rest;
  double multiplier = 0;
  NewtonSettings settings;
  settings.tolerance = 1e-5;  // rounding of the stiff pins is 1e-6 of so small a load
  const NewtonResult result = solve_equilibrium(problem, settings, work, x, multiplier);
  EXPECT_TRUE(result.converged()) << to_text(result.status) << " " << result.residual;
  const double deflection = blend(vertices, vertices.value, centre, x).z();
  return deflection * bending.rigidity() / (pressure * std::pow(side, 4));
}

TEST(Validation, SimplySupportedSquarePlateDeflectsByNaviersSeries) {
  double exact = 0;
  for (int m = 1; m < 100; m += 2)
    for (int n = 1; n < 100; n += 2) {
      const double sign = ((m + n) / 2) % 2 == 1 ? 1 : -1;
      exact += sign * 16 / (std::pow(M_PI, 6) * m * n * std::pow(m * m + n * n, 2));
    }
  std::vector<double> errors;
  for (int columns : {6, 12, 24}) {
    errors.push_back(plate_deflection(columns) / exact - 1);
    fmt::print("plate, {} columns: {:.2e}\n", columns, errors.back());
  }
  fmt::print("Navier {:.6f}; order {:.2f}, {:.2f}\n", exact, test::order(errors[0], errors[1]),
             test::order(errors[1], errors[2]));
  // First order only: at an open edge the subdivision rule ties two second derivatives to each other (the
  // plate's twist to its bending) in a strip as wide as a cell, which stiffens it. Closed organs have no
  // edge.
  EXPECT_LT(std::abs(errors[0]), 0.12);
  EXPECT_LT(std::abs(errors[2]), 0.03);
  EXPECT_GT(test::order(std::abs(errors[1]), std::abs(errors[2])), 0.9);
}

}  // namespace
}  // namespace calot
