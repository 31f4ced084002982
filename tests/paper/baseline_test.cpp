// The paper's section 6: 61 nodes and three extensions of four nodes against uniform structures of 238 and 946
// nodes, one place pulled out by 10 mm or pushed in by 8 mm.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "paper/paper_comparison.h"

namespace calot {
namespace {

void print(const std::vector<PaperRow>& rows) {
  for (const PaperRow& r : rows)
    fmt::print(
        "{}, {} nodes ({} extensions, level {}), {} unknowns: error {:.2f}% mean, {:.2f}% near the contact, "
        "{:.1f}% at most of {:.2f} mm; {} iterations, {:.1e} flops a factor, {:.1e} in all, {:.2f} MB, "
        "condition {:.0f}, {:.2f} s\n",
        r.formulation, r.nodes, r.extensions, r.levels, r.unknowns, r.mean_error_pct, r.contact_error_pct,
        r.max_error_pct, 1e3 * r.largest_m, r.newton_iterations, r.factor_flops, r.flops,
        1e-6 * r.memory_bytes, r.condition_estimate, r.solve_s);
}

class PaperBaseline : public testing::TestWithParam<double> {
 protected:
  std::vector<PaperRow> compared() {
    PaperCase given;
    given.outward = GetParam();
    const Result<std::vector<PaperRow>> rows = compare_paper(given);
    EXPECT_TRUE(rows) << to_text(rows.failure());
    if (!rows) return {};
    print(rows.value());
    return rows.value();
  }
};

INSTANTIATE_TEST_SUITE_P(PulledAndPushed, PaperBaseline, testing::Values(10e-3, -8e-3));

TEST_P(PaperBaseline, ErrorAndGainAreOfThePapersOrder) {
  const std::vector<PaperRow> rows = compared();
  ASSERT_EQ(rows.size(), 5U);
  const PaperRow &coarse = rows[0], &uniform = rows[1], &finest = rows[2], &one = rows[3], &staged = rows[4];
  EXPECT_EQ(coarse.nodes, 61);
  EXPECT_EQ(uniform.nodes, 238);
  EXPECT_EQ(finest.nodes, 946);
  // The place went nearly as far as the springs' ends.
  EXPECT_GT(finest.largest_m, 0.9 * std::abs(GetParam()));
  EXPECT_EQ(finest.max_error_pct, 0);
  EXPECT_LT(uniform.mean_error_pct, 0.5 * coarse.mean_error_pct);  // first order at least
  for (const PaperRow& row : {one, staged}) {
    EXPECT_EQ(row.nodes, 61 + 3 * 4);
    EXPECT_EQ(row.unknowns, 183 + 36);
    // The paper: "of the order of 10% of the maximum displacement".
    EXPECT_GT(row.mean_error_pct, 2);
    EXPECT_LT(row.mean_error_pct, 20);
    EXPECT_GT(row.mean_error_pct, uniform.mean_error_pct);
    // What extensions are for, though it is little.
    EXPECT_LT(row.contact_error_pct, coarse.contact_error_pct);
    EXPECT_LT(row.memory_bytes, 0.2 * uniform.memory_bytes);
  }
  EXPECT_LT(one.contact_error_pct, staged.contact_error_pct);
  // The paper's own count is a cube of the unknowns of each stage: a gain of nearly two orders of magnitude,
  // of 40 with the work in between.
  EXPECT_DOUBLE_EQ(staged.factor_flops, (std::pow(183, 3) + std::pow(36, 3)) / 3);
  EXPECT_DOUBLE_EQ(uniform.factor_flops, std::pow(714, 3) / 3);
  for (const auto& [whole, small] :
       {std::pair(uniform.factor_flops, staged.factor_flops), std::pair(uniform.flops, staged.flops)}) {
    EXPECT_GT(whole / small, 10);
    EXPECT_LT(whole / small, 1000);
  }
}

TEST(PaperComparison, SubdividedExtensionsAddUnknownsToTheSecondStageOnly) {
  PaperCase given;
  given.refinements = 1;
  given.levels = {0, 1};
  const std::vector<PaperRow> rows = compare_paper(given).value();
  ASSERT_EQ(rows.size(), 6U);
  print(rows);
  EXPECT_EQ(rows[3].unknowns, 183 + 36);
  EXPECT_EQ(rows[5].unknowns, 183 + 3 * 3 * 16);
  EXPECT_EQ(rows[5].levels, 1);
  EXPECT_DOUBLE_EQ(rows[5].factor_flops, (std::pow(183, 3) + std::pow(144, 3)) / 3);
  EXPECT_LT(rows[5].contact_error_pct, rows[0].contact_error_pct);
}

TEST(PaperComparison, IsTheSameEachTime) {
  PaperCase given;
  given.refinements = 1;
  const std::vector<PaperRow> a = compare_paper(given).value(), b = compare_paper(given).value();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].mean_error_pct, b[k].mean_error_pct);
    EXPECT_EQ(a[k].flops, b[k].flops);
  }
}

TEST(PaperComparison, CasesWithoutSenseAreRefused) {
  for (int k = 0; k < 4; ++k) {
    PaperCase given;
    if (k == 0) given.radius = 0;
    if (k == 1) given.contact = Vec3::Zero();
    if (k == 2) given.extensions = 119;
    if (k == 3) given.levels = {-1};
    const Result<std::vector<PaperRow>> rows = compare_paper(given);
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.failure().kind, FailureKind::usage);
  }
}

}  // namespace
}  // namespace calot
