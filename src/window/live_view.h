#pragma once
// What a window shows of a session that runs in another thread: plain data, the newest only.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "render/scene.h"
#include "session/live.h"

namespace calot {

struct HandView {
  std::string name, holds;      ///< the organ held, or empty
  double force = 0, limit = 8;  ///< N, at the tip; limit 0: it is not measured
  InstrumentPose pose;
  bool waits = false;  ///< outside, while another one is in its port
  bool drawn = false;  ///< back into its port, as another one is to come in
};

struct LiveView {
  int attempt = 0;  ///< another one begins where it changes
  Scene scene;
  double time = 0, time_limit = 0;       ///< s
  std::string step, hint;                ///< what is asked; how it is done, empty in an exam
  double step_time = 0, step_limit = 0;  ///< s; no limit: 0
  int step_number = 0;
  std::string last_event;
  std::vector<HandView> hands;             ///< the laparoscope is the last
  std::shared_ptr<LivePictures> pictures;  ///< to be told when this one is shown; may be null
  /// With these, see LivePictures::note_shown. A view that is replaced before it is taken would lose its inputs: none is made
  /// unless LatestView::wanted().
  std::vector<double> inputs;
  double paused = 0;  ///< s
};

/// One thread puts, another takes; what was not taken is replaced.
class LatestView {
 public:
  std::function<void()> when_put;  ///< wakes who takes; to be set before anything is put
  void put(std::shared_ptr<const LiveView> view) {
    {
      const std::scoped_lock lock(mutex_);
      view_ = std::move(view);
    }
    if (when_put) when_put();
  }
  /// None where there is none since the last time.
  std::shared_ptr<const LiveView> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(view_, nullptr);
  }
  /// Whether the last one has been taken: another need not be made before.
  bool wanted() {
    const std::scoped_lock lock(mutex_);
    return view_ == nullptr;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const LiveView> view_;
};

}  // namespace calot
