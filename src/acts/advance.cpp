#include "acts/advance.h"

#include <algorithm>
#include <utility>

#include "acts/blades.h"
#include "acts/close_within_pinch.h"
#include "acts/follow.h"
#include "acts/hard_hold.h"
#include "acts/jaw_acts.h"
#include "field/between_jaws.h"
#include "field/field_state.h"
#include "field/field_tissues.h"
#include "field/grip.h"
#include "field/leaving.h"
#include "field/take_hold.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// Where the tools really go: jaws that rest on tissue close no further of themselves.
Poses reachable(const Field& field, const Poses& targets) {
  Poses poses = targets;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (field.tools[i].jaws_rest() && poses[i].jaw < field.tools[i].pose.jaw)
      poses[i].jaw = field.tools[i].pose.jaw;
  return poses;
}

/// Jaw angles at which a tool halts, rad. Blades and appliers halt at each, as they divide and flatten what is between
/// them there, and so do jaws that close on clips: metal stops them.
double grid_of(const Field& field, ToolIndex instrument, bool each_alone) {
  if (each_alone || instrument_row(field.tool(instrument).definition.type).jaws != JawUse::hold)
    return grip_grid;
  const bool on_clips = std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return !clips_between(field, instrument, organ).empty();
  });
  return on_clips ? grip_grid : grip_grid_on_the_way;
}

/// Where the tools' motion halts: wherever one may take hold, and at its end.
std::vector<double> all_stops(const std::vector<std::vector<double>>& holding_stops) {
  std::vector<double> stops = {1.0};
  for (const std::vector<double>& of_tool : holding_stops)
    stops.insert(stops.end(), of_tool.begin(), of_tool.end());
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
  return stops;
}

/// A field that is solved roughly on the way, and not after, however that ends.
struct RoughWay {
  explicit RoughWay(Field& of) : field(of) {}
  RoughWay(const RoughWay&) = delete;
  RoughWay& operator=(const RoughWay&) = delete;
  ~RoughWay() { field.rough = false; }
  Field& field;
};

}  // namespace

Result<std::vector<WorldEvent>> advance(Field& field, const Poses& targets, SolveStatistics& statistics) {
  std::vector<WorldEvent> events;
  TearWatch tears(field);
  std::vector<char> slipped_before;
  for (Tool& tool : field.tools) slipped_before.push_back(std::exchange(tool.slipping, false));
  if (Result<bool> done = let_go(field, targets, events, statistics); !done) return done.failure();
  const Poses to = reachable(field, targets), start = present_poses(field);
  std::vector<char> rested;
  for (const Tool& tool : field.tools) rested.push_back(tool.jaws_rest());
  const RoughWay way(field);
  // Without masses each stop is an equilibrium of its own. What is hard slides before jaws, and is turned by them, unless
  // its balance and friction are asked at each stop: there each is a step of its own, too.
  const bool each_alone = field.step_time == 0 || may_touch_hard(field, largest_travel(field, to));
  std::vector<std::vector<double>> holding_stops;
  for (std::size_t i = 0; i < to.size(); ++i)
    holding_stops.push_back(closing_stops(start[i], to[i], grid_of(field, ToolIndex(i), each_alone)));
  bool first = true;
  double reached = 0;
  for (double stop : all_stops(holding_stops)) {
    const Piece piece = each_alone ? Piece{} : Piece{std::exchange(first, false), stop == 1};
    const double duration = (each_alone ? stop - std::exchange(reached, stop) : 1) * field.step_time;
    field.rough = field.step_time > 0 && stop < 1;
    Poses here = interpolate(start, to, stop);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (rested[i] || field.tools[i].jaws_rest()) here[i].jaw = field.tools[i].pose.jaw;
    const Poses from = present_poses(field);
    const auto go = [&](const Poses& poses) {
      for (std::size_t i = 0; i < poses.size(); ++i)
        if (poses[i].jaw < field.tools[i].pose.jaw) make_room(field, ToolIndex(i), poses[i].jaw);
      return follow(field, poses, duration, piece, slipped_before, events, statistics);
    };
    if (Result<bool> moved =
            close_within_pinch(field, here, targets, go, !piece.last, slipped_before, events, statistics);
        !moved)
      return moved.failure();
    else if (!moved.value())
      break;
    for (std::size_t i = 0; i < field.tools.size(); ++i) {
      const std::vector<double>& own = holding_stops[i];
      const bool at_stop = std::binary_search(own.begin(), own.end(), stop);
      const bool closed_on = rested[i] && field.tools[i].pose.jaw < from[i].jaw;
      if (field.tools[i].pressing ? !closed_on : field.tools[i].jaw_stopped || !at_stop) continue;
      Result<bool> closed = close_jaws(field, ToolIndex(i), tears, events, statistics);
      if (!closed) return closed.failure();
    }
  }
  if (field.rough) end_in_balance(field, statistics);
  // What is not in balance tells not what slips.
  if (statistics.balanced) judge_clasps(field, slipped_before, events);
  feel_again(field);
  pass_leaving(field, field.step_time);
  grow_damage(field);
  tears.judge(field, events);
  return events;
}

Result<std::vector<WorldEvent>> advance_unwedged(Field& field, const Poses& targets,
                                                 SolveStatistics& statistics) {
  if (field.step_time == 0) return advance(field, targets, statistics);
  const bool hard = touches_hard(field);
  const FieldState before = field_state(field);
  Result<std::vector<WorldEvent>> events = advance(field, targets, statistics);
  // Where tissue was crushed out of any shape that can be solved for the tools have gone too far, too.
  const bool lost = !events && events.failure().kind == FailureKind::simulation && !field.stopped();
  if (!events && !lost) return events;
  const bool ended = statistics.balanced && (hard || !statistics.cut_short);
  const bool stuck = lost || (hard && wedges_hard(field)) || (!ended && crushes(field));
  if (!stuck) {
    // Hands give way to what is hard in the next step only: where tools came short of their way their forces say nothing.
    if (hard) statistics.balanced &= !statistics.cut_short;
    return events;
  }
  restore(field, before);
  SolveStatistics again;  // with a budget of its own, as what was tried has spent the step's
  events = advance(field, present_poses(field), again);
  statistics.newton_iterations += again.newton_iterations;
  statistics.factorisations += again.factorisations;
  statistics.cut_short = true;  // the tools did not come where they were to
  statistics.balanced = again.balanced;
  statistics.residual = again.residual;
  return events;
}

}  // namespace calot
