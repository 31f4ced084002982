#pragma once
// Friction of an organ's contact points during one solve.

#include <vector>

#include "body/contact_points.h"
#include "collision/friction.h"

namespace calot {

struct RubbingPoint {
  int point = 0;  ///< contact point
  int shape = 0;  ///< index into ContactLoads::shapes
  StickSlip hold;
};
void visit_members(auto&& visit, MembersOf<RubbingPoint> auto& rubbing) {
  auto& [point, shape, hold] = rubbing;
  visit(point, shape, hold);
}

/// Ordered by shape, then point; each pair occurs once.
struct FrictionLoad {
  std::vector<RubbingPoint> points;

  /// Null when the pair does not rub.
  const RubbingPoint* find(int shape, int point) const;
  double value(const Tessellation& skin, const VecX& x) const;  ///< J
  void add_gradient(const Tessellation& skin, const VecX& x, VecX& gradient) const;
  void add_hessian(const Tessellation& skin, const VecX& x, BlockMatrix& matrix,
                   Workers* workers = nullptr) const;
};
void visit_members(auto&& visit, MembersOf<FrictionLoad> auto& load) {
  auto& [points] = load;
  visit(points);
}

}  // namespace calot
