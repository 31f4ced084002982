#pragma once
// A body's skin and an instrument whose pose is unknown: what presses, what rubs and what pads hold, each a function of the
// skin's nodes and of the tool's, so that both sides of a touch give way.
//
// How the field is to use it, once its tools are bodies of the group:
//   - Group: members are the organs' bodies, then a ToolBody for each tool, made anew for each part of a motion with the
//     commanded pose of its end; states of tools are kept beside those of organs (OrganSnapshot, restore). Joins: a
//     ToolTouch for each organ and tool, a ToolMeeting for each pair of tools, with the first nodes of both.
//   - A part of a motion starts with the tool where it is: Newton goes to the command, and the joins' safe_share() keeps
//     what meets apart. As a first guess the tools move with their commands (keeping their lags) and the organs by the
//     first-order answer: the load of a command's motion is hessian() of the hand times its way, on the tool's nodes
//     alone. motion_load(), share_kept_apart() and ShapePaths of advance.cpp fall away, and so do the poses that
//     predict(), contact_loads() and settle_group() are handed: Tool::pose becomes pose_at() of the tool's state,
//     beside Tool::command.
//   - ContactLoads::shapes keeps the support only, and so BodyProblem and ContactSearch of an organ that lies on none do
//     nothing; ContactLoads::grip and friction of tools become PadHold and ToolRub here. The support's stay.
//   - Jaws stop where the tissue carries the pinch: closing_stops(), fold_fills_jaws(), make_room(), reachable() and
//     Tool::jaw_stopped fall away. A tool holds while its pads pinch (Hand::effort().pinch at a share of the pinch that
//     is to be stated) and both pads hold skin; a grasp is the first step at whose end that is so. Holds are taken of
//     skin that presses on a pad when that begins, not at multiples of an angle: pressure now says when that is. Jaws
//     are released by opening, when the pinch falls to zero.
//   - A PadHold pulls along the pad only: across it the pads' contact carries, so a hold cannot press skin into its own
//     pad, and holding_limit() may take what really presses on each pad in place of the definition's pinch.
//   - tool_loads() sums forces(); handle_force() is as before, or from Hand::effort().

#include "sim/contact_search.h"
#include "sim/group_problem.h"
#include "sim/posed_part.h"

namespace calot {

/// A skin point that a jaw's pad holds along itself (the pad is the plane x = 0 of the jaw's frame).
struct PadHold {
  int part = 1;  ///< 1 or 2
  int skin_point = 0;
  Vec3 local = Vec3::Zero();  ///< m, in the jaw's frame, where it is held; across the pad it is free
  double stiffness = 0;       ///< N/m
};

/// A contact point that rubs on a part.
struct ToolRub {
  int part = 0;
  int point = 0;   ///< contact point
  StickSlip hold;  ///< in the part's frame
};

/// What of a tool does not follow from where it and the skin are.
struct ToolHolds {
  std::vector<PadHold> pads;
  std::vector<ToolRub> rubs;
};

/// A force of the skin on the tool, and why.
struct ForceOnTool {
  enum class By { contact, hold, rub };
  By by = By::contact;
  int part = 0;
  int point = 0;                                 ///< contact point; of a hold the skin point
  Vec3 at = Vec3::Zero(), force = Vec3::Zero();  ///< m, N
};

class ToolTouch : public Join {
 public:
  /// First nodes of both in the group's numbering.
  struct FirstNodes {
    int body = 0, tool = 0;
  };
  /// `bodies`: the places in the group of the body and of the tool's. Tool and holds must outlive the join.
  ToolTouch(const std::array<int, 2>& bodies, const Tool& tool, const ToolHolds& holds,
            const Barrier& barrier = contact_barrier);

  void begin(std::span<const GroupPlace> bodies) const override;
  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  bool lacking() const override { return lacking_; }
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;
  double safe_share(const VecX& x, const VecX& step, double share) const override;

  /// One for each point that presses, is held or rubs; of the bodies that begin() told of.
  std::vector<ForceOnTool> forces(const VecX& x) const;

 private:
  /// What one point of the skin does: a blend of up to three skin points (weights sum to 1).
  struct Load {
    ForceOnTool::By by;
    int part, point;
    Triangle rows;  ///< unused ones as the first, of weight 0
    Vec3 weights;
    Vec3 at;
    double energy;
    Vec3 gradient;
    Mat3 hessian;  ///< by the place
  };
  /// Calls use(load) for each, with its Hessian where that is asked for.
  template <class Use>
  void for_loads(const VecX& x, bool hessians, const Use& use) const;
  VecX of_body(const VecX& x) const { return x.segment(Eigen::Index{3} * first_.body, body_->rest().size()); }
  ToolVector of_tool(const VecX& x) const { return x.segment<6>(Eigen::Index{3} * first_.tool); }
  ContactLoads shapes_at(const InstrumentPose& pose) const;

  std::array<int, 2> bodies_;
  const Tool& tool_;
  const ToolHolds& holds_;
  Barrier barrier_;
  mutable const Body* body_ = nullptr;  ///< of the solve that began last
  mutable FirstNodes first_;
  mutable ContactSearch search_;
  mutable bool lacking_ = false;
};

}  // namespace calot
