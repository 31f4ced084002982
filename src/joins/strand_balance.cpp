#include "joins/strand_balance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace calot {
namespace {

/// What depends on the node, whose energy the way down lowers.
class Node {
 public:
  Node(const StrandBetween& between, const NodeLoad& load, const StrandVector& places)
      : between_(between), load_(load), start_(places.segment<3>(3)) {}

  double energy(const StrandVector& at) const {
    const Vec3 way = at.segment<3>(3) - start_;
    return between_.strand.value(at, between_.past) + (met() ? between_.touch.value(*met(), at) : 0) +
           load_.gradient.dot(way) + 0.5 * load_.stiffness * way.squaredNorm();
  }
  Vec3 gradient(const StrandVector& at) const {
    StrandVector of_strand = between_.strand.gradient(at, between_.past);
    if (met()) of_strand += between_.touch.gradient(*met(), at);
    return of_strand.segment<3>(3) + load_.gradient + load_.stiffness * (at.segment<3>(3) - start_);
  }
  /// Newton's step for that gradient; where the energy curves down it is as long as if it curved up.
  Vec3 step(const StrandVector& at, const Vec3& gradient) const {
    StrandMatrix of_strand = between_.strand.hessian(at, between_.past);
    if (met()) of_strand += between_.touch.hessian(*met(), at);
    const Mat3 own = of_strand.block<3, 3>(3, 3) + load_.stiffness * Mat3::Identity();
    const Eigen::SelfAdjointEigenSolver<Mat3> modes(own);
    const Vec3 stiffness = modes.eigenvalues().cwiseAbs().cwiseMax(between_.strand.centring());
    const Vec3 along = modes.eigenvectors().transpose() * gradient;
    return -modes.eigenvectors() * along.cwiseQuotient(stiffness);
  }
  double safe_share(const StrandVector& at, const StrandVector& motion) const {
    return met() ? between_.touch.safe_share(*met(), at, motion, 1.0) : 1.0;
  }

 private:
  const StrandThread* met() const { return between_.thread; }

  const StrandBetween& between_;
  const NodeLoad& load_;
  Vec3 start_;
};

/// Goes that way as far as the energy falls; whether it does.
bool descend(const Node& node, const Vec3& step, StrandVector& at) {
  constexpr int halvings = 12;
  StrandVector motion = StrandVector::Zero();
  motion.segment<3>(3) = step;
  const double before = node.energy(at), rounding = 1e-13 * std::abs(before);
  double share = node.safe_share(at, motion);
  for (int k = 0; k < halvings; ++k, share *= 0.5) {
    const StrandVector next = at + share * motion;
    if (!(node.energy(next) <= before + rounding)) continue;
    at = next;
    return true;
  }
  return false;
}

}  // namespace

Vec3 balanced_node(const StrandBetween& strand, const NodeLoad& load, const StrandVector& places) {
  constexpr int most_steps = 30;
  constexpr double longest = 1e-3;               // m, of a step
  constexpr double worth = 1e-7, enough = 1e-9;  // of the strength
  const double strength = strand.strand.law.setup().strength;
  const Node node(strand, load, places);
  StrandVector at = places;
  Vec3 gradient = node.gradient(at);
  if (gradient.norm() <= worth * strength) return at.segment<3>(3);
  for (int k = 0; k < most_steps && gradient.norm() > enough * strength; ++k) {
    const Vec3 step = node.step(at, gradient);
    if (!descend(node, step * std::min(1.0, longest / step.norm()), at)) break;
    gradient = node.gradient(at);
  }
  return at.segment<3>(3);
}

}  // namespace calot
