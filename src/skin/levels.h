#pragma once
// Nested levels of one Loop surface: the faces of each level split into four on the next, and the surface is that
// of any level's control mesh. What a level adds to the one before it are the functions of its odd nodes (those
// on split edges): with all nodes of level 0 they are a basis of the finer level, linearly independent (natural
// refinement: Krysl, Grinspun and Schroeder 2003, doi 10.1002/nme.601).

#include <array>
#include <vector>

#include "skin/subdivision.h"

namespace calot {

class SurfaceLevels {
 public:
  /// Levels 0 (`control`) to `levels`; connectivity and edges' numbers go one further. Failures as
  /// LoopSurface::create.
  static Result<SurfaceLevels> create(const TriMesh& control, int levels);

  int levels() const { return static_cast<int>(surfaces_.size()) - 1; }
  /// Nodes keep their numbers from level to level; those from nodes(level - 1) to nodes(level) - 1 are odd ones
  /// of `level`. `level` to levels() + 1.
  int nodes(int level) const { return meshes_[level].nodes; }
  int level_of(int node) const;
  /// Corners of the faces; face f's children on the next level are 4f + c at corner c and 4f + 3 in the middle.
  const std::vector<Triangle>& faces(int level) const { return meshes_[level].faces; }
  /// Node of level + 1 on the edge from corner `edge` of a face to the next corner; `level` to levels().
  int edge_node(int level, int face, int edge) const { return meshes_[level].edge_nodes[face][edge]; }
  /// The one or two faces of `level` whose edge the odd node of level + 1 splits; -1 where there is none.
  const std::array<int, 2>& faces_at_edge(int level, int odd_node) const {
    return meshes_[level].edge_faces[odd_node - meshes_[level].nodes];
  }
  /// Faces of level 0 on which the function of a node of `level` is not zero: increasing.
  std::vector<int> support(int level, int node) const;

  /// Where a node of any level lies, in the parameters of a face of level 0.
  FacePoint place(int node) const { return places_[node]; }
  /// A point of a level's face in the parameters of the face of level 0 that it is part of.
  FacePoint on_coarse(int level, const FacePoint& at) const;

  /// Stencils over the nodes of `level` at points of level 0's faces, with derivatives by level 0's parameters;
  /// accurate as LoopSurface::evaluate, by the level's own edges.
  StencilTable evaluate(int level, std::span<const FacePoint> points, int order) const;
  const LoopSurface& surface() const { return surfaces_.front(); }

 private:
  struct Mesh {
    int nodes = 0;
    std::vector<Triangle> faces;
    std::vector<std::array<int, 3>> edge_nodes;
    std::vector<std::array<int, 2>> edge_faces;
    std::vector<std::vector<int>> faces_of_node;
  };
  static void number_edges(Mesh& mesh);
  static Mesh split(const Mesh& mesh);
  void place_nodes();

  std::vector<Mesh> meshes_;  ///< levels + 2
  std::vector<LoopSurface> surfaces_;
  std::vector<FacePoint> places_;
};

}  // namespace calot
