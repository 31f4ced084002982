#pragma once
// One organ: the shell on its subdivision surface, its bile, its bed, and the skin that is drawn and touched
// (the paper's virtual structure, section 5). Everything here is fixed once built; what moves is in
// BodyState.

#include <functional>
#include <memory>
#include <optional>

#include "anatomy/definitions.h"
#include "fem/bile.h"
#include "fem/links.h"
#include "fem/shell.h"
#include "geometry/tri_mesh.h"
#include "numerics/newton.h"
#include "sim/contact_points.h"
#include "skin/shared_rows.h"

namespace calot {

/// The skin (drawn and touched) is split so that its points stand this close at rest, m: what is drawn follows a jaw's
/// edge, 0.8 mm round.
inline constexpr double skin_spacing = 1.0e-3;

/// How freely a detail moves (detail_fading.h).
struct DetailShare {
  double share = 1;      ///< 0: held at rest, 1: free
  bool leaving = false;  ///< its share falls
  bool operator==(const DetailShare&) const = default;
};

struct BodyState {
  VecX x;                     ///< 3 a node, m: places of the control nodes, then displacements of the details
  double datum_pressure = 0;  ///< pressure at the datum's height, Pa
  double volume = 0;          ///< m^3, what the constraint keeps
  std::vector<DetailShare> shares = {};  ///< one a detail; none: all are free
  /// N, 3 a node: what a change of the details altered and is still made good; empty: nothing.
  VecX fading_load = {};
};

class ShellBody {
 public:
  /// From a control mesh whose limit surface is the unstressed shape (m, world).
  struct Setup {
    std::string name = "organ";
    TriMesh control;
    ShellMaterial material;
    std::optional<BileDefinition> bile;  ///< closed surfaces only
    Vec3 up = Vec3::UnitZ();
    /// Elastic foundation at a quadrature point at rest position x, N/m per m^2 (0: none).
    std::function<double(const Vec3& x)> foundation;
    std::vector<QuadraturePoint> rule = three_point_rule();
    int levels = 0;  ///< of details that it can be extended by
  };
  static Result<ShellBody> create(const Setup& setup);

  /// The same structure with other details active (odd nodes of levels().nodes, increasing): the paper's
  /// structural extensions. The faces that they split have quadrature and bile of their own; the bed stays where
  /// it was. Fails (scenario) where too many details reach one face.
  Result<ShellBody> with_details(std::vector<int> details) const;
  /// From here on details refine the answer to instruments, not the state `rest` (of this structure, which has no
  /// details, in equilibrium): with any details the same shape is in equilibrium, held by a constant load and volume
  /// that make good what the finer rules see differently there. So nothing moves where an extension is laid or
  /// taken away unloaded (the defect correction of the full approximation scheme: Brandt 1977).
  void keep_in_equilibrium(const BodyState& rest);
  /// That load, N, 3 a node; empty without details or before keep_in_equilibrium.
  const VecX& kept_load() const { return refined_->kept_load; }
  /// Gradient of the energies of wall, bed and bile less that load, N.
  VecX forces(const VecX& x, double datum_pressure) const;
  /// Enclosed volume, m^3, of a structure with bile.
  double volume(const VecX& x) const { return refined_->bile->volume(x) - refined_->kept_volume; }
  /// The same, its gradient (m^2) added to `gradient`.
  double add_volume_gradient(const VecX& x, VecX& gradient) const {
    return refined_->bile->add_volume_gradient(x, gradient) - refined_->kept_volume;
  }
  /// The same with the load of the bile's weight added to `load`.
  double add_weight_and_volume_gradient(const VecX& x, VecX& load, VecX& gradient) const {
    return refined_->bile->add_load_and_volume_gradient(x, 0, load, gradient) - refined_->kept_volume;
  }
  const std::vector<int>& details() const { return refined_->surface.basis.details(); }
  const DetailBasis& basis() const { return refined_->surface.basis; }
  const SurfaceLevels& levels() const { return base_->levels; }
  /// Where the nodes of all levels lie on the surface at rest, m.
  const std::vector<Vec3>& node_rest() const { return base_->node_rest; }
  /// Coordinates `x` of this structure as those of `other`, which differs in its details only: those that are new
  /// there begin at zero.
  VecX coordinates_in(const ShellBody& other, const VecX& x) const;
  /// Levels that have active details.
  int levels_used() const;
  /// Bound on how far any surface point moves when the nodes move by `dx`, m.
  double largest_motion(const VecX& dx) const;

  /// Whether both are one structure, but for their details.
  bool same_base(const ShellBody& other) const { return base_ == other.base_; }

