#include "fem/nodal_mass.h"

#include "fem/lanes.h"

namespace calot {

namespace {

/// Whether each block is a number times the identity.
bool same_for_all_ways(const BlockMatrix& mass) {
  for (int column = 0; column < mass.size(); ++column)
    for (int e = mass.column_starts()[column]; e < mass.column_starts()[column + 1]; ++e) {
      const bool diagonal = mass.rows()[e] % 3 == column % 3;
      const int own = mass.column_starts()[column - column % 3] + (e - mass.column_starts()[column]) / 3 * 3;
      if (mass.entries()[e] != (diagonal ? mass.entries()[own] : 0.0)) return false;
    }
  return true;
}

}  // namespace

NodalMass::NodalMass(const BlockMatrix& mass) : begin_{0} {
  if (!same_for_all_ways(mass)) {
    whole_ = &mass;
    return;
  }
  for (int node = 0; node < mass.nodes(); ++node) {
    const int column = 3 * node;
    for (int e = mass.column_starts()[column]; e < mass.column_starts()[column + 1]; e += 3) {
      row_.push_back(mass.rows()[e] / 3);
      mass_.push_back(mass.entries()[e]);
    }
    begin_.push_back(static_cast<int>(row_.size()));
  }
}

VecX NodalMass::multiply(const VecX& x) const {
  if (whole_ != nullptr) return whole_->multiply(x);
  const std::size_t nodes = begin_.size() - 1;
  std::vector<Lanes> from(nodes), to(nodes, Lanes{});
  for (std::size_t i = 0; i < nodes; ++i) from[i] = Lanes{x[3 * i], x[3 * i + 1], x[3 * i + 2], 0};
  for (std::size_t j = 0; j < nodes; ++j) {
    int e = begin_[j];
    Lanes sum = fused(all_lanes(mass_[e]), from[j], to[j]);
    while (++e < begin_[j + 1]) {
      const Lanes mass = all_lanes(mass_[e]);
      sum = fused(mass, from[row_[e]], sum);
      to[row_[e]] = fused(mass, from[j], to[row_[e]]);
    }
    to[j] = sum;
  }
  VecX out(x.size());
  for (std::size_t i = 0; i < nodes; ++i)
    for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = to[i][c];
  return out;
}

}  // namespace calot
