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

using Metrics = std::map<std::string, double>;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Times at which a leg of the tip's path ends, ascending: the instrument's grasps and releases, and steps.
std::vector<double> leg_ends(const Progress& progress, const std::string& instrument) {
  std::vector<double> times;
  for (const SessionEvent& event : progress.events()) {
    const bool own = event.instrument == instrument &&
                     (event.kind == EventKind::grasp || event.kind == EventKind::release);
    if (own || ends_a_step(event.kind)) times.push_back(event.time);
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

/// Idle spells, and when it first and last moved, s; before 0: never.
struct Idleness {
  double idle = 0, first_move = -1, last_move = -1;
};

void add_idleness(const std::vector<MotionSample>& motion, Idleness& sum) {
  std::size_t i = 0;
  while (i + 1 < motion.size()) {
    const auto slow = [&](std::size_t k) {
      return (motion[k + 1].tip - motion[k].tip).norm() * MotionProcessing::rate < idle_speed;
    };
    std::size_t end = i + 1;
    while (end + 1 < motion.size() && slow(end) == slow(i)) ++end;
    const double span = motion[end].time - motion[i].time;
    if (slow(i) && span >= idle_duration) {
      sum.idle += span;
    } else if (!slow(i)) {
      if (sum.first_move < 0) sum.first_move = motion[i].time;
      sum.last_move = motion[end].time;
    }
    i = end;
  }
}

/// Its motion while it was in its port, a part for each stay: what waits outside does not move.
std::vector<std::vector<MotionSample>> stays_in_port(const std::vector<double>& time,
                                                     const std::vector<InstrumentSample>& samples) {
  std::vector<std::vector<MotionSample>> out;
  std::size_t begin = 0;
  while (begin < samples.size()) {
    std::size_t end = begin + 1;
    while (end < samples.size() && samples[end].waits == samples[begin].waits) ++end;
    const auto part = [&](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(begin),
                         all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    if (!samples[begin].waits) out.push_back(processed_motion(part(time), part(samples)));
    begin = end;
  }
  return out;
}

void measure_motion(const std::vector<std::vector<MotionSample>>& stays, const std::vector<double>& ends,
                    const std::string& prefix, Metrics& metrics) {
  double path = 0, depth = 0, angle = 0, roll = 0, straight = 0;
  Idleness idleness;
  for (const std::vector<MotionSample>& motion : stays) {
    for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
      path += (motion[i + 1].tip - motion[i].tip).norm();
      depth += std::abs(motion[i + 1].insertion - motion[i].insertion);
      angle += angle_between(motion[i].axis, motion[i + 1].axis);
      roll += std::abs(motion[i + 1].roll - motion[i].roll);
    }
    straight += sum_of_straight_legs(motion, ends);
    add_idleness(motion, idleness);
  }
  metrics[prefix + "path_length_mm"] = path / units::mm;
  metrics[prefix + "depth_perception_mm"] = depth / units::mm;
  metrics[prefix + "angular_path_deg"] = angle / units::deg;
  metrics[prefix + "response_orientation_deg"] = roll / units::deg;
  if (path > smallest_path) metrics[prefix + "economy"] = straight / path;
  metrics[prefix + "idle_time_s"] = idleness.idle;
  metrics[prefix + "time_s"] = idleness.first_move < 0 ? 0.0 : idleness.last_move - idleness.first_move;
}

void measure_activation(const std::vector<double>& time, const std::vector<InstrumentSample>& samples,
                        const std::string& prefix, Metrics& metrics) {
  double active = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (samples[i].active) active += time[i] - time[i - 1];
  metrics[prefix + "activation_time_s"] = active;
}

void measure_forces(const std::vector<InstrumentSample>& samples, const std::string& prefix,
                    Metrics& metrics) {
  double peak = 0, peak_handle = 0, peak_jaws = 0, peak_shaft = 0, peak_lag = 0, peak_pads = 0, sum = 0;
  int loaded = 0;
  for (const InstrumentSample& sample : samples) {
    peak_lag = std::max(peak_lag, sample.lag);
    if (!sample.balanced) continue;
    peak = std::max(peak, sample.force);
    peak_handle = std::max(peak_handle, sample.handle_force);
    peak_jaws = std::max(peak_jaws, sample.jaws_force);
    peak_shaft = std::max(peak_shaft, sample.shaft_force);
    peak_pads = std::max(peak_pads, sample.pad_pressure);
    if (sample.force > smallest_force) {
      sum += sample.force;
      ++loaded;
    }
  }
  metrics[prefix + "peak_force_N"] = peak;
  metrics[prefix + "peak_handle_force_N"] = peak_handle;
  metrics[prefix + "peak_jaws_force_N"] = peak_jaws;
  metrics[prefix + "peak_shaft_force_N"] = peak_shaft;
  metrics[prefix + "peak_lag_mm"] = peak_lag / units::mm;
  metrics[prefix + "peak_pad_pressure_kPa"] = peak_pads / 1e3;
  metrics[prefix + "mean_force_N"] = loaded > 0 ? sum / loaded : 0.0;
}

void sum_divided(const Progress& progress, const std::string& instrument, Metrics& metrics) {
  double area = 0;
  for (const SessionEvent& event : progress.events())
    if (event.kind == EventKind::divided && event.instrument == instrument) area += event.value;
  metrics[instrument + ".divided_mm2"] = area;
}

/// Those that are counted of such an owner.
void count_events(const Progress& progress, MetricOwner owner, const std::string& instrument,
                  Metrics& metrics) {
  for (const MetricRow& row : metric_rows()) {
    if (!row.counts || row.owner != owner) continue;
    metrics[instrument + "." + row.name] = static_cast<double>(
        std::count_if(progress.events().begin(), progress.events().end(), [&](const SessionEvent& event) {
          return event.kind == row.event && event.instrument == instrument;
        }));
  }
}

void measure_laparoscope(const Traces& traces, const Progress& progress, Metrics& metrics) {
  if (traces.laparoscope.empty()) return;
  const std::string name = laparoscope_name;
  measure_motion({processed_motion(traces.time, traces.laparoscope)}, leg_ends(progress, name), name + ".",
                 metrics);
  count_events(progress, MetricOwner::laparoscope, name, metrics);
  double sum = 0;
  for (const double off : traces.off_level) sum += std::abs(off);
  metrics[name + ".horizon_off_deg"] = sum / static_cast<double>(traces.off_level.size()) / units::deg;
}

/// By what it can lose; none where it can lose nothing.
std::optional<MetricOwner> owner_by_filling(const OrganDefinition& organ) {
  if (is_hollow(organ.shape)) return MetricOwner::holds_bile;
  const auto* tube = std::get_if<TubeShape>(&organ.shape);
  if (tube == nullptr) return std::nullopt;
  return tube->carries == Carries::blood ? MetricOwner::holds_blood : MetricOwner::holds_bile;
}

void sum_lost(const SceneDefinition& scene, const std::vector<LostState>& lost, Metrics& metrics) {
  for (const OrganDefinition& organ : scene.anatomy.organs)
    if (const std::optional<MetricOwner> owner = owner_by_filling(organ))
      metrics[organ.name + (owner == MetricOwner::holds_blood ? ".blood_lost_mL" : ".bile_lost_mL")] = 0;
  for (const OrganDefinition& organ : scene.anatomy.organs)
    if (is_hollow(organ.shape)) metrics[organ.name + ".aspirated_mL"] = 0;
  double bile = 0, blood = 0, aspirated = 0;
  for (const LostState& of : lost) {
    aspirated += of.aspirated;
    if (of.aspirated > 0) metrics[of.name + ".aspirated_mL"] = of.aspirated / units::mL;
    bile += of.bile, blood += of.blood;
    if (of.bile > 0) metrics[of.name + ".bile_lost_mL"] = of.bile / units::mL;
    if (of.blood > 0) metrics[of.name + ".blood_lost_mL"] = of.blood / units::mL;
  }
  metrics["total.bile_lost_mL"] = bile / units::mL;
  metrics["total.blood_lost_mL"] = blood / units::mL;
  metrics["total.aspirated_mL"] = aspirated / units::mL;
}

void measure_raw(const SceneDefinition& scene, const Traces& traces, Metrics& metrics) {
  const std::string raw = ".raw_mm2";
  for (const OrganDefinition& organ : scene.anatomy.organs)
    if (has_capsule(organ.shape)) metrics[organ.name + raw] = 0;
  for (std::size_t i = 0; i < traces.organs.size(); ++i)
    if (!traces.organs[i].empty() && traces.organs[i].back().raw > 0)
      metrics[traces.organ_names[i] + raw] = traces.organs[i].back().raw / (units::mm * units::mm);
}

/// The owners' names of the exercise, "" for the total.
std::vector<std::string> owners(const ExerciseDefinition& exercise, MetricOwner owner) {
  std::vector<std::string> names;
  switch (owner) {
    case MetricOwner::instrument:
    case MetricOwner::moved:
      for (const InstrumentDefinition& instrument : exercise.scene.instruments)
        names.push_back(instrument.name);
      if (owner == MetricOwner::moved) names.emplace_back(laparoscope_name);
      return names;
    case MetricOwner::laparoscope:
      return {laparoscope_name};
    case MetricOwner::organ:
      for (const auto* organs : {&exercise.scene.anatomy.organs, &exercise.later_organs})
        for (const OrganDefinition& organ : *organs) names.push_back(organ.name);
      return names;
    case MetricOwner::hollow:
      for (const auto* organs : {&exercise.scene.anatomy.organs, &exercise.later_organs})
        for (const OrganDefinition& organ : *organs)
          if (is_hollow(organ.shape)) names.push_back(organ.name);
      return names;
    case MetricOwner::has_capsule:
      for (const auto* organs : {&exercise.scene.anatomy.organs, &exercise.later_organs})
        for (const OrganDefinition& organ : *organs)
          if (has_capsule(organ.shape)) names.push_back(organ.name);
      return names;
    case MetricOwner::holds_bile:
    case MetricOwner::holds_blood:
      for (const auto* organs : {&exercise.scene.anatomy.organs, &exercise.later_organs})
        for (const OrganDefinition& organ : *organs)
          if (owner_by_filling(organ) == owner) names.push_back(organ.name);
      return names;
    case MetricOwner::tissue:
      for (const auto* tissues : {&exercise.scene.anatomy.tissue, &exercise.later_tissues})
        for (const TissueDefinition& tissue : *tissues) names.push_back(tissue.name);
      return names;
    case MetricOwner::compared_organ:
      for (const OrganDefinition& organ : exercise.scene.anatomy.organs)
        if (!organ.compared_with.empty()) names.push_back(organ.name);
      return names;
    case MetricOwner::step:
      return exercise.step_names;
    case MetricOwner::hold:
      return exercise.hold_names;
    case MetricOwner::note:
      return exercise.note_names;
    case MetricOwner::total:
      break;
  }
  return {"total"};
}

}  // namespace

const std::vector<MetricRow>& metric_rows() {
  using enum MetricOwner;
  static const std::vector<MetricRow> rows = {
      {"path_length_mm", moved, "length of the tip's path, sum |dp|"},
      {"time_s", moved, "from the first movement to the last (movement: not idle)"},
      {"idle_time_s", moved, "time at less than 5 mm/s, counted where it lasts 0.5 s or more"},
      {"economy", moved,
       "sum of straight legs / path length, 0 to 1; a leg ends at each grasp, release and step"},
      {"depth_perception_mm", moved, "way in and out along the shaft, sum |dd|"},
      {"angular_path_deg", moved, "sum of the angle between u and the next u"},
      {"response_orientation_deg", moved, "turning about the shaft, sum |dpsi|"},
      {"peak_force_N", instrument,
       "largest force of the tissue on the whole of it, raw: opposite forces on jaws and shaft cancel"},
      {"mean_force_N", instrument, "mean of that force where it is above 1 mN, raw"},
      {"peak_handle_force_N", instrument, "largest force felt at its handle, raw"},
      {"peak_jaws_force_N", instrument,
       "largest force on its jaws, or on what its shaft ends in, raw: what its force_limit judges",
       EventKind::overforce},
      {"peak_shaft_force_N", instrument, "largest force on its shaft, raw"},
      {"peak_lag_mm", instrument,
       "furthest that its tip was from where it was commanded to be, as its hand gave way, raw"},
      {"peak_pad_pressure_kPa", instrument,
       "largest mean pressure of its pads on the wall they held: their pinch on its area; from 500 on for "
       "some seconds it "
       "crushes, raw"},
      {"clashes", instrument, "how often it began to press on another instrument", EventKind::clash, true},
      {"grasps", instrument, "how often it took hold", EventKind::grasp, true},
      {"empty_grasps", instrument, "how often it closed on nothing", EventKind::empty_grasp, true},
      {"releases", instrument, "how often it let go", EventKind::release, true},
      {"slips", instrument, "how often what it held slid", EventKind::slip, true},
      {"activations", instrument, "how often current began to flow in it", EventKind::activation, true},
      {"activation_time_s", instrument, "time for which current flowed", EventKind::activation},
      {"dry_activations", instrument, "how often current flowed in it and it touched nothing",
       EventKind::dry_activation, true},
      {"divided_mm2", instrument, "area of strands that its current divided", EventKind::divided},
      {"clips", instrument, "how many clips it set", EventKind::clip, true},
      {"clips_dropped", instrument, "how many clips fell from it", EventKind::clip_dropped, true},
      {"cuts", instrument, "how often it divided something", EventKind::cut, true},
      {"cuts_unclipped", instrument, "how often it divided a duct or a vessel that was not clipped",
       EventKind::cut_unclipped, true},
      {"perforations", instrument, "how often it opened a hollow organ's wall", EventKind::perforation, true},
      {"liver_cuts", instrument, "how often its blades closed on the liver", EventKind::cut_liver, true},
      {"empty_cuts", instrument, "how often its blades closed on nothing", EventKind::empty_cut, true},
      {"contacts", laparoscope, "how often its end began to touch an organ, where it was moved",
       EventKind::contact, true},
      {"horizon_off_deg", laparoscope, "mean angle of its horizon from level"},
      {"peak_pressure_Pa", organ, "largest pressure of its filling"},
      {"max_stretch", organ, "largest principal stretch of its wall", EventKind::overstretch},
      {"bile_lost_mL", holds_bile, "bile that left it by openings", EventKind::bile_leak},
      {"blood_lost_mL", holds_blood, "blood that left it by openings", EventKind::bleeding},
      {"aspirated_mL", hollow, "what needles drew out of it", EventKind::aspirated},
      {"raw_mm2", has_capsule, "surface that lost its capsule to current", EventKind::raw_surface},
      {"lowest_frequency_Hz", organ,
       "of the organ at rest, bile included: shaking below a third of it may be treated as static"},
      {"rest_shift_mm", organ, "how far its furthest point came to rest from where it is drawn"},
      {"torn_pct", tissue, "share of its strands that were torn", EventKind::tear},
      {"blunt_pct", tissue, "of those torn, the share that a pull tore, and neither current nor blades did",
       EventKind::tear},
      {"mean_difference_pct", compared_organ,
       "mean departure from the motion of the organ it is compared with, when the session ends"},
      {"largest_difference_pct", compared_organ, "the largest such departure"},
      {"time_in_s", hold, "time for which the predicate of t:hold held"},
      {"time_s", step, "how long the step lasted"},
      {"note", note, "the number that t:note gave last under this name"},
      {"time_s", total, "how long the session lasted"},
      {"bile_lost_mL", total, "bile that left all organs", EventKind::bile_leak},
      {"blood_lost_mL", total, "blood that left all organs", EventKind::bleeding},
      {"aspirated_mL", total, "what needles drew out of all organs", EventKind::aspirated},
  };
  return rows;
}

std::string metric_title(const std::string& metric) {
  static const std::pair<std::string_view, const char*> units[] = {
      {"_mm2", "mm²"}, {"_mm", "mm"},   {"_mL", "mL"}, {"_N", "N"},   {"_s", "s"},
      {"_deg", "°"},   {"_kPa", "kPa"}, {"_Pa", "Pa"}, {"_Hz", "Hz"}, {"_pct", "%"}};
  const std::size_t dot = metric.rfind('.');
  std::string name = metric.substr(dot == std::string::npos ? 0 : dot + 1), unit;
  for (const auto& [ending, word] : units)
    if (unit.empty() && name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      unit = std::string(", ") + word;
    }
  if (name == "time_in") name = "time held";
  std::replace(name.begin(), name.end(), '_', ' ');
  return (dot == std::string::npos ? "" : metric.substr(0, dot) + ": ") + name + unit;
}

std::string pattern(const MetricRow& row) {
  const auto of = [&](const char* owner) { return std::string(owner) + "." + row.name; };
  switch (row.owner) {
    case MetricOwner::instrument:
    case MetricOwner::moved:
      return of("<instrument>");
    case MetricOwner::laparoscope:
      return of(laparoscope_name);
    case MetricOwner::organ:
    case MetricOwner::hollow:
    case MetricOwner::has_capsule:
    case MetricOwner::holds_bile:
    case MetricOwner::holds_blood:
    case MetricOwner::compared_organ:
      return of("<organ>");
    case MetricOwner::tissue:
      return of("<tissue>");
    case MetricOwner::step:
      return of("<step>");
    case MetricOwner::hold:
      return of("<step>.<hold>");
    case MetricOwner::note:
      return "note.<name>";
    case MetricOwner::total:
      break;
  }
  return of("total");
}

std::vector<std::string> place_names(const AnatomyDefinition& anatomy,
                                     std::span<const OrganDefinition> later_organs,
                                     std::span<const TissueDefinition> later_tissues) {
  std::vector<std::string> names;
  for (std::span<const OrganDefinition> organs : {std::span(anatomy.organs), later_organs})
    for (const OrganDefinition& organ : organs) names.push_back(organ.name);
  for (std::span<const TissueDefinition> tissues : {std::span(anatomy.tissue), later_tissues})
    for (const TissueDefinition& tissue : tissues) names.push_back(tissue.name);
  for (const GroundDefinition& ground : anatomy.ground) names.push_back(ground.name);
  return names;
}

bool is_place(const std::string& name, const std::vector<std::string>& places) {
  return std::find(places.begin(), places.end(), name.substr(0, name.find('.'))) != places.end();
}

std::vector<std::string> metric_names(const ExerciseDefinition& exercise) {
  std::vector<std::string> names;
  for (const MetricRow& row : metric_rows())
    for (const std::string& owner : owners(exercise, row.owner))
      names.push_back(row.owner == MetricOwner::note ? "note." + owner : owner + "." + row.name);
  return names;
}

std::optional<EventKind> event_behind(const std::string& metric) {
  for (const MetricRow& row : metric_rows())
    if (row.name == metric) return row.event;
  return std::nullopt;
}

std::map<std::string, double> measure(const SceneDefinition& scene, const Traces& traces,
                                      const Progress& progress) {
  Metrics metrics = progress.metrics();
  for (std::size_t i = 0; i < traces.instruments.size(); ++i) {
    const std::string& name = scene.instruments[i].name;
    if (traces.instruments[i].empty()) continue;
    measure_motion(stays_in_port(traces.time, traces.instruments[i]), leg_ends(progress, name), name + ".",
                   metrics);
    measure_forces(traces.instruments[i], name + ".", metrics);
    measure_activation(traces.time, traces.instruments[i], name + ".", metrics);
    count_events(progress, MetricOwner::instrument, name, metrics);
    sum_divided(progress, name, metrics);
  }
  measure_laparoscope(traces, progress, metrics);
  for (std::size_t i = 0; i < traces.organs.size(); ++i) {
    if (traces.organs[i].empty()) continue;
    double pressure = traces.organs[i].front().pressure, stretch = traces.organs[i].front().max_stretch;
    for (const OrganSample& sample : traces.organs[i]) {
      if (!sample.balanced) continue;
      pressure = std::max(pressure, sample.pressure);
      stretch = std::max(stretch, sample.max_stretch);
    }
    // Of several with one name, one after the other, the largest.
    const std::string& name = traces.organ_names[i];
    for (const auto& [metric, value] :
         {std::pair{".peak_pressure_Pa", pressure}, {".max_stretch", stretch}}) {
      const auto [known, fresh] = metrics.try_emplace(name + metric, value);
      if (!fresh) known->second = std::max(known->second, value);
    }
  }
  for (const TissueState& tissue : traces.tissues) {
    metrics[tissue.name + ".torn_pct"] = 100.0 * tissue.torn / tissue.strands;
    metrics[tissue.name + ".blunt_pct"] = 100.0 * tissue.blunt / std::max(1, tissue.torn);
  }
  sum_lost(scene, traces.lost, metrics);
  measure_raw(scene, traces, metrics);
  for (const StepRecord& step : progress.steps()) {
    if (step.ended >= 0) metrics[step.name + ".time_s"] = step.ended - step.started;
  }
  if (!traces.time.empty()) metrics["total.time_s"] = traces.time.back() - traces.time.front();
  return metrics;
}

}  // namespace calot
