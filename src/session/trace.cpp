#include "session/trace.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace calot {
namespace {

constexpr int channels = 8;  // tip, axis, insertion, roll
using Channels = Eigen::Matrix<double, channels, 1>;

Channels to_channels(const InstrumentSample& sample) {
  Channels c;
  c << sample.tip, sample.axis, sample.insertion, sample.roll;
  return c;
}

/// Value at `t` of the straight line fitted by weighted least squares to samples [first, last).
Channels local_line(const std::vector<double>& time, const std::vector<InstrumentSample>& samples,
                    std::size_t first, std::size_t last, double t, double sigma) {
  double s0 = 0, s1 = 0, s2 = 0;
  Channels y0 = Channels::Zero(), y1 = Channels::Zero();
  for (std::size_t i = first; i < last; ++i) {
    const double u = (time[i] - t) / sigma;
    const double w = std::exp(-0.5 * u * u);
    const Channels c = to_channels(samples[i]);
    s0 += w;
    s1 += w * u;
    s2 += w * u * u;
    y0 += w * c;
    y1 += w * u * c;
  }
  const double determinant = s0 * s2 - s1 * s1;
  if (determinant <= 1e-12 * s0 * s0) return y0 / s0;  // one sample in reach
  return (s2 * y0 - s1 * y1) / determinant;
}

void append_laparoscope(const World& world, Traces& traces) {
  const LaparoscopeState& state = world.report().laparoscope;
  InstrumentSample& lens = traces.laparoscope.emplace_back();
  lens.tip = state.view.position;
  lens.axis = (lens.tip - world.laparoscope().port()).normalized();
  lens.insertion = state.pose.insertion;
  lens.roll = state.pose.roll;
  traces.off_level.push_back(horizon_off_level(state.view));
}

}  // namespace

void append_sample(const World& world, Traces& traces) {
  const StepReport& report = world.report();
  const SceneDefinition& scene = world.scene();
  traces.instruments.resize(report.instruments.size());
  traces.time.push_back(report.time);
  for (std::size_t i = 0; i < report.instruments.size(); ++i) {
    const InstrumentState& state = report.instruments[i];
    InstrumentSample sample;
    sample.tip = state.tip;
    sample.axis = (state.tip - world.port_position(scene.instruments[i].port)).normalized();
    sample.insertion = state.pose.insertion;
    sample.roll = state.pose.roll;
    sample.force = state.force.norm();
    sample.handle_force = state.handle_force.norm();
    sample.jaws_force = state.load_on(ToolPart::jaws).force.norm();
    sample.shaft_force = state.load_on(ToolPart::shaft).force.norm();
    sample.active = state.action == InstrumentAction::activate;
    sample.waits = state.waits;
    sample.lag = state.lag;
    sample.pad_pressure = state.pad_pressure;
    sample.balanced = report.balanced;
    traces.instruments[i].push_back(sample);
  }
  append_laparoscope(world, traces);
  for (const OrganState& organ : report.organs) {
    const auto row = static_cast<std::size_t>(organ.record);
    if (row >= traces.organs.size()) {
      traces.organs.resize(row + 1);
      traces.organ_names.resize(row + 1);
    }
    traces.organ_names[row] = organ.name;
    traces.organs[row].push_back({organ.pressure, organ.max_stretch, report.balanced, organ.raw});
  }
  traces.lost = report.lost;
  for (const TissueState& tissue : report.tissues) {
    const auto same = [&](const TissueState& known) { return known.name == tissue.name; };
    const auto at = std::find_if(traces.tissues.begin(), traces.tissues.end(), same);
    if (at == traces.tissues.end())
      traces.tissues.push_back(tissue);
    else
      *at = tissue;
  }
}

std::vector<MotionSample> processed_motion(const std::vector<double>& time,
                                           const std::vector<InstrumentSample>& samples) {
  std::vector<MotionSample> result;
  if (samples.empty()) return result;
  const double start = time.front(), duration = time.back() - start;
  // A Gaussian of width sigma has the response exp(-2 (pi sigma f)^2), which is -3 dB at f = sqrt(ln 2)/(2 pi
  // sigma).
  double sigma = std::sqrt(std::log(2.0)) / (2 * std::numbers::pi * MotionProcessing::cut_off);
  // A trace slower than the smoother needs a neighbour in reach of every grid point.
  if (samples.size() > 1) sigma = std::max(sigma, duration / static_cast<double>(samples.size() - 1) / 2);
  const int count = static_cast<int>(std::floor(duration * MotionProcessing::rate + 1e-9)) + 1;
  for (int k = 0; k < count; ++k) {
    const double t = start + k / MotionProcessing::rate;
    const auto first = std::lower_bound(time.begin(), time.end(), t - 4 * sigma) - time.begin();
    const auto last = std::upper_bound(time.begin(), time.end(), t + 4 * sigma) - time.begin();
    const Channels c =
        local_line(time, samples, static_cast<std::size_t>(first), static_cast<std::size_t>(last), t, sigma);
    result.push_back({t, c.segment<3>(0), c.segment<3>(3).normalized(), c[6], c[7]});
  }
  return result;
}

}  // namespace calot
