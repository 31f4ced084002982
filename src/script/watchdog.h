#pragma once
// Ends the process when the calls into a script outlast their limit. Only library calls that hardly ever return
// (a pattern that backtracks for ever) get that far; the instruction budget stops everything else.

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
  /// `script` is named in the message. `seconds` of wall time, which no result depends on, are for all calls
  /// until the next refill().
  Watchdog(std::string script, double seconds, int exit_code);
  ~Watchdog() = default;
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void arm();
  void disarm();
  void refill();
  /// Where the script is now, for the message; `file` must outlive the watchdog.
  void note_place(const std::string& file, int line);
  /// Called, from the watchdog's thread, before the process ends.
  void set_flush(std::function<void()> flush);

 private:
  void watch(const std::stop_token& stop);
  [[noreturn]] void end_process();

  std::string script_;
  double seconds_;
  int exit_code_;
  std::int64_t left_;                      ///< ns, of the thread that arms it
  std::atomic<std::int64_t> deadline_{0};  ///< ns of the steady clock; 0: not armed
  std::atomic<const std::string*> file_{nullptr};
  std::atomic<int> line_{0};
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::function<void()> flush_;
  std::jthread thread_;  ///< last: it uses all the others
};

}  // namespace calot
