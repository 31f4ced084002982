#include "skin/levels.h"

#include <algorithm>
#include <map>
#include <utility>

namespace calot {
namespace {

/// A child's parameters in its parent's: origin + scale * (u, v). The middle child is turned by half a turn, so
/// the scale is a number, of either sign.
struct ChildPlace {
  double u, v, scale;
};
constexpr ChildPlace child_places[4] = {{0, 0, 0.5}, {0.5, 0, 0.5}, {0, 0.5, 0.5}, {0.5, 0.5, -0.5}};

/// A point of a level-0 face on the level's face that holds it; `scale` is the level's edge as a share of the
/// coarse one, negative in faces that stand upside down.
struct LevelPoint {
  FacePoint at;
  double scale = 1;
};

LevelPoint on_level(int level, const FacePoint& coarse) {
  LevelPoint out{coarse, 1};
  for (int k = 0; k < level; ++k) {
    const double u = out.at.u, v = out.at.v;
    const int child = u >= 0.5 ? 1 : v >= 0.5 ? 2 : u + v <= 0.5 ? 0 : 3;
    const ChildPlace& place = child_places[child];
    out.at = {4 * out.at.face + child, (u - place.u) / place.scale, (v - place.v) / place.scale};
    out.scale *= place.scale;
  }
  return out;
}

}  // namespace

void SurfaceLevels::number_edges(Mesh& mesh) {
  std::map<std::pair<int, int>, int> numbers;
  mesh.edge_nodes.resize(mesh.faces.size());
  mesh.faces_of_node.resize(mesh.nodes);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& corners = mesh.faces[f];
    for (int node : corners) mesh.faces_of_node[node].push_back(static_cast<int>(f));
    for (int edge : {0, 2, 1}) {  // the order of split_faces, which numbers the bile's points alike
      const std::pair<int, int> ends = std::minmax(corners[edge], corners[(edge + 1) % 3]);
      const int next = mesh.nodes + static_cast<int>(numbers.size());
      const auto [found, fresh] = numbers.try_emplace(ends, next);
      mesh.edge_nodes[f][edge] = found->second;
      if (fresh)
        mesh.edge_faces.push_back({static_cast<int>(f), -1});
      else
        mesh.edge_faces[found->second - mesh.nodes][1] = static_cast<int>(f);
    }
  }
}

SurfaceLevels::Mesh SurfaceLevels::split(const Mesh& mesh) {
  Mesh out;
  out.nodes = mesh.nodes + static_cast<int>(mesh.edge_faces.size());
  out.faces.reserve(4 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    const auto [ab, bc, ca] = mesh.edge_nodes[f];
    out.faces.insert(out.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}});
  }
  return out;
}

void SurfaceLevels::place_nodes() {
  places_.resize(meshes_.back().nodes);
  std::vector<bool> placed(places_.size(), false);
  constexpr double corner_u[3] = {0, 1, 0}, corner_v[3] = {0, 0, 1};
  for (std::size_t level = 0; level < meshes_.size(); ++level) {
    for (std::size_t f = 0; f < meshes_[level].faces.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int node = meshes_[level].faces[f][k];
        if (placed[node]) continue;
        placed[node] = true;
        places_[node] = on_coarse(static_cast<int>(level), {static_cast<int>(f), corner_u[k], corner_v[k]});
      }
    }
  }
}

Result<SurfaceLevels> SurfaceLevels::create(const TriMesh& control, int levels) {
  SurfaceLevels out;
  Mesh mesh;
  mesh.nodes = static_cast<int>(control.points.size());
  mesh.faces = control.triangles;
  for (int level = 0;; ++level) {
    number_edges(mesh);
    Mesh next = split(mesh);
    if (level <= levels) {
      TriMesh connected;
      connected.points.resize(mesh.nodes);
      connected.triangles = mesh.faces;
      Result<LoopSurface> surface = LoopSurface::create(connected);
      if (!surface) return surface.failure();
      out.surfaces_.push_back(std::move(surface).value());
    }
    out.meshes_.push_back(std::move(mesh));
    if (level > levels) break;
    mesh = std::move(next);
  }
  out.place_nodes();
  return out;
}

int SurfaceLevels::level_of(int node) const {
  int level = 0;
  while (node >= meshes_[level].nodes) ++level;
  return level;
}

std::vector<int> SurfaceLevels::support(int level, int node) const {
  const Mesh& mesh = meshes_[level];
  std::vector<int> out;
  for (int near : mesh.faces_of_node[node])
    for (int corner : mesh.faces[near])
      for (int face : mesh.faces_of_node[corner]) out.push_back(face >> (2 * level));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

FacePoint SurfaceLevels::on_coarse(int level, const FacePoint& at) const {
  FacePoint out = at;
  for (int k = 0; k < level; ++k) {
    const ChildPlace& place = child_places[out.face % 4];
    out = {out.face / 4, place.u + place.scale * out.u, place.v + place.scale * out.v};
  }
  return out;
}

StencilTable SurfaceLevels::evaluate(int level, std::span<const FacePoint> points, int order) const {
  std::vector<FacePoint> at;
  std::vector<double> scales;
  for (const FacePoint& point : points) {
    const LevelPoint here = on_level(level, point);
    at.push_back(here.at);
    scales.push_back(here.scale);
  }
  StencilTable table = surfaces_[level].evaluate(at, order);
  for (int r = 0; r < table.rows(); ++r) {
    const double once = 1.0 / scales[r], twice = once * once;
    for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) {
      if (order >= 1) table.du[e] *= once, table.dv[e] *= once;
      if (order >= 2) table.duu[e] *= twice, table.duv[e] *= twice, table.dvv[e] *= twice;
    }
  }
  return table;
}

}  // namespace calot
