#pragma once
// Judges the frames of one session.

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "goldens/report.h"

namespace calot {

/// Receives each frame's comparison once; its pictures are gone afterwards.
using GoldenSink = std::function<void(const GoldenResult&)>;

/// Frames are judged as they are drawn; those that drifted wait for the session's end, with their pictures.
class SessionJudge {
 public:
  /// `folder`: of the scenario's goldens; `wanted`: names of the frames to judge.
  SessionJudge(std::string scenario, std::filesystem::path folder, std::set<std::string> wanted,
               GoldenSink sink);
  void see(const Frame& frame);
  /// Judges what drifted and what was not drawn.
  void end(const Played& played);

 private:
  GoldenResult undrawn(const std::string& frame, const Played& played) const;

  std::string scenario_;
  std::filesystem::path folder_;
  std::set<std::string> wanted_;  ///< and not drawn yet
  GoldenSink sink_;
  std::vector<GoldenResult> drifted_;
};

}  // namespace calot
