#include "session/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/units.h"
#include "session/metrics.h"
#include "session/rest_remarks.h"
#include "session/skin_difference.h"

namespace calot {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One session's moving parts; the loop below reads as the order of things.
class Session {
 public:
  Session(World& world, ExerciseScript& script, InputSource& source, const SessionOptions& options)
      : world_(world),
        script_(script),
        source_(source),
        options_(options),
        differences_(world),
        dt_(1 / world.scene().solver.rate) {
    for (const InstrumentState& state : world.report().instruments) input_.instruments.push_back(state.pose);
  }

  SessionResult run() {
    const Clock::time_point start = Clock::now();
    note_report();
    note_frequencies();
    note_rest();
    for (const WorldEvent& event : world_.report().events) result_.progress.add_event(event);
    while (!ended_) {
      observe(false);
      step();
    }
    close_steps();
    note_differences();
    note_refusals();
    note_given_steps();
    for (std::string& note : source_.notes()) result_.notes.push_back(std::move(note));
    observe(true);
    result_.metrics = measure(script_.definition().scene, result_.traces, result_.progress);
    finish_recording();
    result_.timing.wall_s = seconds_since(start);
    return std::move(result_);
  }

 private:
  void finish_recording() {
    if (options_.recording == nullptr) return;
    options_.recording->write({result_.metrics, result_.progress, result_.notes});
    const bool by_source = result_.end == SessionEnd::source_ended && !options_.source_end.empty();
    options_.recording->finish(by_source ? options_.source_end : to_text(result_.end));
  }

  void end(SessionEnd how) {
    ended_ = true;
    result_.end = how;
  }
  void end(const Failure& failure) {
    end(SessionEnd::failed);
    result_.failure = failure;
  }

  void step() {
    if (options_.stop != nullptr && *options_.stop) return end(SessionEnd::interrupted);
    // Half a step's slack, so that rounding of the summed time costs no step.
    if (world_.report().time + dt_ / 2 > script_.definition().time_limit) return end(SessionEnd::time_limit);
    if (world_.report().time + dt_ / 2 > options_.until) return end(SessionEnd::source_ended);
    if (!read_input()) return;
    const Clock::time_point start = Clock::now();
    Result<StepReport> report = world_.step(input_);
    const double taken = seconds_since(start);
    note_time(taken);
    if (options_.profile != nullptr) {
      const StepReport& now = world_.report();
      options_.profile->push_back({now.time + (report ? 0 : dt_), taken, now.statistics,
                                   report ? now.events : std::vector<WorldEvent>()});
    }
    if (!report) return note_failed_step(report.failure());
    note_report();
    for (const WorldEvent& event : report->events) result_.progress.add_event(event);
    const bool bails_out = note_acts();
    if (ended_) return;  // the report could not be written
    Result<bool> done = script_.advance(world_, result_.progress, dt_);
    if (!done) return end(done.failure());
    if (done.value()) return end(SessionEnd::steps_done);
    if (bails_out) end(SessionEnd::bailed_out);
  }

  void note_time(double taken) {
    SessionTiming& timing = result_.timing;
    timing.simulation_s += taken;
    timing.step_s.push_back(taken);
    const double second = std::floor(world_.report().time - dt_ / 2);  // in which the step lies
    in_second_ = std::exchange(second_, second) == second ? in_second_ + taken : taken;
    timing.slowest_s = std::max(timing.slowest_s, in_second_);
  }

  /// What who operates did besides moving; true where that ends the operation.
  bool note_acts() {
    bool bails_out = false;
    for (const SessionAct& act : input_.acts) {
      WorldEvent event;
      event.kind = act.kind;
      event.time = world_.report().time;
      event.text = act.text;
      result_.progress.add_event(event);
      bails_out = bails_out || act.kind == EventKind::bail_out;
    }
    return bails_out;
  }

  /// The input that could not be followed is recorded too: its replay fails at the same place.
  void note_failed_step(const Failure& failure) {
    if (failure.kind == FailureKind::interrupted) return end(SessionEnd::interrupted);
    end(failure);
    result_.state_hashes.push_back(world_.state_hash());
    if (options_.recording != nullptr) {
      options_.recording->write({world_.report().time + dt_, input_, world_.state_hash()});
    }
  }

  bool read_input() {
    Result<std::optional<StepInput>> next = source_.next(world_, dt_);
    if (!next) {
      if (next.failure().kind == FailureKind::interrupted)
        end(SessionEnd::interrupted);
      else
        end(next.failure());
      return false;
    }
    if (next->has_value()) {
      input_ = *next.value();
    } else if (options_.end_with_source) {
      end(SessionEnd::source_ended);
      return false;
    } else {
      input_.actions.clear();  // poses are held, pedals are not
      input_.acts.clear();
      input_.laparoscope.reset();
    }
    return true;
  }

