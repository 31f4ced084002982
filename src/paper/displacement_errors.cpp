#include "paper/displacement_errors.h"

#include <algorithm>

namespace calot {

double largest_of(const std::vector<Vec3>& displacements) {
  double out = 0;
  for (const Vec3& d : displacements) out = std::max(out, d.norm());
  return out;
}

DisplacementErrors displacement_errors(const std::vector<Vec3>& displacements,
                                       const std::vector<Vec3>& reference, const std::vector<bool>& near) {
  DisplacementErrors out;
  const double largest = largest_of(reference);
  int close = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = 100 * (displacements[i] - reference[i]).norm() / largest;
    out.mean_pct += error / static_cast<double>(reference.size());
    out.max_pct = std::max(out.max_pct, error);
    if (!near[i]) continue;
    out.contact_pct += error;
    ++close;
  }
  if (close > 0) out.contact_pct /= close;
  return out;
}

}  // namespace calot
