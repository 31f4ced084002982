#pragma once
// A solid organ, such as a lobe of the liver: quadratic tetrahedra condensed once onto the control nodes of its skin, in
// strips that turn on their own. What is touched is its skin, a Loop surface: it yields as the control nodes do, so a
// dent narrower than they stand apart is shallower than a finer solid's.

#include "body/body.h"
#include "body/loop_skin.h"
#include "fem/capsule_net.h"
#include "fem/kept_reduction.h"
#include "fem/links.h"
#include "geometry/box_surface.h"
#include "geometry/tri_mesh.h"

namespace calot {

/// The skin's points stand this close at rest, m.
inline constexpr double solid_skin_spacing = 5.5e-3;

class SolidBody : public Body {
 public:
  struct Setup {
    std::string name = "liver";
    BoxSurface box;   ///< the control mesh' triangles
    TriMesh control;  ///< m; its limit surface is the rest shape
    ElasticSolid material{6e3, 0.45};
    double density = 1060;  ///< kg/m^3; 0: weightless
    CapsuleMaterial capsule = {};
    Vec3 up = Vec3::UnitZ();
    /// False: as drawn it is in balance with its weight, which then does nothing.
    bool sags = false;
    std::array<int, 3> cells_each{1, 1, 2};  ///< of tetrahedra in each cell of the box
    /// Strips that turn on their own: across, and from the box' second way's beginning to its end.
    std::array<int, 2> strips{1, 4};
    /// Elastic foundation at a skin point, on a triangle of the control mesh, at rest, N/m per m^2 (0: none).
    std::function<double(const Vec3& x, int triangle)> foundation = {};
    std::map<std::string, Vec3> landmarks = {};  ///< m, at rest: the nearest skin points
  };
  /// Fails (scenario) where the shape folds over itself. `kept` as of World::create: for its reduction.
  static Result<SolidBody> create(const Setup& setup, KeptResults* kept = nullptr);

  /// The same on another foundation.
  SolidBody with_foundation(const std::function<double(const Vec3& x, int triangle)>& foundation) const;
  const SolidBody* as_solid() const override { return this; }

  const std::string& name() const override { return setup_.name; }
  const VecX& rest() const override { return rest_; }
  /// The nodes after them are no places, but how far the modes of the inside are (solid_reduction.h), m, three a node.
  int coarse_nodes() const override { return mesh_.nodes; }
  double size() const override { return size_; }
  const std::vector<double>& edge_lengths() const override { return edge_lengths_; }
  const BlockMatrix& pattern() const override {
    return constant_;
  }  ///< its constant part is the foundation's

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const override;
  const VecX& kept_load() const override { return load_; }
  const BlockMatrix* mass() const override { return mass_ ? &*mass_ : nullptr; }
  double strain_energy(const VecX& x) const override { return solid_.value(x) + capsule_.value(x); }
  double max_stretch(const VecX& x) const override;

  const Tessellation& skin() const override { return skin_; }
  const std::vector<double>& skin_areas() const override { return skin_areas_; }
  double contact_area(int point) const override { return areas_[point / contacts_each] / contacts_each; }
  const std::vector<Vec3>& skin_rest() const override { return skin_rest_; }
  int skin_parts() const override { return parts_of(triangles_each()); }
  const std::vector<std::vector<int>>& face_nodes() const override { return face_nodes_; }
  std::vector<Vec3> skin_normals(const VecX& x) const override;
  std::map<std::string, int> landmarks() const override { return nearest_points(setup_.landmarks); }

  const FramedSolid& solid() const { return solid_; }
  const SolidMesh& mesh() const { return mesh_; }
  double volume() const { return volume_; }  ///< m^3, at rest

 private:
  void build_skin();
  void build_matrices(const ReducedSolid& reduced);
  /// The foundation's springs and the modes' own stiffness.
  void lay_bed(const std::function<double(const Vec3& x, int triangle)>& foundation);
  void add_modes(const VecX& diagonal, BlockMatrix& matrix) const;

  Setup setup_;
  SolidMesh mesh_;
  FramedSolid solid_;
  VecX rest_, load_;
  double size_ = 0, volume_ = 0;
  double least_force_ = 0;  ///< N
  VecX mode_stiffness_;     ///< N/m
  std::vector<double> edge_lengths_, areas_, skin_areas_;
  std::vector<Vec3> skin_rest_;
  std::vector<std::vector<int>> face_nodes_;
  Tessellation skin_;
  CapsuleNet capsule_;  ///< of half the control mesh' edges
  Links bed_;
  BlockMatrix constant_{0, {}};
  std::optional<BlockMatrix> mass_;
  std::vector<Eigen::Matrix<double, 3, 10>> slopes_;  ///< 1/m, of each tetrahedron: its mean deformation
};

}  // namespace calot
