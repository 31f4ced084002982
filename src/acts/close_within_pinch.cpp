#include "acts/close_within_pinch.h"

#include <algorithm>
#include <cmath>

#include "acts/clips.h"
#include "acts/pads.h"
#include "field/field_state.h"
#include "field/grip.h"
#include "field/teeth.h"
#include "motion/step_budget.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// rad: jaws whose tips are nearer than 20 nm apart differ by nothing that is felt.
constexpr double least_angle = 1e-6;
/// More of them find no angle where one of two is all that there is: a fold that snaps through.
constexpr int most_trials = 24;

/// One motion, tried with jaws at several angles.
class Trials {
 public:
  Trials(Field& field, Poses to, const std::function<Result<bool>(const Poses&)>& go,
         std::vector<WorldEvent>& events, const std::vector<std::size_t>& pressing,
         SolveStatistics& statistics)
      : field_(field),
        to_(std::move(to)),
        go_(go),
        events_(events),
        statistics_(statistics),
        start_(field_state(field)),
        told_(events.size()),
        at_start_(field.tools.size(), 0.0) {
    for (std::size_t i : pressing)
      if (!pressed_at_start(i)) at_start_[i] = excess(i);
  }

  /// By how much of the pinch the jaws press harder than that when the motion is over, the tool's at `jaw`. What cannot
  /// be followed presses without end.
  double excess(std::size_t tool, double jaw) {
    if (!fresh_) {
      restore(field_, start_);
      events_.resize(told_);
    }
    fresh_ = false;
    to_[tool].jaw = jaw;
    ++statistics_.jaw_trials[field_.tools[tool].definition.name];
    last_ = go_(to_);
    if (!last_) return std::numeric_limits<double>::infinity();
    return excess(tool);
  }
  /// Where the motion was tried last.
  double excess(std::size_t tool) const {
    return pressed_apart(field_, ToolIndex(tool)) / field_.tools[tool].definition.pinch_force - 1;
  }
  const Result<bool>& last() const { return last_; }
  /// Before it, of jaws that tissue had not stopped.
  double excess_at_start(std::size_t tool) const { return at_start_[tool]; }
  /// No further angle is worth what the step may still take: what was tried last is kept.
  bool spent() const { return is_spent(field_, statistics_); }
  double jaw_at_start(std::size_t tool) const { return start_.tools[tool].pose.jaw; }
  bool pressed_at_start(std::size_t tool) const { return start_.tools[tool].pressing; }

 private:
  Field& field_;
  Poses to_;
  const std::function<Result<bool>(const Poses&)>& go_;
  std::vector<WorldEvent>& events_;
  SolveStatistics& statistics_;
  FieldState start_;
  std::size_t told_;
  std::vector<double> at_start_;
  bool fresh_ = true;
  Result<bool> last_ = true;
};

/// An angle and the excess there.
struct At {
  double jaw, excess;
};

/// Between jaws that press too hard and such that do not press hard enough: regula falsi in the share of the pinch that
/// is missing, where what is pressed beyond counts no more than what is missing at most (Illinois).
void find_pinch(Trials& trials, std::size_t tool, At tight, At loose) {
  double of_tight = std::min(tight.excess, 1.0), of_loose = loose.excess;
  for (int k = 0; k < most_trials && loose.jaw - tight.jaw > least_angle; ++k) {
    const double share = std::clamp(of_tight / (of_tight - of_loose), 0.1, 0.9);
    const double jaw = tight.jaw + share * (loose.jaw - tight.jaw);
    const double excess = trials.excess(tool, jaw);
    if (std::abs(excess) <= pinch_tolerance || trials.spent()) return;
    if (excess > 0) {
      tight = {jaw, excess};
      of_tight = std::min(excess, 1.0);
      of_loose *= 0.5;
    } else {
      loose = {jaw, excess};
      of_loose = excess;
      of_tight *= 0.5;
    }
  }
  trials.excess(tool, loose.jaw);
}

/// From jaws that press too hard, or not hard enough, towards `end`: by a little first, as what rests on tissue has
/// little to make up for.
void turn_to_pinch(Trials& trials, std::size_t tool, At here, double end) {
  constexpr double shortest = grip_grid / 16;
  for (double way = shortest; here.jaw != end; way *= 4) {
    const double jaw = end > here.jaw ? std::min(here.jaw + way, end) : std::max(here.jaw - way, end);
    const At next{jaw, trials.excess(tool, jaw)};
    if (std::abs(next.excess) <= pinch_tolerance || trials.spent()) return;
    if ((next.excess > 0) != (here.excess > 0))
      return next.excess > 0 ? find_pinch(trials, tool, next, here) : find_pinch(trials, tool, here, next);
    here = next;
  }
}

}  // namespace

Result<bool> close_within_pinch(Field& field, const Poses& to, const Poses& targets,
                                const std::function<Result<bool>(const Poses&)>& go,
                                std::vector<WorldEvent>& events, SolveStatistics& statistics) {
  std::vector<std::size_t> pressing;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Tool& tool = field.tools[i];
    // Clips between the pads carry whatever presses: jaws rest on the metal.
    if (std::isfinite(hold_of_clips(field, ToolIndex(i)))) continue;
    if (has_teeth(tool) && !tool.waits && (tool.pressing || to[i].jaw < tool.pose.jaw)) pressing.push_back(i);
  }
  if (pressing.empty()) return go(to);
  Trials trials(field, to, go, events, pressing, statistics);
  std::vector<std::size_t> stopped;
  for (std::size_t i : pressing) {
    if (!trials.last()) break;
    const double from = trials.jaw_at_start(i), opening = field.tools[i].geometry.jaw_opening;
    const At first{to[i].jaw, i == pressing.front() ? trials.excess(i, to[i].jaw) : trials.excess(i)};
    const bool tight = first.excess > pinch_tolerance;
    if (tight) stopped.push_back(i);
    if (trials.spent()) continue;
    if (!trials.pressed_at_start(i)) {
      if (!tight) continue;
      // Jaws that were closing are let back as far as they have come.
      const At loose{from, trials.excess_at_start(i)};
      if (loose.excess < -pinch_tolerance) {
        find_pinch(trials, i, first, loose);
      } else {
        trials.excess(i, from);
      }
    } else if (tight) {
      turn_to_pinch(trials, i, first, std::min(from + grip_grid, opening));
    } else if (first.excess < -pinch_tolerance && targets[i].jaw < first.jaw) {
      turn_to_pinch(trials, i, first, std::max(targets[i].jaw, from - grip_grid));
    }
  }
  for (std::size_t i : stopped) field.tools[i].pressing = true;
  return trials.last();
}

}  // namespace calot
