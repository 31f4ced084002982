#pragma once
// Control meshes with every valence from four to seven, their points moved at random so that nothing is
// symmetric.

#include <string>
#include <vector>

#include "base/rng.h"
#include "geometry/shapes.h"

namespace calot::test {

/// Radius 1; six nodes in four triangles each.
inline TriMesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

inline TriMesh shaken(TriMesh mesh, double by) {
  Rng rng(7);
  for (Vec3& p : mesh.points) p += by * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  return mesh;
}

struct NamedMesh {
  std::string name;
  TriMesh mesh;  ///< about 1 m in size, edges of 0.2 to 1 m
};

inline std::vector<NamedMesh> closed_meshes() {
  return {{"valence 4", shaken(split_edges(octahedron()), 0.1)},
          {"valence 5", shaken(revolve(sphere_profile(1), 61).value(), 0.05)},
          {"valence 5 and 7", shaken(revolve(pear_profile(4, 2), 240).value(), 0.02)}};
}

inline TriMesh sheet() { return shaken(rectangle(4, 3, 4, 3), 0.1); }

inline std::vector<int> valences(const TriMesh& mesh) {
  std::vector<int> count(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int node : t) ++count[node];
  return count;
}

}  // namespace calot::test
