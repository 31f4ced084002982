#pragma once
// The core and every file are in SI (m, N, Pa, s, m^3, kg, rad); these are multipliers to write figures with.

namespace calot::units {

inline constexpr double m = 1.0, cm = 1e-2, mm = 1e-3, um = 1e-6;
inline constexpr double mL = 1e-6, L = 1e-3;
inline constexpr double N = 1.0, mN = 1e-3;
inline constexpr double Pa = 1.0, kPa = 1e3, MPa = 1e6;
inline constexpr double mmHg = 133.322387415;  // conventional millimetre of mercury, BIPM SI brochure 8th ed.
inline constexpr double s = 1.0, ms = 1e-3;
inline constexpr double kg = 1.0, g = 1e-3;
inline constexpr double rad = 1.0, deg = 3.14159265358979323846 / 180.0;
inline constexpr double standard_gravity = 9.80665;  // m/s^2

}  // namespace calot::units
