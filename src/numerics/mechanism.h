#pragma once
// Bodies that nothing holds.

#include <optional>
#include <span>

#include "numerics/block_matrix.h"
#include "numerics/parts.h"

namespace calot {

/// Mean of the diagonal's sizes at a part's nodes, N/m: how stiff it is.
double mean_stiffness(const BlockMatrix& matrix, const Part& part);

/// A part that a rigid motion meets no resistance to, be it alone or together with what it is joined to. `gradients`:
/// of the constraints, a column each; `compliances` of these, empty: all 0. None too where the matrix is not finite: the
/// solve says so.
std::optional<int> mechanism(const BlockMatrix& matrix, const Eigen::MatrixXd& gradients,
                             const VecX& compliances, const VecX& x, std::span<const Part> parts);

}  // namespace calot
