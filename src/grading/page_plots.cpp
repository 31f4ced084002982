#include "grading/page_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "base/units.h"
#include "session/metrics.h"

namespace calot {
namespace {

using PerSample = std::function<double(const InstrumentSample&)>;

constexpr const char* time_label = "time, s";

/// Those of the instruments that are not far above `most`, N, the largest force of the curves.
void add_limits(const SceneDefinition& scene, double most, PagePlot& plot) {
  std::map<double, std::string> names;
  for (const InstrumentDefinition& instrument : scene.instruments) {
    std::string& all = names[instrument.force_limit];
    all += (all.empty() ? "" : ", ") + instrument.name;
  }
  for (const auto& [limit, who] : names)
    if (limit < 3 * most) plot.levels.push_back({"force limit of " + who, limit});
}

/// A plot's quantity, and the metric of it that a score may judge.
struct ForceKind {
  const char* title;
  const char* metric;
  PerSample force;
};

/// What the score expects of an expert and of a novice, where they are told apart by this metric.
void add_benchmarks(const ExerciseDefinition& exercise, const char* metric, PagePlot& plot) {
  for (const ScorePart& part : exercise.score.parts) {
    if (part.kind != ScorePartKind::benchmark || !part.metric.ends_with(std::string(".") + metric)) continue;
    plot.levels.push_back({"full marks for " + metric_title(part.metric), part.expert});
    plot.levels.push_back({"no marks for " + metric_title(part.metric), part.novice});
  }
}

void add_bands(const Progress& progress, double end, PagePlot& plot) {
  for (const StepRecord& step : progress.steps())
    if (step.band)
      plot.bands.push_back({fmt::format("asked for in {}, on {}", step.name, step.band->instrument),
                            step.band->least, step.band->most, step.started,
                            step.ended < 0 ? end : step.ended});
}

/// The largest force, N; where it is never above zero there is no plot.
double add_force(const ForceKind& kind, const ExerciseDefinition& exercise, const Traces& traces,
                 std::vector<PagePlot>& plots) {
  const SceneDefinition& scene = exercise.scene;
  PagePlot plot;
  plot.title = kind.title;
  plot.x_label = time_label;
  plot.y_label = "force, N";
  double most = 0;
  for (std::size_t i = 0; i < traces.instruments.size(); ++i) {
    PageCurve& curve = plot.curves.emplace_back();
    curve.name = scene.instruments[i].name;
    for (std::size_t k = 0; k < traces.time.size(); ++k) {
      curve.points.push_back({traces.time[k], kind.force(traces.instruments[i][k])});
      most = std::max(most, curve.points.back()[1]);
    }
  }
  if (!(most > 0)) return most;
  add_benchmarks(exercise, kind.metric, plot);
  plots.push_back(std::move(plot));
  return most;
}

void add_way(const char* title, const char* across, const char* up, int x, int y,
             const SceneDefinition& scene, const Traces& traces, std::vector<PagePlot>& plots) {
  PagePlot plot;
  plot.title = title;
  plot.x_label = across;
  plot.y_label = up;
  plot.is_path = true;
  for (std::size_t i = 0; i < traces.instruments.size(); ++i) {
    PageCurve& curve = plot.curves.emplace_back();
    curve.name = scene.instruments[i].name;
    for (const InstrumentSample& sample : traces.instruments[i])
      curve.points.push_back({sample.tip[x] / units::mm, sample.tip[y] / units::mm});
  }
  if (!plot.curves.empty()) plots.push_back(std::move(plot));
}

/// Of organs that were there all the time: of others only the values are kept, not their times.
void add_organs(const char* title, const char* label, const Traces& traces,
                const std::function<double(const OrganSample&)>& value, std::vector<PagePlot>& plots) {
  PagePlot plot;
  plot.title = title;
  plot.x_label = time_label;
  plot.y_label = label;
  for (std::size_t i = 0; i < traces.organs.size(); ++i) {
    if (traces.organs[i].size() != traces.time.size()) continue;
    PageCurve curve;
    curve.name = traces.organ_names[i];
    bool moves = false;
    for (std::size_t k = 0; k < traces.time.size(); ++k) {
      curve.points.push_back({traces.time[k], value(traces.organs[i][k])});
      moves = moves || curve.points.back()[1] != curve.points.front()[1];
    }
    if (moves) plot.curves.push_back(std::move(curve));
  }
  if (!plot.curves.empty()) plots.push_back(std::move(plot));
}

}  // namespace

std::vector<PagePlot> page_plots(const ExerciseDefinition& exercise, const Progress& progress,
                                 const Traces& traces) {
  const SceneDefinition& scene = exercise.scene;
  std::vector<PagePlot> plots;
  const ForceKind jaws{"Force on the jaws", "peak_jaws_force_N",
                       [](const InstrumentSample& s) { return s.jaws_force; }};
  if (const double most = add_force(jaws, exercise, traces, plots); most > 0) {
    PagePlot& plot = plots.back();
    add_bands(progress, traces.time.back(), plot);
    add_limits(scene, most, plot);
  }
  const ForceKind others[] = {
      {"Force on the shaft", "peak_shaft_force_N", [](const InstrumentSample& s) { return s.shaft_force; }},
      {"Force on the whole instrument", "peak_force_N", [](const InstrumentSample& s) { return s.force; }},
      {"Force felt at the handle", "peak_handle_force_N",
       [](const InstrumentSample& s) { return s.handle_force; }}};
  for (const ForceKind& kind : others) add_force(kind, exercise, traces, plots);
  add_way("Way of the tip, from the front", "to the patient's left, mm", "towards the head, mm", 0, 1, scene,
          traces, plots);
  add_way("Way of the tip, from the feet", "to the patient's left, mm", "out of the abdomen, mm", 0, 2, scene,
          traces, plots);
  add_organs(
      "Largest stretch of the wall", "stretch", traces, [](const OrganSample& s) { return s.max_stretch; },
      plots);
  add_organs(
      "Pressure inside", "pressure, mmHg", traces,
      [](const OrganSample& s) { return s.pressure / units::mmHg; }, plots);
  return plots;
}

}  // namespace calot
