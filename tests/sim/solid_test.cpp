// A lobe of the liver: what condensation and few frames leave of the solid that is not condensed, and what it is to others.

#include <gtest/gtest.h>

#include <numbers>

#include "anatomy/organ_frame.h"
#include "base/units.h"
#include "body/solid_body.h"
#include "geometry/lobe.h"
#include "geometry/solid_moments.h"
#include "geometry/turn.h"
#include "numerics/cholesky.h"
#include "numerics/dense_cholesky.h"
#include "numerics/modes.h"
#include "organs/body_kinds.h"
#include "rig.h"
#include "support/bodies.h"
#include "support/derivatives.h"
#include "support/long_run.h"
#include "support/solids.h"

namespace calot {
namespace {

OrganDefinition lobe() {
  OrganDefinition organ;
  organ.name = "liver";
  organ.shape = LobeShape{};
  return organ;
}

BodyPointer body_of(const OrganDefinition& organ) {
  const ContactLoads none;
  Result<RestedOrgan> made = make_organ(organ, none, Vec3::UnitZ(), 1e-6);
  EXPECT_TRUE(made) << to_text(made.failure());
  return made->organ.body;
}

const SolidBody& solid(const BodyPointer& body) { return dynamic_cast<const SolidBody&>(*body); }

constexpr ElasticSolid liver{6e3, 0.45};
/// Of tetrahedra in the default lobe: 8 x 4 cells of its skin, two through each.
const TetGrid grid{{8, 4, 2}};

/// With springs on places of it and a load, brought to rest by Newton's method.
template <class Energy>
struct Rested {
  const Energy& energy;
  const StencilTable& places;
  Links held;
  VecX load, x;
  BlockMatrix pattern;

