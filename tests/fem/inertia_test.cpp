// The laws of an implicit Euler step with mass: on spring nets, a lone spring, and a shell that is filled.

#include <gtest/gtest.h>

#include <numbers>

#include "fem/links.h"
#include "fem/liquid_mass.h"
#include "fem/point_mass.h"
#include "fem/shell.h"
#include "numerics/retardation.h"
#include "numerics/spring_net.h"
#include "support/areas.h"
#include "support/bodies.h"

namespace calot {
namespace {

using test::Net;

NewtonSettings tight(double tolerance) {
  NewtonSettings out;
  out.tolerance = tolerance;
  return out;
}

/// A row a node, which is there.
StencilTable nodes_themselves(int nodes) {
  StencilTable out;
  for (int i = 0; i < nodes; ++i) {
    out.node.push_back(i);
    out.value.push_back(1);
    out.begin.push_back(i + 1);
  }
  return out;
}

struct Flight {
  VecX x, velocity;
};

/// A net in free flight, its nodes' masses all different.
class FlyingNet {
 public:
  explicit FlyingNet(double tau) : tau_(tau) {
    net_.ground = 0;
    net_.load.setZero();
    for (int i = 0; i < Net::nodes; ++i) mass_.mass.push_back(0.5 + 0.3 * i);
  }

  Flight start() const {
    Rng rng(5);
    return {net_.rest() + test::random_coordinates(rng, 18, 0.05), test::random_coordinates(rng, 18, 0.5)};
  }
  void step(double h, Flight& at) const {
    const Step problem(*this, at, h);
    NewtonWorkspace work = net_.workspace();
    VecX x = at.x + h * at.velocity;
    double none = 0;
    const NewtonResult result = solve_equilibrium(problem, tight(1e-13), work, x, none);
    ASSERT_TRUE(result.converged()) << to_text(result.status) << ' ' << result.residual;
    at.velocity = (x - at.x) / h;
    at.x = x;
  }
  Flight after(double seconds, int steps) const {
    Flight at = start();
    for (int k = 0; k < steps; ++k) step(seconds / steps, at);
    return at;
  }

  Vec3 momentum(const Flight& at) const { return mass_.momentum(table_, at.velocity); }
  Vec3 angular(const Flight& at) const { return mass_.angular_momentum(table_, at.x, at.velocity); }
  double energy(const Flight& at) const { return net_.value(at.x) + mass_.energy(table_, at.velocity); }

 private:
  struct Adding {
    const Net& net;
    double value(const VecX& x) const { return net.value(x); }
    void add_gradient(const VecX& x, VecX& gradient) const {
      VecX g;
      double internal = 0;
      net.gradient(x, g, internal);
      gradient += g;
    }
    void add_hessian(const VecX& x, BlockMatrix& matrix) const { net.hessian(x, 0, matrix); }
  };

  class Step : public BodyEnergy {
   public:
    Step(const FlyingNet& of, const Flight& at, double h)
        : of_(of), predicted_(at.x + h * at.velocity), h_(h), retarded_(of.tau_, h, at.x) {}
    bool constrained() const override { return false; }
    double value(const VecX& x) const override {
      return retarded_.value(Adding{of_.net_}, x) + of_.mass_.energy(of_.table_, (x - predicted_) / h_);
    }
    void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
      gradient = VecX::Zero(x.size());
      retarded_.add_gradient(Adding{of_.net_}, x, gradient);
      largest_internal = std::max(largest_node(gradient), 1 / (h_ * h_));  // places of 1 m are rounded so
      of_.mass_.add_product(of_.table_, x - predicted_, 1 / (h_ * h_), gradient);
    }
    void hessian(const VecX& x, double, BlockMatrix& matrix) const override {
      retarded_.hessian(Adding{of_.net_}, x, matrix);
      of_.mass_.add_hessian(of_.table_, 1 / (h_ * h_), matrix);
    }
    double constraint(const VecX&, VecX&) const override { return 0; }
    double constraint_value(const VecX&) const override { return 0; }
    double constraint_scale() const override { return 1; }
    double length_scale() const override { return 1; }
    double safe_share(const VecX&, const VecX&) const override { return 1; }

   private:
    const FlyingNet& of_;
    VecX predicted_;
    double h_;
    Retardation retarded_;
  };

