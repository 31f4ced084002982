#pragma once
// L L' of a dense symmetric matrix, compiled once for all that need it.

#include <vector>

#include "base/workers.h"
#include "geometry/types.h"

namespace calot {

/// Columns that are worked on at a time.
inline constexpr Eigen::Index cholesky_block = 48;

/// L in place of the lower triangle of a, the only part that is read; false when a is not positive definite. `ends`:
/// one past the last row that is not zero in each block of columns, never falling: nothing below is read or written;
/// none: all rows. The bits do not depend on who shares the work.
bool cholesky_in_place(Eigen::MatrixXd& a, const std::vector<Eigen::Index>& ends = {},
                       Workers* workers = nullptr);

/// (L L')^-1 right, of a factor that succeeded, with the same ends. Columns together take a fraction of the time.
VecX cholesky_solve(const Eigen::MatrixXd& l, VecX right, const std::vector<Eigen::Index>& ends = {});
Eigen::MatrixXd cholesky_solve(const Eigen::MatrixXd& l, Eigen::MatrixXd right,
                               const std::vector<Eigen::Index>& ends = {});

/// L^-1 right, likewise; rows that are 0 until the first that is not cost nothing.
Eigen::MatrixXd cholesky_solve_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd right,
                                     const std::vector<Eigen::Index>& ends = {});

}  // namespace calot
