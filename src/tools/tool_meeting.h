#pragma once
// Instruments that meet: two tools of a group press on each other where they touch, and so push each other aside as far as
// their hands give way.
//
// Points fixed in the parts of each tool are kept off the shapes of the other by the contact barrier, a ball of their
// radius each: points of a rod's axis with the rod's radius, points of a jaw's inner box with its rounding. So the one's
// surface is met as it is but for what lies between two balls, 0.03 mm (rods) to 0.1 mm (jaws' edges) deep. Unlike the
// distance of two shapes, which has kinks where they lie along each other, the sum over points is smooth whatever the
// attitude. Both tools' points count, each for half, so neither is preferred. The tools' own parts do not meet.

#include "group/contact_search.h"
#include "group/join.h"
#include "tools/tool_points.h"

namespace calot {

class ToolMeeting : public Join {
 public:
  /// A tool and the first of its nodes in the group's numbering. The tools must outlive the join.
  struct Side {
    const Tool* tool = nullptr;
    int first_node = 0;
  };
  ToolMeeting(const Side& one, const Side& other, const Barrier& barrier = contact_barrier);

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  /// Exact where tools can be in balance; of what is deeper in each other the turning of the forces counts as there.
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;
  double safe_share(const VecX& x, const VecX& step, double share) const override;

  /// N, of the first tool on the other.
  Vec3 force(const VecX& x) const;
  /// m, the nearest that a point of one comes to the other, surface to surface; negative: inside. At most `most`.
  double gap(const VecX& x, double most) const;

 private:
  ToolVector unknowns(int side, const VecX& x) const {
    return x.segment<6>(Eigen::Index{3} * sides_[side].first_node);
  }
  /// Calls use(side that the point is of, point, its place, part of the other side, that shape) for what comes nearer than `reach`
  /// to the other's contact shapes.
  template <class Use>
  void for_near(const VecX& x, double reach, const Use& use) const;

  std::array<Side, 2> sides_;
  std::array<std::vector<ToolPoint>, 2> points_;
  Barrier barrier_;
};

}  // namespace calot