  Net net_{false};
  double tau_;
  PointMass mass_;
  StencilTable table_ = nodes_themselves(Net::nodes);
};

TEST(Inertia, AFreeNetKeepsItsMomentum) {
  for (double tau : {0.0, 0.05}) {
    const FlyingNet net(tau);
    const Flight begin = net.start(), end = net.after(2, 40);
    const Vec3 before = net.momentum(begin);
    EXPECT_GT(before.norm(), 0.1);
    EXPECT_LT((net.momentum(end) - before).norm(), 1e-10 * before.norm());
    EXPECT_LT(net.energy(end), net.energy(begin)) << "the scheme loses energy";
  }
}

TEST(Inertia, TheErrorsOfAngularMomentumAndEnergyFallWithTheStep) {
  const FlyingNet net(0);
  const Flight begin = net.start();
  std::vector<double> turns, energies;
  for (int steps : {100, 200, 400}) {
    const Flight end = net.after(0.4, steps);
    turns.push_back((net.angular(end) - net.angular(begin)).norm());
    energies.push_back(net.energy(begin) - net.energy(end));
  }
  for (std::size_t k = 1; k < turns.size(); ++k) {
    // First order: halves, but for the second order's share.
    EXPECT_NEAR(turns[k] / turns[k - 1], 0.5, 0.05);
    EXPECT_NEAR(energies[k] / energies[k - 1], 0.5, 0.05);
  }
  EXPECT_GT(turns.back(), 0);
  EXPECT_LT(energies.back(), 0.1 * net.energy(begin));
}

/// By which a step shrinks the amplitude of a mass on a spring of w rad/s.
double amplitude_kept(double w, double h, double tau) {
  const StencilTable table = nodes_themselves(1);
  const PointMass mass{{0.2}};
  const Links spring{{0}, {Vec3::Zero()}, {0.2 * w * w}};
  std::vector<double> places;
  VecX x{{1e-3, 0, 0}}, velocity = VecX::Zero(3);
  struct Adding {
    const Links& spring;
    const StencilTable& table;
    void add_gradient(const VecX& at, VecX& gradient) const { spring.add_gradient(table, at, gradient); }
    void add_hessian(const VecX&, BlockMatrix& matrix) const { spring.add_hessian(table, matrix); }
  };
  for (int k = 0; k < 4; ++k) {
    const Retardation retarded(tau, h, x);
    BlockMatrix matrix(1, std::vector<std::vector<int>>{{0}});
    retarded.hessian(Adding{spring, table}, x, matrix);
    mass.add_hessian(table, 1 / (h * h), matrix);
    VecX gradient = VecX::Zero(3);
    const VecX predicted = x + h * velocity;
    retarded.add_gradient(Adding{spring, table}, predicted, gradient);
    const VecX next = predicted - gradient / matrix.diagonal(0);  // linear: one step
    velocity = (next - x) / h;
    x = next;
    places.push_back(x[0]);
  }
  // r^n cos(n a + b) has y_n^2 - y_(n-1) y_(n+1) = r^(2 n) sin(a)^2.
  const auto squared = [&](int n) { return places[n] * places[n] - places[n - 1] * places[n + 1]; };
  return std::sqrt(squared(2) / squared(1));
}

TEST(Inertia, AModeLosesWhatTheClosedFormSays) {
  for (double hertz : {2.0, 9.3})
    for (double h : {0.02, 0.005})
      for (double tau : {0.0, 2e-3}) {
        const double wh = 2 * std::numbers::pi * hertz * h;
        // z^2 (1 + (w h)^2 + w^2 tau h) - z (2 + w^2 tau h) + 1 = 0; rounding is that of a difference of squares.
        EXPECT_NEAR(amplitude_kept(wh / h, h, tau), 1 / std::sqrt(1 + wh * wh * (1 + tau / h)), 1e-9)
            << hertz << ' ' << h << ' ' << tau;
      }
  EXPECT_NEAR(1 - amplitude_kept(2 * std::numbers::pi * 9.3, 0.02, 0), 0.35, 0.005) << "a third, at 50 Hz";
}

constexpr double wall_thickness = 2e-3, density = 1020;

/// A shell and what fills it, in free flight.
struct Balloon {
  VecX rest;
  Tessellation skin;
  StencilTable quadrature;
  Shell shell;
  Bile bile;
  PointMass wall;
  double volume = 0;
  BlockMatrix pattern;

