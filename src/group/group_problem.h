#pragma once
// The bodies that are solved together: one numbering of all nodes, body by body, and one Newton's method (the paper's
// groupstructure, section 7).

#include <memory>
#include <span>

#include "group/body_problem.h"
#include "group/join.h"
#include "numerics/newton_workspace.h"
#include "numerics/sharp_terms.h"

namespace calot {

/// A body, what acts on it and where it is. All must outlive the problem that is made of it.
struct Member {
  const Body& body;
  const ContactLoads& loads;
  ContactSearch& search;
  BodyState& state;
  Assembly* assembly =
      nullptr;  ///< several threads do the work, to the same bits; of a group the first one's
};

/// Matrices of the single bodies, with room for what couples each with itself, and the couplings that the joint one
/// was made for. Of a body alone there is none: its matrix is the group's.
struct GroupPatterns {
  std::vector<BlockMatrix> own;
  std::vector<std::vector<int>> joined;
};
void visit_members(auto&& visit, MembersOf<GroupPatterns> auto& patterns) {
  auto& [own, joined] = patterns;
  visit(own, joined);
}

/// Where the kept volume of each body stands among the constraints of their group; -1: it has none. The group has them
/// body by body, `counts` of each (constraints_of), a volume's first.
std::vector<Eigen::Index> volume_constraints(std::span<const int> counts);

class GroupProblem : public ConstrainedEnergy {
 public:
  GroupProblem(std::span<const Member> members, std::span<const JoinPointer> joins, GroupPatterns& patterns,
               bool fixed_pressures = false);

  VecX coordinates() const;  ///< of all states
  VecX multipliers() const;  ///< likewise
  /// The same where nothing is accelerated: those of compliant constraints are 0.
  VecX resting_multipliers() const;
  /// Of each member, Pa; 0 where it has none among the multipliers.
  VecX pressures(const VecX& multipliers) const;
  /// Room for what its patterns couple, as prepare() makes it; of two members or more.
  NewtonWorkspace workspace() const;
  /// Writes a solution into the members' states.
  void keep(const VecX& x, const VecX& multipliers) const;

  std::vector<Part> parts() const override;
  int constraints() const override { return constraints_; }
  double value(const VecX& x) const override;
  double cancelling() const override;
  void gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const override;
  void hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const override;
  bool add_convexity(const VecX& x, BlockMatrix& matrix) const override;
  void constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const override;
  VecX constraint_values(const VecX& x) const override;
  void gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal, VecX& values,
                               Eigen::MatrixXd& of_constraints) const override;
  VecX constraint_scales() const override;
  VecX compliances() const override;
  void prepare(NewtonWorkspace& work) const override;
  VecX curved(const VecX& x, VecX step) const override;
  double safe_share(const VecX& x, const VecX& step) const override;
  double share_if_whole(const VecX& x, const VecX& step) const override;
  /// The least of the bodies'.
  double longest_share(const VecX& x, const VecX& step) const;
  VecX relaxed(VecX x) const override;
  Workers* workers() const override;
  /// Of what presses on each body.
  std::vector<SharpTangent> sharp_tangents(const VecX& x, bool convex) const override;
  std::unique_ptr<const SharpTerms> sharp_terms(const VecX& x, const VecX& step, double least,
                                                std::span<const SharpTangent> tangents) const override;

 private:
  class Pressed;

  struct Range {
    Eigen::Index first, size;              ///< of the coordinates
    Eigen::Index constraint, constraints;  ///< the first, and how many
  };
  /// Then its matrix is the group's, and holds what its joins couple.
  bool alone() const { return problems_.size() == 1; }
  int first_node(std::size_t member) const { return static_cast<int>(ranges_[member].first) / 3; }
  VecX part_of(std::size_t member, const VecX& x) const {
    return x.segment(ranges_[member].first, ranges_[member].size);
  }
  /// Calls work(member), which must write nothing that another's does, for each, and meanwhile finds what
  /// `joins` do at x; the largest is begun first, and who has nothing left to begin helps with it.
  template <class Work>
  void for_each_member(const Work& work, std::span<const Join* const> joins = {},
                       const VecX* x = nullptr) const;
  /// Those that may act at x, or on a step from there (null: none).
  std::vector<const Join*> joins_at(const VecX& x, const VecX* step = nullptr) const;
  /// Of a member that has such nodes.
  LooseNodes loose_nodes(std::size_t member, const VecX& x) const;
  void prepare_alone(NewtonWorkspace& work) const;
  std::vector<std::vector<int>> cliques(bool close) const;
  /// One a node: what is not kept is condensed. Of a body whose nodes are all coupled with each other, such as a solid,
  /// those that no join meets are condensed too: kept, they would stand in the way of all that comes after them.
  std::vector<char> kept_nodes() const;
  /// The part of `share` of a step that is safe.
  double safe_part(const VecX& x, const VecX& step, double share) const;
  void add_own_hessian(std::size_t member, const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const;
  /// Adds what these joins, found at x, do to the bodies; residuals are judged beside these forces, too.
  void add_joins(std::span<const Join* const> joins, const VecX& x, VecX& gradient,
                 VecX& largest_internal) const;

  std::span<const Member> members_;
  std::span<const JoinPointer> joins_;
  GroupPatterns& patterns_;
  std::vector<BodyProblem> problems_;
  std::vector<Range> ranges_;
  std::vector<Eigen::Index> volumes_;  ///< of each member: place of its volume's constraint; -1: it has none
  /// What gradient_and_constraint() found last of each member.
  struct OwnSlopes {
    VecX x, gradient, internal, values;
    Eigen::MatrixXd of_constraints;
  };
  mutable std::vector<OwnSlopes> last_;
  std::vector<std::size_t> by_size_;  ///< members, the largest last
  std::size_t small_ = 0;             ///< the first of these are not worth sharing
  Eigen::Index size_ = 0;             ///< coordinates
  int constraints_ = 0;
};

}  // namespace calot
