#include "acts/advance.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "acts/blades.h"
#include "acts/close_within_pinch.h"
#include "acts/jaw_acts.h"
#include "field/field_tissues.h"
#include "field/grip.h"
#include "field/moving_bodies.h"
#include "motion/predict.h"
#include "motion/settle_field.h"
#include "motion/structural_extension.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

constexpr int max_parts = 100;
/// No motion between two stops takes more: one that needs them is blocked, and says so within seconds.
constexpr int step_iterations = 1000;
/// A solve that takes more than this is broken off; where it got somewhere it goes on with fresh pairs, else the
/// part is cut in two.
constexpr int part_iterations = 30;
constexpr double smallest_share = 1e-3;

Failure cannot_follow(const Field& field, const std::string& why, double done) {
  std::string tools;
  for (const Tool& tool : field.tools) {
    const Vec3 tip = 1e3 * tip_position(tool.trocar, tool.pose, tool.geometry);
    tools += fmt::format("{}'{}' with its tip at ({:.1f}, {:.1f}, {:.1f}) mm", tools.empty() ? "" : ", ",
                         tool.definition.name, tip.x(), tip.y(), tip.z());
  }
  return fail(
      FailureKind::simulation,
      fmt::format("the motion of {} could not be followed beyond {:.0f}% of a step: {}", tools, 100 * done,
                  why),
      "move more slowly or less far, keep the tool out of the tissue it already squeezes, or give the "
      "organ more nodes where it is handled");
}

/// Which body a solve found no balance of, and how far it was from one.
std::string out_of_balance(const Field& field, const NewtonResult& failed) {
  return fmt::format("'{}' finds no balance: {} (residual {:.2g})", member_name(field, failed.part),
                     to_text(failed.status), failed.residual);
}

/// Moves the organs by a share of what is predicted.
void move_by(double share, const Prediction& prediction, Field& field) {
  const BodyParts parts(field);
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    BodyState& state = field.organs[k].state;
    state.x += share * parts.of(k, prediction.dx);
    state.datum_pressure += share * prediction.dpressures[static_cast<Eigen::Index>(k)];
  }
  for (std::size_t k = field.organs.size(); k < moving_bodies(field); ++k)
    state_of(field, k).x += share * parts.of(k, prediction.dx);
}

/// Moves all tools from their poses to `to`, organs in equilibrium and grips within what they hold at the end
/// of each part, in `duration` s where masses count.
Result<bool> follow(Field& field, const Poses& to, double duration, const std::vector<char>& slipped_before,
                    std::vector<WorldEvent>& events, SolveStatistics& statistics) {
  int iterations_before = statistics.newton_iterations;
  double done = 0;
  NewtonResult last;  // of the solve that failed last, if any did in this part
  std::string stuck;  // what failed last, in any part
  for (int part = 0; done < 1.0; ++part) {
    const Poses from = present_poses(field);
    grow_damage(field);
    const Result<std::vector<MotionPart>> parts = next_parts(field);
    if (!parts) return parts.failure();
    const double time_left = (1.0 - done) * duration;
    begin_parts(parts.value(), time_left, field);
    const bool fresh = !factor_serves(field.group);
    Result<Prediction> answer = predict(field, from, to, fresh, statistics);
    if (answer && answer->share < 1.0 && !fresh) answer = predict(field, from, to, true, statistics);
    if (!answer) return answer.failure();
    if (answer->share < smallest_share && from != to) answer = of_tools_alone(field, from, to, statistics);
    const Prediction& prediction = answer.value();
    // Organs that move by themselves have all the time there is: no tool stands where they begin to be looked for.
    double share = from == to ? 1.0 : prediction.share;
    const double left = 1.0 - done;
    bool accepted = false;
    while (!accepted) {
      const int iterations = statistics.newton_iterations - iterations_before;
      if (part >= max_parts || iterations > step_iterations)
        return cannot_follow(field,
                             fmt::format("not in {} parts and {} Newton iterations{}", part, iterations,
                                         stuck.empty() ? "" : "; last, " + stuck),
                             done);
      if (share < smallest_share)
        return cannot_follow(field, last.converged() ? "the tissue it touches leaves it no room" : stuck,
                             done);
      const double next = share >= 1.0 ? 1.0 : done + share * left;
      const Poses poses = next >= 1.0 ? to : interpolate(from, to, share);
      const GroupSnapshot before = snapshot(field);
      const std::vector<VecX> places = present_places(field);
      begin_parts(parts.value(), share * time_left, field);
      move_by(std::min(share, prediction.share), prediction, field);
      last = settle_group(field, poses, places, part_iterations, statistics);
      accepted = last.converged();
      if (accepted) {
        field.group.missed = missed_by(prediction, share, before, field, last.by_last_factor);
        for (std::size_t i = 0; i < field.tools.size(); ++i) field.tools[i].pose = poses[i];
        for (Organ& organ : field.organs) follow_contacts(field, organ, statistics);
        done = next;
        last = {};
        ++statistics.substeps;
        const int iterations_moving = statistics.newton_iterations;
        Result<bool> held = let_slip(field, slipped_before, events, statistics);
        if (!held) return held;
        iterations_before += statistics.newton_iterations - iterations_moving;
      } else {
        stuck = out_of_balance(field, last);
        restore(field, before);
        share *= 0.5;
      }
    }
  }
  return true;
}

/// Where the tools really go: jaws that rest on tissue close no further of themselves.
Poses reachable(const Field& field, const Poses& targets) {
  Poses poses = targets;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (field.tools[i].jaws_rest() && poses[i].jaw < field.tools[i].pose.jaw)
      poses[i].jaw = field.tools[i].pose.jaw;
  return poses;
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
  std::vector<std::vector<double>> holding_stops;
  for (std::size_t i = 0; i < to.size(); ++i)
    holding_stops.push_back(closing_stops(start[i], to[i], grip_grid));
  double reached = 0;
  for (double stop : all_stops(holding_stops)) {
    const double duration = (stop - std::exchange(reached, stop)) * field.step_time;
    Poses here = interpolate(start, to, stop);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (rested[i] || field.tools[i].jaws_rest()) here[i].jaw = field.tools[i].pose.jaw;
    const Poses from = present_poses(field);
    const auto go = [&](const Poses& poses) {
      for (std::size_t i = 0; i < poses.size(); ++i)
        if (poses[i].jaw < field.tools[i].pose.jaw) make_room(field, static_cast<int>(i), poses[i].jaw);
      return follow(field, poses, duration, slipped_before, events, statistics);
    };
    if (Result<bool> moved = close_within_pinch(field, here, targets, go, events, statistics); !moved)
      return moved.failure();
    for (std::size_t i = 0; i < field.tools.size(); ++i) {
      const std::vector<double>& own = holding_stops[i];
      const bool at_stop = std::binary_search(own.begin(), own.end(), stop);
      const bool closed_on = rested[i] && field.tools[i].pose.jaw < from[i].jaw;
      if (field.tools[i].pressing ? !closed_on : field.tools[i].jaw_stopped || !at_stop) continue;
      Result<bool> closed = close_jaws(field, static_cast<int>(i), tears, events, statistics);
      if (!closed) return closed.failure();
    }
  }
  judge_clasps(field, slipped_before, events);
  feel_again(field);
  grow_damage(field);
  tears.judge(field, events);
  return events;
}

}  // namespace calot
