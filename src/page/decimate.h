#pragma once
// Fewer points that look the same.

#include <array>
#include <vector>

namespace calot {

using PlanePoints = std::vector<std::array<double, 2>>;

/// Of a curve over x, which does not fall: where it has more than 2 * `columns` points, the lowest and the highest of
/// each column, in their order, besides its first and last point. No peak is lost. What is not finite is left out.
PlanePoints thinned_over_x(const PlanePoints& points, std::size_t columns);

/// Of a way in the plane: points that lie `least` from the last one kept, and the last point; where these are more than
/// `most`, every second of them, or every third, ...
PlanePoints thinned_way(const PlanePoints& points, double least, std::size_t most);

}  // namespace calot
