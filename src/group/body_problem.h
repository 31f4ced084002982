#pragma once
// What one body of a group makes stationary: its own energies and liquid, the shapes that touch it and the grips that
// hold it.

#include <optional>

#include "body/inertia.h"
#include "group/contact_search.h"
#include "group/pressed_laws.h"
#include "numerics/constrained_energy.h"

namespace calot {

/// No step takes a contact point nearer to a shape's core (contact_guard below it) than this share of its distance
/// before it.
inline constexpr double contact_keep = 0.2;

/// How many constraints a body has: its liquid's volume, where it has one that is kept, and then, where masses count, its
/// inertia's.
int constraints_of(const Body& body, bool masses_count, bool fixed_pressure = false);

/// A group of one.
class BodyProblem : public ConstrainedEnergy {
 public:
  /// `fixed_pressure`: the multiplier is prescribed and the volume free; not with inertia. Without contact of the skin
  /// with itself.
  BodyProblem(const Body& body, const ContactLoads& loads, std::vector<ContactPair> pairs,
              const BodyState& start, bool fixed_pressure = false);
  /// With it. `search` finds the pairs, where they are asked for, and remembers what touches; it must outlive the
  /// problem. `assembly`: several threads do the work, to the same bits.
  BodyProblem(const Body& body, const ContactLoads& loads, ContactSearch& search, const BodyState& start,
              bool fixed_pressure = false, Assembly* assembly = nullptr);

  const Body& body() const { return body_; }
  /// Where a solve begins.
  VecX multipliers() const;

  std::vector<Part> parts() const override;
  int constraints() const override {
    return constraints_of(body_, loads_.inertia != nullptr, fixed_pressure_);
  }
  double value(const VecX& x) const override;
  double cancelling() const override;
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override;
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override;
  /// Of what touches: how distances curve times the pressure.
  bool add_convexity(const VecX& x, BlockMatrix& matrix) const override;
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override;
  VecX constraint_values(const VecX& x) const override;
  void gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                               Eigen::MatrixXd& of_constraints) const override;
  VecX constraint_scales() const override;
  VecX compliances() const override;
  /// The pattern that the body's matrix needs beside `present`, which it has; none: that serves.
  std::optional<BlockMatrix> new_pattern(const BlockMatrix& present) const;
  double safe_share(const VecX& x, const VecX& step) const override;
  /// What presses: see pressed_laws.h.
  std::vector<SharpTangent> pressed_tangents(const VecX& x, bool convex) const;
  PressedLaws pressed_laws(const VecX& x, const VecX& step, double least,
                           std::span<const SharpTangent> tangents) const;
  /// What safe_share() is no more than: as far as no two bodies nor their parts need be compared.
  double longest_share(const VecX& x, const VecX& step) const;
  /// The part of `share` of a step that is safe beside the shapes, and beside the skin itself.
  double share_beside_shapes(const VecX& x, const VecX& step, double share) const {
    return share_beside_shapes(x, step, share, pairs());
  }
  /// The same beside the shapes alone, of only these pairs of skin and shape.
  double share_beside_shapes(const VecX& x, const VecX& step, double share,
                             const std::vector<ContactPair>& pairs) const;
  /// The pairs whose triangles hang on any of the `marked` nodes (one flag a node): only these change their distance in a
  /// step that moves no other node.
  std::vector<ContactPair> pairs_on(const std::vector<char>& marked) const;
  double share_beside_itself(const VecX& x, const VecX& step, double share) const;

 private:
  /// Of the liquid, where masses count; else null.
  const LiquidMass* liquid_mass() const { return loads_.inertia ? loads_.inertia->liquid() : nullptr; }
  /// How far any node, and so any skin point, is from where the solve began, m.
  double moved(const VecX& x) const;
  /// The share of a step on which the nodes of a face come no further from its first one's way than their shortest edges are
  /// long. Nodes that lie on no face of the skin, and details, come no further than theirs.
  double unfolding_share(const VecX& step) const;
  /// Of a share of a step of `way`, m, that for which pairs were gathered: no place of the skin, which is up to `gone`, m, from
  /// where the solve began, comes further than the margin from there.
  double margin_share(double gone, double way, double share) const;
  const std::vector<ContactPair>& pairs() const;
  const std::vector<Touch>& touching(const VecX& x) const;
  Workers* workers() const override;
  /// Does all `work` and finds what touches at x, for which no memory is shared: what touches is
  /// known then.
  template <class... Work>
  void beside_touches(const VecX& x, const Work&... work) const;
  /// Gradient but for the liquid's part; its largest internal force. Does `beside` at the same time.
  template <class... Work>
  double add_dry_gradient(const VecX& x, VecX& gradient, const Work&... beside) const;
  void fill_volume(double volume, const VecX& of_volume, VecX& values, Eigen::MatrixXd& gradients) const;
  /// Of the inertia, behind the volume's.
  void fill_inertia(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const;
  /// Calls use(first coordinate, N/m) for the details that springs hold at rest.
  template <class Use>
  void for_held_details(const Use& use) const;
  const Body& body_;
  const ContactLoads& loads_;
  mutable std::optional<std::vector<ContactPair>> pairs_;  ///< none: not looked for yet
  std::vector<Shape> cores_;                               ///< of the shapes: what no trial may reach
  VecX start_;
  double volume_, multiplier_;
  bool fixed_pressure_;
  ContactSearch* search_;
  Assembly* assembly_ = nullptr;
  mutable TouchMemory touches_;  ///< where no search remembers
};

struct ContactForce {
  int shape = 0;
  int point = 0;                 ///< contact point
  Vec3 at = Vec3::Zero();        ///< its place, m
  Vec3 on_shape = Vec3::Zero();  ///< N, of the skin on the shape
};
/// One for each contact point in range.
std::vector<ContactForce> contact_forces(const std::vector<Touch>& touches);
std::vector<ContactForce> contact_forces(const Body& body, const VecX& x, const ContactLoads& loads,
                                         const std::vector<ContactPair>& pairs);

}  // namespace calot
