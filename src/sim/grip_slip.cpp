#include "sim/grip_slip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/clips.h"
#include "sim/field_state.h"
#include "sim/grip.h"
#include "sim/settle_field.h"
#include "sim/teeth.h"

namespace calot {
namespace {

/// Newton iterations that a change of a grip may take.
struct Budget {
  const SolveStatistics& statistics;
  int last;  ///< count at which it is spent
  bool spent() const { return statistics.newton_iterations >= last; }
};

Failure without_end(const Field& field, int instrument, const std::string& what) {
  return fail(FailureKind::simulation,
              fmt::format("{} the jaws of '{}' finds no rest", what, field.tools[instrument].definition.name),
              "raise the instrument's pinch_force or pad_friction, pull less far, or move in smaller steps");
}

/// Weakens the springs of the points that `leaves` picks, step by step, so that what they held moves along
/// equilibria; then they are let go.
Result<bool> fade(Field& field, int instrument, const std::function<bool(const GripPoint&)>& leaves,
                  double weaken, const Budget& budget, SolveStatistics& statistics) {
  constexpr double last_stiffness = 0.05;  // N/m a point, far below the wall's
  const std::string when = "as a grip let it go";
  for (double stiffness = grip_stiffness; stiffness > last_stiffness; stiffness *= weaken) {
    if (budget.spent()) return without_end(field, instrument, "what leaves");
    for (Organ& organ : field.organs)
      for (GripPoint& grip : organ.grips)
        if (leaves(grip)) grip.stiffness *= weaken;
    if (Result<bool> settled = settle_field(field, when, statistics); !settled) return settled;
  }
  for (Organ& organ : field.organs) std::erase_if(organ.grips, leaves);
  return settle_field(field, when, statistics);
}

auto held_by(int instrument) {
  return [instrument](const GripPoint& grip) { return grip.instrument == instrument; };
}

/// Moves what a tool holds along its pads by `way` (m, patient's frame) and lets go what leaves them.
Result<bool> slide(Field& field, int instrument, const Vec3& way, const Budget& budget,
                   SolveStatistics& statistics) {
  const Tool& tool = field.tools[instrument];
  const bool draws = hold_of_clips(field, instrument) < holding_limit(tool);
  if (draws) draw_clips(field, instrument, way);
  const auto off_the_pads = [&](const GripPoint& grip) {
    return grip.instrument == instrument && !before_pad(grip.local, tool.geometry);
  };
  bool leave = false;
  for (Organ& organ : field.organs) {
    for (GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      const Pose jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, grip.jaw);
      Vec3 along = jaw.linear().transpose() * way;
      along.x() = 0;  // never through the pad
      grip.local += along;
      leave |= off_the_pads(grip);
    }
  }
  if (draws && hold_by_clips(field, instrument))
    return settle_field(field, "as a clip was drawn along", statistics);
  // A clip that has come off was what the pads held.
  if (draws) return fade(field, instrument, held_by(instrument), 0.04, budget, statistics);
  // The rest of the fold holds on: longer steps than a release's do.
  if (leave) return fade(field, instrument, off_the_pads, 0.04, budget, statistics);
  return settle_field(field, "as it slipped from the jaws", statistics);
}

}  // namespace

Result<bool> release(Field& field, int instrument, SolveStatistics& statistics) {
  const Budget budget{statistics, statistics.newton_iterations + hold_iterations};
  const FieldState before = field_state(field);
  const Result<bool> faded = fade(field, instrument, held_by(instrument), 0.2, budget, statistics);
  if (!faded) restore(field, before);
  return faded;
}

Vec3 pad_pull(const Field& field, int instrument) {
  const Tool& tool = field.tools[instrument];
  Vec3 pull = Vec3::Zero();
  for (const Organ& organ : field.organs) {
    if (grip_count(organ, instrument) == 0) continue;
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    for (std::size_t g = 0; g < organ.grips.size(); ++g)
      if (organ.grips[g].instrument == instrument)
        pull += now.grip.stiffness[g] *
                (organ.body->skin_point(now.grip.row[g], organ.state.x) - now.grip.target[g]);
    const std::vector<Touch>& touching = organ.search.touching(*organ.body, organ.state.x, now);
    for (const ContactForce& contact : contact_forces(touching))
      if (contact.shape / shapes_per_tool == instrument && contact.shape % shapes_per_tool > 0)
        pull += contact.on_shape;
  }
  const Vec3 across = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(0);
  return pull - across * across.dot(pull);
}

Vec3 asked_of_friction(const Tool& tool, const Vec3& pull) {
  const Mat3 hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear();
  const double half = 0.5 * tool.pose.jaw;
  const double out = pull.dot(hinge.col(2)), pressed_out = 2 * tool.definition.pinch_force * std::sin(half);
  return pull + ((out + pressed_out) / std::cos(half) - out) * hinge.col(2);
}

double holding_limit(const Tool& tool) {
  return 2.0 * tool.definition.pad_friction * tool.definition.pinch_force;
}

double holding_limit(const Field& field, int instrument) {
  return std::min(holding_limit(field.tools[instrument]), hold_of_clips(field, instrument));
}

Result<double> slip(Field& field, int instrument, SolveStatistics& statistics) {
  constexpr double above = 1.001, below = 0.95;  // of the limit
  // m: the longest is below half the distance of the skin's points; what is shorter than the shortest is no
  // slide but the jump of a fold that a leaving point frees.
  constexpr double shortest_way = 10e-6, longest_way = 0.2e-3;
  const Budget budget{statistics, statistics.newton_iterations + hold_iterations};
  const Tool& tool = field.tools[static_cast<std::size_t>(instrument)];
  // Clips, which the pads hold across, are drawn along by the pull alone.
  const auto asked = [&] {
    const Vec3 pull = pad_pull(field, instrument);
    return hold_of_clips(field, instrument) < holding_limit(tool) ? pull : asked_of_friction(tool, pull);
  };
  double limit = holding_limit(field, instrument);
  Vec3 pull = asked();
  const double at_start = pad_pull(field, instrument).norm();
  if (pull.norm() <= above * limit) return 0.0;
  const FieldState start = field_state(field);
  double way = shortest_way;
  while (!budget.spent()) {
    const FieldState before = field_state(field);
    const Result<bool> slid = slide(field, instrument, way * pull.normalized(), budget, statistics);
    if (!slid) {
      restore(field, start);
      return slid.failure();
    }
    const Vec3 now = asked();
    limit = holding_limit(field, instrument);  // a clip that has come off holds no more
    const bool lost = !both_pads_hold(field, instrument);
    if (!lost && now.norm() < below * limit && way > shortest_way) {  // too far
      restore(field, before);
      way = std::max(0.3 * way, shortest_way);
      continue;
    }
    if (lost || now.norm() <= above * limit) return at_start;
    // By the secant; a fold that gives no more resistance is followed at a growing pace.
    const double stiffness = (pull.norm() - now.norm()) / way, longest = std::min(2 * way, longest_way);
    const double next = stiffness > 0 ? (now.norm() - limit) / stiffness : longest;
    way = std::clamp(next, shortest_way, longest);
    pull = now;
  }
  restore(field, start);
  return without_end(field, instrument, "the fold that slips through");
}

}  // namespace calot
