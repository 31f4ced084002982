#pragma once
// A few bodies of a group, and what joins them, without a world around.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <deque>

#include "body/rod_body.h"
#include "body/shell_body.h"
#include "group/equilibrium.h"
#include "support/bodies.h"
#include "support/derivatives.h"

namespace calot::test {

/// An empty ball of soft wall.
inline BodyPointer soft_ball(const Vec3& middle, double radius = 20e-3, int nodes = 61, int levels = 0) {
  ShellBody::Setup setup;
  setup.name = "ball";
  setup.control = sphere(nodes, radius);
  for (Vec3& p : setup.control.points) p += middle;
  setup.material = {{30e3, 2e-3}, {30e3, 2e-3}};
  setup.levels = levels;
  return std::make_shared<const ShellBody>(ShellBody::create(setup).value());
}
inline BodyPointer straight_duct(const Vec3& from, const Vec3& to, double radius = 2.5e-3) {
  RodBody::Setup setup;
  setup.points = {from, to};
  setup.radius = radius;
  return std::make_shared<const RodBody>(RodBody::create(setup).value());
}

struct GroupRig {
  struct One {
    BodyPointer body;
    ContactLoads loads = {};
    ContactSearch search = {};
    BodyState state = {};
  };
  std::deque<One> bodies;
  std::vector<JoinPointer> joins;
  NewtonWorkspace work{BlockMatrix(0, {})};
  GroupPatterns patterns;
  Assembly* assembly = nullptr;

  explicit GroupRig(const std::vector<BodyPointer>& of) {
    for (const BodyPointer& body : of) {
      bodies.push_back({body});
      bodies.back().search.own.active = false;
      bodies.back().state.x = body->rest();
    }
  }
  std::vector<GroupPlace> places() const {
    std::vector<GroupPlace> out;
    int first = 0;
    for (const One& one : bodies) {
      out.push_back({one.body.get(), first});
      first += one.body->nodes();
    }
    return out;
  }
  std::vector<Member> members() {
    std::vector<Member> out;
    for (One& one : bodies) out.push_back({*one.body, one.loads, one.search, one.state, assembly});
    return out;
  }
  VecX x() const {
    std::vector<double> all;
    for (const One& one : bodies) all.insert(all.end(), one.state.x.begin(), one.state.x.end());
    return Eigen::Map<VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
  }
  /// A spring of `stiffness` (N/m) from a skin point to a place.
  void hold(int body, int row, const Vec3& at, double stiffness) {
    GripSprings& grip = bodies[body].loads.grip;
    grip.row.push_back(row);
    grip.target.push_back(at);
    grip.stiffness.push_back(stiffness);
  }
  NewtonResult settle(double tolerance = 1e-8) {
    NewtonSettings settings;
    settings.tolerance = tolerance;
    return calot::settle(members(), joins, patterns, settings, work);
  }
  /// With room for all that the joins couple.
  BlockMatrix matrix(const VecX& at) const {
    std::vector<std::vector<int>> cliques;
    for (const JoinPointer& join : joins) {
      join->begin(places());
      join->add_cliques(at, false, cliques);
    }
    return BlockMatrix(static_cast<int>(at.size()) / 3, cliques);
  }
};

inline VecX gradient_of(const Join& join, const VecX& x) {
  VecX g = VecX::Zero(x.size());
  join.add_gradient(x, g);
  return g;
}

/// Gradient against the value and Hessian against the gradient, along random ways.
inline void expect_derivatives(const GroupRig& rig, const Join& join, const VecX& x, double step,
                               double tolerance) {
  BlockMatrix h = rig.matrix(x);
  join.add_hessian(x, h);
  EXPECT_FALSE(join.lacking());
  const VecX g = gradient_of(join, x);
  ASSERT_GT(g.norm(), 1e-3);
  Rng rng(11);
  for (int k = 0; k < 5; ++k) {
    const VecX d = random_coordinates(rng, static_cast<int>(x.size()), 1.0);
    const double slope = (join.value(x + step * d) - join.value(x - step * d)) / (2 * step);
    EXPECT_NEAR(slope, g.dot(d), tolerance * g.norm() * d.norm());
    const VecX bend = (gradient_of(join, x + step * d) - gradient_of(join, x - step * d)) / (2 * step);
    const VecX exact = h.multiply(d);
    EXPECT_LT((bend - exact).norm(), tolerance * exact.norm());
  }
}

/// A join's Hessian at x has a negative eigenvalue, and none beyond rounding with what makes it convex.
inline void expect_convexity(const GroupRig& rig, const Join& join, const VecX& x) {
  const auto smallest = [](const BlockMatrix& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(matrix), Eigen::EigenvaluesOnly)
        .eigenvalues()
        .minCoeff();
  };
  BlockMatrix h = rig.matrix(x);
  join.add_hessian(x, h);
  const double before = smallest(h);
  EXPECT_LT(before, -1e-2);  // N/m
  ASSERT_TRUE(join.add_convexity(x, h));
  EXPECT_GT(smallest(h), 1e-9 * before);
}

}  // namespace calot::test
