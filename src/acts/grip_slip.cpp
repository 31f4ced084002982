#include "acts/grip_slip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "acts/clips.h"
#include "field/field_state.h"
#include "field/grip.h"
#include "field/take_hold.h"
#include "field/teeth.h"
#include "motion/settle_field.h"
#include "motion/step_budget.h"

namespace calot {
namespace {

constexpr double slips_above = 1.001;  // of what is held

/// Newton iterations that a change of a grip may take.
struct Budget {
  const SolveStatistics& statistics;
  int last;  ///< count at which it is spent
  bool spent() const { return statistics.newton_iterations >= last; }
};

Failure without_end(const Field& field, ToolIndex instrument, const std::string& what) {
  return fail(
      FailureKind::simulation,
      fmt::format("{} the jaws of '{}' finds no rest", what, field.tool(instrument).definition.name),
      "raise the instrument's pinch_force or pad_friction, pull or turn less far, or move in smaller steps");
}

/// Lets the points that `leaves` picks go. Where masses count they are let go at once; else their springs are weakened
/// step by step, so that what they held moves along equilibria. Where there are none nothing is solved.
Result<bool> fade(Field& field, ToolIndex instrument, const std::function<bool(const GripPoint&)>& leaves,
                  double weaken, const Budget& budget, SolveStatistics& statistics) {
  constexpr double last_stiffness = 0.05;  // N/m a point, far below the wall's
  const std::string when = "as a grip let it go";
  if (field.step_time > 0) {
    std::size_t left = 0;
    for (Organ& organ : field.organs) left += std::erase_if(organ.grips, leaves);
    return left == 0 ? Result<bool>(true) : settle_in_step(field, when, statistics);
  }
  // What is hard does not unfold: it is let go at once.
  bool hard = false;
  for (Organ& organ : field.organs)
    if (!is_bitten(organ)) hard |= std::erase_if(organ.grips, leaves) > 0;
  const bool any = std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return std::any_of(organ.grips.begin(), organ.grips.end(), leaves);
  });
  if (!any) return hard ? settle_in_step(field, when, statistics) : true;
  for (double stiffness = grip_stiffness; stiffness > last_stiffness; stiffness *= weaken) {
    if (budget.spent()) return without_end(field, instrument, "what leaves");
    for (Organ& organ : field.organs)
      for (GripPoint& grip : organ.grips)
        if (leaves(grip)) grip.stiffness *= weaken;
    if (Result<bool> settled = settle_in_step(field, when, statistics); !settled) return settled;
  }
  for (Organ& organ : field.organs) std::erase_if(organ.grips, leaves);
  return settle_in_step(field, when, statistics);
}

auto held_by(ToolIndex instrument) {
  return [instrument](const GripPoint& grip) { return grip.instrument == instrument; };
}

/// What a tool's pads hold is asked of them: a pull along them, or a couple about its shaft.
struct Demand {
  Vec3 towards = Vec3::Zero();  ///< unit: of the pull, or of the couple's axis; patient's frame
  bool turns = false;           ///< it is a couple
  double asked = 0, limit = 0;  ///< N or N m
  double share() const { return asked > 0 ? asked / limit : 0; }
};

/// m, from the middle between the pads to a fold's walls: one that turns by an angle has come by that times this.
constexpr double turning_lever = 1.2e-3;

/// Where a point goes as what the pads hold gives way by `way` m, patient's frame.
Vec3 given_way(const Tool& tool, const Demand& demand, double way, const Vec3& at) {
  if (!demand.turns) return way * demand.towards;
  const Vec3 hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).translation();
  return way / turning_lever * demand.towards.cross(at - hinge);
}

