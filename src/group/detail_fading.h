#pragma once
// Details fade in and out: where one comes or goes under load a spring holds its weight back, from rigidly (share 0)
// to not at all (1), so that neither the skin nor a tool's force jumps; what the finer rules alter at once is made good
// by a load that passes. Both follow the way that tools travel (travel_bound, of the one that travels most), so the
// answer does not depend on the rate of the steps.

#include <vector>

#include "body/shell_body.h"

namespace calot {

/// Way that takes a detail from held to free or back, and a load to 1 / e of itself, m.
inline constexpr double fade_length = 2e-3;
/// No detail has less: a spring a thousand times as stiff as the wall is rigid.
inline constexpr double least_share = 1e-3;

/// Stiffness of the springs, N/m, one a detail; none where all are free.
std::vector<double> detail_holds(const ShellBody& body, const std::vector<DetailShare>& shares);

/// Moves shares and the fading load on as a tool travels by `way`, m.
void fade_details(double way, BodyState& state);

/// The details of a body that are wanted or still do something: those that leave do until their share is spent or they
/// are where they were at rest. Increasing.
std::vector<int> lasting_details(const ShellBody& body, const BodyState& state,
                                 const std::vector<int>& wanted);

/// Load that keeps a body in balance as it becomes `next`, at the same place `x` in its coordinates, but for the new
/// details, which are held: its finer rules see a deformed wall otherwise than those before.
VecX made_good(const ShellBody& body, const BodyState& state, const ShellBody& next, const VecX& x);

/// Shares for the details `next` of a body that has its own: what is new begins with the least, what is not `wanted`
/// leaves.
std::vector<DetailShare> shares_of(const std::vector<int>& next, const std::vector<int>& wanted,
                                   const ShellBody& body, const std::vector<DetailShare>& shares);

}  // namespace calot
