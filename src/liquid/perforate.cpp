#include "liquid/perforate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "body/rod_body.h"
#include "field/divide_body.h"

namespace calot {
namespace {

constexpr double gape = 0.5e-3;        // m, of a slit in a wall (d)
constexpr double least_slit = 1.0e-3;  // m: blades that stand on a wall have cut it

}  // namespace

void perforate(Organ& organ, ToolIndex instrument, const std::string& name) {
  if (organ.body->liquid() == nullptr) return;
  Vec3 sum = Vec3::Zero();
  double low = 1, high = -1;  // m, along the jaws
  std::vector<int> held;
  for (const GripPoint& grip : organ.grips) {
    if (grip.instrument != instrument) continue;
    held.push_back(grip.skin_point);
    sum += organ.body->skin_rest()[grip.skin_point];
    low = std::min(low, grip.local.z());
    high = std::max(high, grip.local.z());
  }
  if (held.empty()) return;
  const Vec3 middle = sum / static_cast<double>(held.size());
  const auto nearer = [&](int a, int b) {
    return (organ.body->skin_rest()[a] - middle).norm() < (organ.body->skin_rest()[b] - middle).norm();
  };
  Opening hole;
  hole.point = *std::min_element(held.begin(), held.end(), nearer);
  hole.area = gape * std::max(least_slit, high - low);
  hole.cause = name;
  organ.openings.push_back(hole);
}

void perforate(Organ& organ, const Vec3& at, const std::string& instrument) {
  constexpr double burnt = 3e-6;  // m^2, 2 mm across (d)
  if (organ.body->liquid() == nullptr) return;
  Opening hole;
  hole.point = nearest_of(organ.body->skin_positions(organ.state.x), at);
  hole.area = burnt;
  hole.cause = instrument;
  organ.openings.push_back(hole);
}

Result<double> open_tube(Organ& tube, double share, double width) {
  const RodBody* rod = tube.body->as_tube();
  if (rod == nullptr) return no_tube(tube.definition, "open", "opened");
  const int last = static_cast<int>(rod->last_point());
  int nearest = -1;
  for (int point = 1; point < last; ++point)
    if (nearest < 0 ||
        std::abs(rod->share_of_length(point) - share) < std::abs(rod->share_of_length(nearest) - share))
      nearest = point;
  if (nearest < 0)
    return fail(FailureKind::scenario, fmt::format("'{}' is too short to be opened", tube.definition.name));
  const bool is_open = std::any_of(tube.openings.begin(), tube.openings.end(),
                                   [&](const Opening& opening) { return opening.point == nearest; });
  if (is_open)
    return fail(FailureKind::scenario,
                fmt::format("'{}' is open already at {:.2f} of its length", tube.definition.name,
                            rod->share_of_length(nearest)),
                "open it once there, wider (the third argument), or elsewhere");
  Opening hole;
  hole.point = nearest;
  hole.area = 0.25 * std::numbers::pi * width * width;
  // A tube's openings stand in the order of their points.
  const auto behind = std::find_if(tube.openings.begin(), tube.openings.end(),
                                   [&](const Opening& opening) { return opening.point > nearest; });
  tube.openings.insert(behind, hole);
  return rod->share_of_length(nearest);
}

}  // namespace calot
