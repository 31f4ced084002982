#include "group/detail_fading.h"

#include <algorithm>
#include <cmath>

#include "base/index_of.h"
#include "numerics/parts.h"

namespace calot {
namespace {

/// Below this, N, nothing is left of a load.
constexpr double no_load = 1e-9;

bool contains(const std::vector<int>& list, int value) { return index_of(value, list) >= 0; }

}  // namespace

std::vector<double> detail_holds(const ShellBody& body, const std::vector<DetailShare>& shares) {
  if (std::all_of(shares.begin(), shares.end(), [](const DetailShare& s) { return s.share == 1.0; }))
    return {};
  std::vector<double> out;
  for (std::size_t i = 0; i < shares.size(); ++i)
    out.push_back(body.detail_stiffness(static_cast<int>(i)) * (1.0 / shares[i].share - 1.0));
  return out;
}

void fade_details(double way, BodyState& state) {
  const double change = way / fade_length;
  for (DetailShare& s : state.shares)
    s.share = std::clamp(s.share + (s.leaving ? -change : change), least_share, 1.0);
  if (way == 0 || state.fading_load.size() == 0) return;
  state.fading_load *= std::exp(-change);  // whatever the steps
  if (largest_node(state.fading_load) < no_load) state.fading_load.resize(0);
}

std::vector<int> lasting_details(const ShellBody& body, const BodyState& state,
                                 const std::vector<int>& wanted) {
  constexpr double displaced = 1e-6;  // m
  std::vector<int> out;
  for (std::size_t i = 0; i < body.details().size(); ++i) {
    const int detail = body.details()[i];
    const Eigen::Index at = 3 * (Eigen::Index{body.coarse_nodes()} + static_cast<Eigen::Index>(i));
    const bool spent =
        !state.shares.empty() && state.shares[i].leaving && state.shares[i].share <= least_share;
    if (contains(wanted, detail) || (!spent && state.x.segment<3>(at).norm() > displaced))
      out.push_back(detail);
  }
  return out;
}

VecX made_good(const ShellBody& body, const BodyState& state, const ShellBody& next, const VecX& x) {
  VecX known = -body.forces(state.x, state.datum_pressure);
  if (state.fading_load.size() > 0) known += state.fading_load;
  VecX out = next.forces(x, state.datum_pressure);
  // What both have, that is: a new detail's own force is for its spring.
  const VecX both = body.coordinates_in(next, VecX::Ones(known.size()));
  out = out.cwiseProduct(both) + body.coordinates_in(next, known);
  if (largest_node(out) < no_load) out.resize(0);
  return out;
}

std::vector<DetailShare> shares_of(const std::vector<int>& next, const std::vector<int>& wanted,
                                   const ShellBody& body, const std::vector<DetailShare>& shares) {
  std::vector<DetailShare> out;
  for (int detail : next) {
    const int known = index_of(detail, body.details());
    DetailShare share{least_share, false};
    if (known >= 0) share = shares.empty() ? DetailShare{} : shares[known];
    share.leaving = !contains(wanted, detail);
    out.push_back(share);
  }
  return out;
}

}  // namespace calot
