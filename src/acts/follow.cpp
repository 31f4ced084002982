#include "acts/follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "acts/grip_slip.h"
#include "acts/jaw_acts.h"
#include "field/field_tissues.h"
#include "field/moving_bodies.h"
#include "motion/predict.h"
#include "motion/settle_field.h"
#include "motion/step_budget.h"
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

/// What a motion takes and brings beside the tools' way.
struct Passing {
  double duration;  ///< s
  Piece piece;
  const std::vector<char>& slipped_before;
  std::vector<WorldEvent>& events;
};

/// A motion that is under way. Where masses count it is one step of implicit Euler, however many parts its tools' way is cut
/// into so that nothing is passed through: only where they end everything is balanced. Without masses, and where that finds
/// no balance, each part is balanced, and a step of its own.
class Following {
 public:
  /// `passing`: null where neither time passes nor anything slips, as the part of the bodies' motion stays the one that
  /// they are in.
  Following(Field& field, const Poses& to, const Passing* passing, SolveStatistics& statistics)
      : field_(field),
        to_(to),
        passing_(passing),
        statistics_(statistics),
        iterations_before_(statistics.newton_iterations) {}

  Result<bool> run() {
    while (done_ < 1.0) {
      if (is_spent(field_, statistics_)) return end_here();
      if (Result<bool> part = one_part(); !part || !part.value()) return part;
    }
    return true;
  }

 private:
  /// Whether the motion goes on.
  Result<bool> one_part() {
    const Poses from = present_poses(field_);
    if (std::optional<Failure> failure = begin()) return *failure;
    const Result<Prediction> answer = answer_to(from);
    if (!answer) return answer.failure();
    // Organs that move by themselves have all the time there is: no tool stands where they begin to be looked for.
    double share = from == to_ ? 1.0 : answer->share;
    NewtonResult last;  // of the solve that failed last, if any did in this part
    for (bool accepted = false; !accepted;) {
      if (field_.step_time > 0 && passing_ && share < smallest_share && !field_.stopped())
        return stay(answer.value());
      if (std::optional<Failure> failure = given_up(share, last)) return *failure;
      const GroupSnapshot before = snapshot(field_);
      const double next = share >= 1.0 ? 1.0 : done_ + share * (1.0 - done_);
      const Poses poses = next >= 1.0 ? to_ : interpolate(from, to_, share);
      const bool passes = is_on_the_way(share);
      last = passes ? bring_along_to(poses, share, answer.value()) : settle_at(poses, share, answer.value());
      accepted = last.converged() || was_cut_short(field_, last) ||
                 (passes && last.status == NewtonStatus::iteration_limit) || ends_so(share, last);
      if (accepted) {
        learn(answer.value(), share, before, last);
        if (Result<bool> kept = keep(poses, next); !kept) return kept;
      } else {
        stuck_ = out_of_balance(field_, last);
        restore(field_, before);
        if (share >= 1.0 && goes_back()) return true;
        share *= 0.5;
      }
    }
    ++part_;
    return true;
  }

  /// Whether a step that found no balance at its end stays there, as nothing more may be tried: inertia carries it on.
  bool ends_so(double share, const NewtonResult& last) {
    if (share < 1.0 || !passing_ || !passing_->piece.last) return false;
    if (!is_spent(field_, statistics_) || !may_end_so(field_, last)) return false;
    statistics_.cut_short = true;
    return true;
  }

  /// The budget is spent: bodies that were only brought along find their balance with the tools as far as they came.
  Result<bool> end_here() {
    statistics_.cut_short = true;
    if (!is_one_step()) return by_parts_ ? pass_the_rest() : Result<bool>(false);
    field_.rough = false;
    if (done_ == 0)
      if (std::optional<Failure> failure = begin()) return *failure;
    const GroupSnapshot before = snapshot(field_);
    if (!settle_in_step(field_, "with the tools as far as they came", statistics_)) restore(field_, before);
    note_unasked(field_, statistics_);
    return false;
  }

  /// What is left of the time of a step that went on by parts passes with the tools as far as they came: what falls would
  /// hang in the air for as long. Where that finds no end it is left out.
  Result<bool> pass_the_rest() {
    const Poses here = present_poses(field_);
    const GroupSnapshot before = snapshot(field_);
    if (std::optional<Failure> failure = begin()) return *failure;
    const Result<Prediction> answer = predict(field_, here, here, true, statistics_);
    if (!answer || !stay(answer.value())) restore(field_, before);
    return false;
  }

  /// What the tools press leaves them no room yet: the rest of the time passes with them where they are, in which it gives
  /// way. The motion ends there, and its next step goes on.
  Result<bool> stay(const Prediction& answer) {
    const Poses here = present_poses(field_);
    const GroupSnapshot before = snapshot(field_);
    field_.rough = false;
    const NewtonResult last = settle_at(here, 1.0, answer);
    if (!last.converged() && !may_end_so(field_, last)) {
      restore(field_, before);
      return cannot_follow(field_, out_of_balance(field_, last), done_);
    }
    statistics_.cut_short = true;
    ++statistics_.substeps;
    note_unasked(field_, statistics_);
    return false;
  }

  double time_left() const { return passing_ ? (1.0 - done_) * passing_->duration : 0; }  ///< s
  bool is_one_step() const { return passing_ && field_.step_time > 0 && !by_parts_; }
  /// Whether bodies need only be brought along to this share of what is left of the way.
  bool is_on_the_way(double share) const { return is_one_step() && (share < 1.0 || !passing_->piece.last); }

