#pragma once
// Decompositions of 3 x 3 matrices. Here and nowhere else, as Eigen's templates for them take seconds of a compiler's
// time in each file.

#include "geometry/types.h"

namespace calot {

struct Principal {
  Vec3 values;   ///< eigenvalues, increasing
  Mat3 vectors;  ///< unit eigenvectors, columns
};

/// Of a symmetric matrix, of which the lower triangle is read.
Principal principal(const Mat3& symmetric);
/// Its eigenvalues alone, increasing.
Vec3 principal_values(const Mat3& symmetric);

struct Singular {
  Mat3 left, right;  ///< U and V of M = U S V', orthogonal; singular values decreasing
};

Singular singular(const Mat3& m);

}  // namespace calot
