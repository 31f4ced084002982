#pragma once
// A hollow organ: the shell on its subdivision surface, its bile, its bed, and the skin that is drawn and touched
// (the paper's virtual structure, section 5).

#include <functional>
#include <memory>
#include <optional>

#include "anatomy/definitions.h"
#include "base/units.h"
#include "body/body.h"
#include "body/loop_skin.h"
#include "fem/bile.h"
#include "fem/links.h"
#include "fem/shell.h"
#include "geometry/tri_mesh.h"
#include "skin/shared_rows.h"

namespace calot {

/// The skin (drawn and touched) is split so that its points stand this close at rest, m: what is drawn follows a jaw's
/// edge, 0.8 mm round.
inline constexpr double skin_spacing = 1.0e-3;

/// The bile of a shell, less what keeps the rest state as it is (ShellBody::keep_in_equilibrium).
struct ShellBile : Liquid {
  explicit ShellBile(Bile filling) : bile(std::move(filling)) {}
  double volume(const VecX& x) const override { return bile.volume(x) - kept_volume; }
  double add_volume_gradient(const VecX& x, VecX& gradient) const override {
    return bile.add_volume_gradient(x, gradient) - kept_volume;
  }
  double add_weight_and_volume_gradient(const VecX& x, VecX& load, VecX& gradient) const override {
    return bile.add_load_and_volume_gradient(x, 0, load, gradient) - kept_volume;
  }
  double weight_value(const VecX& x) const override { return bile.value(x); }
  void add_load(const VecX& x, double datum_pressure, VecX& gradient) const override {
    bile.add_load(x, datum_pressure, gradient);
  }
  void add_hessian(const VecX& x, double datum_pressure, BlockMatrix& matrix,
                   Assembly* assembly) const override {
    bile.add_hessian(x, datum_pressure, matrix, assembly);
  }
  void add_hessian(const VecX& x, double datum_pressure, const Vec3& weight, BlockMatrix& matrix,
                   Assembly* assembly) const override {
    bile.add_hessian(x, datum_pressure, LiquidWeight::pulling(bile.weight().vector() + weight), matrix,
                     assembly);
  }
  LiquidMass mass(const FlowModes& flow, double kept, const LiquidMotion& begin, double h) const override {
    return LiquidMass(bile, flow, bile.specific_weight() / units::standard_gravity, kept + kept_volume, begin,
                      h);
  }
  Vec3 centroid(const VecX& x, double kept) const override {
    return bile.moments(x).first / (kept + kept_volume);
  }
  double pressure_at(const Vec3& place, double datum_pressure) const override {
    return bile.pressure_at(place, datum_pressure);
  }
  double pressure_at_top(const VecX& x, double datum_pressure) const override {
    return bile.pressure_at_top(x, datum_pressure);
  }

  Bile bile;
  double kept_volume = 0;  ///< m^3
};

class ShellBody : public Body {
 public:
  /// From a control mesh whose limit surface is the unstressed shape (m, world).
  struct Setup {
    std::string name = "organ";
    TriMesh control;
    ShellMaterial material;
    std::optional<BileDefinition> bile;  ///< closed surfaces only
    double wall_density = 0;             ///< kg/m^3; 0: weightless
    Vec3 up = Vec3::UnitZ();
    /// Elastic foundation at a quadrature point at rest position x, N/m per m^2 (0: none).
    std::function<double(const Vec3& x)> foundation;
    std::vector<QuadraturePoint> rule = three_point_rule();
    int levels = 0;  ///< of details that it can be extended by
    /// Places of its landmarks, m, where its skin lies so at rest: the nearest skin points.
    std::function<std::map<std::string, Vec3>(const std::vector<Vec3>& skin)> landmarks = {};
  };
  static Result<ShellBody> create(const Setup& setup);

