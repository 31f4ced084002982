#pragma once
// The text that a program sends to operate an exercise: one input or command a line.
//
//   pose T NAME pitch yaw insertion roll jaw [ACTION]   as recordings have it: rad and m, about the trocar
//   tip T NAME x y z roll jaw [ACTION]                  the tip of the closed jaws, m in the patient's frame
//   pause | resume | restart | abandon | end            a command alone on its line
//   time_out [words] | bail_out [words]                 an act, and what is said at it
//   # ...                                               a comment; empty lines are left out too
//
// T is the source's own time in s: 0 or more, and never less than in the line before (of this connection, or since
// `restart`). NAME is an instrument of the exercise. An ACTION (activate, ...) lasts until the instrument's next line.

#include <string>
#include <string_view>
#include <vector>

#include "input/live_decoder.h"

namespace calot {

/// Turns bytes as they come into events. A line that cannot be used is one too, with its number and why.
class LiveLines : public LiveDecoder {
 public:
  static constexpr std::size_t longest = 1000;  ///< bytes

  /// `source` is what messages call it.
  LiveLines(std::vector<LiveInstrument> instruments, std::string source);
  void add(std::string_view bytes, std::vector<LiveEvent>& events) override;
  /// A line without an end may be half of one.
  void finish(std::vector<LiveEvent>& events) override;
  bool ended() const override { return ended_; }

 private:
  void end_line(std::vector<LiveEvent>& events);
  Result<std::optional<LiveEvent>> read(std::string_view line);
  Result<LiveInput> read_input(const std::vector<std::string_view>& words);
  /// The time of an input, s: 0 or more, and not before the last input's.
  Result<double> read_time(std::string_view word) const;
  /// The place among instruments_ of the one with this name.
  Result<int> read_instrument(std::string_view word) const;
  /// The pose, rad and m, that an input's five values give or, of a tip's place, the one whose tip is there.
  Result<InstrumentPose> read_pose(const std::vector<std::string_view>& words,
                                   const LiveInstrument& instrument) const;
  Failure wrong(const std::string& message, const std::string& hint) const;
  Result<double> number(std::string_view word, const char* name) const;

  std::vector<LiveInstrument> instruments_;
  std::string source_, line_;
  bool too_long_ = false, ended_ = false;
  int number_ = 0;     ///< of the line
  double time_ = 0;    ///< s, of the last input
  int time_line_ = 0;  ///< where that was
};

}  // namespace calot
