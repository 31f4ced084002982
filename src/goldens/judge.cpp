#include "goldens/judge.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "session/build_info.h"

namespace calot {
namespace {

/// What differs in how the two were made, in words; empty when nothing does.
std::string other_make(const GoldenSidecar& golden, const GoldenSidecar& actual) {
  std::string text;
  const auto add = [&](const char* what, const std::string& a, const std::string& b) {
    if (a != b) text += fmt::format("{}{}: golden {}, here {}", text.empty() ? "" : "; ", what, a, b);
  };
  add("renderer", golden.renderer, actual.renderer);
  add("toolchain", golden.make.toolchain, actual.make.toolchain);
  add("instruction set", golden.make.instruction_set, actual.make.instruction_set);
  add("mathematics", golden.make.mathematics, actual.make.mathematics);
  return text;
}

std::string pixels_text(const ImageDifference& difference) {
  return fmt::format(
      "{} pixels differ, by up to {} of 255; the largest blob has {} pixels in {} x {} at ({}, {})",
      difference.differing_pixels, difference.max_delta, difference.largest_blob, difference.blob_width,
      difference.blob_height, difference.blob_x, difference.blob_y);
}

std::string end_text(const SessionResult& session) {
  const std::string why = session.end == SessionEnd::failed ? ": " + to_text(session.failure) : "";
  return to_text(session.end) + why;
}

}  // namespace

std::string to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "same";
    case Verdict::same_picture:
      return "same picture";
    case Verdict::drifted:
      return "drifted";
    case Verdict::physics_changed:
      return "physics changed";
    case Verdict::rendering_changed:
      return "rendering changed";
    case Verdict::missing:
      return "missing";
    case Verdict::unreadable:
      return "unreadable";
    case Verdict::stale:
      return "stale";
    case Verdict::no_scenario:
      return "no scenario";
    case Verdict::not_played:
      return "not played";
  }
  return "not played";
}

Judgement judge(const Golden& golden, const Golden& actual) {
  const GoldenSidecar &stored = golden.sidecar, &present = actual.sidecar;
  const std::string make = other_make(stored, present);
  const std::string in_brackets = make.empty() ? "" : fmt::format(" ({})", make);
  const bool same_state = stored.state_hash == present.state_hash;
  const bool same_binary = same_bits(stored.make, present.make);
  Judgement judgement;
  Result<ImageDifference> difference =
      compare(golden.image, actual.image, make.empty() ? CompareTolerance() : stored.tolerance);
  const bool same_picture = difference && difference->within;
  const std::string pixels = difference ? pixels_text(difference.value()) : to_text(difference.failure());
  const std::string edited =
      stored.scenario_hash == present.scenario_hash
          ? ""
          : "; the exercise's text has changed since, too, or that of a module that it uses";
  if (difference) judgement.difference = std::move(difference).value();
  if (same_state && same_picture) {
    if (judgement.difference->max_delta > 0) judgement.message = pixels + in_brackets;
  } else if (same_state) {
    judgement.verdict = Verdict::rendering_changed;
    judgement.message = pixels + edited + in_brackets;
  } else if (same_picture && !same_binary) {
    judgement.verdict = Verdict::same_picture;
    judgement.message = "other bits are expected here, and the picture does not differ" + in_brackets;
  } else if (!same_binary && present.time > 0 && judgement.difference) {
    judgement.verdict = Verdict::drifted;
    judgement.message = pixels + edited + in_brackets;
  } else {
    judgement.verdict = Verdict::physics_changed;
    judgement.message =
        fmt::format("state {}, golden {}; {}{}{}{}", hex(present.state_hash), hex(stored.state_hash),
                    same_picture ? "no pixel shows it" : pixels, edited,
                    same_binary ? "" : "; other bits are expected here, but not this much", in_brackets);
  }
  judgement.passed = judgement.verdict == Verdict::same || judgement.verdict == Verdict::same_picture;
  return judgement;
}

Judgement judge_undrawn(const Golden& golden, const SessionResult& session) {
  const bool same_binary = same_bits(golden.sidecar.make, this_make());
  return {same_binary ? Verdict::not_played : Verdict::drifted,
          false,
          fmt::format("the session ended before this picture ({})", end_text(session)),
          {}};
}

void judge_course(Judgement& drifted, const Course& golden, const Course& here,
                  const SessionResult& session) {
  const bool done = session.end == SessionEnd::steps_done;
  drifted.passed = done && same_course(golden, here);
  drifted.message =
      fmt::format("other bits are expected here, {} course ({}here {}; golden {}); {}",
                  drifted.passed ? "and the session took the golden's" : "but the session took another",
                  done ? "" : fmt::format("ended as {}; ", end_text(session)), to_text(here), to_text(golden),
                  drifted.message);
}

}  // namespace calot
