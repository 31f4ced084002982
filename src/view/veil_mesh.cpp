#include "view/veil_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/field.h"
#include "view/strand_lines.h"

namespace calot {
namespace {

constexpr int rows = 8;                  // from skin to skin
constexpr double outside = 1.8e-3;       // m, of the strands' middles: the fat along them lies within
constexpr std::size_t strands_each = 4;  // strands to a stretch of the sheet, of which it takes the outermost

/// A parabola through the strand's three places.
Vec3 bowed(const StrandLine& line, double share) {
  const double a = (1 - share) * (1 - 2 * share), b = 4 * share * (1 - share), c = share * (2 * share - 1);
  return a * line.from + b * line.by + c * line.to;
}

/// Of the strands at rest: the way along which the sheet runs, and that out of it.
struct SheetFrame {
  Vec3 middle, along, out;
};

SheetFrame frame_of(const std::vector<StrandLine>& strands) {
  SheetFrame frame{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
  Vec3 way = Vec3::Zero();
  for (const StrandLine& s : strands) frame.middle += s.by, way += s.to - s.from;
  frame.middle /= static_cast<double>(strands.size());
  way = way.norm() > 0 ? way.normalized() : Vec3::UnitZ();
  Mat3 spread = Mat3::Zero();
  for (const StrandLine& s : strands) {
    const Vec3 d = s.by - frame.middle, across = d - way * way.dot(d);
    spread += across * across.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
  frame.along = axes.eigenvectors().col(2);
  frame.out = way.cross(frame.along).normalized();
  return frame;
}

/// Of each stretch along the sheet the outermost strand on one side; -1 where there is none.
std::vector<int> outermost(const std::vector<StrandLine>& strands, const SheetFrame& frame, double side) {
  std::vector<double> along, out;
  for (const StrandLine& s : strands) {
    along.push_back(frame.along.dot(s.by - frame.middle));
    out.push_back(side * frame.out.dot(s.by - frame.middle));
  }
  const auto [low, high] = std::minmax_element(along.begin(), along.end());
  const int stretches = std::max(2, static_cast<int>(strands.size() / strands_each));
  std::vector<int> found(stretches, -1);
  for (std::size_t k = 0; k < strands.size(); ++k) {
    const double share = (along[k] - *low) / std::max(*high - *low, 1e-9);
    int& best = found[std::min(static_cast<int>(share * stretches), stretches - 1)];
    if (best < 0 || out[k] > out[best]) best = static_cast<int>(k);
  }
  return found;
}

/// Between two neighbours of a leaf, from `here` to `next`; outward of them by `side` of here-to-next x from-to-to.
void add_ribbon(const StrandLine& here, const StrandLine& next, const StrandLine& here_rest,
                const StrandLine& next_rest, double side, SceneMesh& out) {
  const int first = static_cast<int>(out.positions.size());
  for (int i = 0; i <= rows; ++i) {
    const double share = static_cast<double>(i) / rows;
    const Vec3 a = bowed(here, share), b = bowed(next, share);
    Vec3 normal = side * (b - a).cross(here.to - here.from + next.to - next.from);
    normal = normal.norm() > 0 ? normal.normalized() : Vec3::UnitZ();
    const Vec3 lift = outside * std::sin(std::numbers::pi * share) * normal;
    for (const Vec3& p : {a, b}) {
      out.positions.emplace_back(p + lift);
      out.normals.push_back(normal);
    }
    out.rest_positions.push_back(bowed(here_rest, share));
    out.rest_positions.push_back(bowed(next_rest, share));
  }
  for (int i = 0; i < rows; ++i) {
    const int a = first + 2 * i;
    out.triangles.push_back({a, a + 1, a + 3});
    out.triangles.push_back({a, a + 3, a + 2});
  }
}

/// Neighbouring ribbons share places and normals where they meet, so that they do not show as such.
void add_leaf(const std::vector<int>& chain, const std::vector<StrandLine>& now,
              const std::vector<StrandLine>& rest, const std::vector<bool>& torn, double side,
              SceneMesh& out) {
  constexpr int each = 2 * (rows + 1);
  int before = -1;  // the first point of the ribbon before
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    const int a = chain[k], b = chain[k + 1];
    if (a < 0 || b < 0 || torn[a] || torn[b]) {
      before = -1;
      continue;
    }
    const int first = static_cast<int>(out.positions.size());
    add_ribbon(now[a], now[b], rest[a], rest[b], side, out);
    for (int i = 0; before >= 0 && i < each; i += 2) {
      const int one = before + i + 1, other = first + i;
      const Vec3 normal = (out.normals[one] + out.normals[other]).normalized();
      const Vec3 place = 0.5 * (out.positions[one] + out.positions[other]);
      out.normals[one] = out.normals[other] = normal;
      out.positions[one] = out.positions[other] = place;
    }
    before = first;
  }
}

}  // namespace

SceneMesh veil_mesh(const World& world) {
  SceneMesh out;
  out.material = Material::veil;
  const Field& field = world.field();
  if (field.tissues.empty()) return out;
  std::vector<std::vector<Vec3>> skins, rest_skins;
  for (const Organ& organ : field.organs) {
    skins.push_back(organ.body->skin_positions(organ.state.x));
    rest_skins.push_back(organ.body->skin_rest());
  }
  for (const Tissue& tissue : field.tissues) {
    const std::vector<StrandLine> now = strand_lines(tissue, tissue.now.state.x, skins);
    if (now.size() < 2 * strands_each) continue;  // no sheet
    const std::vector<StrandLine> rest = strand_lines(tissue, tissue.body->rest(), rest_skins);
    const SheetFrame frame = frame_of(rest);
    std::vector<bool> torn;
    for (std::size_t k = 0; k < now.size(); ++k)
      torn.push_back(tissue.strands->strands()[k].strand.law.torn(tissue.now.opened[k]));
    for (double side : {1.0, -1.0}) add_leaf(outermost(rest, frame, side), now, rest, torn, side, out);
  }
  return out;
}

}  // namespace calot
