#pragma once
// An instrument as a body of the group: two nodes (posed_part.h), held by a hand (hand.h) to where it is commanded.
// Other instruments that it meets are joined to it by ToolMeeting; skins are not (hands.h).

#include "body/body.h"
#include "tools/hand.h"

namespace calot {

/// At rest it is where it is commanded: another command makes another body. It has no skin of its own, so no shapes may be
/// among its member's loads, and its walls do not meet themselves (SelfContact::active is to be false).
class ToolBody : public Body {
 public:
  ToolBody(const Tool& tool, const InstrumentPose& command, const HandStrength& strength);

  const Tool& tool() const { return tool_; }
  const Hand& hand() const { return hand_; }
  /// A state with the tool at a pose.
  static BodyState at(const InstrumentPose& pose) { return {.x = tool_coordinates(pose)}; }

  const std::string& name() const override { return tool_.definition.name; }
  const VecX& rest() const override { return rest_; }
  double size() const override { return tool_.geometry.working_length; }
  const std::vector<double>& edge_lengths() const override { return longest_steps_; }
  const BlockMatrix& pattern() const override { return pattern_; }
  double value(const VecX& x) const override { return hand_.sample(x).energy; }
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const override;
  double strain_energy(const VecX& x) const override { return value(x); }
  double max_stretch(const VecX&) const override { return 1; }

  const Tessellation& skin() const override;
  const std::vector<double>& skin_areas() const override { return none_; }
  double contact_area(int) const override { return 0; }
  const std::vector<Vec3>& skin_rest() const override { return no_points_; }
  const std::vector<std::vector<int>>& face_nodes() const override { return no_faces_; }
  std::vector<Vec3> skin_normals(const VecX&) const override { return {}; }

 private:
  Tool tool_;
  Hand hand_;
  VecX rest_;
  std::vector<double> longest_steps_;
  BlockMatrix pattern_;
  std::vector<double> none_;
  std::vector<Vec3> no_points_;
  std::vector<std::vector<int>> no_faces_;
};

}  // namespace calot
