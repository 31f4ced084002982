#include "fem/bile.h"

#include <fmt/format.h>

#include <algorithm>

#include "fem/assembly.h"
#include "fem/lanes.h"

namespace calot {
namespace {

constexpr int most_points = 28;  // of a cell

double tetra_volume(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) / 6.0; }

}  // namespace

Result<Bile> Bile::create(const BileSurface& surface, double specific_weight, const Vec3& up,
                          const Vec3& datum) {
  Bile bile;
  bile.points_ = surface.points;
  bile.weight_ = {specific_weight, up};
  bile.datum_ = datum;
  const StencilTable& table = bile.points_;
  for (std::size_t c = 0; c < surface.cells.size(); ++c) {
    Cell cell;
    cell.first_part = static_cast<int>(bile.parts_.size());
    const std::vector<int> points = bile.add_parts(surface.cells[c]);
    if (points.size() > most_points)
      return fail(FailureKind::internal, fmt::format("cell {} of the bile has {} points", c, points.size()));
    cell.points = static_cast<int>(points.size());
    FaceNodes nodes;
    for (int p : points) nodes.add_row(table, p);
    if (nodes.count() > max_face_nodes)
      return fail(FailureKind::scenario,
                  fmt::format("cell {} of the bile depends on {} nodes", c, nodes.nodes.size()),
                  "remesh: a vertex has too many neighbours");
    cell.weights = static_cast<int>(bile.weights_.size());
    bile.weights_.resize(bile.weights_.size() + static_cast<std::size_t>(cell.points) * nodes.padded, 0.0);
    for (std::size_t k = 0; k < points.size(); ++k)
      dense_weights(table, table.value, points[k], nodes, &bile.weights_[cell.weights + k * nodes.padded]);
    bile.cells_.push_back(cell);
    bile.cell_nodes_.push_back(std::move(nodes));
  }
  return bile;
}

std::vector<int> Bile::add_parts(const std::vector<BileSurface::Part>& parts) {
  std::vector<int> points;
  for (const BileSurface::Part& from : parts) {
    Part part{from.corners, {}, from.weight};
    for (int k = 0; k < 3; ++k) {
      const auto found = std::find(points.begin(), points.end(), part.corners[k]);
      part.local[k] = static_cast<int>(found - points.begin());
      if (found == points.end()) points.push_back(part.corners[k]);
    }
    parts_.push_back(part);
  }
  return points;
}

std::vector<Vec3> Bile::positions(const VecX& x) const {
  std::vector<Vec3> out = blend_all(points_, points_.value, x);
  for (Vec3& p : out) p -= datum_;
  return out;
}

double Bile::volume(const VecX& x) const {
  const std::vector<Vec3> at = positions(x);
  double sum = 0;
  for (const auto& [t, local, w] : parts_) sum += w * tetra_volume(at[t[0]], at[t[1]], at[t[2]]);
  return sum;
}

double Bile::value(const VecX& x, const LiquidWeight& weight) const {
  const std::vector<Vec3> at = positions(x);
  double sum = 0;
  for (const auto& [t, local, w] : parts_)
    sum += w * tetra_volume(at[t[0]], at[t[1]], at[t[2]]) * weight.up.dot(at[t[0]] + at[t[1]] + at[t[2]]);
  return 0.25 * weight.size * sum;  // the fourth corner of each tetrahedron is the datum, at height 0
}

/// Triangles side by side; lanes that are not used have no weight.
struct Bile::Triangles {
  Lanes3 corner[3];
  Lanes weight = {};
};

Bile::Triangles Bile::triangles(int first, int used, const std::vector<Vec3>& at) const {
  Triangles out;
  for (int lane = 0; lane < used; ++lane) {
    const Part& part = parts_[first + lane];
    out.weight[lane] = part.weight;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) out.corner[k][c][lane] = at[part.corners[k]][c];
  }
  return out;
}

