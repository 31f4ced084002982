#include "page/decimate.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

PlanePoints finite(const PlanePoints& points) {
  PlanePoints out;
  std::copy_if(points.begin(), points.end(), std::back_inserter(out),
               [](const auto& point) { return std::isfinite(point[0]) && std::isfinite(point[1]); });
  return out;
}

PlanePoints kept_apart(const PlanePoints& points, double least) {
  PlanePoints out{points.front()};
  for (const auto& point : points)
    if (std::hypot(point[0] - out.back()[0], point[1] - out.back()[1]) >= least) out.push_back(point);
  if (out.back() != points.back()) out.push_back(points.back());
  return out;
}

}  // namespace

PlanePoints thinned_over_x(const PlanePoints& points, std::size_t columns) {
  const PlanePoints all = finite(points);
  if (all.size() <= 2 * columns) return all;
  PlanePoints out{all.front()};
  for (std::size_t column = 0; column < columns; ++column) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(column * all.size() / columns);
    const auto end = all.begin() + static_cast<std::ptrdiff_t>((column + 1) * all.size() / columns);
    auto [low, high] =
        std::minmax_element(begin, end, [](const auto& a, const auto& b) { return a[1] < b[1]; });
    if (high < low) std::swap(low, high);
    out.push_back(*low);
    if (high != low) out.push_back(*high);
  }
  out.push_back(all.back());
  return out;
}

PlanePoints thinned_way(const PlanePoints& points, double least, std::size_t most) {
  const PlanePoints all = finite(points);
  if (all.empty()) return all;
  const PlanePoints apart = kept_apart(all, least);
  const std::size_t room = std::max<std::size_t>(most, 2) - 1, stride = (apart.size() + room - 1) / room;
  PlanePoints out;
  for (std::size_t i = 0; i + 1 < apart.size(); i += stride) out.push_back(apart[i]);
  out.push_back(apart.back());
  return out;
}

}  // namespace calot
