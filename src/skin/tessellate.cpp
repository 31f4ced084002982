#include "skin/tessellate.h"

#include <algorithm>
#include <map>
#include <utility>

namespace calot {

namespace {

/// Numbers the points of a split: those shared between triangles are numbered once.
class Splitter {
 public:
  Splitter(int nodes, int parts) : parts_(parts), placed_(nodes, false) { result_.at.resize(nodes); }

  /// Grid point (i, j) lies at (u, v) = (i, j) / parts.
  void add(int face, const Triangle& corner) {
    std::vector<int> grid(static_cast<std::size_t>(parts_ + 1) * (parts_ + 1), -1);
    for (int j = 0; j <= parts_; ++j)
      for (int i = 0; i + j <= parts_; ++i) grid[index(i, j)] = point(face, corner, i, j);
    for (int j = 0; j < parts_; ++j) {
      for (int i = 0; i + j < parts_; ++i) {
        result_.triangles.push_back({grid[index(i, j)], grid[index(i + 1, j)], grid[index(i, j + 1)]});
        if (i + j + 1 < parts_) {
          result_.triangles.push_back(
              {grid[index(i + 1, j)], grid[index(i + 1, j + 1)], grid[index(i, j + 1)]});
        }
      }
    }
  }

  Tessellation take() { return std::move(result_); }

 private:
  int index(int i, int j) const { return j * (parts_ + 1) + i; }

  int point(int face, const Triangle& corner, int i, int j) {
    const int k = parts_ - i - j;
    const FacePoint at{face, static_cast<double>(i) / parts_, static_cast<double>(j) / parts_};
    if (k == parts_) return node(corner[0], at);
    if (i == parts_) return node(corner[1], at);
    if (j == parts_) return node(corner[2], at);
    if (j == 0) return on_edge(corner[0], corner[1], i, at);
    if (k == 0) return on_edge(corner[1], corner[2], j, at);
    if (i == 0) return on_edge(corner[2], corner[0], k, at);
    return append(at);
  }

  int node(int n, const FacePoint& at) {
    if (!placed_[n]) result_.at[n] = at;
    placed_[n] = true;
    return n;
  }

  /// The point `step` parts from a towards b.
  int on_edge(int a, int b, int step, const FacePoint& at) {
    if (a > b) {
      std::swap(a, b);
      step = parts_ - step;
    }
    std::vector<int>& points = edges_[{a, b}];
    if (points.empty()) points.assign(parts_ + 1, -1);
    if (points[step] < 0) points[step] = append(at);
    return points[step];
  }

  int append(const FacePoint& at) {
    result_.at.push_back(at);
    return static_cast<int>(result_.at.size()) - 1;
  }

  int parts_;
  std::vector<bool> placed_;
  std::map<std::pair<int, int>, std::vector<int>> edges_;
  Tessellation result_;
};

}  // namespace

Tessellation split_faces(int nodes, const std::vector<Triangle>& triangles, int parts) {
  Splitter splitter(nodes, parts);
  for (std::size_t f = 0; f < triangles.size(); ++f) splitter.add(static_cast<int>(f), triangles[f]);
  return splitter.take();
}

}  // namespace calot