Bile::PointForces Bile::point_forces(const VecX& x, double datum_pressure, const LiquidWeight& weight) const {
  const Vec3& up = weight.up;
  const std::vector<Vec3> at = positions(x);
  PointForces out;
  out.load.assign(at.size(), Vec3::Zero());
  out.by_volume.assign(at.size(), Vec3::Zero());
  const double g4 = 0.25 * weight.size;
  const int count = static_cast<int>(parts_.size());
  for (int first = 0; first < count; first += lane_count) {
    const int used = std::min(lane_count, count - first);
    const Triangles t = triangles(first, used, at);
    const Lanes3 sum = t.corner[0] + t.corner[1] + t.corner[2];
    const Lanes s = g4 * (up[0] * sum[0] + up[1] * sum[1] + up[2] * sum[2]) - datum_pressure;
    const Lanes share = t.weight / 6.0, volume = share * dot(t.corner[0], cross(t.corner[1], t.corner[2]));
    out.volume += sum_of(volume);
    for (int k = 0; k < 3; ++k) {
      const Lanes3 by = share * cross(t.corner[(k + 1) % 3], t.corner[(k + 2) % 3]);
      for (int c = 0; c < 3; ++c) {
        const Lanes load = s * by[c] + g4 * up[c] * volume;
        for (int lane = 0; lane < used; ++lane) {
          const int point = parts_[first + lane].corners[k];
          out.by_volume[point][c] += by[c][lane];
          out.load[point][c] += load[lane];
        }
      }
    }
  }
  return out;
}

double Bile::add_volume_gradient(const VecX& x, VecX& gradient) const {
  const PointForces forces = point_forces(x, 0, weight_);
  spread(points_, forces.by_volume, gradient);
  return forces.volume;
}

LiquidMoments Bile::moments(const VecX& x) const {
  const std::vector<Vec3> at = positions(x);
  LiquidMoments out;
  for (const auto& [t, local, w] : parts_) {
    const double v = w * tetra_volume(at[t[0]], at[t[1]], at[t[2]]);
    out.volume += v;
    out.first += 0.25 * v * (at[t[0]] + at[t[1]] + at[t[2]]);  // the fourth corner is the datum
  }
  return out;
}

Eigen::MatrixX3d Bile::moment_gradients(const VecX& x) const {
  const std::vector<Vec3> at = positions(x);
  // Of the moment's x, y and z (columns) by a point's place (rows).
  std::vector<Mat3> by_point(at.size(), Mat3::Zero());
  for (const auto& [t, local, w] : parts_) {
    const Vec3 &a = at[t[0]], &b = at[t[1]], &c = at[t[2]];
    const Vec3 mean = 0.25 * (a + b + c), by[3] = {b.cross(c), c.cross(a), a.cross(b)};
    const double quarter = 0.25 * w * tetra_volume(a, b, c);
    for (int k = 0; k < 3; ++k) {
      Mat3& sum = by_point[t[k]];
      sum.noalias() += w / 6 * by[k] * mean.transpose();
      sum.diagonal().array() += quarter;
    }
  }
  std::vector<Mat3> by_node(static_cast<std::size_t>(x.size()) / 3, Mat3::Zero());
  for (int r = 0; r < points_.rows(); ++r)
    for (int e = points_.begin[r]; e < points_.begin[r + 1]; ++e)
      by_node[points_.node[e]] += points_.value[e] * by_point[r];
  Eigen::MatrixX3d out(x.size(), 3);
  for (std::size_t node = 0; node < by_node.size(); ++node)
    out.middleRows<3>(3 * static_cast<Eigen::Index>(node)) = by_node[node];
  return out;
}

void Bile::add_load(const VecX& x, double datum_pressure, const LiquidWeight& weight, VecX& gradient) const {
  spread(points_, point_forces(x, datum_pressure, weight).load, gradient);
}

double Bile::add_load_and_volume_gradient(const VecX& x, double datum_pressure, const LiquidWeight& weight,
                                          VecX& load, VecX& by_volume) const {
  const PointForces forces = point_forces(x, datum_pressure, weight);
  spread(points_, forces.load, load);
  spread(points_, forces.by_volume, by_volume);
  return forces.volume;
}

/// Second derivatives by a cell's points, kept by component pairs: at[pair][i * points + j] by component c of point
/// i and component d of point j.
struct Bile::CellHessian {
  int points = 0;
  bool coupled[most_points * most_points];
  double at[6][most_points * most_points];

  void reset(int count) {
    points = count;
    std::fill(coupled, coupled + count * count, false);
    for (auto& pair : at) std::fill(pair, pair + count * count, 0.0);
  }
};

/// Second derivatives of weight V (g4 up . (a + b + c) - m) of four triangles.
struct Bile::TriangleDerivatives {
  struct Block {
    Lanes at[6];  ///< by component pairs
  };

  const Vec3& up;
  const Lanes3* corner;
  Lanes3 by[3];  ///< gradient of g4 V by each corner, weighed
  Lanes s;

