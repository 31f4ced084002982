#include "skin/detail_basis.h"

#include <algorithm>
#include <utility>

namespace calot {

DetailBasis::DetailBasis(const SurfaceLevels& levels, std::vector<int> details)
    : levels_(&levels), details_(std::move(details)), details_on_(levels.faces(0).size()) {
  for (std::size_t i = 0; i < details_.size(); ++i) {
    const int level = levels.level_of(details_[i]);
    if (active_.empty() || active_.back().level != level) {
      active_.push_back(
          {level, std::vector<int>(levels.nodes(level), -1), std::vector<char>(levels.faces(0).size(), 0)});
    }
    active_.back().column[details_[i]] = coarse_nodes() + static_cast<int>(i);
    for (int face : levels.support(level, details_[i])) {
      active_.back().touched[face] = 1;
      details_on_[face].push_back(details_[i]);
    }
  }
}

StencilTable DetailBasis::evaluate(std::span<const FacePoint> points, int order) const {
  StencilTable coarse = levels_->evaluate(0, points, order);
  return active_.empty() ? coarse : extend(coarse, points, order);
}

namespace {

/// Adds entry e of `from` to the last row of `to`, as `column`.
void add_entry(const StencilTable& from, int e, int column, StencilTable& to) {
  to.node.push_back(column);
  to.value.push_back(from.value[e]);
  if (!from.du.empty()) to.du.push_back(from.du[e]), to.dv.push_back(from.dv[e]);
  if (!from.duu.empty()) {
    to.duu.push_back(from.duu[e]);
    to.duv.push_back(from.duv[e]);
    to.dvv.push_back(from.dvv[e]);
  }
  ++to.begin.back();
}

}  // namespace

StencilTable DetailBasis::extend(const StencilTable& coarse, std::span<const FacePoint> points,
                                 int order) const {
  std::vector<StencilTable> fine;
  for (const Level& level : active_) {
    // Points that no function reaches get a row without entries.
    std::vector<FacePoint> at;
    for (const FacePoint& point : points)
      if (level.touched[point.face]) at.push_back(point);
    const StencilTable rows = levels_->evaluate(level.level, at, order);
    StencilTable all;
    int row = 0;
    for (const FacePoint& point : points) {
      if (level.touched[point.face])
        append_rows(rows, row, row + 1, all), ++row;
      else
        all.begin.push_back(all.begin.back());
    }
    fine.push_back(std::move(all));
  }
  std::vector<const StencilTable*> tables;
  for (const StencilTable& table : fine) tables.push_back(&table);
  return merge(coarse, points, tables);
}

StencilTable DetailBasis::extend(const StencilTable& coarse, std::span<const FacePoint> points,
                                 const std::vector<StencilTable>& by_level) const {
  std::vector<const StencilTable*> tables;
  for (const Level& level : active_) tables.push_back(&by_level[level.level - 1]);
  return merge(coarse, points, tables);
}

StencilTable DetailBasis::merge(const StencilTable& coarse, std::span<const FacePoint> points,
                                const std::vector<const StencilTable*>& fine) const {
  StencilTable out;
  reserve_as(coarse, 0.5, out);
  int copied = 0;  // rows; those that no detail reaches are copied many at a time
  for (int r = 0; r < coarse.rows(); ++r) {
    if (!reaches(points[r].face)) continue;
    append_rows(coarse, copied, r + 1, out);
    copied = r + 1;
    for (std::size_t k = 0; k < active_.size(); ++k)
      for (int e = fine[k]->begin[r]; e < fine[k]->begin[r + 1]; ++e)
        if (const int column = active_[k].column[fine[k]->node[e]]; column >= 0)
          add_entry(*fine[k], e, column, out);
  }
  append_rows(coarse, copied, coarse.rows(), out);
  return out;
}

namespace {

/// Split faces of each level, children of split faces only.
using Splits = std::vector<std::vector<char>>;

/// Splits what children of split faces and neighbours by one split at most ask for.
void balance(const SurfaceLevels& levels, Splits& split) {
  for (int level = static_cast<int>(split.size()) - 1; level > 0; --level) {
    for (std::size_t f = 0; f < split[level].size(); ++f) {
      if (!split[level][f]) continue;
      split[level - 1][f / 4] = 1;
      for (int edge = 0; edge < 3; ++edge)
        for (int near : levels.faces_at_edge(level, levels.edge_node(level, static_cast<int>(f), edge)))
          if (near >= 0) split[level - 1][near / 4] = 1;
    }
  }
}

Splits balanced_splits(const SurfaceLevels& levels, std::span<const int> details) {
  Splits split;
  int deepest = 0;
  for (int detail : details) deepest = std::max(deepest, levels.level_of(detail));
  for (int k = 0; k < deepest; ++k) split.emplace_back(levels.faces(k).size(), 0);
  for (int detail : details) {
    const int level = levels.level_of(detail) - 1;
    for (int face : levels.faces_at_edge(level, detail))
      if (face >= 0) split[level][face] = 1;
  }
  balance(levels, split);
  return split;
}

/// Only faces that have a child that is split stay so.
void merge(Splits& split) {
  for (std::size_t level = 0; level < split.size(); ++level) {
    for (std::size_t f = 0; f < split[level].size(); ++f) {
      if (level + 1 == split.size()) split[level][f] = 0;
      if (!split[level][f]) continue;
      const auto first = split[level + 1].begin() + static_cast<std::ptrdiff_t>(4 * f);
      split[level][f] = std::any_of(first, first + 4, [](char child) { return child != 0; });
    }
  }
}

bool is_split(const Splits& split, int level, int face) {
  return level < static_cast<int>(split.size()) && split[level][face];
}

FaceTree::Leaf leaf_of(const SurfaceLevels& levels, const Splits& split, int level, int face) {
  FaceTree::Leaf leaf{level, face, {}};
  if (level < static_cast<int>(split.size()))
    for (int edge = 0; edge < 3; ++edge)
      for (int near : levels.faces_at_edge(level, levels.edge_node(level, face, edge)))
        if (near >= 0 && split[level][near]) leaf.hanging[edge] = true;
  return leaf;
}

/// Those of a face that is split: first of its children that are not, then within the others.
void add_leaves(const SurfaceLevels& levels, const Splits& split, int level, int face,
                std::vector<FaceTree::Leaf>& out) {
  for (int child = 4 * face; child < 4 * face + 4; ++child)
    if (!is_split(split, level + 1, child)) out.push_back(leaf_of(levels, split, level + 1, child));
  for (int child = 4 * face; child < 4 * face + 4; ++child)
    if (is_split(split, level + 1, child)) add_leaves(levels, split, level + 1, child, out);
}

}  // namespace

FaceTree::FaceTree(const SurfaceLevels& levels, std::span<const int> details, bool merged) {
  Splits split = balanced_splits(levels, details);
  if (merged) {
    merge(split);
    balance(levels, split);
  }
  for (int face = 0; face < static_cast<int>(levels.faces(0).size()); ++face) {
    first.push_back(static_cast<int>(leaves.size()));
    if (is_split(split, 0, face))
      add_leaves(levels, split, 0, face, leaves);
    else
      leaves.push_back(leaf_of(levels, split, 0, face));
  }
  first.push_back(static_cast<int>(leaves.size()));
}

namespace {

/// A face with the nodes that hang on its edges, as few triangles as they allow.
void add_triangles(const SurfaceLevels& levels, int level, int face, std::array<bool, 3> hanging,
                   std::vector<Triangle>& out) {
  const Triangle& corner = levels.faces(level)[face];
  const int count = hanging[0] + hanging[1] + hanging[2];
  if (count == 0) {
    out.push_back(corner);
    return;
  }
  int middle[3];
  for (int edge = 0; edge < 3; ++edge) middle[edge] = levels.edge_node(level, face, edge);
  if (count == 3) {
    for (int k = 0; k < 3; ++k) out.push_back({corner[k], middle[k], middle[(k + 2) % 3]});
    out.push_back({middle[0], middle[1], middle[2]});
    return;
  }
  int k = 0;  // count 1: the edge with the node; 2: the first of the two edges that have one, as they follow
  while (!hanging[k] || (count == 2 && !hanging[(k + 1) % 3])) ++k;
  const int a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
  if (count == 1) {
    out.insert(out.end(), {{a, middle[k], c}, {middle[k], b, c}});
  } else {
    const int ab = middle[k], bc = middle[(k + 1) % 3];
    out.insert(out.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
  }
}

}  // namespace

std::vector<Triangle> cover(const SurfaceLevels& levels, const FaceTree::Leaf& leaf, bool fine) {
  std::vector<Triangle> out;
  if (!fine) {
    add_triangles(levels, leaf.level, leaf.face, leaf.hanging, out);
    return out;
  }
  const auto [ab, bc, ca] = leaf.hanging;
  const int child = 4 * leaf.face, below = leaf.level + 1;
  const Triangle& middle = levels.faces(below)[child + 3];  // bc, ca, ab
  add_triangles(levels, below, child, {ab, false, ca}, out);
  out.push_back({middle[2], middle[0], middle[1]});
  add_triangles(levels, below, child + 1, {ab, bc, false}, out);
  add_triangles(levels, below, child + 2, {false, bc, ca}, out);
  return out;
}

}  // namespace calot
