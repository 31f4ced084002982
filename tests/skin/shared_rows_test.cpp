#include "skin/shared_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "skin/meshes.h"

namespace calot::test {
namespace {

/// Details of both levels about a random node.
std::vector<int> details_about(const SurfaceLevels& levels, Rng& rng) {
  std::vector<int> out;
  for (int level : {1, 2}) {
    const int first = levels.nodes(level - 1), count = levels.nodes(level) - first;
    for (int k = 0; k < 4; ++k) out.push_back(first + static_cast<int>(rng.uniform(0, count)));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

DetailedSurface surface_with(const SurfaceLevels& levels, const std::vector<int>& details) {
  return {DetailBasis(levels, details), FaceTree(levels, details)};
}

TEST(SharedRows, AreThoseEvaluatedAfreshToTheBit) {
  Rng rng(5);
  int taken = 0, fresh = 0;
  for (const auto& [name, mesh] : closed_meshes()) {
    const SurfaceLevels levels = SurfaceLevels::create(mesh, 2).value();
    DetailedSurface before = surface_with(levels, {});
    std::vector<FacePoint> points;
    for (int face = 0; face < static_cast<int>(levels.faces(0).size()); ++face)
      for (int k = 0; k < 3; ++k) points.push_back({face, 0.1 + 0.2 * k, rng.uniform(0, 0.4)});
    StencilTable table = before.basis.evaluate(points, 2);
    for (int round = 0; round < 6; ++round) {
      // Some stay, some go, some come; in the end all have gone.
      std::vector<int> details = details_about(levels, rng);
      for (std::size_t i = 0; i < before.basis.details().size(); i += 2)
        details.push_back(before.basis.details()[i]);
      std::sort(details.begin(), details.end());
      details.erase(std::unique(details.begin(), details.end()), details.end());
      if (round == 5) details.clear();
      DetailedSurface now = surface_with(levels, details);
      const SharedRows shared(before, now);
      std::vector<int> known(points.size(), -1);
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (shared.same(points[k].face)) known[k] = static_cast<int>(k);
        ++(known[k] < 0 ? fresh : taken);
      }
      const StencilTable rows = shared.rows(points, 2, table, known), all = now.basis.evaluate(points, 2);
      EXPECT_EQ(rows.begin, all.begin) << name;
      EXPECT_EQ(rows.node, all.node) << name;
      EXPECT_EQ(rows.value, all.value) << name;
      EXPECT_EQ(rows.du, all.du) << name;
      EXPECT_EQ(rows.dvv, all.dvv) << name;
      table = rows;
      before = surface_with(levels, details);
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(fresh, 100);
}

}  // namespace
}  // namespace calot::test
