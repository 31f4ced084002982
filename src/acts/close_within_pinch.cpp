#include "acts/close_within_pinch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acts/clips.h"
#include "acts/follow.h"
#include "acts/grip_slip.h"
#include "acts/hard_hold.h"
#include "acts/jaw_acts.h"
#include "acts/pads.h"
#include "field/field_state.h"
#include "field/grip.h"
#include "field/take_hold.h"
#include "field/teeth.h"
#include "motion/settle_field.h"
#include "motion/step_budget.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// rad: jaws whose tips are nearer than 20 nm apart differ by nothing that is felt.
constexpr double least_angle = 1e-6;
/// More of them find no angle where one of two is all that there is: a fold that snaps through.
constexpr int most_trials = 24;

/// One motion, and jaws that are turned at its end.
class Trials {
 public:
  Trials(Field& field, Poses to, const std::function<Result<bool>(const Poses&)>& go,
         std::vector<WorldEvent>& events, const std::vector<std::size_t>& pressing, bool brought_along,
         SolveStatistics& statistics)
      : field_(field),
        to_(std::move(to)),
        go_(go),
        events_(events),
        statistics_(statistics),
        start_(field_state(field)),
        told_(events.size()),
        pressing_(pressing),
        brought_along_(brought_along),
        on_the_way_(field.rough),
        at_start_(field.tools.size(), 0.0) {
    for (std::size_t i : pressing)
      if (!pressed_at_start(i)) at_start_[i] = excess(i);
  }

  /// By how much of the pinch the jaws press harder than that when the motion is over, the tool's at `jaw`. What cannot
  /// be followed presses without end.
  double excess(std::size_t tool, double jaw) {
    to_[tool].jaw = jaw;
    field_.rough = on_the_way_ || (moved_ && field_.step_time > 0);
    ++statistics_.jaw_trials[field_.tools[tool].definition.name];
    if (reached_ && field_.step_time > 0 && !rubs(tool))
      turn(tool, jaw);
    else
      go();
    return last_ ? excess(tool) : std::numeric_limits<double>::infinity();
  }
  /// Whether jaws were turned after the motion.
  bool turned() const { return turned_; }
  /// Where the motion was tried last.
  double excess(std::size_t tool) const {
    return pressed_apart(field_, ToolIndex(tool)) / field_.tools[tool].definition.pinch_force - 1;
  }
  const Result<bool>& last() const { return last_; }
  /// How it ended. A turn that failed was undone: the motion stands, its jaws as they were before, in a step cut short.
  Result<bool> end() {
    if (last_ || !reached_ || field_.stopped()) return last_;
    statistics_.cut_short = true;
    return true;
  }
  /// Before it, of jaws that tissue had not stopped.
  double excess_at_start(std::size_t tool) const { return at_start_[tool]; }
  /// No further angle is worth what the step may still take: what was tried last is kept.
  bool spent() const { return is_spent(field_, statistics_); }
  double jaw_at_start(std::size_t tool) const { return start_.tools[tool].pose.jaw; }
  bool pressed_at_start(std::size_t tool) const { return start_.tools[tool].pressing; }

 private:
  /// Whether anything rubs on a tool's jaws: what is squeezed out of them slides, and does not come back as they open again.
  bool rubs(std::size_t tool) const {
    const auto on_jaws = [&](const RubbingPoint& rubbing) {
      const FieldShape which = field_.shape(rubbing.shape);
      return which.tool == ToolIndex(tool) && !which.is_shaft();
    };
    return std::any_of(field_.organs.begin(), field_.organs.end(), [&](const Organ& organ) {
      return std::any_of(organ.friction.points.begin(), organ.friction.points.end(), on_jaws);
    });
  }
  /// The whole motion, from its beginning.
  void go() {
    if (moved_) {
      restore(field_, start_);
      events_.resize(told_);
    }
    moved_ = true;
    last_ = go_(to_);
    if (brought_along_ && last_ && last_.value()) balance_what_presses();
    reached_ = bool(last_);
    grips_.clear();
    for (const Organ& organ : field_.organs) grips_.push_back(organ.grips);
  }
  /// Bodies that are only brought along lag behind: jaws that do not press with their pinch then do not do so in
  /// balance. Where any seem to, the balance says.
  void balance_what_presses() {
    const auto seems_to = [&](std::size_t tool) { return !pressed_at_start(tool) && excess(tool) > 0; };
    if (!std::any_of(pressing_.begin(), pressing_.end(), seems_to)) return;
    if (Result<bool> settled = settle_in_step(field_, "with jaws that press", statistics_); !settled)
      last_ = settled;
  }
  /// Turns a tool's jaws where the motion has brought them; they stay as they are where it fails.
  void turn(std::size_t tool, double jaw) {
    const FieldState before = field_state(field_);
    // However far jaws were closed on trial, what they hold lies as the motion left it.
    for (std::size_t k = 0; k < grips_.size(); ++k) field_.organs[k].grips = grips_[k];
    for (std::size_t i = 0; i < field_.tools.size(); ++i)
      make_room(field_, ToolIndex(i), i == tool ? jaw : field_.tools[i].pose.jaw);
    last_ = turn_jaw(field_, ToolIndex(tool), jaw, statistics_);
    if (!last_) {
      restore(field_, before);
      statistics_.balanced = false;  // with jaws that do not press with their pinch
    }
    turned_ = true;
  }

