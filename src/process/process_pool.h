#pragma once
// Work shared among processes: what one of them does, even dying, touches no other.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "base/status.h"

namespace calot {

struct PoolOptions {
  int processes = 1;  ///< at most; where the system refuses some, those that there are do all
  const std::atomic<bool>* stop =
      nullptr;  ///< set: those at work are ended, and what is not done stays undone
};

/// Calls work(k) for each of 0 .. count - 1, each in some child process, and on_answer(k, its answer) here, one after
/// the other as they come. A failure as an answer: the process ended in the midst of it (its exit code names the kind);
/// another one goes on with the rest. The caller runs no threads. Fails (resource) where no process can be started.
Result<int> work_in_processes(int count, const PoolOptions& options,
                              const std::function<std::string(int)>& work,
                              const std::function<void(int, Result<std::string>)>& on_answer);

}  // namespace calot
