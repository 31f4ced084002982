#pragma once
// The comparison of the paper's section 6: a coarse structure with structural extensions, of one system or in
// its two stages, against uniformly finer structures of the same elements under the same load.

#include <string>

#include "paper/star_structure.h"

namespace calot {

/// Spheres of flat triangles, each twice as fine as the one before it, all of the sphere's volume.
Result<std::vector<TriMesh>> flat_spheres(double radius, int nodes, int refinements);

/// A sphere full of bile, its base held, one place of it moved along its normal.
struct PaperCase {
  PaperSetup setup;
  double radius = 20e-3;           ///< m
  int nodes = 61;                  ///< of the coarse structure
  int refinements = 2;             ///< each splits every edge: 61, 238, 946 nodes
  double base_stiffness = 2e6;     ///< N/m per m^2 in the middle of the base, below
  double base_spread = 8e-3;       ///< m, of its Gaussian
  Vec3 contact{0.45, 0.25, 0.86};  ///< direction from the centre, of any length but 0
  double outward = 10e-3;          ///< how far the springs' ends go, m; negative: inward
  double contact_stiffness = 1e8;  ///< N/m per m^2 in the middle of the contact
  double contact_spread = 2e-3;    ///< m, of its Gaussian
  int steps = 8;                   ///< of the motion
  int extensions = 3;              ///< in the triangles nearest to the contact
  std::vector<int> levels{0};      ///< subdivisions of the extensions, a pair of rows each
};

struct PaperRow {
  std::string formulation;  ///< "uniform", "extended, one system" or "extended, two stages"
  int nodes = 0, extensions = 0, levels = 0;
  int unknowns = 0;           ///< of all stages
  int newton_iterations = 0;  ///< filling and motion
  double factor_flops = 0;    ///< of one factorisation of each stage, the paper's measure
  double flops = 0;           ///< of all factorisations
  double memory_bytes = 0;    ///< matrices and factors
  /// Distance of surface points from where the finest uniform structure has them, over its largest
  /// displacement, %: in the mean, in the mean within 10 mm of the contact, at most.
  double mean_error_pct = 0, contact_error_pct = 0, max_error_pct = 0;
  double condition_estimate = 0;  ///< (largest / smallest diagonal of L)^2, of the worse stage
  double solve_s = 0;             ///< wall time; nothing else depends on it
  double largest_m = 0;           ///< largest displacement
};

/// Rows: the uniform structures from coarse to fine, then for each of `levels` the extended one of one system
/// and in two stages. Some 3,800 surface points, seen from the sphere's centre, carry the load and are
/// compared; all structures are scaled to hold the sphere's volume, and displacements count from the filled
/// state. Fails
/// (usage) for a case without sense, and (simulation) when a structure finds no equilibrium.
Result<std::vector<PaperRow>> compare_paper(const PaperCase& given);

}  // namespace calot
