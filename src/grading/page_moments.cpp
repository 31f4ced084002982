#include "grading/page_moments.h"

#include <fmt/format.h>

#include "render/jpeg.h"

namespace calot {
namespace {

constexpr int jpeg_quality = 80;

}  // namespace

std::set<EventKind> error_kinds(const ExerciseDefinition& exercise) {
  std::set<EventKind> kinds(exercise.score.critical.begin(), exercise.score.critical.end());
  for (const EventRow& row : event_rows())
    if (row.error) kinds.insert(row.kind);
  for (const ScorePart& part : exercise.score.parts) {
    if (part.kind == ScorePartKind::penalty) kinds.insert(part.event);
    for (const auto* counted : {&part.minor, &part.major, &part.errors})
      kinds.insert(counted->begin(), counted->end());
  }
  return kinds;
}

std::string PageMoments::wanted(const Progress& progress) {
  moment_ = {};
  const bool of_steps = add_steps(progress), of_errors = add_errors(progress);
  if (of_steps && of_steps_ < most_of_steps)
    ++of_steps_;
  else if (!of_errors && (of_steps || !moment_.events.empty())) {
    ++left_out;
    return {};
  } else if (!of_errors) {
    return {};
  }
  if (of_errors) ++of_errors_;
  return fmt::format("moment {}", pictures.size() + 1);
}

/// Whether any began or ended in this state.
bool PageMoments::add_steps(const Progress& progress) {
  const std::vector<StepRecord>& steps = progress.steps();
  for (; ended_ < steps.size() && steps[ended_].ended >= 0; ++ended_) {
    moment_.ends.push_back(ended_);
    moment_.words.push_back("ends: " + steps[ended_].title);
  }
  for (; begun_ < steps.size(); ++begun_) {
    moment_.begins.push_back(begun_);
    moment_.words.push_back("begins: " + steps[begun_].title);
  }
  return !moment_.ends.empty() || !moment_.begins.empty();
}

/// Whether one of those in this state may have a picture of its own.
bool PageMoments::add_errors(const Progress& progress) {
  bool any = false;
  for (; seen_ < progress.events().size(); ++seen_) {
    const SessionEvent& event = progress.events()[seen_];
    if (!errors_.contains(event.kind)) continue;
    const auto last = last_.find(event.kind);
    if (last != last_.end() && event.time - last->second.time <= shared_within) {
      events[seen_] = last->second.picture;
      continue;
    }
    moment_.events.push_back(seen_);
    LastOfKind& of_kind = last_[event.kind];
    if (of_errors_ >= most_of_errors || of_kind.count >= most_of_a_kind) {
      if (of_kind.count == 0) last_.erase(event.kind);  // no picture to share
      continue;
    }
    of_kind = {event.time, pictures.size(), of_kind.count + 1};
    std::string words = to_text(event.kind);
    if (!event.instrument.empty()) words += ", " + event.instrument;
    if (!event.organ.empty()) words += ", " + event.organ;
    moment_.words.push_back(words);
    any = true;
  }
  return any;
}

std::optional<Failure> PageMoments::take(const Frame& frame) {
  Result<std::string> bytes = jpeg_bytes(frame.image, jpeg_quality);
  if (!bytes) return bytes.failure();
  const std::size_t picture = pictures.size();
  for (const std::size_t step : moment_.begins) step_begins[step] = picture;
  for (const std::size_t step : moment_.ends) step_ends[step] = picture;
  for (const std::size_t event : moment_.events) events[event] = picture;
  pictures.push_back({frame.time, fmt::format("{}", fmt::join(moment_.words, "; ")), "image/jpeg",
                      std::move(bytes).value(), frame.image.width, frame.image.height});
  return std::nullopt;
}

}  // namespace calot
