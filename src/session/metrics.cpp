#include "session/metrics.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace calot {
namespace {

constexpr double idle_speed = 5e-3;      // m/s (c)
constexpr double idle_duration = 0.5;    // s (c)
constexpr double smallest_force = 1e-3;  // N; below it an instrument counts as unloaded
constexpr double smallest_path = 1e-6;   // m; a shorter path is rounding, and has no economy

const char* const instrument_metrics[] = {"path_length_mm",
                                          "time_s",
                                          "idle_time_s",
                                          "economy",
                                          "depth_perception_mm",
                                          "angular_path_deg",
                                          "response_orientation_deg",
                                          "peak_force_N",
                                          "mean_force_N",
                                          "peak_handle_force_N",
                                          "grasps",
                                          "releases",
                                          "slips"};
const char* const organ_metrics[] = {"peak_pressure_Pa", "max_stretch", "lowest_frequency_Hz"};

const char* const difference_metrics[] = {"mean_difference_pct", "largest_difference_pct"};

using Metrics = std::map<std::string, double>;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Times at which a leg of the tip's path ends, ascending: the instrument's grasps and releases, and steps.
std::vector<double> leg_ends(const Progress& progress, const std::string& instrument) {
  std::vector<double> times;
  for (const SessionEvent& event : progress.events()) {
    const bool own = event.instrument == instrument && (event.kind == "grasp" || event.kind == "release");
    if (own || event.kind == "step_done" || event.kind == "step_timeout") times.push_back(event.time);
  }
  std::sort(times.begin(), times.end());
  return times;
}

double sum_of_straight_legs(const std::vector<MotionSample>& motion, const std::vector<double>& ends) {
  double sum = 0;
  std::size_t next = 0;
  Vec3 from = motion.front().tip;
  for (const MotionSample& sample : motion) {
    if (next >= ends.size() || sample.time < ends[next]) continue;
    while (next < ends.size() && sample.time >= ends[next]) ++next;
    sum += (sample.tip - from).norm();
    from = sample.tip;
  }
  return sum + (motion.back().tip - from).norm();
}

/// Idle spells and the span between the first and the last movement.
void measure_idleness(const std::vector<MotionSample>& motion, const std::string& prefix, Metrics& metrics) {
  double idle = 0, first_move = -1, last_move = -1;
  std::size_t i = 0;
  while (i + 1 < motion.size()) {
    const auto slow = [&](std::size_t k) {
      return (motion[k + 1].tip - motion[k].tip).norm() * MotionProcessing::rate < idle_speed;
    };
    std::size_t end = i + 1;
    while (end + 1 < motion.size() && slow(end) == slow(i)) ++end;
    const double span = motion[end].time - motion[i].time;
    if (slow(i) && span >= idle_duration) {
      idle += span;
    } else if (!slow(i)) {
      if (first_move < 0) first_move = motion[i].time;
      last_move = motion[end].time;
    }
    i = end;
  }
  metrics[prefix + "idle_time_s"] = idle;
  metrics[prefix + "time_s"] = first_move < 0 ? 0.0 : last_move - first_move;
}

void measure_motion(const std::vector<MotionSample>& motion, const std::vector<double>& ends,
                    const std::string& prefix, Metrics& metrics) {
  double path = 0, depth = 0, angle = 0, roll = 0;
  for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
    path += (motion[i + 1].tip - motion[i].tip).norm();
    depth += std::abs(motion[i + 1].insertion - motion[i].insertion);
    angle += angle_between(motion[i].axis, motion[i + 1].axis);
    roll += std::abs(motion[i + 1].roll - motion[i].roll);
  }
  metrics[prefix + "path_length_mm"] = path / units::mm;
  metrics[prefix + "depth_perception_mm"] = depth / units::mm;
  metrics[prefix + "angular_path_deg"] = angle / units::deg;
  metrics[prefix + "response_orientation_deg"] = roll / units::deg;
  if (path > smallest_path) metrics[prefix + "economy"] = sum_of_straight_legs(motion, ends) / path;
  measure_idleness(motion, prefix, metrics);
}

void measure_forces(const std::vector<InstrumentSample>& samples, const std::string& prefix,
                    Metrics& metrics) {
  double peak = 0, peak_handle = 0, sum = 0;
  int loaded = 0;
  for (const InstrumentSample& sample : samples) {
    peak = std::max(peak, sample.tip_force);
    peak_handle = std::max(peak_handle, sample.handle_force);
    if (sample.tip_force > smallest_force) {
      sum += sample.tip_force;
      ++loaded;
    }
  }
  metrics[prefix + "peak_force_N"] = peak;
  metrics[prefix + "peak_handle_force_N"] = peak_handle;
  metrics[prefix + "mean_force_N"] = loaded > 0 ? sum / loaded : 0.0;
}

void count_grips(const Progress& progress, const std::string& instrument, Metrics& metrics) {
  double grasps = 0, releases = 0, slips = 0;
  for (const SessionEvent& event : progress.events()) {
    if (event.instrument != instrument) continue;
    if (event.kind == "grasp") ++grasps;
    if (event.kind == "release") ++releases;
    if (event.kind == "slip") ++slips;
  }
  metrics[instrument + ".grasps"] = grasps;
  metrics[instrument + ".releases"] = releases;
  metrics[instrument + ".slips"] = slips;
}

}  // namespace

std::vector<std::string> metric_names(const SceneDefinition& scene, const std::vector<std::string>& steps,
                                      const std::vector<std::string>& holds) {
  std::vector<std::string> names;
  for (const InstrumentDefinition& instrument : scene.instruments) {
    for (const char* metric : instrument_metrics) names.push_back(instrument.name + "." + metric);
  }
  for (const OrganDefinition& organ : scene.anatomy.organs) {
    for (const char* metric : organ_metrics) names.push_back(organ.name + "." + metric);
    if (organ.compared_with.empty()) continue;
    for (const char* metric : difference_metrics) names.push_back(organ.name + "." + metric);
  }
  for (const std::string& hold : holds) names.push_back(hold + ".time_in_s");
  for (const std::string& step : steps) names.push_back(step + ".time_s");
  names.push_back("total.time_s");
  return names;
}

std::map<std::string, double> measure(const SceneDefinition& scene, const Traces& traces,
                                      const Progress& progress) {
  Metrics metrics = progress.metrics();
  for (std::size_t i = 0; i < traces.instruments.size(); ++i) {
    const std::string& name = scene.instruments[i].name;
    const std::vector<MotionSample> motion = processed_motion(traces.time, traces.instruments[i]);
    if (motion.empty()) continue;
    measure_motion(motion, leg_ends(progress, name), name + ".", metrics);
    measure_forces(traces.instruments[i], name + ".", metrics);
    count_grips(progress, name, metrics);
  }
  for (std::size_t i = 0; i < traces.organs.size(); ++i) {
    if (traces.organs[i].empty()) continue;
    double pressure = traces.organs[i].front().pressure, stretch = traces.organs[i].front().max_stretch;
    for (const OrganSample& sample : traces.organs[i]) {
      pressure = std::max(pressure, sample.pressure);
      stretch = std::max(stretch, sample.max_stretch);
    }
    metrics[scene.anatomy.organs[i].name + ".peak_pressure_Pa"] = pressure;
    metrics[scene.anatomy.organs[i].name + ".max_stretch"] = stretch;
  }
  for (const StepRecord& step : progress.steps()) {
    if (step.ended >= 0) metrics[step.name + ".time_s"] = step.ended - step.started;
  }
  if (!traces.time.empty()) metrics["total.time_s"] = traces.time.back() - traces.time.front();
  return metrics;
}

}  // namespace calot
