// An inflated sphere without bending and weight against its closed form. Thin-walled (Green and Adkins 1970),
// p = t / (R L^2) dW/dL at stretch L, with W a unit volume and I1 = 2 L^2 + 1 / L^4:
//   neo-Hookean     p = 2 mu (t / R) (1 / L - 1 / L^7)
//   Fung (Demiray)  the same times exp(b (I1 - 3)).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bodies.h"

namespace calot::sphere_test {
namespace {

constexpr double radius = 20e-3, thickness = 2e-3, shear_modulus = 100e3;
constexpr double stretches[] = {1.02, 1.05, 1.1, 1.2, 1.3};

double closed_form(double stretch, double stiffening) {
  const double invariant = 2 * stretch * stretch + std::pow(stretch, -4);
  return 2 * shear_modulus * thickness / radius * (1 / stretch - std::pow(stretch, -7)) *
         std::exp(stiffening * (invariant - 3));
}

ShellBody balloon(const TriMesh& mesh, double stiffening) {
  ShellBody::Setup setup;
  setup.control = mesh;
  setup.material = {{shear_modulus, thickness, stiffening}, {shear_modulus, thickness}, false};
  setup.bile = BileDefinition{};
  setup.bile->density = 0;
  // Keeps it from drifting; 1e-6 of the wall's stiffness mu t / R^2.
  setup.foundation = [](const Vec3&) { return 1e-6 * shear_modulus * thickness / (radius * radius); };
  return ShellBody::create(setup).value();
}

struct Errors {
  double pressure = 0;      ///< largest relative error of the pressure
  double wall = 0;          ///< the same with the volume of the true sphere: the shell's share of it
  double out_of_round = 0;  ///< largest relative deviation of the radius
};

Errors errors_of(const TriMesh& mesh, double stiffening) {
  const ShellBody body = balloon(mesh, stiffening);
  NewtonWorkspace work(body.pattern());
  const double unstressed = body.bile()->volume(body.rest());
  const double share_of_sphere = unstressed / (4.0 / 3.0 * M_PI * std::pow(radius, 3));
  Errors errors;
  for (double stretch : stretches) {
    const double exact = closed_form(stretch, stiffening);
    BodyState state{stretch * body.rest(), exact, unstressed * std::pow(stretch, 3)};
    const NewtonResult result = test::equilibrium(body, {}, state, work);
    EXPECT_TRUE(result.converged()) << to_text(result.status);
    errors.pressure = std::max(errors.pressure, std::abs(state.datum_pressure / exact - 1));
    errors.wall = std::max(errors.wall, std::abs(state.datum_pressure * share_of_sphere / exact - 1));
    for (const Vec3& p : body.skin_positions(state.x))
      errors.out_of_round = std::max(errors.out_of_round, std::abs(p.norm() / (stretch * radius) - 1));
  }
  return errors;
}

class InflatedSphere : public testing::TestWithParam<double> {};

TEST_P(InflatedSphere, ConvergesToTheClosedForm) {
  std::vector<Errors> errors;
  for (const TriMesh& mesh : test::nested_spheres(3)) {
    errors.push_back(errors_of(mesh, GetParam()));
    fmt::print("{} nodes: pressure {:.2e}, wall alone {:.2e}, out of round {:.2e}\n", mesh.points.size(),
               errors.back().pressure, errors.back().wall, errors.back().out_of_round);
  }
  const double order = test::order(errors[0].wall, errors[1].wall);
  const double later = test::order(errors[1].wall, errors[2].wall);
  fmt::print("order of the wall {:.2f}, {:.2f}\n", order, later);
  EXPECT_LT(errors[0].pressure, 5e-3);
  EXPECT_LT(errors[1].pressure, errors[0].pressure / 4);
  EXPECT_LT(errors[2].pressure, 2e-4);
  EXPECT_GT(order, 1.8);
  EXPECT_GT(later, 1.8);
  EXPECT_LT(errors[0].out_of_round, 0.01);
  EXPECT_LT(errors[2].out_of_round, errors[0].out_of_round / 4);
}

// At the largest stretch, 1.3, the second is 4.3 times as stiff as the first.
INSTANTIATE_TEST_SUITE_P(Validation, InflatedSphere, testing::Values(0.0, 2.0));

}  // namespace
}  // namespace calot::sphere_test
