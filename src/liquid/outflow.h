#pragma once
// How fast a liquid leaves by an opening: Torricelli, and Hagen and Poiseuille on the way to it.

namespace calot {

/// What feeds a tube: the patient, where it is whole.
struct TubeFeed {
  double pressure = 0;    ///< Pa, gauge
  double resistance = 0;  ///< Pa s/m^3
};
/// Of Torricelli's flow through a sharp edge.
inline constexpr double discharge = 0.6;

/// m^3/s, through an opening of `area` (m^2) that the patient feeds at that pressure.
double fed_flow(const TubeFeed& feed, double pressure, double area, double density);
/// m^3 that leave an elastic organ in `time` s: `pressure` (Pa) at the beginning, `compliance` in m^3/Pa; 0: the pressure
/// stays. Exact without a resistance (Pa s/m^3) on the way; with one of the second order in the time.
double elastic_outflow(double pressure, double compliance, double area, double density, double time,
                       double resistance = 0);

}  // namespace calot
