#include "app/operate_view.h"

#include <fmt/format.h>

namespace calot {
namespace {

void show_step(const Progress& progress, double time, LiveMode mode, LiveView& view) {
  view.step_number = static_cast<int>(progress.steps().size());
  const StepRecord* step = progress.running();
  if (step == nullptr) return;
  view.step = step->title;
  if (mode == LiveMode::practice) view.hint = step->hint;
  view.step_time = time - step->started;
  view.step_limit = step->limit;
}

}  // namespace

void ViewMaker::look(const World& world, const Progress& progress) {
  if (!builder_) builder_.emplace(world, options_.detail);
  builder_->follow(world);
  if (!latest_.wanted()) return;
  const StepReport& report = world.report();
  auto view = std::make_shared<LiveView>();
  view->attempt = options_.attempt;
  view->scene = builder_->build(world);
  view->time = report.time;
  view->time_limit = options_.time_limit;
  show_step(progress, report.time, options_.mode, *view);
  if (!progress.events().empty()) {
    const SessionEvent& event = progress.events().back();
    view->last_event = fmt::format("{} {} at {:.1f} s", to_text(event.kind), event.instrument, event.time);
  }
  const std::vector<InstrumentDefinition>& definitions = world.scene().instruments;
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    const InstrumentState& state = report.instruments[i];
    view->hands.push_back({definitions[i].name, state.holds, state.load_on(ToolPart::jaws).force.norm(),
                           definitions[i].force_limit, state.pose, state.waits,
                           source_.is_drawn_back(static_cast<int>(i))});
  }
  view->hands.push_back({laparoscope_name, "", 0, 0, report.laparoscope.pose});
  view->pictures = options_.pictures;
  view->inputs = source_.take_unseen();
  view->paused = source_.paused();
  latest_.put(std::move(view));
}

}  // namespace calot