  /// The same structure with other details active (odd nodes of levels().nodes, increasing): the paper's
  /// structural extensions. The faces that they split have quadrature and bile of their own; the bed stays where
  /// it was. Fails (scenario) where too many details reach one face.
  Result<ShellBody> with_details(std::vector<int> details) const;
  /// The same, with its details, on another foundation (Setup::foundation).
  Result<ShellBody> with_foundation(std::function<double(const Vec3& x)> foundation) const;
  /// From here on details refine the answer to instruments, not the state `rest` (of this structure, which has no
  /// details, in equilibrium): with any details the same shape is in equilibrium, held by a constant load and volume
  /// that make good what the finer rules see differently there. So nothing moves where an extension is laid or
  /// taken away unloaded (the defect correction of the full approximation scheme: Brandt 1977).
  void keep_in_equilibrium(const BodyState& rest);
  /// That load with the wall's weight, N, 3 a node; empty where there is neither.
  const VecX& kept_load() const override { return refined_->kept_load; }
  /// Gradient of the energies of wall, bed and bile less that load, N.
  VecX forces(const VecX& x, double datum_pressure) const;
  const std::vector<int>& details() const override { return refined_->surface.basis.details(); }
  const DetailBasis& basis() const { return refined_->surface.basis; }
  const SurfaceLevels& levels() const { return base_->levels; }
  /// Where the nodes of all levels lie on the surface at rest, m.
  const std::vector<Vec3>& node_rest() const { return base_->node_rest; }
  /// Coordinates `x` of this structure as those of `other`, which differs in its details only: those that are new
  /// there begin at zero.
  VecX coordinates_in(const ShellBody& other, const VecX& x) const;
  int levels_used() const override;
  int level_of_detail(int index) const override { return levels().level_of(details()[index]); }
  int most_levels() const override { return base_->levels.levels(); }
  double largest_motion(const VecX& dx) const override;
  std::map<std::string, int> landmarks() const override;
  const ShellBody* as_shell() const override { return this; }

  const std::string& name() const override { return base_->setup.name; }
  int coarse_nodes() const override { return refined_->surface.basis.coarse_nodes(); }
  const VecX& rest() const override { return refined_->rest; }
  const TriMesh& control() const { return base_->setup.control; }
  const Shell& shell() const { return refined_->shell; }
  const Bile* bile() const { return refined_->bile ? &refined_->bile->bile : nullptr; }
  const std::vector<double>& edge_lengths() const override { return refined_->edge_lengths; }
  double size() const override { return base_->size; }
  const BlockMatrix& pattern() const override {
    return refined_->constant;
  }  ///< its constant part is the bed's

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const override;
  const BlockMatrix* mass() const override { return refined_->mass ? &*refined_->mass : nullptr; }
  const Liquid* liquid() const override { return refined_->bile ? &*refined_->bile : nullptr; }
  /// Of the coarse nodes' motions: what details move is too little.
  Result<FlowModes> flow(const VecX& x) const override;
  double strain_energy(const VecX& x) const override { return refined_->shell.value(x); }
  double max_stretch(const VecX& x) const override { return refined_->shell.max_stretch(x); }

  const Tessellation& skin() const override { return refined_->skin; }
  const std::vector<double>& skin_areas() const override { return base_->skin_areas; }
  double contact_area(int point) const override {
    return base_->triangle_areas[point / contacts_each] / contacts_each;
  }
  const std::vector<Vec3>& skin_rest() const override { return base_->skin_rest; }
  int skin_parts() const override { return parts_of(triangles_each()); }
  const std::vector<std::vector<int>>& face_nodes() const override { return refined_->face_nodes; }
  std::vector<Vec3> skin_normals(const VecX& x) const override;
  /// About the wall's own resistance to a detail (by its place among details()), N/m.
  double detail_stiffness(int index) const;

  /// The bed's springs and the surface points that they hold, the same at rest whatever the details.
  const Links& foundation() const { return base_->bed; }
  const StencilTable& bed_points() const { return refined_->bed_points; }
  const StencilTable& quadrature() const { return refined_->quadrature; }

 private:
  /// What does not depend on the details.
  struct Base {
    Setup setup;
    SurfaceLevels levels;
    Tessellation skin{};
    Tessellation flow_skin{};                   ///< closed, of coarse nodes
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
  void build_mass();
  void build_bed(const ShellBody* before, const SharedRows* shared);

  struct Kept {
    BodyState state;
    VecX forces;  ///< of wall, bed and bile, less the weight
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
    Shell shell;
    std::optional<ShellBile> bile;
    Tessellation skin;
    std::vector<double> edge_lengths;
    BlockMatrix constant{0, {}};
    std::optional<BlockMatrix> mass;
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