  static Balloon of(const TriMesh& mesh, double shear_modulus) {
    const LoopSurface surface = LoopSurface::create(mesh).value();
    const std::vector<QuadraturePoint> rule = three_point_rule();
    std::vector<Vec2> places;
    for (const QuadraturePoint& q : rule) places.emplace_back(q.u, q.v);
    StencilTable table = surface.evaluate(test::at_all_faces(surface.faces(), places), 2);
    VecX rest = to_coordinates(mesh.points);
    const ShellMaterial material{{shear_modulus, wall_thickness}, {shear_modulus, wall_thickness}, true};
    Shell shell = Shell::create(face_by_face(table, rule), rest, material).value();
    Tessellation skin = surface.tessellate(2);
    BileSurface inside{skin.stencils, {}};
    for (std::size_t t = 0; t < skin.triangles.size(); t += 4) {
      inside.cells.emplace_back();
      for (std::size_t k = t; k < t + 4; ++k) inside.cells.back().push_back({skin.triangles[k], 1});
    }
    const Vec3 datum(2e-3, -1e-3, 30e-3);
    Bile bile = Bile::create(inside, density * 9.81, Vec3::UnitZ(), datum).value();
    PointMass wall;
    for (double area : shell.point_areas()) wall.mass.push_back(area * wall_thickness * 1050);
    std::vector<std::vector<int>> cliques = shell.cliques();
    for (std::vector<int>& clique : bile.cliques()) cliques.push_back(std::move(clique));
    BlockMatrix pattern(surface.nodes(), cliques);
    const double volume = bile.volume(rest);
    return {std::move(rest), std::move(skin), std::move(table), std::move(shell),
            std::move(bile), std::move(wall), volume,           std::move(pattern)};
  }

  LiquidMotion still() const { return {rest, VecX::Zero(rest.size()), Vec3::Zero()}; }
  LiquidMass liquid(const LiquidMotion& start, double h) const {
    FlowModes modes = FlowModes::inside(skin.stencils, skin.triangles, start.x, 20e-3).value();
    return LiquidMass(bile, std::move(modes), density, volume, start, h);
  }
  double mass() const { return wall.total() + density * volume; }
};

/// One step of it under forces at its nodes and a gravity.
class BalloonStep : public ConstrainedEnergy {
 public:
  BalloonStep(const Balloon& of, const LiquidMotion& start, double h, VecX load, const Vec3& gravity)
      : of_(of),
        liquid_(of.liquid(start, h)),
        predicted_(start.x + h * start.velocity),
        load_(std::move(load)),
        weight_(density * gravity),
        h_(h) {
    of.wall.add_weight(of.quadrature, gravity, load_);
  }

  const LiquidMass& liquid() const { return liquid_; }
  std::vector<Part> parts() const override {
    return {{{0, static_cast<int>(predicted_.size()) / 3}, {}, 40e-3}};
  }
  int constraints() const override { return 1 + LiquidMass::constraints; }
  double value(const VecX& x) const override {
    return of_.shell.value(x) + of_.wall.energy(of_.quadrature, (x - predicted_) / h_) - load_.dot(x) +
           of_.bile.value(x, LiquidWeight::pulling(weight_));
  }
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override {
    gradient = -load_;
    of_.shell.add_gradient(x, gradient);
    of_.bile.add_load(x, 0, LiquidWeight::pulling(weight_), gradient);
    of_.wall.add_product(of_.quadrature, x - predicted_, 1 / (h_ * h_), gradient);
    largest_internal = VecX::Ones(1);  // N
  }
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override {
    matrix.set_zero();
    of_.shell.add_hessian(x, matrix);
    const Vec3 apparent = weight_ + liquid_.weight(multipliers.tail(LiquidMass::constraints));
    of_.bile.add_hessian(x, multipliers[0], LiquidWeight::pulling(apparent), matrix);
    of_.wall.add_hessian(of_.quadrature, 1 / (h_ * h_), matrix);
  }
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override {
    values = constraint_values(x);
    gradients.resize(x.size(), constraints());
    VecX by_volume = VecX::Zero(x.size());
    of_.bile.add_volume_gradient(x, by_volume);
    gradients.col(0) = by_volume;
    gradients.rightCols(LiquidMass::constraints) = liquid_.constraint_gradients(x);
  }
  VecX constraint_values(const VecX& x) const override {
    VecX out(constraints());
    out[0] = of_.bile.volume(x) - of_.volume;
    out.tail(LiquidMass::constraints) = liquid_.constraint_values(x);
    return out;
  }
  VecX compliances() const override {
    VecX out = VecX::Zero(constraints());
    out.tail(LiquidMass::constraints) = liquid_.compliances();
    return out;
  }
  VecX constraint_scales() const override {
    VecX out(constraints());
    out[0] = of_.volume;
    out.tail(LiquidMass::constraints) = liquid_.constraint_scales();
    return out;
  }
  double safe_share(const VecX&, const VecX&) const override { return 1; }

