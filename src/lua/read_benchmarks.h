#pragma once

#include <filesystem>

#include "session/benchmarks.h"

namespace calot {

/// A file of the form
///   return {
///     name = "Residents, Graz", version = 2, exercise = "grasp-and-traction",
///     calibration = "medians of 14 residents and 6 surgeons, 2025", pass = 75, cap = 40,
///     parts = { { part = "hold.band.time_in_s", novice = 4, expert = 10 }, { part = "overforce", each = 0.25 } },
///   }
/// in which calibration, pass, cap and parts may be left out. `modules` as for a scenario. Fails with all that is wrong,
/// at the author's lines (scenario), or where it cannot be read (usage).
Result<BenchmarkTable> read_benchmarks(const std::filesystem::path& path,
                                       const std::filesystem::path& modules);

}  // namespace calot