  TriangleDerivatives(const Triangles& t, double g4, const Vec3& upwards, double datum_pressure)
      : up(upwards), corner(t.corner) {
    const Lanes3 sum = t.corner[0] + t.corner[1] + t.corner[2];
    s = t.weight / 6.0 * (g4 * (up[0] * sum[0] + up[1] * sum[1] + up[2] * sum[2]) - datum_pressure);
    for (int i = 0; i < 3; ++i)
      by[i] = g4 / 6.0 * t.weight * cross(t.corner[(i + 1) % 3], t.corner[(i + 2) % 3]);
  }

  /// By the corners i and j.
  Block block(int i, int j) const {
    Block out;
    for (int pair = 0; pair < 6; ++pair) {
      const int c = component_pairs[pair][0], d = component_pairs[pair][1];
      out.at[pair] = by[i][c] * up[d] + up[c] * by[j][d];
    }
    if (i == j) return out;
    // d2V by (i, i + 1) = -[third corner] / 6, by (i + 1, i) its transpose.
    const Lanes3 turn = (j == (i + 1) % 3 ? -s : s) * corner[3 - i - j];
    out.at[1] -= turn[2];
    out.at[2] += turn[1];
    out.at[4] -= turn[0];
    return out;
  }
};

void Bile::assemble(std::size_t cell, const std::vector<Vec3>& at, double datum_pressure,
                    const LiquidWeight& weight, CellHessian& h) const {
  const int points = cells_[cell].points;
  h.reset(points);
  const int end = cell + 1 < cells_.size() ? cells_[cell + 1].first_part : static_cast<int>(parts_.size());
  for (int first = cells_[cell].first_part; first < end; first += lane_count) {
    const int used = std::min(lane_count, end - first);
    const Triangles t = triangles(first, used, at);
    const TriangleDerivatives derivatives(t, 0.25 * weight.size, weight.up, datum_pressure);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const TriangleDerivatives::Block block = derivatives.block(i, j);
        for (int lane = 0; lane < used; ++lane) {
          const Part& part = parts_[first + lane];
          const int place = part.local[i] * points + part.local[j];
          h.coupled[place] = true;
          for (int pair = 0; pair < 6; ++pair) h.at[pair][place] += block.at[pair][lane];
        }
      }
    }
  }
}

void Bile::cell_hessian(std::size_t cell, const std::vector<Vec3>& at, double datum_pressure,
                        const LiquidWeight& weight, ElementMatrix& element) const {
  CellHessian h;
  double products[most_points * max_face_nodes];
  const int points = cells_[cell].points, n = cell_nodes_[cell].padded;
  const double* weights = weights_.data() + cells_[cell].weights;
  assemble(cell, at, datum_pressure, weight, h);
  int others[most_points][most_points], count[most_points] = {};  // that each point is coupled with
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j)
      if (h.coupled[i * points + j]) others[i][count[i]++] = j;
  element.reset(n);
  for (int pair = 0; pair < 6; ++pair) {
    for (int i = 0; i < points; ++i) {
      for (int a = 0; a < n; a += lane_count) {
        Lanes sum = {};
        for (int k = 0; k < count[i]; ++k) {
          const int j = others[i][k];
          sum = fused(all_lanes(h.at[pair][i * points + j]), load_lanes(weights + j * n + a), sum);
        }
        store_lanes(sum, products + i * n + a);
      }
    }
    element.add(pair, points, weights, products);
  }
}

void Bile::add_hessian(const VecX& x, double datum_pressure, const LiquidWeight& weight, BlockMatrix& matrix,
                       Assembly* assembly) const {
  const std::vector<Vec3> at = positions(x);
  add_elements(cell_nodes_, matrix, assembly, [&](std::size_t cell, ElementMatrix& element) {
    cell_hessian(cell, at, datum_pressure, weight, element);
  });
}

double Bile::pressure_at(const Vec3& position, double datum_pressure) const {
  return pressure_at(position, datum_pressure, weight_);
}

double Bile::pressure_at(const Vec3& position, double datum_pressure, const LiquidWeight& weight) const {
  return datum_pressure - weight.size * weight.up.dot(position - datum_);
}

double Bile::pressure_at_top(const VecX& x, double datum_pressure) const {
  double top = -1e300;
  for (const Vec3& p : positions(x)) top = std::max(top, weight_.up.dot(p));
  return datum_pressure - weight_.size * top;
}

std::vector<std::vector<int>> Bile::cliques() const {
  std::vector<std::vector<int>> out;
  for (const FaceNodes& cell : cell_nodes_) out.push_back(cell.nodes);
  return out;
}

}  // namespace calot
