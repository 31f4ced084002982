#include "geometry/lobe.h"

#include <algorithm>
#include <cmath>

namespace calot {
namespace {

/// What recedes of the edge towards the sides, of the depth.
constexpr double receding = 0.14;
/// By how much its ends are rounded: either side of them of the depth, and of the thickness there.
constexpr double end_shorter = 0.16, end_thinner = 0.22;

double depth_at(const LobeForm& form, double y) {
  const double aside = 2 * y / form.width;
  return form.depth * (1 - receding * aside * aside);
}

/// 1 at the ends, next to nothing beside the bed: smooth, for the skin goes through these places and would swing over.
double end_share(const LobeForm& form, double y) { return std::pow(2 * y / form.width, 4); }

double thickness_at(const LobeForm& form, double from_edge) {
  const double more = form.thickness - form.edge;
  return form.edge + more * (1 - std::exp(-from_edge * std::tan(form.edge_angle) / more));
}

/// x of the underside, which what lies in the bed lifts.
double underside_at(const LobeForm& form, double y, double z) {
  const double radius = form.bed_radius ? form.bed_radius(z) : 0.0;
  const double round = radius * radius - y * y;
  return std::max(form.underside, round > 0 ? std::sqrt(round) : 0.0);
}

}  // namespace

Vec3 lobe_place(const LobeForm& form, const Vec3& at) {
  const double y = form.width * (at[0] - 0.5), end = end_share(form, y);
  const double rounding = end_shorter * form.depth * end, depth = depth_at(form, y) - 2 * rounding;
  const double back = form.edge_at - form.depth + rounding, z = back + depth * at[1];
  const double under = underside_at(form, y, z), thick = thickness_at(form, back + depth - z);
  // The bed takes from the thickness, but no more than leaves an edge above it.
  const double through = std::max(form.underside + thick, under + form.edge) - under;
  const double thinner = end_thinner * thick * end;
  return {under + thinner + at[2] * (through - 2 * thinner), y, z};
}

LobeCells lobe_cells(const LobeForm& form) {
  LobeCells out;
  out.surface.cells = {8, 4};
  out.along = {0, 0.32, 0.6, 0.83, 1};
  if (form.bed_width > 0) {
    // Of the width: half the bed, and the shoulder of what is round in it.
    const double bed = 0.5 * form.bed_width / form.width, shoulder = 0.62 * bed, beside = 0.25 + 0.5 * bed;
    for (double side : {-0.5, -beside, -bed, -shoulder, 0.0, shoulder, bed, beside, 0.5})
      out.across.push_back(0.5 + side);
  } else {
    for (int k = 0; k <= out.surface.cells[0]; ++k) out.across.push_back(k / 8.0);
  }
  return out;
}

TriMesh lobe_mesh(const LobeForm& form, const LobeCells& cells) {
  TriMesh out;
  out.triangles = cells.surface.triangles();
  for (double through : {0.0, 1.0})
    for (double along : cells.along)
      for (double across : cells.across) out.points.push_back(lobe_place(form, {across, along, through}));
  return out;
}

std::function<double(double)> radius_by_height(const Profile& profile) {
  constexpr int samples = 200;
  std::vector<Vec2> points;
  for (int k = 0; k <= samples; ++k) points.push_back(profile.point(static_cast<double>(k) / samples));
  return [points](double z) {
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Vec2 &a = points[k - 1], &b = points[k];
      if (z < a.y() || z > b.y() || b.y() <= a.y()) continue;
      return a.x() + (z - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    }
    return 0.0;
  };
}

}  // namespace calot
