#pragma once
// The middle nodes of a tissue's strands as a body of the group: weights with inertia, condensed 3 x 3 onto what their
// strands join (strand_join.h), which alone holds them. It has no skin, so no shapes may be among its member's loads, and
// its walls do not meet themselves (SelfContact::active is to be false).

#include "body/body.h"

namespace calot {

class TissueBody : public Body {
 public:
  struct Setup {
    std::string name = "tissue";
    std::vector<Vec3> nodes;     ///< m, at rest
    std::vector<double> masses;  ///< kg, one a node, > 0
    Vec3 up = Vec3::UnitZ();
    double strength = 0.1;  ///< N, of a strand: residuals are judged beside it
  };
  explicit TissueBody(const Setup& setup);
  const Setup& setup() const { return setup_; }

  /// Some of its nodes, increasing, as a body of their own.
  TissueBody part(const std::vector<int>& which) const;

  const std::string& name() const override { return setup_.name; }
  const VecX& rest() const override { return rest_; }
  int kept_nodes() const override { return 0; }
  bool has_loose_nodes() const override { return true; }
  double size() const override { return size_; }
  const std::vector<double>& edge_lengths() const override { return longest_steps_; }
  const BlockMatrix& pattern() const override { return pattern_; }
  double value(const VecX&) const override { return 0; }
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX&, BlockMatrix&, Assembly*) const override {}
  const VecX& kept_load() const override { return weight_; }
  const BlockMatrix* mass() const override { return &mass_; }
  double strain_energy(const VecX&) const override { return 0; }
  double max_stretch(const VecX&) const override { return 1; }

  const Tessellation& skin() const override;
  const std::vector<double>& skin_areas() const override { return none_; }
  double contact_area(int) const override { return 0; }
  const std::vector<Vec3>& skin_rest() const override { return no_points_; }
  const std::vector<std::vector<int>>& face_nodes() const override { return no_faces_; }
  std::vector<Vec3> skin_normals(const VecX&) const override { return {}; }

 private:
  Setup setup_;
  VecX rest_, weight_;
  double size_ = 0;
  std::vector<double> longest_steps_;
  BlockMatrix pattern_, mass_;
  std::vector<double> none_;
  std::vector<Vec3> no_points_;
  std::vector<std::vector<int>> no_faces_;
};
void visit_members(auto&& visit, MembersOf<TissueBody::Setup> auto& setup) {
  auto& [name, nodes, masses, up, strength] = setup;
  visit(name, nodes, masses, up, strength);
}

}  // namespace calot
