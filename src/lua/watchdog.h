#pragma once
// Ends the process when one call into a script outlasts its limit. Only library calls that never return (a
// pattern that backtracks for ever) get that far; the instruction budget stops everything else.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace calot {

class Watchdog {
 public:
  /// `script` is named in the message. Wall time, which no result depends on.
  Watchdog(std::string script, double seconds, int exit_code);
  ~Watchdog() = default;
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void arm();
  void disarm() { deadline_ = 0; }
  /// Called, from the watchdog's thread, before the process ends.
  void set_flush(std::function<void()> flush);

 private:
  void watch(const std::stop_token& stop);
  [[noreturn]] void end_process();

  std::string script_;
  double seconds_;
  int exit_code_;
  std::atomic<std::int64_t> deadline_{0};  ///< ns of the steady clock; 0: not armed
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::function<void()> flush_;
  std::jthread thread_;  ///< last: it uses all the others
};

}  // namespace calot