/// Moves what a tool holds along its pads by `way` (m) and lets go what leaves them.
Result<bool> slide(Field& field, ToolIndex instrument, const Demand& demand, double way, const Budget& budget,
                   SolveStatistics& statistics) {
  const Tool& tool = field.tool(instrument);
  const bool draws = hold_of_clips(field, instrument) < holding_limit(tool);
  if (draws) draw_clips(field, instrument, way * demand.towards);
  const auto off_the_pads = [&](const GripPoint& grip) {
    return grip.instrument == instrument && !before_pad(grip.local, tool.geometry);
  };
  bool leave = false;
  for (Organ& organ : field.organs) {
    for (GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      const Pose jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, grip.jaw);
      Vec3 along = jaw.linear().transpose() * given_way(tool, demand, way, jaw * grip.local);
      along.x() = 0;  // never through the pad
      grip.local += along;
      leave |= off_the_pads(grip);
    }
  }
  if (draws && hold_by_clips(field, instrument))
    return settle_in_step(field, "as a clip was drawn along", statistics);
  // A clip that has come off was what the pads held.
  if (draws) return fade(field, instrument, held_by(instrument), 0.04, budget, statistics);
  // The rest of the fold, which has moved, holds on: longer steps than a release's do.
  if (leave) return fade(field, instrument, off_the_pads, 0.04, budget, statistics);
  return settle_in_step(field, "as it slipped from the jaws", statistics);
}

}  // namespace

Result<bool> release(Field& field, ToolIndex instrument, SolveStatistics& statistics) {
  const Budget budget{statistics, statistics.newton_iterations + hold_iterations};
  const FieldState before = field_state(field);
  const Result<bool> faded = fade(field, instrument, held_by(instrument), 0.2, budget, statistics);
  if (!faded) restore(field, before);
  return faded;
}

Result<bool> leave_pads(Field& field, ToolIndex instrument, SolveStatistics& statistics) {
  const std::array<Pose, 2> to_local = to_jaws(field.tool(instrument));
  bool any = false;
  for (Organ& organ : field.organs)
    for (GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      const Vec3 at = to_local[grip.jaw] * organ.body->skin_point(grip.skin_point, organ.state.x);
      grip.leaves = at.x() < grip.local.x() - pad_reach;
      any |= grip.leaves;
    }
  if (!any || field.step_time > 0) return true;
  const Budget budget{statistics, statistics.newton_iterations + hold_iterations};
  const FieldState before = field_state(field);
  const auto leaves = [](const GripPoint& grip) { return grip.leaves; };
  const Result<bool> left = fade(field, instrument, leaves, 0.04, budget, statistics);
  if (left) return true;
  restore(field, before);
  for (Organ& organ : field.organs)
    for (GripPoint& grip : organ.grips) grip.leaves = false;
  return left.failure();
}

void let_left_go(Field& field) {
  for (Organ& organ : field.organs)
    std::erase_if(organ.grips, [](const GripPoint& grip) { return grip.leaves; });
}

PadLoad pad_load(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  const Pose hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry);
  const Vec3 across = hinge.linear().col(0), shaft = hinge.linear().col(2);
  PadLoad load;
  const auto add = [&](const Vec3& at, const Vec3& force) {
    load.pull += force - across * across.dot(force);
    load.couple += shaft.dot((at - hinge.translation()).cross(force));
  };
  for (const Organ& organ : field.organs) {
    if (grip_count(organ, instrument) == 0) continue;
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    for (std::size_t g = 0; g < organ.grips.size(); ++g) {
      if (organ.grips[g].instrument != instrument) continue;
      const Vec3 at = organ.body->skin_point(now.grip.row[g], organ.state.x);
      add(at, now.grip.sample(g, at).gradient);
    }
    const std::vector<Touch>& touching = organ.search.touching(*organ.body, organ.state.x, now);
    for (const ContactForce& contact : contact_forces(touching)) {
      const FieldShape which = field.shape(contact.shape);
      if (which.tool == instrument && !which.is_shaft()) add(contact.at, contact.on_shape);
    }
  }
  return load;
}

double couple_limit(const Tool& tool) { return tool.definition.pinch_force * tool.geometry.jaw_width / 2; }