  Field& field_;
  Poses to_;
  const std::function<Result<bool>(const Poses&)>& go_;
  std::vector<WorldEvent>& events_;
  SolveStatistics& statistics_;
  FieldState start_;
  std::size_t told_;
  const std::vector<std::size_t>& pressing_;
  bool brought_along_;
  bool on_the_way_;  ///< rough from the first trial on; else from the second
  std::vector<double> at_start_;
  std::vector<std::vector<GripPoint>> grips_;  ///< of the organs, at the motion's end
  bool moved_ = false, reached_ = false, turned_ = false;
  Result<bool> last_ = true;
};

/// An angle and the excess there.
struct At {
  double jaw, excess;
};

/// What presses, as the logarithm of its share of the pinch: what gives way to jaws stiffens as they squeeze it, so that
/// this falls in nearly a straight line as they open.
double logarithm(double excess) {
  constexpr double least = 0.02, most = 50;  // of the pinch: beyond, tissue is not there or there is no room
  return std::log(std::clamp(1 + excess, least, most));
}

/// The next angle to try from `here`: by the slope, where one is known, else by a growing way.
double next_angle(const At& here, double slope, int trial) {
  constexpr double shortest = grip_grid / 16, longest = 0.5 * grip_grid;
  const double open = here.excess > 0 ? 1 : -1;
  if (!(slope < 0)) return here.jaw + open * std::min(shortest * std::pow(4.0, trial), grip_grid);
  return here.jaw + std::clamp(-logarithm(here.excess) / slope, -longest, longest);
}

/// Turns jaws from `here` to where they press with their pinch, between `least` and `most`, rad: by secants, between what
/// presses too hard and what presses not hard enough as soon as both are known.
void find_pinch(Trials& trials, std::size_t tool, At here, std::optional<At> other, double least, double most,
                double& slope) {
  // At first nearer to it than need be, so that the end hardly depends on where the search began.
  const auto good_enough = [](double excess, int trial) {
    return std::abs(excess) <= (trial == 0 || trial > 3 ? pinch_tolerance : pinch_tolerance / 4);
  };
  std::optional<At> tight, loose;
  const auto note = [&](const At& at) { (at.excess > 0 ? tight : loose) = at; };
  if (other) note(*other);
  for (int k = 0; k < most_trials && !trials.spent(); ++k) {
    if (good_enough(here.excess, k)) return;
    note(here);
    double jaw = std::clamp(next_angle(here, slope, k), least, most);
    if (tight && loose) {
      const double way = loose->jaw - tight->jaw;
      if (way <= least_angle) break;
      // Where secants creep along one side halves do not.
      jaw = k % 4 == 3 ? tight->jaw + 0.5 * way
                       : std::clamp(jaw, tight->jaw + 0.05 * way, loose->jaw - 0.05 * way);
    }
    if (jaw == here.jaw) return;
    const At next{jaw, trials.excess(tool, jaw)};
    const double secant = (logarithm(next.excess) - logarithm(here.excess)) / (jaw - here.jaw);
    if (secant < 0) slope = secant;
    here = next;
  }
  if (here.excess > pinch_tolerance && loose && !trials.spent()) trials.excess(tool, loose->jaw);
}

}  // namespace

Result<bool> close_within_pinch(Field& field, const Poses& to, const Poses& targets,
                                const std::function<Result<bool>(const Poses&)>& go, bool brought_along,
                                const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                                SolveStatistics& statistics) {
  std::vector<std::size_t> pressing;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Tool& tool = field.tools[i];
    // Clips between the pads carry whatever presses: jaws rest on the metal.
    if (std::isfinite(hold_of_clips(field, ToolIndex(i)))) continue;
    const bool gives_way = has_teeth(tool) || rests_on_hard(field, ToolIndex(i));
    if (gives_way && !tool.waits && (tool.pressing || to[i].jaw < tool.pose.jaw)) pressing.push_back(i);
  }
  if (pressing.empty()) return go(to);
  Trials trials(field, to, go, events, pressing, brought_along, statistics);
  std::vector<std::size_t> stopped;
  for (std::size_t i : pressing) {
    if (!trials.last()) break;
    const double from = trials.jaw_at_start(i), opening = field.tools[i].geometry.jaw_opening;
    const At first{to[i].jaw, i == pressing.front() ? trials.excess(i, to[i].jaw) : trials.excess(i)};
    const bool tight = first.excess > pinch_tolerance;
    if (tight) stopped.push_back(i);
    // Jaws that have pressed before find their pinch at the end of the step.
    if (trials.spent() || (trials.pressed_at_start(i) && brought_along)) continue;
    double& slope = field.tools[i].pinch_slope;
    if (trials.pressed_at_start(i)) {
      const double most = std::min(from + grip_grid, opening);
      find_pinch(trials, i, first, std::nullopt, std::max(targets[i].jaw, from - grip_grid), most, slope);
    } else if (tight) {
      // Jaws that were closing are let back as far as they have come.
      const At loose{from, trials.excess_at_start(i)};
      if (loose.excess < -pinch_tolerance) {
        find_pinch(trials, i, first, loose, to[i].jaw, from, slope);
      } else {
        trials.excess(i, from);
      }
    }
  }
  for (std::size_t i : stopped) field.tools[i].pressing = true;
  if (trials.turned() && trials.spent()) note_unasked(field, statistics);
  if (!trials.last() || !trials.turned() || trials.spent()) return trials.end();
  if (Result<bool> held = let_slip(field, slipped_before, events, statistics); !held) return held;
  return trials.last();
}

}  // namespace calot
