#pragma once
// Nested spheres, and equilibrium of a body under links alone.

#include "body/shell_body.h"
#include "group/equilibrium.h"
#include "support/bodies.h"

namespace calot::test {

/// Control meshes of one sphere about the origin: 61 nodes, each split once more, with the new nodes on the
/// sphere: 61, 238, 946. Nodes of a coarser mesh come first in a finer one and stand for the same points.
inline std::vector<TriMesh> nested_spheres(int levels, double radius = 20e-3) {
  TriMesh mesh = revolve(sphere_profile(radius), 61).value();
  std::vector<TriMesh> out = {fitted(mesh)};
  for (int level = 1; level < levels; ++level) {
    mesh = split_edges(mesh);
    for (Vec3& p : mesh.points) p = radius * p.normalized();
    out.push_back(fitted(mesh));
  }
  return out;
}

/// Order of convergence when the mesh size is halved.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

inline NewtonResult equilibrium(const ShellBody& body, const ContactLoads& field, BodyState& state,
                                NewtonWorkspace& work, double tolerance = 1e-8) {
  NewtonSettings settings;
  settings.tolerance = tolerance;
  const BodyProblem problem(body, field, gather_pairs(body, state.x, field, 0.0), state);
  VecX multipliers = problem.multipliers();
  const NewtonResult result = solve_equilibrium(problem, settings, work, state.x, multipliers);
  if (multipliers.size() > 0) state.datum_pressure = multipliers[0];
  return result;
}

}  // namespace calot::test
