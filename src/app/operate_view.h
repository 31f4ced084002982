#pragma once
// What a window is shown of a world: made by the thread that simulates, between two steps.

#include <memory>

#include "session/progress.h"
#include "view/build_scene.h"
#include "window/live_view.h"

namespace calot {

class ViewMaker {
 public:
  /// The source must outlive it.
  ViewMaker(LatestView& latest, double time_limit, LiveMode mode, LiveSource& source,
            std::shared_ptr<LivePictures> pictures, int attempt)
      : latest_(latest),
        time_limit_(time_limit),
        mode_(mode),
        source_(source),
        pictures_(std::move(pictures)),
        attempt_(attempt) {}
  /// To be told of every state; makes a view of it where the last one has been taken.
  void look(const World& world, const Progress& progress);

 private:
  LatestView& latest_;
  double time_limit_;
  LiveMode mode_;
  LiveSource& source_;
  std::shared_ptr<LivePictures> pictures_;
  int attempt_;
  std::optional<SceneBuilder> builder_;
};

}  // namespace calot
