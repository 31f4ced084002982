#pragma once
// A rigid thing as a body: an affine one of four nodes, which its stiffness keeps a rotation of itself. A soft one strains
// alike everywhere.

#include "anatomy/definitions.h"
#include "body/body.h"
#include "fem/affine.h"
#include "geometry/tri_mesh.h"

namespace calot {

class RigidBody : public Body {
 public:
  struct Setup {
    std::string name = "stone";
    TriMesh surface;     ///< m, closed, outward, where it is at rest
    double density = 0;  ///< kg/m^3
    /// Pa, Young's modulus: a turn of 1/20 in one step of the solver still costs no more than weight gives. Stiffer ones
    /// take many short steps to roll to rest, and so does tissue that turns them.
    double stiffness = RigidShape{}.stiffness;
    Vec3 up = Vec3::UnitZ();
    /// Places that move along, m, where it is at rest; its centre is one of itself.
    std::map<std::string, Vec3> landmarks = {};
  };
  /// Fails (scenario) where the surface encloses nothing.
  static Result<RigidBody> create(const Setup& setup);

  const std::string& name() const override { return setup_.name; }
  const VecX& rest() const override { return rest_; }
  double size() const override { return size_; }
  const std::vector<double>& edge_lengths() const override { return edge_lengths_; }
  const BlockMatrix& pattern() const override { return pattern_; }

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const override;
  const VecX& kept_load() const override { return weight_; }
  double strain_energy(const VecX& x) const override { return value(x); }
  double max_stretch(const VecX& x) const override { return 1 + affine_->distortion(x); }
  bool turns_as_a_whole() const override { return true; }
  VecX curved(const VecX& x, const VecX& step) const override { return affine_->curved(x, step); }

  const Tessellation& skin() const override { return skin_; }
  const std::vector<double>& skin_areas() const override { return skin_areas_; }
  double contact_area(int point) const override { return areas_[point / contacts_each] / contacts_each; }
  const std::vector<Vec3>& skin_rest() const override { return setup_.surface.points; }
  const std::vector<std::vector<int>>& face_nodes() const override { return face_nodes_; }
  double beyond_nodes() const override { return size_; }
  double largest_motion(const VecX& dx) const override;
  std::vector<Vec3> skin_normals(const VecX& x) const override;

  const BlockMatrix* mass() const override { return &mass_; }
  /// Each has a skin point of its own; the centre the first.
  std::map<std::string, int> landmarks() const override { return landmark_points_; }
  /// Where it lies in the body, not on its skin.
  Vec3 landmark_place(int row, const VecX& x) const override;
  bool is_bitten() const override { return false; }
  const AffineBody& affine() const { return *affine_; }

 private:
  void choose_landmark_points();

  Setup setup_;
  std::optional<AffineBody> affine_;
  VecX rest_, weight_;
  double size_ = 0, farthest_weights_ = 1;  ///< the largest sum of a skin point's weights without their signs
  std::vector<double> edge_lengths_, areas_, skin_areas_;
  std::map<std::string, int> landmark_points_;
  std::vector<std::vector<int>> face_nodes_{{0, 1, 2, 3}};
  BlockMatrix mass_{4, {{std::vector<int>{0, 1, 2, 3}}}};
  BlockMatrix pattern_{4, {{std::vector<int>{0, 1, 2, 3}}}};
  Tessellation skin_;
};

}  // namespace calot
