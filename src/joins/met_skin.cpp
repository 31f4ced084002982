#include "joins/met_skin.h"

#include "body/body.h"
#include "body/loop_skin.h"

namespace calot {
namespace {

/// The points of one face's grid: (i, j) with i + j <= parts.
class SplitFace {
 public:
  SplitFace(const std::vector<Triangle>& split, int face, int parts)
      : triangles_(split.data() + std::ptrdiff_t{face} * parts * parts), parts_(parts) {}

  int point(int i, int j) const {
    if (i + j < parts_) return upright(i, j)[0];
    return i > 0 ? upright(i - 1, j)[1] : upright(i, j - 1)[2];
  }

 private:
  /// The triangle (i, j), (i + 1, j), (i, j + 1): each is followed by the one across its long side, but the last of a row.
  const Triangle& upright(int i, int j) const { return triangles_[2 * parts_ * j - j * j + 2 * i]; }

  const Triangle* triangles_;
  int parts_;
};

/// The largest step that leaves no points further apart than met_spacing.
int step_of(const Body& body) {
  const double gap = body.skin_parts() > 1 ? body.widest_skin_gap() : met_spacing;
  int step = 1;
  for (int k = 2; k <= body.skin_parts() && k * gap <= met_spacing; ++k)
    if (body.skin_parts() % k == 0) step = k;
  return step;
}

}  // namespace

std::vector<Triangle> joined_triangles(const std::vector<Triangle>& split, int parts, int step) {
  std::vector<Triangle> out;
  const int faces = static_cast<int>(split.size()) / (parts * parts);
  for (int f = 0; f < faces; ++f) {
    const SplitFace face(split, f, parts);
    for (int j = 0; j < parts; j += step)
      for (int i = 0; i + j < parts; i += step) {
        out.push_back({face.point(i, j), face.point(i + step, j), face.point(i, j + step)});
        if (i + j + step < parts)
          out.push_back({face.point(i + step, j), face.point(i + step, j + step), face.point(i, j + step)});
      }
  }
  return out;
}

MetSkin met_skin(const Body& body) {
  const std::vector<Triangle>& triangles = body.skin().triangles;
  const int step = step_of(body);
  if (step == 1) return {triangles, body.triangles_each(), body.skin_areas()};
  MetSkin out{
      joined_triangles(triangles, body.skin_parts(), step), body.triangles_each() / (step * step), {}};
  out.areas = lumped(areas_of(body.skin_rest(), out.triangles), out.triangles, body.skin_rest().size());
  return out;
}

}  // namespace calot
