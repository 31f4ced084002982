#pragma once
// A surface point as fixed linear blends of control points: the only thing the rooms fem, skin and collision
// need to share. Linear triangles, Loop faces and refined faces differ only in their stencils.

#include <vector>

#include "geometry/types.h"

namespace calot {

/// Row r has entries begin[r] .. begin[r+1] - 1. Weights of one row and derivative order act alike on x, y,
/// z.
struct StencilTable {
  std::vector<int> begin{0};   ///< rows + 1
  std::vector<int> node;       ///< control point of each entry, increasing within a row
  std::vector<double> value;   ///< weights of the position; they sum to 1 in a row
  std::vector<double> du, dv;  ///< first derivatives by the face's parameters; empty when not asked for
  std::vector<double> duu, duv, dvv;  ///< second derivatives; empty when not asked for

  int rows() const { return static_cast<int>(begin.size()) - 1; }
};

/// Room for as many rows and entries as `like` has, and a share more, with its derivatives.
inline void reserve_as(const StencilTable& like, double more, StencilTable& table) {
  const auto entries = static_cast<std::size_t>((1 + more) * static_cast<double>(like.node.size()));
  table.begin.reserve(like.begin.size());
  table.node.reserve(entries);
  table.value.reserve(entries);
  if (!like.du.empty()) table.du.reserve(entries), table.dv.reserve(entries);
  if (!like.duu.empty()) table.duu.reserve(entries), table.duv.reserve(entries), table.dvv.reserve(entries);
}

/// Adds rows first .. last - 1 of `from`, with the derivatives that it has.
inline void append_rows(const StencilTable& from, int first, int last, StencilTable& to) {
  const int begin = from.begin[first], end = from.begin[last];
  const auto copy = [&](const auto& source, auto& target) {
    if (!source.empty()) target.insert(target.end(), source.begin() + begin, source.begin() + end);
  };
  const int shift = static_cast<int>(to.node.size()) - begin;
  copy(from.node, to.node);
  copy(from.value, to.value);
  copy(from.du, to.du);
  copy(from.dv, to.dv);
  copy(from.duu, to.duu);
  copy(from.duv, to.duv);
  copy(from.dvv, to.dvv);
  for (int r = first; r < last; ++r) to.begin.push_back(from.begin[r + 1] + shift);
}

/// Sum of weights[e] * x[node[e]] over row r; `weights` is one of the table's arrays, x is 3 * nodes
/// coordinates (x, y, z of node 0, then of node 1, ...).
inline Vec3 blend(const StencilTable& table, const std::vector<double>& weights, int r, const VecX& x) {
  Vec3 sum = Vec3::Zero();
  for (int e = table.begin[r]; e < table.begin[r + 1]; ++e)
    sum += weights[e] * x.segment<3>(Eigen::Index{3} * table.node[e]);
  return sum;
}

/// blend for every row.
inline std::vector<Vec3> blend_all(const StencilTable& table, const std::vector<double>& weights,
                                   const VecX& x) {
  std::vector<Vec3> points(table.rows());
  for (int r = 0; r < table.rows(); ++r) points[r] = blend(table, weights, r, x);
  return points;
}

/// The transpose of blend (virtual work): adds weight * value to the nodes of row r, values of the position.
inline void spread(const StencilTable& table, int r, const Vec3& value, VecX& nodes) {
  for (int e = table.begin[r]; e < table.begin[r + 1]; ++e)
    nodes.segment<3>(Eigen::Index{3} * table.node[e]) += table.value[e] * value;
}
inline void spread(const StencilTable& table, const std::vector<Vec3>& values, VecX& nodes) {
  for (int r = 0; r < table.rows(); ++r) spread(table, r, values[r], nodes);
}

/// Points as the coordinates that blend() takes.
inline VecX to_coordinates(const std::vector<Vec3>& points) {
  VecX x(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) x.segment<3>(3 * static_cast<Eigen::Index>(i)) = points[i];
  return x;
}

/// A point of a control face: u + v <= 1, corners (0,0), (1,0), (0,1) are the face's vertices 0, 1, 2.
struct FacePoint {
  int face = 0;
  double u = 0, v = 0;
};

/// A crack-free triangulation of a limit surface. Points on shared edges and vertices occur once.
struct Tessellation {
  std::vector<FacePoint> at;        ///< one parametric place of each point
  StencilTable stencils;            ///< one row a point, with first derivatives (for normals)
  std::vector<Triangle> triangles;  ///< indices into points, oriented as the control faces
};

}  // namespace calot
