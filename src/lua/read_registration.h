#pragma once

#include <filesystem>

#include "input/registration.h"

namespace calot {

/// A file of the form
///   local calot = require "calot"
///   local mm, s, deg = calot.units.mm, calot.units.s, calot.units.deg
///   return {
///     version = 1, exercise = "grasp-and-traction", format = "jigsaws",   -- or "csv", "sequence"
///     unit = 1, angle_unit = 1, time_unit = 1,     -- theirs in m, rad, s: unit = mm, angle_unit = deg
///     time_step = 1 / 30 * s,                      -- jigsaws: between rows
///     x_axis = { 1, 0, 0 }, y_axis = { 0, 1, 0 }, z_axis = { 0, 0, 1 },   -- theirs, in the patient's frame
///     longest_gap = 0.25 * s,
///     columns = { time = "t", tip_x = "x" },       -- csv: what they are called there (input/foreign_motion.h)
///     instruments = {
///       { name = "left", source = "slave_left", port = { 0.1, 0, 0.05 }, jaw_closed = -0.3, jaw_open = 1 },
///     },
///   }
/// in which all but version, exercise, format, and the instruments' name and source may be left out. Fails as
/// read_benchmarks.
Result<Registration> read_registration(const std::filesystem::path& path,
                                       const std::filesystem::path& modules);

}  // namespace calot
