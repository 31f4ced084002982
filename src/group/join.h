#pragma once
// What joins bodies that are solved together (group_problem.h).

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "base/workers.h"
#include "body/body.h"
#include "body/skin_bounds.h"

namespace calot {

class SkinJoin;

/// Where a body stands in a group.
struct GroupPlace {
  const Body* body = nullptr;
  int first_node = 0;
  Workers* workers = nullptr;  ///< who share what is asked about it; none: who asks, alone
};

/// Nodes of a body that its own energies do not couple with each other, and what those do to each at some x.
struct LooseNodes {
  int first = 0;   ///< number of the first of them in the group
  VecX gradient;   ///< N, 3 a node
  VecX stiffness;  ///< N/m, one a node, the same in each direction and at each x
};

/// What joins bodies: an energy over nodes of several of them, in the group's numbering. What it remembers is no part of
/// any result.
class Join {
 public:
  virtual ~Join() = default;
  /// Null: it is no contact of skins, which may rub on each other (body_rubbing.h).
  virtual const SkinJoin* skins() const { return nullptr; }
  /// A solve begins, of these bodies: they stay what they are until the next. Asked before anything else.
  virtual void begin(std::span<const GroupPlace> /*bodies*/) const {}
  /// Whether, while the bodies' skins are in these bounds, nothing acts, couples or stops them: then nothing else needs to
  /// be asked.
  virtual bool idle(std::span<const SkinBounds> /*bodies*/) const { return false; }
  /// Finds what acts at x, which is then asked for; threads call it for several joins at a time.
  virtual void find(const VecX& /*x*/) const {}
  virtual double value(const VecX& x) const = 0;  ///< J
  virtual void add_gradient(const VecX& x, VecX& gradient) const = 0;
  /// Couplings that the pattern does not hold are left out: Newton then converges more slowly.
  virtual void add_hessian(const VecX& x, BlockMatrix& matrix) const = 0;
  /// As ConstrainedEnergy's, of the same couplings.
  virtual bool add_convexity(const VecX& /*x*/, BlockMatrix& /*matrix*/) const { return false; }
  /// Whether the last add_hessian() left some out.
  virtual bool lacking() const { return false; }
  /// Adds groups of nodes that add_hessian() may couple: with `close` in a solve that begins at x, else in some later solve,
  /// too. A matrix is made with room for the second kind, so that it serves many solves. Asked only of groups of two bodies
  /// or more: a body alone has all that it couples in its own pattern.
  virtual void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const = 0;
  /// How many of the groups that add_cliques() adds are of couplings that last, so that with `close` it leaves them out:
  /// a matrix always has room for them.
  virtual std::size_t lasting_cliques() const { return 0; }
  /// Moves those of these nodes that this join alone couples with others to where they are in balance between them.
  virtual void relax(const LooseNodes& /*nodes*/, VecX& /*x*/) const {}
  /// The largest part of `share` of the step that is safe.
  virtual double safe_share(const VecX& /*x*/, const VecX& /*step*/, double share) const { return share; }
};

using JoinPointer = std::shared_ptr<const Join>;

/// The least of share_of(0) .. share_of(count - 1), which threads ask for several at a time, and of `most`.
template <class ShareOf>
double least_safe(Workers* workers, std::size_t count, double most, const ShareOf& share_of) {
  std::vector<double> shares(count, most);
  for_each_chunk(workers, static_cast<int>(count),
                 [&](int k) { shares[static_cast<std::size_t>(k)] = share_of(static_cast<std::size_t>(k)); });
  for (double share : shares) most = std::min(most, share);
  return most;
}

}  // namespace calot