 private:
  const Balloon& of_;
  LiquidMass liquid_;
  VecX predicted_, load_;
  Vec3 weight_;
  double h_;
};

/// Takes the step; returns the multipliers.
VecX take(const Balloon& balloon, double h, const VecX& load, const Vec3& gravity, LiquidMotion& at) {
  const BalloonStep problem(balloon, at, h, load, gravity);
  NewtonWorkspace work(balloon.pattern.blank());
  VecX x = at.x + h * at.velocity, multipliers = VecX::Zero(problem.constraints());
  NewtonSettings settings = tight(1e-10);
  settings.constraint_tolerance = 1e-12;
  const NewtonResult result = solve_equilibrium(problem, settings, work, x, multipliers);
  EXPECT_TRUE(result.converged()) << to_text(result.status) << ' ' << result.residual;
  EXPECT_LT(result.iterations, 15);
  EXPECT_EQ(result.shifts, 0);
  at = {x, (x - at.x) / h, problem.liquid().centroid_velocity(x)};
  return multipliers;
}

Vec3 momentum(const Balloon& balloon, const LiquidMotion& at) {
  return balloon.wall.momentum(balloon.quadrature, at.velocity) + density * balloon.volume * at.centroid;
}

TEST(LiquidMass, ConstraintsAndTheirWeightHaveTheirDerivatives) {
  const Balloon pear = Balloon::of(test::pear(30), 100e3);
  Rng rng(3);
  const int n = static_cast<int>(pear.rest.size());
  LiquidMotion start{pear.rest + test::random_coordinates(rng, n, 1e-3),
                     test::random_coordinates(rng, n, 0.1), Vec3(0.1, -0.2, 0.05)};
  const double h = 0.02;
  const LiquidMass liquid = pear.liquid(start, h);
  const VecX x = start.x + test::random_coordinates(rng, n, 1e-3);
  const Eigen::MatrixXd gradients = liquid.constraint_gradients(x);
  for (int k = 0; k < LiquidMass::constraints; ++k)
    EXPECT_LT(
        test::relative_error(gradients.col(k),
                             test::difference_gradient(
                                 [&](const VecX& y) { return liquid.constraint_values(y)[k]; }, x, 1e-6)),
        1e-6)
        << k;
  const VecX multipliers = test::random_coordinates(rng, LiquidMass::constraints, 2);
  BlockMatrix matrix = pear.pattern.blank();
  pear.bile.add_hessian(x, 0, LiquidWeight::pulling(liquid.weight(multipliers)), matrix);
  const Eigen::MatrixXd expected = test::difference_hessian(
      [&](const VecX& y) { return VecX(-liquid.constraint_gradients(y) * multipliers); }, x, 1e-6);
  EXPECT_LT(test::relative_error(test::dense(matrix), expected), 1e-6);
  // The flow beside the centroid's: where it would go by itself, and what it costs to go elsewhere.
  const auto flow = [&](const VecX& y) { return VecX(liquid.constraint_values(y).tail<FlowModes::count>()); };
  const VecX off = flow(x), step = x - start.x - h * start.velocity;
  EXPECT_LT(flow(x - step).norm(), 1e-12 * off.norm());
  const double cost =
      (0.5 * off.cwiseAbs2().cwiseQuotient(liquid.compliances().tail<FlowModes::count>())).sum();
  EXPECT_NEAR(cost, liquid.kinetic_energy(step / h, Vec3::Zero()), 1e-12 * cost);
  EXPECT_GT(cost, 0);
  // Without forces it flies on as it began.
  const LiquidMass still = pear.liquid({pear.rest, VecX::Zero(n), Vec3(0.1, 0, 0)}, h);
  EXPECT_LT((still.constraint_values(pear.rest).head<3>() + Vec3(0.1 * h, 0, 0)).norm(), 1e-15);
  EXPECT_LT(still.centroid_velocity(pear.rest).norm(), 1e-15);
}

TEST(LiquidMass, AFilledShellThatIsShiftedResistsWithAllItsMass) {
  for (const TriMesh& mesh : {test::sphere(30), test::pear(30)}) {
    const Balloon balloon = Balloon::of(mesh, 100e3);
    const double h = 0.02;
    const LiquidMass liquid = balloon.liquid(balloon.still(), h);
    for (const Vec3& shift : {Vec3(3e-3, 0, 0), Vec3(1e-3, -2e-3, 5e-3)}) {
      VecX motion(balloon.rest.size());
      for (Eigen::Index i = 0; i < motion.size(); i += 3) motion.segment<3>(i) = shift;
      const VecX off = liquid.constraint_values(balloon.rest + motion);
      double energy = balloon.wall.energy(balloon.quadrature, motion / h);
      for (Eigen::Index k = 0; k < off.size(); ++k) energy += off[k] * off[k] / (2 * liquid.compliances()[k]);
      const double expected = 0.5 * balloon.mass() * shift.squaredNorm() / (h * h);
      EXPECT_NEAR(energy / expected, 1, 1e-8);
      const double bile = liquid.kinetic_energy(motion / h, liquid.centroid_velocity(balloon.rest + motion));
      EXPECT_NEAR(bile, expected * liquid.mass() / balloon.mass(), 1e-8 * expected);
    }
  }
}

TEST(LiquidMass, ASpinningSphereMeetsTheWallsMassAlone) {
  const Balloon sphere = Balloon::of(test::sphere(61), 100e3);
  VecX spin(sphere.rest.size());
  for (Eigen::Index i = 0; i < spin.size(); i += 3)
    spin.segment<3>(i) = Vec3(3, -2, 6).cross(Vec3(sphere.rest.segment<3>(i)));
  const LiquidMass liquid = sphere.liquid(sphere.still(), 0.02);
  const Vec3 of_centroid = sphere.bile.moment_gradients(sphere.rest).transpose() * spin / sphere.volume;
  const double wall = sphere.wall.energy(sphere.quadrature, spin);
  EXPECT_GT(wall, 0);
  EXPECT_LT(liquid.kinetic_energy(spin, of_centroid), 1e-5 * wall) << "61 nodes are no sphere";
}

TEST(Inertia, AFilledShellFallsAsOne) {
  const Balloon pear = Balloon::of(test::pear(30), 100e3);
  const Vec3 gravity(1, -2, -9), speed(0.1, 0.2, -0.1);
  LiquidMotion at = pear.still();
  for (Eigen::Index i = 0; i < at.velocity.size(); i += 3) at.velocity.segment<3>(i) = speed;
  at.centroid = speed;
  const double h = 0.02;
  Vec3 fallen = Vec3::Zero(), velocity = speed;
  for (int k = 0; k < 3; ++k) {
    const VecX multipliers = take(pear, h, VecX::Zero(at.x.size()), gravity, at);
    velocity += h * gravity;
    fallen += h * velocity;
    VecX expected = pear.rest;
    for (Eigen::Index i = 0; i < expected.size(); i += 3) expected.segment<3>(i) += fallen;
    EXPECT_LT((at.x - expected).lpNorm<Eigen::Infinity>(), 1e-10);
    EXPECT_LT((at.centroid - velocity).norm(), 1e-10);
    // Weightless: what accelerates its liquid is its weight.
    EXPECT_LT((multipliers.segment<3>(1) / pear.volume + density * gravity).norm(), 1e-6 * density);
  }
}

TEST(Inertia, AFilledShellThatIsPushedGainsTheForceTimesTheTime) {
  const Balloon pear = Balloon::of(test::pear(30), 100e3);
  const double h = 0.02;
  LiquidMotion at = pear.still();
  VecX load = VecX::Zero(at.x.size());
  load.segment<3>(30) = Vec3(0.06, 0.02, -0.02);  // at two nodes: it bulges too
  load.segment<3>(60) = Vec3(0.02, -0.04, 0.02);
  const Vec3 force = test::net_force(load);
  for (int k = 1; k <= 4; ++k) {
    take(pear, h, load, Vec3::Zero(), at);
    EXPECT_LT((momentum(pear, at) - k * h * force).norm(), 1e-8 * k * h * force.norm());
  }
  const Vec3 shift = test::net_force(at.x - pear.rest) / (static_cast<double>(at.x.size()) / 3);
  VecX bulge = at.x - pear.rest;
  for (Eigen::Index i = 0; i < bulge.size(); i += 3) bulge.segment<3>(i) -= shift;
  EXPECT_GT(bulge.lpNorm<Eigen::Infinity>(), 1e-4);
}

}  // namespace
}  // namespace calot