  /// Keeps the world's present report: hash, traces, table and, after a step, the recording.
  void note_report() {
    const StepReport& report = world_.report();
    const bool at_rest = result_.state_hashes.empty();
    result_.state_hashes.push_back(report.state_hash);
    append_sample(world_, result_.traces);
    SessionTiming& timing = result_.timing;
    timing.substeps += report.statistics.substeps;
    timing.steps_cut_short += report.statistics.cut_short ? 1 : 0;
    timing.steps_unbalanced += report.balanced ? 0 : 1;
    timing.newton_iterations += report.statistics.newton_iterations;
    refused_ += report.statistics.extensions_refused;
    timing.assembly_s += report.statistics.assembly_s;
    timing.factorisation_s += report.statistics.factorisation_s;
    timing.solve_s += report.statistics.solve_s;
    timing.contact_s += report.statistics.contact_s;
    bool written = options_.table == nullptr || options_.table->write(report);
    if (options_.recording != nullptr && !at_rest) {
      written = options_.recording->write({report.time, input_, report.state_hash}) && written;
    }
    if (!written)
      end(fail(FailureKind::usage, "the output folder cannot take more: is the disk full?",
               "free space or choose another folder with -o DIR"));
  }

  /// The licence for statics, of each organ at rest; an organ without one gets no figure, and a note why.
  void note_frequencies() {
    const std::vector<OrganDefinition>& organs = world_.scene().anatomy.organs;
    for (std::size_t i = 0; i < organs.size(); ++i) {
      if (!is_hollow(organs[i].shape)) continue;
      const std::string name = organs[i].name + ".lowest_frequency_Hz";
      const Result<double> found = world_.lowest_frequency(OrganIndex(i));
      if (found)
        result_.progress.set_metric(name, found.value());
      else
        result_.notes.push_back(name + " is left out: " + to_text(found.failure()));
    }
  }

  void note_rest() {
    result_.rest = rest_remarks(world_);
    const std::vector<OrganDefinition>& organs = world_.scene().anatomy.organs;
    for (std::size_t i = 0; i < organs.size(); ++i)
      result_.progress.set_metric(organs[i].name + ".rest_shift_mm",
                                  world_.rest_shifts()[i].distance / units::mm);
  }

  void note_refusals() {
    if (refused_ > 0)
      result_.notes.push_back(
          fmt::format("an organ found no rest with finer elements where it was touched, {} times: it kept "
                      "those that it had, and "
                      "is less accurate there",
                      refused_));
  }

  /// Whoever writes the exercise hears of a condition that holds before anybody does anything.
  void note_given_steps() {
    for (const StepRecord& step : result_.progress.steps())
      if (step.outcome == "done" && step.ended - step.started < 1.5 * dt_)
        result_.notes.push_back(
            fmt::format("step {} was done as it began: what it waits for held already", step.name));
  }

  void note_differences() {
    const std::vector<OrganDefinition>& organs = world_.scene().anatomy.organs;
    for (std::size_t i = 0; i < organs.size(); ++i) {
      const std::optional<SkinDifference> found = differences_.of(world_, static_cast<int>(i));
      if (!found) continue;
      result_.progress.set_metric(organs[i].name + ".mean_difference_pct", found->mean_pct);
      result_.progress.set_metric(organs[i].name + ".largest_difference_pct", found->largest_pct);
    }
  }

  void close_steps() {
    const std::string outcome = result_.end == SessionEnd::steps_done   ? "done"
                                : result_.end == SessionEnd::time_limit ? "timeout"
                                : result_.end == SessionEnd::bailed_out ? "bail_out"
                                                                        : "aborted";
    result_.progress.end_step(world_.report().time, outcome);
  }

  void observe(bool last) {
    if (!options_.observer) return;
    const Clock::time_point start = Clock::now();
    options_.observer(world_, result_.progress, last);
    result_.timing.frames_s += seconds_since(start);
  }

  World& world_;
  ExerciseScript& script_;
  InputSource& source_;
  const SessionOptions& options_;
  SkinDifferences differences_;
  double dt_;
  double second_ = -1, in_second_ = 0;  ///< the simulated second of the last step, and what it took so far, s
  StepInput input_;                     ///< its poses are held where the source has ended
  int refused_ = 0;                     ///< changes of structural extensions
  bool ended_ = false;
  SessionResult result_;
};

}  // namespace

std::string to_text(SessionEnd end) {
  switch (end) {
    case SessionEnd::steps_done:
      return "done";
    case SessionEnd::time_limit:
      return "time_limit";
    case SessionEnd::source_ended:
      return "source_ended";
    case SessionEnd::interrupted:
      return "interrupted";
    case SessionEnd::failed:
      return "failed";
    case SessionEnd::bailed_out:
      return "bail_out";
  }
  return "failed";
}

SessionResult run_session(World& world, ExerciseScript& script, InputSource& source,
                          const SessionOptions& options) {
  return Session(world, script, source, options).run();
}

}  // namespace calot
