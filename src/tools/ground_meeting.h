#pragma once
// An instrument and what lies around the organs and stays: ground. Points fixed in the instrument's parts are kept off it by
// the contact barrier, a ball of their radius each (tool_points.h), against the spring of its hand (hand.h): it stops there,
// and presses with no more than its hand can do. What of its shaft is outside of its trocar meets nothing.

#include "group/contact_search.h"
#include "group/join.h"
#include "tools/tool_points.h"

namespace calot {

class GroundMeeting : public Join {
 public:
  /// `first_node`: of the tool, in the group's numbering. The tool must outlive the join. `ground`: the shapes as they are
  /// made.
  GroundMeeting(const Tool& tool, int first_node, const std::vector<Shape>& ground,
                const Barrier& barrier = contact_barrier);

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  /// Exact where a tool can be in balance; of what is deeper the turning of the forces counts as there.
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;
  double safe_share(const VecX& x, const VecX& step, double share) const override;

  /// What a shape does to a point of the tool.
  struct Press {
    std::size_t ground = 0;     ///< among the shapes
    int part = 0;               ///< of the tool
    Vec3 at = Vec3::Zero();     ///< m, on the tool's surface
    Vec3 force = Vec3::Zero();  ///< N, on the tool
  };
  std::vector<Press> presses(const VecX& x) const;
  /// m, the nearest that the tool comes to any of the shapes, surface to surface; negative: inside. At most `most`.
  double gap(const VecX& x, double most) const;

 private:
  ToolVector unknowns(const VecX& x) const { return x.segment<6>(Eigen::Index{3} * first_node_); }
  /// Calls use(shape's index, point, its place, its part) for what comes nearer than `reach` to the shapes.
  template <class Use>
  void for_near(const VecX& x, double reach, const Use& use) const;

  const Tool& tool_;
  int first_node_;
  std::vector<ToolPoint> points_;
  std::vector<Shape> ground_;  ///< as contact has them
  Barrier barrier_;
};

}  // namespace calot
