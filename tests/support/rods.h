#pragma once
// Straight rods.

#include "fem/rod.h"

namespace calot::test {

struct StraightRod {
  Centreline line;
  VecX rest;
  Rod rod;

  BlockMatrix matrix() const { return BlockMatrix(line.nodes(), rod.cliques()); }
};

/// Along +x from the origin, of one section, or of one that depends on the share of the way.
template <class Section>
StraightRod straight_rod(int spans, double length, const Section& section) {
  const Centreline line = Centreline::create(spans + 3).value();
  VecX rest = line.along({Vec3::Zero(), length * Vec3::UnitX()}).value();
  RodQuadrature quadrature = line.quadrature();
  std::vector<RodSection> sections;
  for (double share : quadrature.shares) sections.push_back(section(share));
  Rod rod = Rod::create(std::move(quadrature), rest, std::move(sections)).value();
  return {line, std::move(rest), std::move(rod)};
}
inline StraightRod straight_rod(int spans, double length, const RodSection& section) {
  return straight_rod(spans, length, [&](double) { return section; });
}

}  // namespace calot::test
