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
  ASSERT_EQ(json["staged"].size(), 2U) << "one load, one level, two rates";
  for (const auto& row : json["staged"]) {
    EXPECT_EQ(row["status"], "converged");
    EXPECT_EQ(row["levels"], 1);
    EXPECT_GT(row["largest_apart_pct"].get<double>(), row["mean_apart_pct"].get<double>());
    EXPECT_GT(row["step_ms_median"].get<double>(), 0);
    EXPECT_GT(row["condensed_step_ms_median"].get<double>(), 0);
  }
  const std::string plot = slurp(folder_ / "figures" / "error_against_cost.svg");
  EXPECT_EQ(plot.compare(0, 4, "<svg"), 0);
  EXPECT_NE(plot.find("</svg>"), std::string::npos);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
}

TEST_F(Bench, AnInterruptedOneKeepsWhatItMeasured) {
  const Outcome outcome = calot({"bench", "--quick", "--json", "-o", "figures"}, [&](pid_t pid) {
    while (!fs::exists(folder_ / "figures")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // into the work of seconds
    kill(pid, SIGINT);
  });
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  expect_next_command(outcome);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(json["interrupted"].get<bool>());
  for (const auto& row : json["rows"]) EXPECT_EQ(row["status"], "converged");
  // Figures of an earlier time are not replaced by none.
  const fs::path file = folder_ / "figures" / "bench.json";
  ASSERT_EQ(fs::exists(file), !json["rows"].empty());
  if (fs::exists(file)) {
    EXPECT_EQ(json, nlohmann::json::parse(slurp(file)));
  }
}

TEST_F(Bench, AFolderThatCannotBeIsAUsageErrorBeforeAnythingIsMeasured) {
  spill(folder_ / "taken", "a file\n");
  const Outcome outcome = calot({"bench", "-o", "taken"});
  EXPECT_EQ(outcome.code, 4);
  expect_next_command(outcome);
}

}  // namespace
}  // namespace calot::test