namespace {

/// Of the pull and the couple that which comes nearer to what is held of it, or goes further beyond. A fold that is
/// `turning` is held by turning_share of the couple.
Demand largest_demand(const Field& field, ToolIndex instrument, bool turning) {
  const Tool& tool = field.tool(instrument);
  const PadLoad load = pad_load(field, instrument);
  // Clips, which the pads hold across, are drawn along by the pull alone.
  const bool clips = hold_of_clips(field, instrument) < holding_limit(tool);
  const Vec3 asked = clips ? load.pull : asked_of_friction(tool, load.pull);
  const Demand pull{asked.normalized(), false, asked.norm(), holding_limit(field, instrument)};
  // A tube lies in the middle of both pads: it does not come out of a couple by turning about the shaft.
  const bool tube = std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return organ.body->is_line() && grip_count(organ, instrument) > 0;
  });
  if (clips || tube) return pull;
  const Vec3 shaft = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(2);
  const Demand couple{load.couple > 0 ? shaft : Vec3(-shaft), true, std::abs(load.couple),
                      (turning ? turning_share : 1.0) * couple_limit(tool)};
  return couple.share() > pull.share() ? couple : pull;
}

}  // namespace

Vec3 asked_of_friction(const Tool& tool, const Vec3& pull) {
  const Mat3 hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear();
  const double half = 0.5 * tool.pose.jaw;
  const double out = pull.dot(hinge.col(2)), pressed_out = 2 * tool.definition.pinch_force * std::sin(half);
  return pull + ((out + pressed_out) / std::cos(half) - out) * hinge.col(2);
}

double holding_limit(const Tool& tool) {
  return 2.0 * tool.definition.pad_friction * tool.definition.pinch_force;
}

double holding_limit(const Field& field, ToolIndex instrument) {
  return std::min(holding_limit(field.tool(instrument)), hold_of_clips(field, instrument));
}

Result<Slipped> slip(Field& field, ToolIndex instrument, SolveStatistics& statistics) {
  // m: the longest is below half the distance of the skin's points; what is shorter than the shortest is no
  // slide but the jump of a fold that a leaving point frees.
  constexpr double shortest_way = 10e-6, longest_way = 0.2e-3;
  const Budget budget{statistics, statistics.newton_iterations + hold_iterations};
  Demand demand = largest_demand(field, instrument, false);
  if (demand.share() <= slips_above) return Slipped{};
  const Slipped out{true, demand.turns, pad_load(field, instrument).pull.norm()};
  const FieldState start = field_state(field);
  // Where masses count a step takes one slide of what turns, which may leave it anywhere from where turning stops.
  const bool at_once = field.step_time > 0 && demand.turns;
  const double below = at_once ? turning_share : 0.95;  // of the limit
  double way = at_once ? longest_way : demand.turns ? 0.5 * longest_way : shortest_way;
  bool turning = false;
  while (!budget.spent()) {
    if (is_spent(field, statistics)) {
      statistics.cut_short = true;
      statistics.balanced = false;  // more is asked of what is held than holds
      return out;
    }
    if (!at_once && demand.turns && !std::exchange(turning, true))
      demand = largest_demand(field, instrument, true);
    const FieldState before = field_state(field);
    const Result<bool> slid = slide(field, instrument, demand, way, budget, statistics);
    if (!slid) {
      restore(field, start);
      return slid.failure();
    }
    const Demand now = largest_demand(field, instrument, turning);
    const bool lost = !both_pads_hold(field, instrument);
    if (!lost && now.share() < below && way > shortest_way) {  // too far
      restore(field, before);
      way = std::max(0.3 * way, shortest_way);
      continue;
    }
    if (lost || now.share() <= slips_above) return out;
    // By the secant; a fold that gives no more resistance is followed at a growing pace.
    const double stiffness = (demand.share() - now.share()) / way, longest = std::min(2 * way, longest_way);
    const double next = stiffness > 0 ? (now.share() - 1) / stiffness : longest;
    way = std::clamp(next, shortest_way, longest);
    demand = now;
  }
  restore(field, start);
  if (field.step_time == 0) return without_end(field, instrument, "the fold that slips through");
  statistics.cut_short = true;
  statistics.balanced = false;
  return out;
}

void note_unasked(const Field& field, SolveStatistics& statistics) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    const ToolIndex index(i);
    if (!held_organ(field, index).empty() && asked_of_pads(field, index).share > slips_above)
      statistics.balanced = false;
  }
}

Asked asked_of_pads(const Field& field, ToolIndex instrument) {
  const Demand demand = largest_demand(field, instrument, false);
  return {demand.share(), demand.turns};
}

}  // namespace calot
