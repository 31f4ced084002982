#pragma once
// A coarse Loop surface with some functions of its finer levels beside: a structural extension's basis (the paper,
// section 5.2, whose new nodes P0 and P1', P2', P3' are these functions' nodes).

#include <vector>

#include "skin/levels.h"

namespace calot {

/// Columns: the coarse nodes, which are places, then the details in increasing number, which are displacements,
/// zero at rest. The details' functions lie between 0 and 1/2 and those of one level sum to at most 1.
class DetailBasis {
 public:
  /// `details`: odd nodes of any level, increasing. `levels` must outlive this.
  DetailBasis(const SurfaceLevels& levels, std::vector<int> details);

  int coarse_nodes() const { return levels_->nodes(0); }
  int nodes() const { return coarse_nodes() + static_cast<int>(details_.size()); }
  const std::vector<int>& details() const { return details_; }

  /// Details whose functions are not zero somewhere on a coarse face: increasing.
  const std::vector<int>& details_on(int face) const { return details_on_[face]; }
  bool reaches(int face) const { return !details_on_[face].empty(); }

  /// Stencils at points of coarse faces, with derivatives by the coarse parameters.
  StencilTable evaluate(std::span<const FacePoint> points, int order) const;
  /// The same where the coarse columns are known: `coarse` as SurfaceLevels::evaluate(0, points, order).
  StencilTable extend(const StencilTable& coarse, std::span<const FacePoint> points, int order) const;
  /// The same where those of the levels 1, 2, ... are known too, by SurfaceLevels::evaluate.
  StencilTable extend(const StencilTable& coarse, std::span<const FacePoint> points,
                      const std::vector<StencilTable>& by_level) const;

 private:
  /// `fine`: of each active level, a row a point.
  StencilTable merge(const StencilTable& coarse, std::span<const FacePoint> points,
                     const std::vector<const StencilTable*>& fine) const;

  const SurfaceLevels* levels_;
  std::vector<int> details_;
  struct Level {
    int level = 0;
    std::vector<int> column;    ///< of each of the level's nodes, -1: not active
    std::vector<char> touched;  ///< coarse faces on which an active function is not zero
  };
  std::vector<Level> active_;  ///< increasing
  std::vector<std::vector<int>> details_on_;
};

/// Faces as far split as the details on them ask: a detail splits the faces whose edge carries it, and neighbours
/// differ by one split at most.
struct FaceTree {
  struct Leaf {
    int level = 0, face = 0;
    std::array<bool, 3> hanging = {};  ///< the neighbour at this edge is split, so that a node hangs on it

    bool operator==(const Leaf&) const = default;
    /// Whether both are parts of one face of the level before.
    bool sibling_of(const Leaf& other) const {
      return level > 0 && other.level == level && other.face / 4 == face / 4;
    }
  };
  std::vector<Leaf> leaves;  ///< by coarse face, those of one parent next to each other
  std::vector<int> first;    ///< leaf of each coarse face, and their number

  FaceTree() = default;
  /// `merged`: one split less, leaves that are all the children of a face make way for it where neighbours allow.
  FaceTree(const SurfaceLevels& levels, std::span<const int> details, bool merged = false);
};

/// Triangles that cover a leaf, corners as node numbers of any level: without cracks beside those of its
/// neighbours. `fine`: the leaf split into four first.
std::vector<Triangle> cover(const SurfaceLevels& levels, const FaceTree::Leaf& leaf, bool fine);

}  // namespace calot
