#pragma once
// Instruments as bodies that hands hold, alone in the world.

#include "group/equilibrium.h"
#include "tools/tool_body.h"
#include "tools/tool_meeting.h"

namespace calot::test {

/// Tools that are commanded to poses, each pair of which meets.
class HeldTools {
 public:
  struct One {
    Tool tool;
    InstrumentPose command;
    HandStrength strength;
  };
  explicit HeldTools(std::vector<One> tools) : tools_(std::move(tools)) {
    searches_.resize(tools_.size());
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      searches_[k].own.active = false;
      states_.push_back(ToolBody::at(tools_[k].command));
    }
    for (std::size_t a = 0; a < tools_.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        meetings_.push_back(std::make_shared<const ToolMeeting>(side(b), side(a)));
        joins_.push_back(meetings_.back());
      }
  }

  /// Commands a tool and seeks the balance from where all are.
  NewtonResult command(std::size_t tool, const InstrumentPose& pose) {
    tools_[tool].command = pose;
    std::vector<ToolBody> bodies;
    for (const One& one : tools_) bodies.emplace_back(one.tool, one.command, one.strength);
    std::vector<Member> members;
    for (std::size_t k = 0; k < bodies.size(); ++k)
      members.push_back({bodies[k], loads_, searches_[k], states_[k]});
    NewtonWorkspace work{BlockMatrix(0, {})};
    GroupPatterns patterns;
    return settle(members, joins_, patterns, {}, work);
  }
  /// The same in even parts.
  bool lead(std::size_t tool, const InstrumentPose& to, int parts) {
    const InstrumentPose from = tools_[tool].command;
    for (int k = 1; k <= parts; ++k)
      if (!command(tool, interpolate(from, to, static_cast<double>(k) / parts)).converged()) return false;
    return true;
  }

  const ToolMeeting& meeting(std::size_t k = 0) const { return *meetings_[k]; }
  VecX x() const {
    VecX out(6 * static_cast<Eigen::Index>(states_.size()));
    for (std::size_t k = 0; k < states_.size(); ++k)
      out.segment<6>(6 * static_cast<Eigen::Index>(k)) = states_[k].x;
    return out;
  }
  InstrumentPose pose(std::size_t tool) const { return pose_at(states_[tool].x); }
  Hand::Effort effort(std::size_t tool) const {
    const One& one = tools_[tool];
    return Hand(one.tool, one.command, one.strength).effort(states_[tool].x);
  }

 private:
  ToolMeeting::Side side(std::size_t tool) const {
    return {&tools_[tool].tool, tool_nodes * static_cast<int>(tool)};
  }
  std::vector<One> tools_;
  std::vector<BodyState> states_;
  std::vector<ContactSearch> searches_;
  ContactLoads loads_;
  std::vector<std::shared_ptr<const ToolMeeting>> meetings_;
  std::vector<JoinPointer> joins_;
};

}  // namespace calot::test
