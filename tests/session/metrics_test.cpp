#include "session/metrics.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "base/rng.h"
#include "base/units.h"
#include "session/session_for_tests.h"

namespace calot {
namespace {

using std::numbers::pi;
using units::deg;
using units::mm;

/// Traces of one instrument whose tip follows `tip` for `duration` seconds at `rate`.
Traces traced(double rate, double duration, const std::function<InstrumentSample(double)>& sample) {
  Traces traces;
  traces.instruments.resize(1);
  const int count = static_cast<int>(std::lround(rate * duration));
  for (int i = 0; i <= count; ++i) {
    traces.time.push_back(i / rate);
    traces.instruments[0].push_back(sample(i / rate));
  }
  return traces;
}

InstrumentSample at(const Vec3& tip) {
  InstrumentSample sample;
  sample.tip = tip;
  sample.axis = -Vec3::UnitZ();
  return sample;
}

double measured(const Traces& traces, const std::string& metric, const Progress& progress = {}) {
  const auto metrics = measure(test::small_scene(), traces, progress);
  const auto found = metrics.find(metric);
  return found == metrics.end() ? std::nan("") : found->second;
}

/// A reach of 50 mm in 1 s of least jerk, and its raw path in mm.
InstrumentSample noisy_reach(double t, Rng& rng) {
  const double s = t * t * t * (10 - 15 * t + 6 * t * t);
  const auto noise = [&] {  // close to normal, standard deviation 0.1 mm
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += rng.uniform();
    return 0.1 * mm * sum;
  };
  return at({50 * mm * s + noise(), noise(), noise()});
}

double raw_path_mm(const Traces& traces) {
  double path = 0;
  for (std::size_t i = 0; i + 1 < traces.instruments[0].size(); ++i) {
    path += (traces.instruments[0][i + 1].tip - traces.instruments[0][i].tip).norm();
  }
  return path / mm;
}

TEST(Metrics, PathLengthDependsNeitherOnTheRecordingRateNorOnSensorNoise) {
  for (const double rate : {30.0, 60.0, 120.0, 240.0}) {
    Rng rng(1);
    const Traces traces = traced(rate, 1, [&](double t) { return noisy_reach(t, rng); });
    // Noise of 0.1 mm on steps of about 1.7 mm (30 Hz) lengthens a path by 1 to 2%.
    EXPECT_NEAR(measured(traces, "left.path_length_mm"), 50, 1.0) << rate << " Hz";
  }
  Rng rng(1);
  const Traces fast = traced(240, 1, [&](double t) { return noisy_reach(t, rng); });
  EXPECT_GT(raw_path_mm(fast), 70) << "the trap that resampling is for is not there";
}

TEST(Metrics, ProcessingKeepsStraightMotionExactlyUpToItsEnds) {
  const Traces traces = traced(50, 2, [](double t) { return at({0.03 * t, -0.01 * t, 0.1}); });
  for (const MotionSample& sample : processed_motion(traces.time, traces.instruments[0])) {
    EXPECT_NEAR((sample.tip - Vec3(0.03 * sample.time, -0.01 * sample.time, 0.1)).norm(), 0,
                1e-15);  // rounding
  }
}

TEST(Metrics, ProcessingHalvesThePowerOfAnOscillationAtItsCutOff) {
  const double omega = 2 * pi * MotionProcessing::cut_off;
  const Traces traces = traced(500, 4, [&](double t) { return at({std::sin(omega * t), 0, 0}); });
  double projected = 0, norm = 0;
  for (const MotionSample& sample : processed_motion(traces.time, traces.instruments[0])) {
    if (sample.time < 0.5 || sample.time > 3.5) continue;  // away from the one-sided ends
    projected += sample.tip.x() * std::sin(omega * sample.time);
    norm += std::sin(omega * sample.time) * std::sin(omega * sample.time);
  }
  // Cut at four widths, the Gaussian loses 6.3e-5 of its weight: the response moves by that times 1 +
  // sqrt(1/2).
  EXPECT_NEAR(projected / norm, std::sqrt(0.5), 1.1e-4);
}

TEST(Metrics, ASlowCircleHasItsCircumferenceAndNoEconomy) {
  const double radius = 20 * mm;
  const Traces traces = traced(50, 10, [&](double t) {
    return at({radius * std::cos(2 * pi * t / 10), radius * std::sin(2 * pi * t / 10), 0});
  });
  // The smoother shortens a radius by (sigma omega)^2 / 2 = 1e-4; chords of 1.2 degrees add 2e-5.
  EXPECT_NEAR(measured(traces, "left.path_length_mm"), 2 * pi * 20, 2 * pi * 20 * 3e-4);
  EXPECT_NEAR(measured(traces, "left.economy"), 0, 1e-3);
}

TEST(Metrics, EconomyIsOneForStraightLegsBetweenGraspAndRelease) {
  // 40 mm out in 2 s, 1 s still, 40 mm back: the turn is where the tissue is grasped.
  const auto out_and_back = [](double t) {
    const double x = t < 2 ? t / 2 : t < 3 ? 1.0 : std::max(0.0, 1 - (t - 3) / 2);
    return at({40 * mm * x, 0, 0});
  };
  const Traces traces = traced(50, 5, out_and_back);
  EXPECT_NEAR(measured(traces, "left.economy"), 0, 1e-6);
  Progress progress;
  WorldEvent grasp;
  grasp.kind = EventKind::grasp;
  grasp.instrument = "left";
  grasp.time = 2.5;
  progress.add_event(grasp);
  EXPECT_NEAR(measured(traces, "left.economy", progress), 1, 1e-6);
  WorldEvent other = grasp;
  other.instrument = "right";
  Progress others;
  others.add_event(other);
  EXPECT_NEAR(measured(traces, "left.economy", others), 0, 1e-6)
      << "another hand's grasp ends no leg of this one";
}

TEST(Metrics, AnInstrumentThatNeverMovedHasNoEconomyAndIsIdleThroughout) {
  const Traces traces = traced(50, 3, [](double) { return at({0, 0, 0.1}); });
  EXPECT_TRUE(std::isnan(measured(traces, "left.economy")));
  EXPECT_NEAR(measured(traces, "left.idle_time_s"), 3, 1e-9);
  EXPECT_EQ(measured(traces, "left.time_s"), 0);
}

TEST(Metrics, IdleTimeCountsStandingStillOfHalfASecondAndMore) {
  // Moves 0 to 1 s, still to 3 s, moves to 4 s, still for 0.3 s, moves to 5 s, still to 6 s; 30 mm/s when
  // moving.
  const auto path = [](double t) {
    const double moved = std::min(t, 1.0) + std::clamp(t - 3, 0.0, 1.0) + std::clamp(t - 4.3, 0.0, 0.7);
    return at({30 * mm * moved, 0, 0});
  };
  const Traces traces = traced(50, 6, path);
  // Two spells, 2 s and 1 s; each of their three edges is blurred by at most two grid points of 1/30 s.
  EXPECT_NEAR(measured(traces, "left.idle_time_s"), 3, 3 * 2 / 30.0);
  EXPECT_NEAR(measured(traces, "left.time_s"), 5, 2 / 30.0);
}

TEST(Metrics, DepthAngleAndRollAreSumsOfChangesBackAndForth) {
  // Slow triangles: insertion 10 mm in and out, the axis 30 degrees over and back, roll 90 degrees and back.
  const auto path = [](double t) {
    const double s = t < 5 ? t / 5 : 2 - t / 5;
    InstrumentSample sample = at(Vec3::Zero());
    sample.insertion = 0.1 + 10 * mm * s;
    sample.axis = {std::sin(30 * deg * s), 0, -std::cos(30 * deg * s)};
    sample.roll = 90 * deg * s;
    return sample;
  };
  const Traces traces = traced(50, 10, path);
  // Smoothing rounds the turn: 2 sigma / sqrt(2 pi) x speed is lost, 0.4% of the whole.
  EXPECT_NEAR(measured(traces, "left.depth_perception_mm"), 20, 0.1);
  EXPECT_NEAR(measured(traces, "left.angular_path_deg"), 60, 0.3);
  EXPECT_NEAR(measured(traces, "left.response_orientation_deg"), 180, 0.9);
}

TEST(Metrics, ForcesArePeaksAndTheMeanOfWhatWasLoaded) {
  const Traces traces = traced(50, 4, [](double t) {
    InstrumentSample sample = at(Vec3::Zero());
    sample.force = t < 1.99 ? 0 : t < 2.99 ? 2 : 4;
    sample.handle_force = 0.5 * sample.force;
    sample.jaws_force = 3 * sample.force;
    sample.shaft_force = 2 * sample.force;
    return sample;
  });
  EXPECT_EQ(measured(traces, "left.peak_force_N"), 4);
  EXPECT_EQ(measured(traces, "left.peak_handle_force_N"), 2);
  EXPECT_EQ(measured(traces, "left.peak_jaws_force_N"), 12);
  EXPECT_EQ(measured(traces, "left.peak_shaft_force_N"), 8);
  EXPECT_NEAR(measured(traces, "left.mean_force_N"), 3, 2.0 / 101);  // 50 samples at 2 N, 51 at 4 N
}

TEST(Metrics, OrgansReportTheirPeaks) {
  Traces traces = traced(50, 0.04, [](double) { return at(Vec3::Zero()); });
  traces.organ_names = {"ball"};
  traces.organs = {{{1000, 1.1}, {1800, 1.3}, {1200, 1.2}}};
  EXPECT_EQ(measured(traces, "ball.peak_pressure_Pa"), 1800);
  EXPECT_EQ(measured(traces, "ball.max_stretch"), 1.3);
}

TEST(Metrics, WhatIsRawIsThatOfTheEndAndZeroOfAnUntouchedLiver) {
  Traces traces = traced(50, 0.04, [](double) { return at(Vec3::Zero()); });
  EXPECT_TRUE(std::isnan(measured(traces, "ball.raw_mm2"))) << "it has no capsule";
  SceneDefinition scene = test::small_scene();
  scene.anatomy.organs[0].shape = LobeShape{};
  EXPECT_EQ(measure(scene, traces, {}).at("ball.raw_mm2"), 0);
  traces.organ_names = {"ball"};
  traces.organs = {{{0, 1, true, 0}, {0, 1, true, 2 * mm * mm}, {0, 1, false, 12.5 * mm * mm}}};
  EXPECT_NEAR(measure(scene, traces, {}).at("ball.raw_mm2"), 12.5, 1e-9);
  EXPECT_EQ(event_behind("raw_mm2"), EventKind::raw_surface);
  EXPECT_EQ(metric_title("liver.raw_mm2"), "liver: raw, mm²");
}

TEST(Metrics, EveryMeasuredNameIsAnnouncedAndOnlyTheUnmeasurableIsMissing) {
  Traces traces = traced(50, 1, [](double t) { return at({0.05 * t, 0, 0}); });
  traces.organ_names = {"ball"};
  traces.organs.assign(1, std::vector<OrganSample>(traces.time.size()));
  traces.laparoscope = traces.instruments[0];
  traces.off_level.assign(traces.time.size(), 0.1);
  Progress progress;
  progress.begin_step(0, "grasp", "", {0});
  progress.begin_step(0.5, "hold", "", {0});
  progress.set_metric("hold.band.time_in_s", 0.3);      // by the script
  progress.set_metric("ball.lowest_frequency_Hz", 12);  // by the runner, as the next
  progress.set_metric("ball.rest_shift_mm", 0.2);
  progress.end_step(1, "done");
  const auto metrics = measure(test::small_scene(), traces, progress);
  ExerciseDefinition exercise = test::small_exercise();
  exercise.step_names = {"grasp", "hold"};
  exercise.hold_names = {"hold.band"};
  std::vector<std::string> names = metric_names(exercise);
  std::vector<std::string> found;
  for (const auto& [name, value] : metrics) found.push_back(name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(found, names);
  EXPECT_EQ(metrics.at("grasp.time_s"), 0.5);
  EXPECT_EQ(metrics.at("total.time_s"), 1);
  EXPECT_EQ(metrics.at("laparoscope.path_length_mm"), metrics.at("left.path_length_mm"));
  EXPECT_NEAR(metrics.at("laparoscope.horizon_off_deg"), 0.1 / units::deg, 1e-12);
}

}  // namespace
}  // namespace calot
