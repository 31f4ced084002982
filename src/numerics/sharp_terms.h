#pragma once
// Terms of an energy that bend sharply within a step, but hang on few nodes where they do: contact, pads that press.
// Bodies hardly bend within such a step, so only these terms keep a Newton step from ending in balance.

#include <span>

#include "geometry/state_members.h"
#include "numerics/block_matrix.h"

namespace calot {

/// Of the terms, at one place.
struct SharpHessian {
  /// A matrix, N/m, of nodes first_node, first_node + 1, ...
  struct Part {
    int first_node = 0;
    BlockMatrix matrix;
  };
  std::vector<Part> parts;  ///< of different nodes

  /// Rows and columns of `nodes`, increasing: 3 each.
  Eigen::MatrixXd over(std::span<const int> nodes) const;
};

/// What one of the terms adds to a matrix that is factorised: at a place of a body's skin, which knows it by these numbers.
struct SharpTangent {
  int part = 0, law = 0, point = 0;
  Mat3 stiffness = Mat3::Zero();  ///< N/m
};
void visit_members(auto&& visit, MembersOf<SharpTangent> auto& tangent) {
  auto& [part, law, point, stiffness] = tangent;
  visit(part, law, point, stiffness);
}

/// Some of the terms.
class SharpTerms {
 public:
  virtual ~SharpTerms() = default;
  const std::vector<int>& nodes() const { return nodes_; }  ///< that they hang on, increasing
  /// Their part of the energy, J, and its derivatives, N, 3 a node, and N/m. `convex`: without what makes it indefinite.
  virtual double value(const VecX& x) const = 0;
  virtual VecX gradient(const VecX& x) const = 0;
  virtual SharpHessian hessian(const VecX& x, bool convex) const = 0;
  /// Their part of the matrix that was factorised.
  virtual SharpHessian factorised() const = 0;
  /// The share of a step on which nothing is passed through.
  virtual double safe_share(const VecX& x, const VecX& step) const = 0;

 protected:
  std::vector<int> nodes_;
};

}  // namespace calot