  /// The part of the bodies' motion that this part of the tools' lies in.
  std::optional<Failure> begin() {
    if (!passing_ || (is_one_step() && done_ > 0)) return std::nullopt;
    if (is_one_step()) {
      if (!passing_->piece.first) return std::nullopt;
      first_ = snapshot(field_);
      first_poses_ = present_poses(field_);
    }
    grow_damage(field_);
    Result<std::vector<MotionPart>> parts = next_parts(field_);
    if (!parts) return parts.failure();
    parts_ = std::move(parts).value();
    begin_parts(parts_, time_left(), field_);
    return std::nullopt;
  }

  /// One step that found no balance at its end goes on by parts, from its beginning, where that is this piece's. Whether it
  /// is elsewhere.
  bool goes_back() {
    if (!is_one_step() || !passing_->piece.first || !passing_->piece.last) return false;
    by_parts_ = true;
    part_ = 0;
    iterations_before_ = statistics_.newton_iterations;
    if (done_ == 0) return false;
    restore(field_, first_);
    for (std::size_t i = 0; i < field_.tools.size(); ++i) field_.tools[i].pose = first_poses_[i];
    done_ = 0;
    return true;
  }

  /// For the next prediction. What it missed of another motion than the step's says nothing of that.
  void learn(const Prediction& answer, double share, const GroupSnapshot& before, const NewtonResult& last) {
    if (passing_)
      field_.group.missed = missed_by(answer, share, before, field_, last.by_last_factor);
    else
      field_.group.missed.by_last_factor = last.by_last_factor;
  }

  /// What the organs answer to the rest of the motion: by the last factor where that serves and is safe all the way.
  Result<Prediction> answer_to(const Poses& from) {
    const bool fresh = !factor_serves(field_.group);
    Result<Prediction> answer = predict(field_, from, to_, fresh, statistics_);
    if (answer && answer->share < 1.0 && !answer->fresh)
      answer = predict(field_, from, to_, true, statistics_);
    if (answer && answer->share < smallest_share && from != to_)
      answer = of_tools_alone(field_, from, to_, statistics_);
    return answer;
  }

  /// That a share of what is left, after a solve that failed (or none), is not worth trying.
  std::optional<Failure> given_up(double share, const NewtonResult& last) const {
    if (field_.stopped()) return fail(FailureKind::interrupted, "the step was interrupted");
    const int iterations = statistics_.newton_iterations - iterations_before_;
    if (part_ >= max_parts || iterations > step_iterations)
      return cannot_follow(field_,
                           fmt::format("not in {} parts and {} Newton iterations{}", part_, iterations,
                                       stuck_.empty() ? "" : "; last, " + stuck_),
                           done_);
    if (share < smallest_share)
      return cannot_follow(field_, last.converged() ? "the tissue it touches leaves it no room" : stuck_,
                           done_);
    return std::nullopt;
  }

  NewtonResult settle_at(const Poses& poses, double share, const Prediction& answer) {
    const std::vector<VecX> places = present_places(field_);
    if (!is_one_step()) begin_parts(parts_, share * time_left(), field_);
    move_by(std::min(share, answer.share), answer, field_);
    return settle_group(field_, poses, places, part_iterations, statistics_);
  }

  NewtonResult bring_along_to(const Poses& poses, double share, const Prediction& answer) {
    move_by(std::min(share, answer.share), answer, field_);
    return bring_along(field_, poses, statistics_);
  }

  /// The tools have come to `poses`, and `next` of the motion is done.
  Result<bool> keep(const Poses& poses, double next) {
    for (std::size_t i = 0; i < field_.tools.size(); ++i) field_.tools[i].pose = poses[i];
    done_ = next;
    ++statistics_.substeps;
    // What is not in balance tells neither what slips nor where it is touched.
    if (is_on_the_way(done_)) return true;
    if (is_spent(field_, statistics_)) {
      note_unasked(field_, statistics_);
      return true;
    }
    for (Organ& organ : field_.organs) follow_contacts(field_, organ, statistics_);
    if (!passing_) return true;
    const int iterations = statistics_.newton_iterations;
    Result<bool> held = let_slip(field_, passing_->slipped_before, passing_->events, statistics_);
    iterations_before_ += statistics_.newton_iterations - iterations;
    return held;
  }

  Field& field_;
  const Poses& to_;
  const Passing* passing_;
  SolveStatistics& statistics_;
  GroupSnapshot first_;  ///< where a motion that is one step began
  Poses first_poses_;
  std::vector<MotionPart> parts_;  ///< of the bodies' motion, in which it is
  bool by_parts_ = false;          ///< each part is a step of its own, though masses count
  int iterations_before_;          ///< of Newton's method, that are not this motion's
  int part_ = 0;
  double done_ = 0;    ///< share of the motion
  std::string stuck_;  ///< what failed last, in any part
};

}  // namespace

Result<bool> follow(Field& field, const Poses& to, double duration, Piece piece,
                    const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                    SolveStatistics& statistics) {
  const Passing passing{duration, piece, slipped_before, events};
  return Following(field, to, &passing, statistics).run();
}

Result<bool> turn_jaw(Field& field, ToolIndex instrument, double jaw, SolveStatistics& statistics) {
  Poses to = present_poses(field);
  to[instrument.value].jaw = jaw;
  return Following(field, to, nullptr, statistics).run();
}

}  // namespace calot
