#pragma once
// The paper's structural extension (Moutsopoulos and Gillies 1997, section 5.2, figure 1): a star of small
// triangles in the triangle that an instrument touches.

#include <array>
#include <span>

#include "geometry/stencil.h"
#include "geometry/tri_mesh.h"

namespace calot {

/// Rows of points of flat triangles: three nodes each, with first derivatives.
StencilTable linear_stencils(const std::vector<Triangle>& triangles, std::span<const FacePoint> points);

struct Star {
  std::array<int, 3> corners{};  ///< P1, P2, P3 of the triangle that was touched
  int centre = 0;                ///< P0
  std::array<int, 3> inner{};    ///< P1', P2', P3': the middles of P0Pi
  /// The node next to each corner on its spoke to P0: Pi', after subdivision nearer to Pi.
  std::array<int, 3> heirs{};
};

struct StarMesh {
  TriMesh mesh;                ///< the given mesh's nodes first, in order
  std::vector<int> parent;     ///< of each triangle: the given mesh's triangle that it lies in
  std::vector<bool> extended;  ///< of each triangle: whether that parent has a star
  std::vector<Star> stars;     ///< one a contact, in order
  int coarse_nodes = 0;        ///< of the given mesh
  /// Where each further node lies in the given mesh: its displacement with the coarse structure's, and a force
  /// on it passed to P1, P2, P3 (virtual work), are by these weights.
  std::vector<FacePoint> places;
};

/// The smallest barycentric weight of P0, half of what it has in the middle.
inline constexpr double least_weight = 1.0 / 6.0;

/// Where P0 goes for a contact there (weights below zero: beside the face). Near an edge or a node the
/// triangles of a star would be lines, so there P0 stands back: weights above `least_weight` keep their
/// ratio. Only the nodes move; a load stays where it is.
FacePoint stand_back(const FacePoint& contact);

/// Splits the triangle at each contact into nine: P0Pi'Pj' and, between it and the edges, PiPjPj' and
/// PiPj'Pi'. As the triangle's own edges stay whole, its neighbours do not change, and contacts in triangles
/// that share a node or an edge need no care. Then all triangles of the stars are subdivided `levels` times at
/// all their edges but those of the given mesh: into four each, three where one edge stays whole. Fails (usage) for two contacts in one triangle, a face out of range, a place that is not finite, `levels`
/// below 0.
Result<StarMesh> star_split(const TriMesh& coarse, std::span<const FacePoint> contacts, int levels);

/// The control mesh of a B-spline skin over a structure with stars (section 5.3): its nodes, without the
/// stars' corners P1, P2, P3.
struct StarControl {
  TriMesh mesh;
  std::vector<int> node;  ///< of each control point: the structure's node
};
/// Each corner is drawn into its heir (the edge between them collapses), so whatever joined Pi joins Pi'. A
/// corner that several stars share goes to its nearest heir; the other stars keep their rings towards it.
StarControl star_control(const StarMesh& structure);

}  // namespace calot
