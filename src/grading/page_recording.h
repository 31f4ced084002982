#pragma once
// A recording's score and its replay as what a page shows.

#include "grading/page_moments.h"
#include "page/page_data.h"
#include "session/json.h"

namespace calot {

/// How many events a page lists; errors come before others where there are more.
inline constexpr std::size_t most_page_events = 1000;

/// What was seen while a recording was simulated.
struct Watched {
  Played played;
  PageMoments moments;
  std::string differs;  ///< where the replay's states part from the recording's, and why that may be
  /// Where the states are the same and what they measure is not what the recording says: in words.
  std::vector<std::string> otherwise;
  bool simulated = true;
};
/// What a recording that is scored from what it holds says without being simulated: forces are not known.
Watched held_by(const Recording& recording, const ExerciseDefinition& exercise);

/// `entry` is its score as in score_recording.h; `prefix` of its ids.
PageRecording page_recording(const OrderedJson& entry, const Watched& watched, const std::string& prefix);

/// What a recording is called: its file without ".jsonl", or the folder of a "recording.jsonl".
std::string recording_name(const std::string& file);

}  // namespace calot
