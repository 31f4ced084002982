// `calot bench` as a user and a script meet it. Times are its business, not this test's.

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace calot::test {
namespace {

class Bench : public ProgramTest {};

TEST_F(Bench, TheQuickOneWritesRowsWithEveryFigureAndAPlot) {
  const Outcome outcome = calot({"bench", "--quick", "--json", "-o", "figures"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "calot.bench/1");
  EXPECT_EQ(json, nlohmann::json::parse(slurp(folder_ / "figures" / "bench.json")));
  EXPECT_FALSE(json["machine"]["processor"].get<std::string>().empty());
  EXPECT_GE(json["targets"].size(), 7U);
  std::map<std::string, int> formulations, solvers;
  for (const auto& row : json["rows"]) {
    for (const char* key : {"formulation",
                            "nodes",
                            "extensions",
                            "levels",
                            "solver",
                            "load",
                            "rate_hz",
                            "status",
                            "steps",
                            "step_ms_median",
                            "newton_iterations",
                            "factor_solve_ratio",
                            "flops",
                            "memory_bytes",
                            "mean_error_pct",
                            "contact_error_pct",
                            "max_error_pct",
                            "condition_estimate",
                            "uniform_nodes",
                            "speedup"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_EQ(row["status"], "converged");
    EXPECT_GT(row["step_ms_median"].get<double>(), 0);
    EXPECT_GT(row["condition_estimate"].get<double>(), 1);
    ++formulations[row["formulation"]];
    ++solvers[row["solver"]];
  }
  EXPECT_EQ(formulations.size(), 3U);
  EXPECT_EQ(solvers.size(), 3U);
  const std::string plot = slurp(folder_ / "figures" / "error_against_cost.svg");
  EXPECT_EQ(plot.compare(0, 4, "<svg"), 0);
  EXPECT_NE(plot.find("</svg>"), std::string::npos);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
}

TEST_F(Bench, AFolderThatCannotBeIsAUsageErrorBeforeAnythingIsMeasured) {
  spill(folder_ / "taken", "a file\n");
  const Outcome outcome = calot({"bench", "-o", "taken"});
  EXPECT_EQ(outcome.code, 4);
  expect_next_command(outcome);
}

}  // namespace
}  // namespace calot::test
