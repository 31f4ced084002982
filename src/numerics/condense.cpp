#include "numerics/condense.h"

#include <algorithm>
#include <limits>

namespace calot {

Condensation::Condensation(const BlockMatrix& pattern, int kept)
    : kept_(3 * kept), condensed_(Eigen::MatrixXd::Zero(3 * kept, 3 * kept)) {
  find_groups(pattern);
}

void Condensation::find_groups(const BlockMatrix& pattern) {
  // By nodes: their three unknowns are in one group and meet the same others.
  const int kept = kept_ / 3, count = pattern.nodes() - kept;
  std::vector<int> leader(count);
  for (int i = 0; i < count; ++i) leader[i] = i;
  const auto find = [&](int i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  std::vector<std::vector<int>> outer(count);  // kept nodes, increasing
  for (int column = 0; column < pattern.nodes(); ++column) {
    const int end = pattern.column_starts()[3 * column + 1];
    for (int e = pattern.column_starts()[3 * column]; e < end; e += 3) {
      const int row = pattern.rows()[e] / 3 - kept;
      if (row < 0) continue;
      if (column < kept) {
        outer[row].push_back(column);
      } else {
        const int a = find(row), b = find(column - kept);
        leader[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  group_of_.assign(3 * count, -1);
  place_in_.assign(3 * count, -1);
  std::vector<std::vector<char>> meets;
  for (int i = 0; i < count; ++i) {
    const int first = find(i);
    if (first == i) {
      group_of_[3 * i] = static_cast<int>(groups_.size());
      groups_.emplace_back();
      meets.emplace_back(kept, 0);
    }
    const int number = group_of_[3 * first];
    Group& group = groups_[number];
    for (int unknown = 3 * i; unknown < 3 * i + 3; ++unknown) {
      group_of_[unknown] = number;
      place_in_[unknown] = static_cast<int>(group.inner.size());
      group.inner.push_back(kept_ + unknown);
    }
    for (int node : outer[i]) meets[number][node] = 1;
  }
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (int unknown = 0; unknown < kept_; ++unknown)
      if (meets[g][unknown / 3]) groups_[g].outer.push_back(unknown);
}

void Condensation::gather(const BlockMatrix& matrix) {
  condensed_.setZero();
  for (Group& group : groups_) {
    const Eigen::Index inner = static_cast<Eigen::Index>(group.inner.size());
    group.stiffness.setZero(inner, inner);
    group.coupling.setZero(inner, static_cast<Eigen::Index>(group.outer.size()));
  }
  for (int column = 0; column < matrix.size(); ++column) {
    int place = -1, last = -1;  // of a kept column among its group's outer unknowns
    for (int e = matrix.column_starts()[column]; e < matrix.column_starts()[column + 1]; ++e) {
      const int row = matrix.rows()[e];
      const double value = matrix.entries()[e];
      if (row < kept_) {
        condensed_(row, column) = value;
        continue;
      }
      Group& group = groups_[group_of_[row - kept_]];
      if (column >= kept_) {
        group.stiffness(place_in_[row - kept_], place_in_[column - kept_]) = value;
        continue;
      }
      if (last != group_of_[row - kept_]) {
        last = group_of_[row - kept_];
        place = static_cast<int>(std::lower_bound(group.outer.begin(), group.outer.end(), column) -
                                 group.outer.begin());
      }
      group.coupling(place_in_[row - kept_], place) = value;
    }
  }
}

FactorStatus Condensation::eliminate(const BlockMatrix& matrix) {
  gather(matrix);
  Eigen::MatrixXd product;
  for (Group& group : groups_) {
    group.factor.compute(group.stiffness);
    if (group.factor.info() != Eigen::Success) return FactorStatus::not_positive_definite;
    if (group.outer.empty()) continue;
    group.factor.matrixL().solveInPlace(group.coupling);
    product.setZero(group.coupling.cols(), group.coupling.cols());
    product.selfadjointView<Eigen::Lower>().rankUpdate(group.coupling.transpose());
    for (std::size_t b = 0; b < group.outer.size(); ++b)
      for (std::size_t a = b; a < group.outer.size(); ++a)
        condensed_(group.outer[a], group.outer[b]) -=
            product(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  }
  return FactorStatus::ok;
}

namespace {

VecX pick(const VecX& from, const std::vector<int>& at) {
  VecX out(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) out[static_cast<Eigen::Index>(i)] = from[at[i]];
  return out;
}

}  // namespace

VecX Condensation::reduce(const VecX& right) const {
  VecX out = right.head(kept_);
  for (const Group& group : groups_) {
    if (group.outer.empty()) continue;
    const VecX passed = group.coupling.transpose() * group.factor.matrixL().solve(pick(right, group.inner));
    for (std::size_t i = 0; i < group.outer.size(); ++i)
      out[group.outer[i]] -= passed[static_cast<Eigen::Index>(i)];
  }
  return out;
}

VecX Condensation::expand(const VecX& right, const VecX& kept) const {
  VecX out(right.size());
  out.head(kept_) = kept;
  for (const Group& group : groups_) {
    VecX inner = group.factor.matrixL().solve(pick(right, group.inner));
    if (!group.outer.empty()) inner -= group.coupling * pick(kept, group.outer);
    group.factor.matrixU().solveInPlace(inner);
    for (std::size_t i = 0; i < group.inner.size(); ++i)
      out[group.inner[i]] = inner[static_cast<Eigen::Index>(i)];
  }
  return out;
}

std::vector<std::vector<int>> Condensation::outer_nodes() const {
  std::vector<std::vector<int>> out;
  for (const Group& group : groups_) {
    out.emplace_back();
    for (std::size_t i = 0; i < group.outer.size(); i += 3) out.back().push_back(group.outer[i] / 3);
  }
  return out;
}

double Condensation::flops() const {
  double sum = 0;
  for (const Group& group : groups_) {
    const double inner = static_cast<double>(group.inner.size()),
                 outer = static_cast<double>(group.outer.size());
    sum += inner * inner * inner / 3 + inner * inner * outer + inner * outer * outer;
  }
  return sum;
}

long Condensation::nonzeros() const {
  long sum = 0;
  for (const Group& group : groups_) {
    const long inner = static_cast<long>(group.inner.size());
    sum += inner * (inner + 1) / 2 + inner * static_cast<long>(group.outer.size());
  }
  return sum;
}

double Condensation::smallest_pivot() const {
  double out = groups_.empty() ? 1 : std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) out = std::min(out, group.factor.matrixLLT().diagonal().minCoeff());
  return out;
}
double Condensation::largest_pivot() const {
  double out = groups_.empty() ? 1 : 0;
  for (const Group& group : groups_) out = std::max(out, group.factor.matrixLLT().diagonal().maxCoeff());
  return out;
}

}  // namespace calot
