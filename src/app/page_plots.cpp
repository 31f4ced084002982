#include "app/page_plots.h"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "base/units.h"

namespace calot {
namespace {

using PerSample = std::function<double(const InstrumentSample&)>;

constexpr const char* time_label = "time, s";

/// Those of the instruments up to `most`, N.
std::vector<PageLevel> force_limits(const SceneDefinition& scene, double most) {
  std::map<double, std::string> names;
  for (const InstrumentDefinition& instrument : scene.instruments) {
    std::string& all = names[instrument.force_limit];
    all += (all.empty() ? "" : ", ") + instrument.name;
  }
  std::vector<PageLevel> levels;
  for (const auto& [limit, who] : names)
    if (limit < most) levels.push_back({"force limit of " + who, limit});
  return levels;
}

/// None where it is never above zero.
void add_force(const char* title, const SceneDefinition& scene, const Traces& traces, const PerSample& force,
               bool with_limits, std::vector<PagePlot>& plots) {
  PagePlot plot;
  plot.title = title;
  plot.x_label = time_label;
  plot.y_label = "force, N";
  double most = 0;
  for (std::size_t i = 0; i < traces.instruments.size(); ++i) {
    PageCurve& curve = plot.curves.emplace_back();
    curve.name = scene.instruments[i].name;
    for (std::size_t k = 0; k < traces.time.size(); ++k) {
      curve.points.push_back({traces.time[k], force(traces.instruments[i][k])});
      most = std::max(most, curve.points.back()[1]);
    }
  }
  if (!(most > 0)) return;
  if (with_limits) plot.levels = force_limits(scene, 3 * most);
  plots.push_back(std::move(plot));
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

std::vector<PagePlot> page_plots(const SceneDefinition& scene, const Traces& traces) {
  std::vector<PagePlot> plots;
  add_force(
      "Force on the tip", scene, traces, [](const InstrumentSample& s) { return s.tip_force; }, true, plots);
  add_force(
      "Force on the jaws", scene, traces, [](const InstrumentSample& s) { return s.jaws_force; }, false,
      plots);
  add_force(
      "Force on the shaft", scene, traces, [](const InstrumentSample& s) { return s.shaft_force; }, false,
      plots);
  add_force(
      "Force felt at the handle", scene, traces, [](const InstrumentSample& s) { return s.handle_force; },
      false, plots);
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
