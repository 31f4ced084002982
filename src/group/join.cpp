#include "group/join.h"

#include "base/workers.h"

namespace calot {

double safe_share(std::span<const Join* const> joins, const VecX& x, const VecX& step, double share,
                  Workers* workers) {
  std::vector<double> shares(joins.size(), share);
  for_each_chunk(workers, static_cast<int>(joins.size()), [&](int j) {
    const auto k = static_cast<std::size_t>(j);
    shares[k] = joins[k]->safe_share(x, step, share);
  });
  for (double own : shares) share = std::min(share, own);
  return share;
}

}  // namespace calot
