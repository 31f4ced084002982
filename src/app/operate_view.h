#pragma once
// What a window is shown of a world: made by the thread that simulates, between two steps.

#include <memory>

#include "session/progress.h"
#include "view/build_scene.h"
#include "window/live_view.h"

namespace calot {

class ViewMaker {
 public:
  struct Options {
    double time_limit = 0;  ///< s
    LiveMode mode = LiveMode::practice;
    SceneDetail detail = SceneDetail::full;
    std::shared_ptr<LivePictures> pictures;
    int attempt = 0;
  };
  /// The source must outlive it.
  ViewMaker(LatestView& latest, LiveSource& source, Options options)
      : latest_(latest), source_(source), options_(std::move(options)) {}
  /// To be told of every state; makes a view of it where the last one has been taken.
  void look(const World& world, const Progress& progress);

 private:
  LatestView& latest_;
  LiveSource& source_;
  Options options_;
  std::optional<SceneBuilder> builder_;
};

}  // namespace calot