  double value(double share) const { return energy.value(x) + held.value(places, x) - share * load.dot(x); }
  void settle(double share) {
    for (int round = 0; round < 60; ++round) {
      VecX g = -share * load;
      energy.add_gradient(x, g);
      held.add_gradient(places, x, g);
      if (g.norm() < 1e-8 * load.norm()) return;
      BlockMatrix h = pattern.blank();
      held.add_hessian(places, h);
      energy.add_hessian(x, h);
      Cholesky factor(h);
      for (double shift = 1e-3 * h.diagonal_mean(); factor.factorise(h) != FactorStatus::ok; shift *= 3)
        h.add_to_diagonal(shift);
      const VecX begin = x, step = factor.solve(VecX(-g));
      const double before = value(share);
      double part = 1;
      for (x = begin + step; part > 1e-6 && !(value(share) <= before + 1e-12 * std::abs(before));
           x = begin + part * step)
        part *= 0.5;
    }
    FAIL() << "no rest";
  }
  std::vector<Vec3> points() const { return blend_all(places, places.value, x); }
};

StencilTable single_points(int count) {
  StencilTable out;
  for (int p = 0; p < count; ++p) {
    out.node.push_back(p);
    out.value.push_back(1);
    out.begin.push_back(p + 1);
  }
  return out;
}

Links held_back(const std::vector<Vec3>& points) {
  Links out;
  for (int p = 0; p < grid.points(); ++p) {
    if (grid.place(p)[1] > 0) continue;
    out.row.push_back(p);
    out.target.push_back(points[p]);
    out.stiffness.push_back(30);  // N/m
  }
  return out;
}

double volume_of(const std::vector<QuadraticTet>& tets, const std::vector<Vec3>& points) {
  double sum = 0;
  for (const QuadraticTet& tet : tets) {
    std::array<Vec3, 10> at;
    for (int a = 0; a < 10; ++a) at[a] = points[tet[a]];
    sum += tet_products(at).sum();
  }
  return sum;
}

/// By how much the middle of the edge has turned, rad.
double edge_turn(const std::vector<Vec3>& before, const std::vector<Vec3>& now) {
  std::vector<int> at_edge;
  for (int p = 0; p < grid.points(); ++p) {
    const std::array<int, 3> at = grid.place(p);
    if (at[1] >= grid.points_along()[1] - 3 && std::abs(at[0] - 8) <= 5) at_edge.push_back(p);
  }
  Eigen::Matrix3Xd from(3, at_edge.size()), to = from;
  for (std::size_t k = 0; k < at_edge.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = before[at_edge[k]];
    to.col(static_cast<Eigen::Index>(k)) = now[at_edge[k]];
  }
  return Eigen::AngleAxisd(best_turn(from, to)).angle();
}

TEST(Solid, ItsEdgeTurnedByHalfARightAngleIsWhereThatOfTheUncondensedSolidIs) {
  CALOT_SLOW_WHEN_SANITIZED("fifty solutions with 2,300 unknowns");
  const OrganDefinition organ = lobe();
  const BodyPointer body = body_of(organ);
  const SolidMesh& mesh = solid(body).mesh();
  const std::vector<Vec3> rest = blend_all(mesh.rows, mesh.rows.value, body->rest());
  ASSERT_EQ(rest.size(), static_cast<std::size_t>(grid.points()));
  const test::WholeSolid uncondensed(mesh.tets, rest, liver);
  const StencilTable single = single_points(grid.points());
  Rested<test::WholeSolid> whole{uncondensed,          single,
                                 held_back(rest),      VecX::Zero(3 * grid.points()),
                                 to_coordinates(rest), BlockMatrix(grid.points(), uncondensed.cliques())};
  Rested<FramedSolid> few{solid(body).solid(), mesh.rows,
                          held_back(rest),     VecX::Zero(body->rest().size()),
                          body->rest(),        body->pattern()};
  // What lies in its bed pushes the edge up and back.
  const Vec3 push = organ_frame(organ).linear() * Vec3(1, 0, -0.3);
  for (int p = 0; p < grid.points(); ++p) {
    if (grid.place(p)[1] < grid.points_along()[1] - 2 || grid.place(p)[2] > 0) continue;
    spread(single, p, push, whole.load);
    spread(mesh.rows, p, push, few.load);
  }
  double share = 0;
  for (double step = 1e-3; edge_turn(rest, whole.points()) < 0.25 * std::numbers::pi;) {
    whole.settle(share += step);
    few.settle(share);
    ASSERT_LT(share, 0.1);
  }
  const std::vector<Vec3> exact = whole.points(), found = few.points();
  double worst = 0, largest = 0;
  for (int p = 0; p < grid.points(); ++p) {
    if (!grid.on_surface(p)) continue;
    worst = std::max(worst, (found[p] - exact[p]).norm());
    largest = std::max(largest, (exact[p] - rest[p]).norm());
  }
  const double turn = edge_turn(rest, exact), volume = volume_of(mesh.tets, exact);
  EXPECT_NEAR(edge_turn(rest, found), turn, 0.05 * turn);
  EXPECT_LT(worst, 0.05 * largest);
  EXPECT_NEAR(volume_of(mesh.tets, found), volume_of(mesh.tets, rest), 0.02 * volume);
  EXPECT_NEAR(volume_of(mesh.tets, found), volume, 0.02 * volume);
}

/// The smallest values of K v = value M v, both positive definite, by inverse iteration on a few vectors.
VecX smallest_values(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m) {
  constexpr int vectors = 10, rounds = 15;  // the fifth is then right to 1e-6
  Eigen::MatrixXd factor = k;
  EXPECT_TRUE(cholesky_in_place(factor));
  Rng rng(1);
  Eigen::MatrixXd shapes(k.rows(), vectors);
  for (Eigen::Index i = 0; i < shapes.size(); ++i) shapes.data()[i] = rng.uniform(-1, 1);
  const auto of = [&](const Eigen::MatrixXd& matrix) {
    const Eigen::MatrixXd taken = matrix * shapes;
    return Eigen::MatrixXd(shapes.transpose() * taken);
  };
  VecX values;
  for (int round = 0; round < rounds; ++round) {
    shapes = cholesky_solve(factor, Eigen::MatrixXd(m * shapes));
    const Modes inertia = modes(of(m)).value();
    shapes =
        shapes * Eigen::MatrixXd(inertia.vectors * inertia.values.cwiseSqrt().cwiseInverse().asDiagonal());
    const Modes ritz = modes(of(k)).value();
    shapes = shapes * ritz.vectors;
    values = ritz.values;
  }
  return values;
}

TEST(Solid, ItsFirstFiveFrequenciesAreThoseOfTheUncondensedSolid) {
  CALOT_SLOW_WHEN_SANITIZED("a dense factor of 2,300 unknowns");
  const BodyPointer body = body_of(lobe());
  const SolidMesh& mesh = solid(body).mesh();
  const std::vector<Vec3> rest = blend_all(mesh.rows, mesh.rows.value, body->rest());
  BlockMatrix stiffness = body->pattern();
  body->add_hessian(body->rest(), stiffness, nullptr);
  const VecX found = smallest_values(test::dense(stiffness), test::dense(*body->mass()));
  Eigen::MatrixXd whole = test::whole_stiffness(mesh.tets, rest, liver);
  // The back's springs hold the skin, which is where the averages of its points are.
  Eigen::MatrixXd blends = Eigen::MatrixXd::Zero(grid.points(), mesh.nodes);
  for (int p = 0; p < grid.points(); ++p)
    for (int e = mesh.rows.begin[p]; mesh.averaged[p] && e < mesh.rows.begin[p + 1]; ++e)
      blends(p, mesh.rows.node[e]) = mesh.rows.value[e];
  Eigen::MatrixXd squares = blends.transpose() * blends;
  ASSERT_TRUE(cholesky_in_place(squares));
  const Eigen::MatrixXd average = cholesky_solve(squares, Eigen::MatrixXd(blends.transpose()));
  const Eigen::MatrixXd springs = test::dense(body->pattern()).topLeftCorner(3 * mesh.nodes, 3 * mesh.nodes);
  Eigen::MatrixXd inertia = Eigen::MatrixXd::Zero(whole.rows(), whole.cols());
  const auto every = [](Eigen::Index c, Eigen::Index count) { return Eigen::seqN(c, count, 3); };
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::MatrixXd one_way = springs(every(c, average.rows()), every(c, average.rows()));
    const Eigen::MatrixXd taken = one_way * average, felt = average.transpose() * taken;
    whole(every(c, average.cols()), every(c, average.cols())) += felt;
  }
  for (const QuadraticTet& tet : mesh.tets) {
    std::array<Vec3, 10> at;
    for (int a = 0; a < 10; ++a) at[a] = rest[tet[a]];
    const Eigen::Matrix<double, 10, 10> products = tet_products(at);
    for (int a = 0; a < 10; ++a)
      for (int b = 0; b < 10; ++b)
        for (int c = 0; c < 3; ++c) inertia(3 * tet[a] + c, 3 * tet[b] + c) += 1060 * products(a, b);
  }
  const VecX exact = smallest_values(whole, inertia);
  for (int k = 0; k < 5; ++k)
    EXPECT_NEAR(std::sqrt(found[k]), std::sqrt(exact[k]), 0.01 * std::sqrt(exact[k])) << k;
}

TEST(Solid, ItsForcesAreTheSlopeOfItsEnergyAndItsHessianTheirs) {
  OrganDefinition organ = lobe();
  organ.held = {{"ligament", "upper_side", 20e-3, 1e5}};
  const BodyPointer body = body_of(organ);
  Rng rng(7);
  const int size = static_cast<int>(body->rest().size());
  const VecX x = body->rest() + test::random_coordinates(rng, size, 1e-3);
  const auto forces = [&](const VecX& at) {
    VecX out = VecX::Zero(size);
    double largest = 0;
    body->add_gradient(at, out, largest);
    return out;
  };
  BlockMatrix h = body->pattern();
  body->add_hessian(x, h, nullptr);
  const VecX g = forces(x);
  EXPECT_GT(g.norm(), 0.1);
  for (int trial = 0; trial < 3; ++trial) {
    const VecX d = test::random_coordinates(rng, size, 1.0);
    constexpr double step = 1e-6;  // m, beside nodes 1e-2 m apart
    const double slope = (body->value(x + step * d) - body->value(x - step * d)) / (2 * step);
    EXPECT_NEAR(slope, g.dot(d), 1e-6 * g.norm() * d.norm());
    const VecX bend = (forces(x + step * d) - forces(x - step * d)) / (2 * step);
    EXPECT_LT((bend - h.multiply(d)).norm(), 1e-6 * bend.norm());
  }
}

TEST(Solid, AStepOfItsMotionIsTheSlopeOfItsEnergyToo) {
  const BodyPointer body = body_of(lobe());
  Rng rng(8);
  const int size = static_cast<int>(body->rest().size());
  BodyState state;
  state.x = body->rest();
  state.motion = {{body->rest() + test::random_coordinates(rng, size, 1e-4),
                   test::random_coordinates(rng, size, 1e-2), Vec3::Zero()},
                  0.02};
  const Inertia inertia(*body, state, 5e-3);
  const auto forces = [&](const VecX& at) {
    VecX out = VecX::Zero(size);
    inertia.add_gradient(at, out);
    return out;
  };
  const VecX x = body->rest() + test::random_coordinates(rng, size, 1e-3), g = forces(x);
  BlockMatrix h = body->pattern();
  inertia.hessian(x, h, nullptr);
  const VecX d = test::random_coordinates(rng, size, 1.0);
  constexpr double step = 1e-6;  // m
  EXPECT_NEAR((inertia.value(x + step * d) - inertia.value(x - step * d)) / (2 * step), g.dot(d),
              1e-6 * g.norm() * d.norm());
  const VecX bend = (forces(x + step * d) - forces(x - step * d)) / (2 * step);
  EXPECT_LT((bend - h.multiply(d)).norm(), 1e-6 * bend.norm());
}

TEST(Solid, ItsMassAndWeightAreThoseOfItsVolume) {
  OrganDefinition organ = lobe();
  std::get<LobeShape>(organ.shape).sags = true;
  const BodyPointer body = body_of(organ);
  const SolidMesh& mesh = solid(body).mesh();
  const double mass = 1060 * volume_of(mesh.tets, blend_all(mesh.rows, mesh.rows.value, body->rest()));
  EXPECT_NEAR(enclosed_volume({body->skin_rest(), body->skin().triangles}), solid(body).volume(),
              0.01 * solid(body).volume())
      << "skin and tetrahedra bound the same but for how they round it off";
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0.6, 0.8)}) {
    VecX shift = VecX::Zero(body->rest().size());
    shift.head(3 * mesh.nodes) = way.replicate(mesh.nodes, 1);
    EXPECT_NEAR(shift.dot(body->mass()->multiply(shift)), mass, 1e-9 * mass);
  }
  const Vec3 weight = test::net_force(body->kept_load());
  EXPECT_LT((weight + mass * units::standard_gravity * Vec3::UnitZ()).norm(), 1e-8 * mass);
  // A turn about its centroid has the inertia of the solid.
  const SolidMoments moments = mesh_moments({body->skin_rest(), body->skin().triangles});
  VecX spin = body->rest();
  for (int i = 0; i < 3 * mesh.nodes; i += 3)
    spin.segment<3>(i) = Vec3::UnitX().cross(Vec3(spin.segment<3>(i)) - moments.centroid);
  const double inertia = 1060 * (moments.second(1, 1) + moments.second(2, 2));
  EXPECT_NEAR(spin.dot(body->mass()->multiply(spin)), inertia, 0.02 * inertia);
  EXPECT_EQ(body_of(lobe())->kept_load().size(), 0) << "as drawn it is in balance with its weight";
}

