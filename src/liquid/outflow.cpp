#include "liquid/outflow.h"

#include <algorithm>
#include <cmath>

namespace calot {

double fed_flow(const TubeFeed& feed, double pressure, double area, double density) {
  if (!(pressure > 0) || !(area > 0)) return 0;
  const double by_square = 0.5 * density / std::pow(discharge * area, 2);
  return 2 * pressure /
         (feed.resistance + std::sqrt(feed.resistance * feed.resistance + 4 * by_square * pressure));
}

double elastic_outflow(double pressure, double compliance, double area, double density, double time,
                       double resistance) {
  if (!(pressure > 0) || !(area > 0)) return 0;
  if (resistance > 0) {
    const auto flow = [&](double at) { return fed_flow({at, resistance}, at, area, density); };
    if (!(compliance > 0)) return time * flow(pressure);
    const double half_way = pressure - 0.5 * time * flow(pressure) / compliance;
    return std::min(time * flow(half_way), compliance * pressure);
  }
  const double k = discharge * area * std::sqrt(2 / density), root = std::sqrt(pressure);
  if (!(compliance > 0)) return k * root * time;
  const double empty = 2 * compliance * root / k;  // s, until no pressure is left
  return time >= empty ? compliance * pressure : k * time * (root - k * time / (4 * compliance));
}

}  // namespace calot
