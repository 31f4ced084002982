#pragma once
// How one body grows out of another: points of the one are tied to places that the other carries along, so that the joint
// holds position and direction.
//
// The places are carried by skin points (carried_place.h). A body that is a line carries only places on it so. What
// stands off it is held by struts instead, to several points of the line: springs that keep a length. They leave free
// only a turn about that line, which a rod does not resist either.
//
// Two lines in one, end to end, are a hinge: struts along them resist no bend.
//
// Nothing is loaded at rest, nor when all moves as one rigid body; a force and what answers it lie on one line.

#include "base/status.h"
#include "group/join.h"
#include "joins/carried_place.h"

namespace calot {

/// 1/2 stiffness (|one - other| - length)^2 a link.
struct JointLinks {
  struct Link {
    CarriedPlace one, other;
    double length = 0;  ///< m; 0: tied
  };
  std::array<int, 2> bodies{};  ///< by their places in the group
  std::vector<Link>
      links;  ///< of the point nearest to where they were joined first, to what it is nearest to first
  double stiffness = 0;  ///< N/m, of each link
};
void visit_members(auto&& visit, MembersOf<JointLinks::Link> auto& link) {
  auto& [one, other, length] = link;
  visit(one, other, length);
}
void visit_members(auto&& visit, MembersOf<JointLinks> auto& joint) {
  auto& [bodies, links, stiffness] = joint;
  visit(bodies, links, stiffness);
}

/// What ties the points of body `one` that lie within `radius` (m) of `place` at rest, three at least, to places that
/// `other` carries; together they are as stiff as `stiffness` (N/m). `bodies`: their places in the group. Fails (scenario) where the
/// numbers are not positive or the bodies are the same.
Result<JointLinks> joint_links(const Body& one, const Body& other, std::array<int, 2> bodies,
                               const Vec3& place, double radius, double stiffness);
/// The same with the skin points of both at these places, m, where the joint then is not loaded.
Result<JointLinks> joint_links(const Body& one, const Body& other,
                               const std::array<std::vector<Vec3>, 2>& skins, std::array<int, 2> bodies,
                               const Vec3& place, double radius, double stiffness);

class Joint : public Join {
 public:
  explicit Joint(JointLinks links) : links_(std::move(links)) {}

  void begin(std::span<const GroupPlace> bodies) const override;
  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;

  const JointLinks& links() const { return links_; }
  /// N, of the first body on the other.
  Vec3 force(const VecX& x) const;

 private:
  struct Pull {
    Vec3 arm = Vec3::Zero();  ///< m, from the other's place to the first's
    double distance = 0;
    double tension(const JointLinks::Link& link, double stiffness) const {
      return stiffness * (distance - link.length);
    }
  };
  Pull pull(std::size_t link, const VecX& x) const;
  Vec3 slope(std::size_t link, const VecX& x) const;
  void find_tied() const;

  JointLinks links_;
  /// Two rows a link, in the group's numbering; none where a body is not in the group.
  mutable StencilTable rows_;
  mutable std::vector<int> nodes_;  ///< of all of them, increasing
  /// N/m, of the ties, the same along all axes and wherever the nodes are: of nodes a >= b at b * nodes + a.
  mutable std::vector<double> tied_;
  /// What they were made for.
  mutable std::array<int, 2> first_{-1, -1};
  mutable std::array<std::vector<int>, 2> details_;
};

}  // namespace calot