TEST(Solid, ItsBedHasTheGallbladdersShape) {
  const OrganDefinition organ = lobe();
  const BodyPointer body = body_of(organ);
  const Pose to_frame = organ_frame(organ).inverse();
  const auto radius = radius_by_height(pear_profile(80e-3, 35e-3));
  int in_bed = 0;
  for (const Vec3& p : body->skin_rest()) {
    const Vec3 at = to_frame * p;
    const double from_axis = at.head<2>().norm();
    if (at.z() > 0 && at.z() < 80e-3) {
      EXPECT_GT(from_axis, radius(at.z()) + 0.2e-3) << at.transpose();
    }
    // Its middle part, well below the rim.
    if (at.x() < 0 || std::abs(at.y()) > 8e-3 || at.z() < 35e-3 || at.z() > 58e-3 || from_axis > 25e-3)
      continue;
    ++in_bed;
    EXPECT_LT(from_axis, radius(at.z()) + 3.5e-3) << at.transpose();
  }
  EXPECT_GT(in_bed, 100);
}

TEST(Solid, ARodDentsItAndItComesBack) {
  CALOT_SLOW_WHEN_SANITIZED("a rod on a lobe");
  SceneDefinition scene = test::scene_with(InstrumentType::bipolar_electrode);
  scene.anatomy = {};
  scene.anatomy.organs = {lobe()};
  scene.anatomy.table_head_up = scene.anatomy.table_left_down = 0;
  scene.laparoscope.look_at = "liver.edge";
  Result<World> made = World::create(scene);
  ASSERT_TRUE(made) << to_text(made.failure());
  World world = std::move(made).value();
  test::Driver driver(world);
  const Vec3 up = organ_frame(scene.anatomy.organs[0]).linear().col(0);
  const Vec3 top = world.landmark("liver.upper_side");
  ASSERT_TRUE(driver.go(top + 12e-3 * up, 0, 4) && driver.go(top - 3e-3 * up, 0, 6)) << driver.why();
  EXPECT_GT(world.report().instruments[0].force.norm(), 0.01);
  EXPECT_LT((world.landmark("liver.upper_side") - top).dot(up), -1e-3);
  // A skin point between two contact points, 0.35 mm from either, under a tip 2.5 mm round.
  EXPECT_LT(world.deepest_penetration(), 2.5e-5);
  ASSERT_TRUE(driver.go(top + 12e-3 * up, 0, 4)) << driver.why();
  EXPECT_LT((world.landmark("liver.upper_side") - top).norm(), 1e-5);
}

TEST(Solid, MaxStretchIsThatOfWhereItIsStretchedMost) {
  const BodyPointer body = body_of(lobe());
  const int places = solid(body).coarse_nodes();
  for (int axis = 0; axis < 3; ++axis) {
    VecX x = body->rest();
    for (int node = 0; node < places; ++node) x[3 * node + axis] *= 1.3;
    EXPECT_NEAR(body->max_stretch(x), 1.3, 1e-9);
    // More and more along the axis, up to 1.6 at its end; what is reported is the mean of a tetrahedron there.
    double begin = std::numeric_limits<double>::infinity(), end = -begin;
    for (int node = 0; node < places; ++node) {
      begin = std::min(begin, body->rest()[3 * node + axis]);
      end = std::max(end, body->rest()[3 * node + axis]);
    }
    x = body->rest();
    for (int node = 0; node < places; ++node) {
      const double along = (x[3 * node + axis] - begin) / (end - begin);
      x[3 * node + axis] = begin + (end - begin) * along * (1 + 0.3 * along);
    }
    EXPECT_LT(body->max_stretch(x), 1.6);
    EXPECT_GT(body->max_stretch(x), 1.45);
  }
}

}  // namespace
}  // namespace calot
