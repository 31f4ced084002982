// A held, bile-filled sphere under a smooth pull: meshes of 61, 238 and 946 nodes tend to one shape.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bodies.h"

namespace calot {
namespace {

constexpr double radius = 20e-3;

double bump(const Vec3& at, const Vec3& centre, double spread) {
  return std::exp(-(at - centre).squaredNorm() / (2 * spread * spread));
}

/// Where the mesh's nodes' limit points end up.
std::vector<Vec3> pulled(const TriMesh& mesh) {
  ShellBody::Setup setup;
  setup.control = mesh;
  setup.bile = BileDefinition{};
  const Vec3 bottom(0, 0, -radius), top(0, 0, radius);
  setup.foundation = [&](const Vec3& x) { return 2e6 * bump(x, bottom, 8e-3); };
  const ShellBody body = ShellBody::create(setup).value();
  NewtonWorkspace work(body.pattern());
  BodyState state{body.rest(), 0, 1.1 * body.bile()->volume(body.rest())};
  ContactLoads field;
  EXPECT_TRUE(test::equilibrium(body, field, state, work, 1e-6).converged());
  const std::vector<Vec3> filled = body.skin_positions(state.x);
  for (std::size_t r = 0; r < filled.size(); ++r) {
    const double weight = bump(body.skin_rest()[r], top, 8e-3);
    if (weight < 1e-6) continue;
    field.grip.row.push_back(static_cast<int>(r));
    field.grip.target.push_back(filled[r]);
    field.grip.stiffness.push_back(2e6 * weight * body.skin_areas()[r]);
  }
  const std::vector<Vec3> start = field.grip.target;
  constexpr int steps = 2;
  for (int k = 1; k <= steps; ++k) {
    for (std::size_t i = 0; i < start.size(); ++i)
      field.grip.target[i] = start[i] + Vec3(3e-3, 0, 6e-3) * k / steps;
    const NewtonResult result = test::equilibrium(body, field, state, work, 1e-6);
    EXPECT_TRUE(result.converged()) << to_text(result.status) << " " << result.residual;
  }
  std::vector<Vec3> moved = body.skin_positions(state.x);
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= body.skin_rest()[i];
  moved.resize(mesh.points.size());  // a tessellation's points begin with the nodes
  return moved;
}

TEST(Validation, MeshRefinementConvergesUnderASmoothLoad) {
  std::vector<std::vector<Vec3>> displacements;
  for (const TriMesh& mesh : test::nested_spheres(3)) displacements.push_back(pulled(mesh));
  const std::vector<Vec3>& reference = displacements.back();
  double largest = 0;
  for (const Vec3& d : reference) largest = std::max(largest, d.norm());
  double mean[2], worst[2];
  for (int level = 0; level < 2; ++level) {
    mean[level] = worst[level] = 0;
    const std::size_t nodes = displacements[0].size();
    for (std::size_t i = 0; i < nodes; ++i) {
      const double error = (displacements[level][i] - reference[i]).norm() / largest;
      mean[level] += error / static_cast<double>(nodes);
      worst[level] = std::max(worst[level], error);
    }
    fmt::print("{} nodes against {}: mean {:.2e}, largest {:.2e} of {:.2f} mm\n", displacements[level].size(),
               reference.size(), mean[level], worst[level], 1e3 * largest);
  }
  fmt::print("order {:.2f} (mean), {:.2f} (largest)\n", test::order(mean[0], mean[1]),
             test::order(worst[0], worst[1]));
  EXPECT_GT(largest, 3e-3);
  EXPECT_LT(mean[0], 0.02);  // the target set for 61 nodes
  EXPECT_LT(worst[0], 0.05);
  EXPECT_LT(mean[1], 0.005);
  EXPECT_GT(test::order(mean[0], mean[1]), 1.5);
}

}  // namespace
}  // namespace calot
