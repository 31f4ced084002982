#include "fem/element_layout.h"

#include <gtest/gtest.h>

#include "support/derivatives.h"

namespace calot {
namespace {

/// Rows 0, 1 belong to face 0 and row 2 to face 1.
StencilTable small_table() {
  StencilTable table;
  table.begin = {0, 3, 5, 7};
  table.node = {1, 4, 6, 2, 4, 0, 6};
  table.value = {0.2, 0.3, 0.5, 0.6, 0.4, 0.9, 0.1};
  return table;
}

TEST(ElementLayout, FacesGatherTheNodesOfTheirRows) {
  const std::vector<FaceNodes> faces = gather_faces(small_table(), {0, 0, 1}, 2);
  EXPECT_EQ(faces[0].nodes, (std::vector<int>{1, 2, 4, 6}));
  EXPECT_EQ(faces[1].nodes, (std::vector<int>{0, 6}));
  EXPECT_EQ(faces[0].padded, 4);
  EXPECT_EQ(faces[1].padded, 4);
}

TEST(ElementLayout, DenseWeightsStandAtTheirNodesAndZeroElsewhere) {
  const StencilTable table = small_table();
  const std::vector<FaceNodes> faces = gather_faces(table, {0, 0, 1}, 2);
  std::vector<double> weights(4, 7.0);
  dense_weights(table, table.value, 1, faces[0], weights.data());
  EXPECT_EQ(weights, (std::vector<double>{0, 0.6, 0.4, 0}));
  dense_weights(table, table.value, 2, faces[1], weights.data());
  EXPECT_EQ(weights, (std::vector<double>{0.9, 0.1, 0, 0}));
}

TEST(ElementLayout, ElementMatrixIsTheCongruenceOfItsRows) {
  const FaceNodes face{{0, 2, 3, 5, 6, 8, 9, 11, 12}, 12};  // tiles of one lane and of two
  Rng rng(1);
  constexpr int rows = 2;
  std::vector<double> weights(rows * face.padded, 0.0);
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3 * rows, 39);
  for (int k = 0; k < rows; ++k)
    for (std::size_t a = 0; a < face.nodes.size(); ++a) {
      const double value = rng.uniform(-1, 1);
      weights[k * face.padded + static_cast<int>(a)] = value;
      for (int c = 0; c < 3; ++c) w(3 * k + c, 3 * face.nodes[a] + c) = value;
    }
  Eigen::Matrix<double, 6, 6> h;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) h(i, j) = h(j, i) = rng.uniform(-1, 1);

  BlockMatrix matrix(13, std::vector<std::vector<int>>{face.nodes});
  // Twice: the matrix adds up.
  ElementMatrix element;
  element.reset(face.padded);
  for (int pair : {0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5}) {
    const auto [c, d] = component_pairs[pair];
    std::vector<double> products(rows * face.padded, 0.0);
    for (int k = 0; k < rows; ++k)
      for (int l = 0; l < rows; ++l)
        for (int a = 0; a < face.padded; ++a)
          products[k * face.padded + a] += h(3 * k + c, 3 * l + d) * weights[l * face.padded + a];
    element.add(pair, rows, weights.data(), products.data());
  }
  element.scatter(face, matrix);
  EXPECT_LT(test::relative_error(test::dense(matrix), 2.0 * w.transpose() * h * w), 1e-14);
}

}  // namespace
}  // namespace calot