  const std::string& name() const { return base_->setup.name; }
  int nodes() const { return static_cast<int>(refined_->rest.size()) / 3; }
  int coarse_nodes() const { return refined_->surface.basis.coarse_nodes(); }
  const VecX& rest() const { return refined_->rest; }
  const TriMesh& control() const { return base_->setup.control; }
  const Shell& shell() const { return refined_->shell; }
  const std::optional<Bile>& bile() const { return refined_->bile; }
  const Tessellation& skin() const { return refined_->skin; }
  /// Rest area that each skin point stands for, m^2.
  const std::vector<double>& skin_areas() const { return base_->skin_areas; }
  /// Rest area that a contact point (contact_points.h) stands for, m^2.
  double contact_area(int point) const {
    return base_->triangle_areas[point / contacts_each] / contacts_each;
  }
  const std::vector<Vec3>& skin_rest() const { return base_->skin_rest; }
  /// Longest edge of the skin's triangles at rest, m.
  double widest_skin_gap() const;
  /// Shortest control edge at each node at rest (halved with each level for a detail), m: the scale of a safe
  /// step there.
  const std::vector<double>& edge_lengths() const { return refined_->edge_lengths; }
  /// About the wall's own resistance to a detail (by its place among details()), N/m.
  double detail_stiffness(int index) const;
  double size() const { return base_->size; }  ///< m, diagonal of the rest shape's box

  /// Nodes that the skin of each control face depends on. As the weights are not negative it lies in the box of the
  /// coarse ones among them, widened by half of each detail's length, whatever the state.
  const std::vector<std::vector<int>>& face_nodes() const { return refined_->face_nodes; }
  /// Triangles of the skin on each control face, which follow each other: those of the first face first.
  int triangles_each() const {
    return static_cast<int>(refined_->skin.triangles.size() / refined_->face_nodes.size());
  }

  /// A matrix with this structure's pattern that holds the constant part of its Hessian (the bed).
  const BlockMatrix& pattern() const { return refined_->constant; }

  /// The bed's springs and the surface points that they hold, the same at rest whatever the details.
  const Links& foundation() const { return base_->bed; }
  const StencilTable& bed_points() const { return refined_->bed_points; }
  const StencilTable& quadrature() const { return refined_->quadrature; }

  std::vector<Vec3> skin_positions(const VecX& x) const;  ///< m
  Vec3 skin_point(int row, const VecX& x) const {
    return blend(refined_->skin.stencils, refined_->skin.stencils.value, row, x);
  }
  std::vector<Vec3> skin_normals(const VecX& x) const;  ///< unit, outward

 private:
  /// What does not depend on the details.
  struct Base {
    Setup setup;
    SurfaceLevels levels;
    Tessellation skin{};
    std::vector<StencilTable> skin_by_level{};  ///< of levels 1, 2, ...
    /// The same places without derivatives, which only drawing asks for.
    StencilTable skin_places{};
    std::vector<StencilTable> skin_places_by_level{};
    std::vector<Vec3> skin_rest{}, node_rest{};
    std::vector<double> skin_areas{}, triangle_areas{};
    std::vector<std::vector<int>> face_points{},
        face_nodes{};  ///< skin points on each face, with the coarse nodes
    Links bed{};
    std::vector<FacePoint> bed_places{};
    double size = 0;
    Vec3 middle = Vec3::Zero();
  };
  ShellBody(std::shared_ptr<const Base> base, std::vector<int> details)
      : base_(std::move(base)),
        refined_(std::make_shared<Refined>(detailed(base_->levels, std::move(details)))) {}
  static DetailedSurface detailed(const SurfaceLevels& levels, std::vector<int> details);
  /// The bed holds on to the coarse rule's points.
  static void lay_bed(const VecX& rest, Base& base);
  /// What is the same in `before`, of the same base, is taken from there.
  std::optional<Failure> build(const ShellBody* before);
  std::optional<Failure> build_shell(const ShellBody* before, const SharedRows* shared);
  void build_skin();
  Result<bool> build_bile(const ShellBody* before, const SharedRows* shared);
  void build_bed(const ShellBody* before, const SharedRows* shared);

  struct Kept {
    BodyState state;
    VecX own_forces;  ///< of wall, bed and bile
  };
  /// Gradient of the energies of wall, bed and bile, N.
  VecX own_forces(const VecX& x, double datum_pressure) const;
  /// Sets the load and volume that keep the state kept_ in equilibrium.
  void make_good();

  /// What depends on the details; nothing changes it once built, so copies of a body share it.
  struct Refined {
    explicit Refined(DetailedSurface detailed) : surface(std::move(detailed)) {}
    DetailedSurface surface;
    VecX rest, kept_load;
    double kept_volume = 0;
    Shell shell;
    std::optional<Bile> bile;
    Tessellation skin;
    std::vector<double> edge_lengths;
    BlockMatrix constant{0, {}};
    StencilTable quadrature, bed_points;
    std::vector<int> first_rows;  ///< of quadrature: each coarse face's first, and their number
    std::vector<int> bile_nodes;  ///< of all levels, where the bile's points are: increasing
    std::vector<std::vector<int>> face_nodes;
  };

  std::shared_ptr<const Base> base_;
  std::shared_ptr<const Kept> kept_;
  std::shared_ptr<Refined> refined_;
};

}  // namespace calot
