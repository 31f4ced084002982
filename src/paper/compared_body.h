#pragma once
// What the comparison (paper/comparison.h) loads and measures: a sphere full of bile, of either formulation, under
// the same springs on the same surface points.

#include <memory>
#include <string>
#include <vector>

#include "numerics/newton.h"
#include "skin/levels.h"

namespace calot {

/// Springs spread about a place of the surface, whose ends go along the surface's normal there.
struct LoadedPlace {
  Vec3 direction = Vec3::UnitZ();  ///< from the sphere's centre, unit
  double travel = 0;               ///< m outwards
};
struct ComparedLoad {
  std::string name;
  std::vector<LoadedPlace> places;
};

/// Surface points that every body shares, by coarse faces' parameters and by their directions from the centre, and
/// the load's stiffness on them: the same numbers whatever the mesh.
struct ComparedSurface {
  TriMesh control;  ///< of the coarse Loop surface, a sphere about the origin
  SurfaceLevels levels;
  std::vector<FacePoint> points;
  std::vector<Vec3> rest;  ///< of the points on the coarse limit surface, m
  double radius = 0;       ///< m

  /// Control meshes of `nodes` nodes and up to `finest` levels more; the points are the nodes of level 2.
  static Result<ComparedSurface> create(double radius, int nodes, int finest);
  /// Springs on each point about a place, N/m: Gaussian, in sum `contact_stiffness`, none beyond three spreads.
  std::vector<double> springs(const Vec3& direction) const;
  /// The mesh of a level that controls the same limit surface.
  Result<TriMesh> level_control(int level) const;
};

inline constexpr double contact_stiffness = 1000;  ///< N/m, of all springs of a place
inline constexpr double contact_spread = 2.5e-3;   ///< m
/// The bed: an elastic foundation about the lowest point, none beyond three spreads.
inline constexpr double bed_stiffness = 2e6;  ///< N/m per m^2 in its middle
inline constexpr double bed_spread = 8e-3;    ///< m
inline constexpr double compared_fill = 1.1;  ///< kept volume over the rest volume

class ComparedBody {
 public:
  virtual ~ComparedBody() = default;
  /// Filled, at rest, and bound to the load's springs where these carry nothing yet.
  virtual NewtonResult begin(const ComparedLoad& load, FactorKind solver) = 0;
  /// To equilibrium with the springs' ends at `share` of their travels, from where it is.
  virtual NewtonResult step(double share) = 0;
  /// The shared points, m.
  virtual std::vector<Vec3> surface() const = 0;
  virtual int nodes() const = 0;
  /// Of those that the condensed solver keeps.
  virtual int coarse_nodes() const { return nodes(); }
  /// The linear systems that a step solves, as last assembled.
  virtual std::vector<const NewtonWorkspace*> systems() const = 0;
  /// Wall time in which the last of the extensions was laid and the body was at rest again, s; 0 without.
  virtual double insertion_s() const { return 0; }
  /// From now on a step solves in the paper's two stages, or not; false where there is no such choice.
  virtual bool use_stages(bool /*staged*/) { return false; }
};

/// The finite elements of this project, on the Loop surface. Level `uniform` of the whole surface, or with details
/// of `extended` levels around each place. Failures as ShellBody's.
Result<std::unique_ptr<ComparedBody>> uniform_shell(const ComparedSurface& surface, int uniform);
Result<std::unique_ptr<ComparedBody>> extended_shell(const ComparedSurface& surface,
                                                     const std::vector<Vec3>& places, int levels);

/// The paper's: flat triangles with hinges (paper/star_structure.h). `levels`: subdivisions of the stars.
Result<std::unique_ptr<ComparedBody>> uniform_triangles(const ComparedSurface& surface, int uniform);
Result<std::unique_ptr<ComparedBody>> extended_triangles(const ComparedSurface& surface,
                                                         const std::vector<Vec3>& places, int levels,
                                                         bool two_stages);

}  // namespace calot
