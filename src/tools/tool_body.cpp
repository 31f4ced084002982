#include "tools/tool_body.h"

#include "numerics/parts.h"

namespace calot {
namespace {

/// What no step of a solver takes a node further than, m: beyond, a spring that has given way says little of where its
/// tool is to go.
constexpr double longest_step = 5e-3;
/// Residuals of a tool that hardly anything touches are judged beside this, N.
constexpr double least_force = 0.1;

}  // namespace

ToolBody::ToolBody(const Tool& tool, const InstrumentPose& command, const HandStrength& strength)
    : tool_(tool),
      hand_(tool, command, strength),
      rest_(tool_coordinates(command)),
      longest_steps_(tool_nodes, longest_step),
      pattern_(tool_nodes, std::vector<std::vector<int>>{{0, 1}}) {}

void ToolBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  const ToolVector pull = hand_.sample(x).gradient;
  gradient += pull;
  largest_internal = std::max(least_force, largest_node(pull));
}

void ToolBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* /*assembly*/) const {
  const ToolMatrix hessian = hand_.sample(x).hessian;
  matrix.add(0, 0, hessian.topLeftCorner<3, 3>());
  matrix.add(1, 0, hessian.bottomLeftCorner<3, 3>());
  matrix.add(1, 1, hessian.bottomRightCorner<3, 3>());
}

const Tessellation& ToolBody::skin() const {
  static const Tessellation none;
  return none;
}

}  // namespace calot
