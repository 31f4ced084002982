#include "body/tissue_body.h"

#include "base/units.h"

namespace calot {
namespace {

/// What no step of a solver takes a node further than, m: many times what a strand is stretched in one.
constexpr double longest_strand_step = 10e-3;

}  // namespace

TissueBody::TissueBody(const Setup& setup)
    : setup_(setup),
      rest_(to_coordinates(setup.nodes)),
      weight_(rest_.size()),
      longest_steps_(setup.nodes.size(), longest_strand_step),
      pattern_(static_cast<int>(setup.nodes.size()), {}),
      mass_(pattern_.blank()) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < nodes(); ++i) {
    mass_.add_to_diagonal(i, setup.masses[i]);
    weight_.segment<3>(3 * i) = -units::standard_gravity * setup.masses[i] * setup.up;
    box.extend(setup.nodes[i]);
  }
  size_ = std::max(box.diagonal().norm(), longest_strand_step);
}

TissueBody TissueBody::part(const std::vector<int>& which) const {
  Setup setup = setup_;
  setup.nodes.clear();
  setup.masses.clear();
  for (int node : which) {
    setup.nodes.push_back(setup_.nodes[node]);
    setup.masses.push_back(setup_.masses[node]);
  }
  return TissueBody(setup);
}

void TissueBody::add_gradient(const VecX& /*x*/, VecX& /*gradient*/, double& largest_internal) const {
  largest_internal = setup_.strength;
}

const Tessellation& TissueBody::skin() const {
  static const Tessellation none;
  return none;
}

}  // namespace calot
