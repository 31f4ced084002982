// The paper's section 6: 61 nodes and three extensions against uniform structures of 238 and 946 nodes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/paper_comparison.h"

namespace calot {
namespace {

void print(const std::vector<PaperRow>& rows) {
  for (const PaperRow& r : rows)
    fmt::print(
        "{:22} {:4} nodes {} ext level {} unknowns {:4} iter {:3} factor {:.2e} flops {:.2e} mem {:.1e} mean "
        "{:5.2f}% "
        "contact {:5.2f}% max {:6.2f}% cond {:.1e} {:.2f} s largest {:.2f} mm\n",
        r.formulation, r.nodes, r.extensions, r.levels, r.unknowns, r.newton_iterations, r.factor_flops,
        r.flops, r.memory_bytes, r.mean_error_pct, r.contact_error_pct, r.max_error_pct, r.condition_estimate,
        r.solve_s, 1e3 * r.largest_m);
}

TEST(PaperBaseline, Pull) {
  PaperCase given;
  given.levels = {0, 1};
  for (double outward : {10e-3, -8e-3}) {
    given.outward = outward;
    const Result<std::vector<PaperRow>> rows = compare_paper(given);
    ASSERT_TRUE(rows) << to_text(rows.failure());
    print(rows.value());
  }
}

}  // namespace
}  // namespace calot
