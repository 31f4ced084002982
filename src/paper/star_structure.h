#pragma once
// The structure of Moutsopoulos and Gillies 1997 (section 5), a baseline to measure ours against:
// constant-strain triangles with bending hinges, solved as one system or, with the stars of structural
// extensions, in two stages.

#include "anatomy/definitions.h"
#include "fem/bile.h"
#include "fem/hinges.h"
#include "fem/links.h"
#include "fem/shell.h"
#include "geometry/star_split.h"
#include "numerics/newton.h"

namespace calot {

struct PaperSetup {
  WallDefinition wall;         ///< thickness and shear modulus take part
  double bile_density = 1020;  ///< kg/m^3
  Vec3 up = Vec3::UnitZ();     ///< unit
  double fill = 1.0;           ///< kept volume over the rest volume
  NewtonSettings newton;
  std::optional<FactorKind> solver = {};  ///< none: by the number of nodes
};

/// Membrane, hinges and bile of some triangles. Fixed once built.
struct PaperElements {
  VecX rest;
  Shell membrane;
  Hinges hinges;
  Bile bile;
  std::vector<double> edges;   ///< shortest at each node, m
  double size = 0;             ///< m, of the whole
  BlockMatrix pattern{0, {}};  ///< of all nodes, empty
  std::vector<std::vector<int>> cliques;

  /// `mesh` may be a part of a closed surface: then the bile's forces hold for nodes inside that part. Hinges
  /// reach over to the `neighbours`, triangles that have no membrane here.
  static Result<PaperElements> create(const TriMesh& mesh, const std::vector<Triangle>& neighbours,
                                      const PaperSetup& setup);
};

/// Springs on points of the elements' triangles.
struct PaperSprings {
  Links links;
  /// Entries in the pattern of the unknowns: linear springs have one Hessian for good.
  std::vector<double> hessian;

  void find_hessian(const PaperElements& elements, const StencilTable& points, int first);
};

/// Equilibrium of nodes `first`, first + 1, ... (the unknowns), those before held where `nodes` has them.
class PaperProblem : public BodyEnergy {
 public:
  /// `points` are points of the elements' triangles, springs its rows. Without `volume` the bile's datum_pressure
  /// (pressure at the origin's height, Pa) is given.
  PaperProblem(const PaperElements& elements, const StencilTable& points, const PaperSprings& springs,
               std::optional<double> volume, double datum_pressure, const VecX& nodes, int first);

  bool constrained() const override { return volume_.has_value(); }
  double value(const VecX& x) const override;
  void gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void hessian(const VecX& x, double datum_pressure, BlockMatrix& matrix) const override;
  double constraint(const VecX& x, VecX& gradient) const override;
  double constraint_value(const VecX& x) const override;
  double constraint_scale() const override { return volume_.value_or(1.0); }
  double length_scale() const override { return elements_.size; }
  double safe_share(const VecX& x, const VecX& step) const override;

  /// Empty matrix of the unknowns.
  static BlockMatrix pattern(const PaperElements& elements, int first);

 private:
  VecX whole(const VecX& x) const;  ///< all nodes
  void add_elements(const VecX& all, double datum_pressure, BlockMatrix& matrix) const;

  const PaperElements& elements_;
  const StencilTable& points_;
  const PaperSprings& springs_;
  std::optional<double> volume_;
  double datum_pressure_;
  VecX nodes_;
  int first_;
};

/// A body of one system, or of the paper's two: the coarse structure first, under the loads at its flat
/// triangles' points, which is to say passed to P1, P2, P3 by barycentric weights; then the extensions' new
/// nodes under the same loads, with the coarse nodes and the bile's pressure as they came out.
class PaperBody {
 public:
  /// `points`: material points of the mesh that springs bind to and that surface() follows.
  static Result<PaperBody> one_system(const TriMesh& mesh, const std::vector<FacePoint>& points,
                                      const PaperSetup& setup);
  /// The same points, in the coarse mesh and in its split.
  static Result<PaperBody> two_stages(const TriMesh& coarse, const std::vector<FacePoint>& points,
                                      const StarMesh& split, const std::vector<FacePoint>& split_points,
                                      const PaperSetup& setup);

  /// Springs of `stiffness` (N/m, one a point, 0: none) to where the points are now. Their ends
  /// go by `travel` (m), as far as settle() says.
  void bind(const std::vector<double>& stiffness, const Vec3& travel);
  /// To equilibrium with the springs' ends at `share` of their travels. On failure the stage that failed is at
  /// its last iterate.
  NewtonResult settle(double share);
  /// Of each stage: its matrix, as last assembled, and its factor.
  std::vector<const NewtonWorkspace*> systems() const;

  std::vector<Vec3> surface() const;  ///< the points, m
  double volume() const;              ///< enclosed by the first (or only) stage, m^3
  const VecX& nodes() const { return stages_.back().nodes; }
  double pressure() const { return datum_pressure_; }  ///< at the origin's height, Pa

 private:
  struct Stage {
    PaperElements elements;
    StencilTable points;
    std::vector<bool> loaded;  ///< points whose springs act on this stage's unknowns
    std::optional<double> volume;
    int first = 0;  ///< unknown
    VecX nodes;
    NewtonWorkspace work;
    PaperSprings springs;
    std::vector<Vec3> from, travel;  ///< of each spring
  };
  static Stage make_stage(PaperElements elements, StencilTable points, std::vector<bool> loaded,
                          std::optional<double> volume, int first, std::optional<FactorKind> solver);
  void carry_extension();
  NewtonResult solve(Stage& stage, double share);

  PaperSetup setup_;
  std::vector<Stage> stages_;
  StencilTable places_;  ///< of the second stage's unknowns in the first stage's mesh
  double datum_pressure_ = 0;
};

}  // namespace calot
