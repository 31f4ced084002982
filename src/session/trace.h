#pragma once
// Raw traces of a session, one sample a step, and the one place where motion is resampled and smoothed.
//
// Path lengths and smoothness depend on sampling rate and noise (a 50 mm reach with 0.1 mm noise an axis
// measures 51 mm at 30 Hz and 77 mm at 240 Hz), so raw traces are kept, resampled and low-passed once at a
// fixed, versioned rate, and scored afterwards.

#include <string>
#include <vector>

#include "world/world.h"

namespace calot {

struct InstrumentSample {
  Vec3 tip = Vec3::Zero();                 ///< m
  Vec3 axis = Vec3::Zero();                ///< unit, along the shaft from trocar to tip
  double insertion = 0;                    ///< m
  double roll = 0;                         ///< rad, not wrapped
  double force = 0;                        ///< N, magnitude of the whole: opposite forces on its parts cancel
  double handle_force = 0;                 ///< N, magnitude
  double jaws_force = 0, shaft_force = 0;  ///< N, magnitudes; what the jaws hold pulls on them
  bool active = false;                     ///< current flowed in the step that ended here
  bool waits = false;                      ///< outside, while another one was in its port
  double lag = 0;                          ///< m, of the tip behind its command: its hand gave way
  double pad_pressure = 0;                 ///< Pa, of its pads on the wall they hold
  bool balanced = true;                    ///< the step that ended here was; else its forces tell nothing
};

struct OrganSample {
  double pressure = 0;  ///< Pa
  double max_stretch = 1;
  bool balanced = true;  ///< as an instrument's
  double raw = 0;        ///< m^2
};

struct Traces {
  std::vector<double> time;                                ///< s, one a sample
  std::vector<std::vector<InstrumentSample>> instruments;  ///< [instrument][sample]
  std::vector<InstrumentSample> laparoscope;               ///< one a sample: its motion alone
  std::vector<double> off_level;                           ///< rad, of its horizon, one a sample
  /// [organ][sample], in the order in which organs came; of one that came later or went, those of its time.
  std::vector<std::vector<OrganSample>> organs;
  std::vector<std::string> organ_names;
  std::vector<TissueState> tissues;  ///< as they were last, by their names
  std::vector<LostState> lost;       ///< in all, by the scene's organs
};

/// Appends the world's present report.
void append_sample(const World& world, Traces& traces);

/// Version 1: motion on a grid of 30 Hz from the first sample to the last; each point is a local straight
/// line fitted to the raw samples with Gaussian weights whose response is down by 3 dB at 6 Hz. Forces,
/// pressures and stretches are not smoothed: peaks are taken from raw samples.
struct MotionProcessing {
  static constexpr int version = 1;
  static constexpr double rate = 30;      ///< Hz
  static constexpr double cut_off = 6.0;  ///< Hz
};

struct MotionSample {
  double time = 0;                               ///< s
  Vec3 tip = Vec3::Zero(), axis = Vec3::Zero();  ///< m; unit
  double insertion = 0, roll = 0;                ///< m, rad
};

std::vector<MotionSample> processed_motion(const std::vector<double>& time,
                                           const std::vector<InstrumentSample>& samples);

}  // namespace calot
